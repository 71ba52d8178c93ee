//! What the files say: counts, places, markup, tone.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::{csv, dots, photograph, stipple};

/// Runs with `-o FILE` and returns what is in it then.
fn file(photo: &Path, name: &str, arguments: &[&str]) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    let options = [&["--quiet", "-o", path.to_str().unwrap()], arguments].concat();
    let output = stipple(photo, &options);
    assert!(output.status.success() && output.stderr.is_empty() && output.stdout.is_empty());
    assert_eq!(crate::names(folder.path()), [name]);
    fs::read(path).unwrap()
}

#[test]
fn as_many_points_as_asked_for_all_inside_the_half_open_picture() {
    for (points, tolerance) in [(20_000, 0.01), (1_000_000, 0.003)] {
        for options in [&[][..], &["--invert"], &["--linear"]] {
            let points = points.to_string();
            let table = csv(&photograph(), &[&["--points", &points], options].concat());
            let dots = dots(&table);
            let wanted: f64 = points.parse().unwrap();
            let error = (dots.len() as f64 / wanted - 1.0).abs();
            assert!(error <= tolerance, "{points} {options:?}: {}", dots.len());
            assert!(
                dots.iter().all(|&(x, y)| (0.0..512.0).contains(&x) && (0.0..512.0).contains(&y))
            );
        }
    }
}

#[test]
fn the_dots_follow_the_tone() {
    let photo = image::open(photograph()).unwrap().into_luma8();
    // Cells of 64 pixels, a few hundred dots each.
    for (options, importance) in [
        (&[][..], (|v| 1.0 - v) as fn(f64) -> f64),
        (&["--invert"], |v| v),
        (&["--linear"], |v| 1.0 - ((v + 0.055) / 1.055).powf(2.4)),
    ] {
        let mut wanted = [0.0; 64];
        for (x, y, pixel) in photo.enumerate_pixels() {
            wanted[(y / 64 * 8 + x / 64) as usize] += importance(f64::from(pixel.0[0]) / 255.0);
        }
        let total: f64 = wanted.iter().sum();
        let dots = dots(&csv(&photograph(), &[&["--points", "40000"], options].concat()));
        let mut found = [0.0; 64];
        for &(x, y) in &dots {
            found[y as usize / 64 * 8 + x as usize / 64] += 1.0;
        }
        for (found, wanted) in found.iter().zip(wanted) {
            let expected = wanted / total * 40_000.0;
            // Far below the 3√n of random points.
            assert!((found - expected).abs() < 6.0 + 0.05 * expected, "{found} for {expected}");
        }
    }
}

#[test]
fn the_same_arguments_give_the_same_bytes_and_another_seed_others() {
    for name in ["a.csv", "a.svg", "a.png"] {
        let options = ["--points", "3000"];
        let first = file(&photograph(), name, &options);
        assert_eq!(first, file(&photograph(), name, &options));
        assert_eq!(first, file(&photograph(), name, &["--points", "3000", "--seed", "0"]));
        assert_ne!(first, file(&photograph(), name, &["--points", "3000", "--seed", "1"]));
    }
}

#[test]
fn csv_in_a_file_is_the_csv_on_standard_output() {
    let options = ["--points", "3000"];
    let table = csv(&photograph(), &options);
    assert_eq!(file(&photograph(), "A.CSV", &options), table.as_bytes());
}

#[test]
fn svg_is_well_formed_and_holds_every_dot() {
    let bytes = file(
        &photograph(),
        "a.svg",
        &["--points", "5000", "--scale", "1.5", "--dot-gain", "ignore"],
    );
    let text = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().namespace(), Some("http://www.w3.org/2000/svg"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 512 512"));
    assert_eq!((root.attribute("width"), root.attribute("height")), (Some("768"), Some("768")));
    let texts: Vec<_> = ["title", "desc"]
        .iter()
        .map(|name| root.children().find(|node| node.has_tag_name(*name)).unwrap().text())
        .collect();
    assert_eq!(texts[0], Some("camera.png"));
    assert!(texts[1].unwrap().contains("seed 0"));

    let strokes = crate::strokes(&text);
    let dots = dots(&csv(&photograph(), &["--points", "5000"]));
    assert_eq!(strokes.len(), dots.len());
    // In black, dots are 5.09 pixels apart; a hundredth of that is allowed.
    for ([u, v], (x, y)) in strokes.iter().zip(dots) {
        assert!((u - f64::from(x)).abs() < 0.0505 && (v - f64::from(y)).abs() < 0.0505);
    }
}

#[test]
fn png_has_the_size_and_the_tone_of_the_photograph() {
    let photo = image::open(photograph()).unwrap().into_luma8();
    let mean = |picture: &image::GrayImage, of: fn(f64) -> f64| {
        picture.pixels().map(|pixel| of(f64::from(pixel.0[0]) / 255.0)).sum::<f64>()
            / f64::from(picture.width() * picture.height())
    };
    let encoded = |v: f64| v;
    let light = |v: f64| {
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    // Dots that overlap in the dark lose some of their ink; small dots lose less.
    for (options, side, of, tolerance) in [
        (&["--points", "20000"][..], 512, encoded as fn(f64) -> f64, 0.05),
        (&["--points", "300000"], 512, encoded, 0.015),
        (&["--points", "20000", "--invert"], 512, encoded, 0.05),
        (&["--points", "300000", "--linear"], 512, light, 0.05),
        (&["--points", "20000", "--scale", "2"], 1024, encoded, 0.05),
        (&["--points", "20000", "--scale", "0.25"], 128, encoded, 0.05),
    ] {
        let bytes = file(&photograph(), "a.png", options);
        let drawn = match image::load_from_memory(&bytes).unwrap() {
            image::DynamicImage::ImageLuma8(drawn) => drawn,
            other => panic!("{:?}", other.color()),
        };
        assert_eq!(drawn.dimensions(), (side, side));
        let (found, wanted) = (mean(&drawn, of), mean(&photo, of));
        assert!((found - wanted).abs() < tolerance, "{options:?}: {found} for {wanted}");
    }
}

#[test]
fn dot_size_is_a_diameter_in_pixels_of_the_photograph() {
    for (size, scale) in [(2.0, 1.0), (3.0, 2.0), (0.5, 1.0), (60.0, 1.0)] {
        let (size_text, scale_text) = (size.to_string(), scale.to_string());
        let options = ["--points", "40", "--dot-size", &size_text, "--scale", &scale_text];
        let drawn = image::load_from_memory(&file(&photograph(), "a.png", &options)).unwrap();
        let ink: f64 =
            drawn.into_luma8().pixels().map(|pixel| 1.0 - f64::from(pixel.0[0]) / 255.0).sum();
        let count = dots(&csv(&photograph(), &["--points", "40"])).len() as f64;
        let radius = size * scale / 2.0;
        let wanted = count * std::f64::consts::PI * radius * radius;
        // Large dots hang over the border, and over each other.
        let tolerance = if size > 10.0 { 0.4 } else { 0.03 };
        assert!((ink / wanted - 1.0).abs() < tolerance, "{size} x {scale}: {ink} for {wanted}");
        let svg = String::from_utf8(file(&photograph(), "a.svg", &options)).unwrap();
        assert!(svg.contains(&format!(" stroke-width=\"{size}")));
    }
}

#[test]
fn without_a_number_black_has_a_dot_every_three_pixels() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("black.png");
    image::GrayImage::new(300, 200).save(&path).unwrap();
    let dots = dots(&csv(&path, &[]));
    assert!(dots.len().abs_diff(300 * 200 / 9) < 70, "{}", dots.len());
}

#[test]
fn no_points_make_empty_files_of_each_kind() {
    assert_eq!(file(&photograph(), "a.csv", &["--points", "0"]), b"x,y\n");
    let svg = String::from_utf8(file(&photograph(), "a.svg", &["--points", "0"])).unwrap();
    assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("<path"));
    let png = image::load_from_memory(&file(&photograph(), "a.png", &["--points", "0"])).unwrap();
    assert!(png.into_luma8().pixels().all(|pixel| pixel.0 == [255]));
}

#[test]
fn the_summary_counts_the_points_and_quiet_says_nothing() {
    let output = stipple(&photograph(), &["-o", "-", "--points", "2000"]);
    let summary = String::from_utf8(output.stderr).unwrap();
    assert_eq!(summary.lines().count(), 1);
    let count = dots(&String::from_utf8(output.stdout).unwrap()).len();
    assert!(summary.starts_with(&format!("twelvefold: {count} points in ")), "{summary}");
    assert!(summary.ends_with(" points a second\n"), "{summary}");
}

#[test]
fn the_best_dots_are_as_many_and_not_the_refined_ones() {
    let refined = csv(&photograph(), &["--exact", "3000"]);
    let best = csv(&photograph(), &["--exact", "3000", "--best"]);
    assert_eq!(dots(&best).len(), 3000);
    assert_ne!(best, refined);
    let options = ["-o", "-", "--best", "--refine", "0"];
    let complaint = crate::complaint_about("--best", &stipple(&photograph(), &options));
    assert!(complaint.contains("--refine 0"), "{complaint}");
}
