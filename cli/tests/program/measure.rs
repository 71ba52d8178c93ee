//! `twelvefold measure` as its user meets it.
use std::collections::HashMap;
use std::path::Path;
use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twelvefold")).args(arguments).output().unwrap()
}

fn table(output: &Output) -> HashMap<String, f64> {
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("measure,value"));
    let pairs = lines.map(|line| line.rsplit_once(',').unwrap());
    pairs.map(|(name, value)| (name.to_owned(), value.parse().unwrap())).collect()
}

fn hammersley(path: &Path, n: u32, scale: f64, shift: f64) {
    let mut text = String::from("x,y\n");
    for i in 0..n {
        let y = f64::from(i.reverse_bits()) / (f64::from(1u32 << 31) * 2.0);
        let x = f64::from(i) / f64::from(n);
        text += &format!("{},{}\n", scale * x + shift, scale * y - shift);
    }
    std::fs::write(path, text).unwrap();
}

#[test]
fn hammersley_points_have_their_known_discrepancies() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("points.csv");
    hammersley(&list, 256, 1.0, 0.0);
    let list_name = list.to_str().unwrap();
    let measured = table(&run(&["measure", list_name]));
    // Every box tried in exact fractions; and scipy.stats.qmc.
    assert!((measured["star discrepancy"] - 0.01605224609375).abs() < 1e-14);
    assert!((measured["L2 star discrepancy"] - 0.006277231397399603).abs() < 1e-12);
    assert_eq!(measured["points"], 256.0);

    // In another window all figures are the same.
    hammersley(&list, 256, 8.0, 32.0);
    let elsewhere = table(&run(&["measure", list_name, "--window", "32,-32,8,8"]));
    for (name, value) in &measured {
        assert!((elsewhere[name] - value).abs() < 1e-9, "{name}");
    }
    // Too many for the exact value: bounds that hold it.
    hammersley(&list, 32_768, 1.0, 0.0);
    let large = table(&run(&["measure", list_name]));
    let (low, high) = (large["star discrepancy at least"], large["star discrepancy at most"]);
    assert!(low > 0.0001 && low < high && high < 0.001, "{low} {high}");
}

#[test]
fn spectra_are_written_and_photographs_followed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (photo, list, table_file) = (path("photo.png"), path("dots.csv"), path("table.csv"));
    image::GrayImage::from_fn(200, 150, |x, y| image::Luma([(x / 2 + y) as u8]))
        .save(&photo)
        .unwrap();
    assert!(run(&["stipple", &photo, "-n", "5000", "-o", &list, "--quiet"]).status.success());
    let (spectrum, rings) = (path("spectrum.png"), path("rings.csv"));
    let output = run(&[
        "measure",
        &list,
        "--image",
        &photo,
        "-o",
        &table_file,
        "--spectrum",
        &spectrum,
        "--rings",
        &rings,
    ]);
    assert!(output.status.success() && output.stdout.is_empty(), "{output:?}");
    let text = std::fs::read_to_string(&table_file).unwrap();
    assert!(text.contains("block variance,0."), "{text}");
    assert!(text.contains("local nearest mean,0."), "{text}");
    let picture = image::open(&spectrum).unwrap();
    assert_eq!(picture.width(), picture.height());
    assert!(picture.width() > 250);
    let rings = std::fs::read_to_string(&rings).unwrap();
    assert!(rings.starts_with("frequency,power,anisotropy\n"));
    assert!(rings.lines().count() > 100);
}

#[test]
fn mistakes_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("points.csv");
    let name = list.to_str().unwrap();
    for (text, reason) in [
        ("x,y\n1,2\n3,oops\n", "line 3: \"oops\" is not a finite number"),
        ("0.5\n", "line 1 has no two coordinates"),
        ("0.5,0.5\n7,7\n", "has 2 points, 1 of them in the window 0,0,1,1"),
        ("", "has 0 points"),
    ] {
        std::fs::write(&list, text).unwrap();
        let output = run(&["measure", name]);
        assert_eq!(output.status.code(), Some(1));
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert_eq!(complaint.lines().count(), 1);
        assert!(complaint.contains(reason), "{complaint}");
    }
    assert_eq!(run(&["measure", name, "--window", "0,0,0,1"]).status.code(), Some(2));
}
