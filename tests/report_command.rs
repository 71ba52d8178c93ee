//! `twelvefold report` as its user meets it, in small.
#![cfg(feature = "cli")]

use std::process::Command;

#[test]
fn a_small_report_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("report");
    let output = Command::new(env!("CARGO_BIN_EXE_twelvefold"))
        .args(["report", "--samples", "256", "--quiet", "-o"])
        .arg(&target)
        .output()
        .unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let markdown = std::fs::read_to_string(target.join("report.md")).unwrap();
    for scene in ["smooth bump", "zone plate", "sun, with occluders", "tone error"] {
        assert!(markdown.contains(scene), "{scene}");
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
    for file in std::fs::read_dir(&target).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "svg") {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(roxmltree::Document::parse(&text).is_ok(), "{}", path.display());
        }
    }
}
