//! `twelvefold-lab report` as its user meets it, in small.

use std::process::Command;

#[test]
fn a_small_report_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("report");
    let output = Command::new(env!("CARGO_BIN_EXE_twelvefold-lab"))
        .args(["report", "--samples", "256", "--quiet", "-o"])
        .arg(&target)
        .output()
        .unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let markdown = std::fs::read_to_string(target.join("report.md")).unwrap();
    for scene in ["smooth bump", "zone plate", "sun, with occluders", "tone error"] {
        assert!(markdown.contains(scene), "{scene}");
    }
    // Every sampler has its row, and every variant a time.
    for row in [
        "ours, relaxed",
        "ours, complete level",
        "ours, seamless set",
        "ours, normalized",
        "ours, smoothed",
        "ours, post-stratified",
        "ours, few-probe",
        "ours, warped level",
        "ours, Sobol + warp",
        "Owen Sobol + warp",
        "Poisson disk",
        "R2 + inverse CDF",
        "rejection (white)",
        "relaxed, f32, depth 2",
        "fixed, f32, depth 4",
        "fixed, few-probe bounds",
        "relaxed stipple map",
        "exactly n, f64",
    ] {
        let mut rows = markdown.lines().filter(|line| line.starts_with(&format!("| {row}")));
        assert!(rows.next().is_some_and(|line| line.matches("| ").count() > 3), "{row}");
    }
    let csv = std::fs::read_to_string(target.join("report.csv")).unwrap();
    let error = |scene: &str, sampler: &str| -> f64 {
        let mark = format!("\"{scene}\",\"{sampler}\",256,");
        let line = csv.lines().find(|line| line.contains(&mark)).unwrap();
        line.split(',').nth_back(1).unwrap().parse().unwrap()
    };
    // What everybody knows: a complete level beats white noise by far on a smooth function, and a
    // warp beats it on a sky.
    assert!(
        error("smooth bump", "ours, complete level") < 0.1 * error("smooth bump", "white noise")
    );
    let white = error("smooth sky", "alias + jitter (white)");
    assert!(error("smooth sky", "ours, warped level") < 0.3 * white);
    // The short cut misses most of what is small and bright; the proven bound does not.
    assert!(error("sun", "ours, few-probe") > 2.0 * error("sun", "ours, 1/density"));
    for file in std::fs::read_dir(&target).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "svg") {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(roxmltree::Document::parse(&text).is_ok(), "{}", path.display());
        }
    }
}
