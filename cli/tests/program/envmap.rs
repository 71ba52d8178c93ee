//! `twelvefold envmap` and `twelvefold stipple --exact` as their user meets them.
use std::path::Path;
use std::process::{Command, Output};

use image::{ImageBuffer, Rgb};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_twelvefold")).args(arguments).output().unwrap()
}

/// Writes a small sky: dim, with a bright patch, and one negative pixel if asked.
fn sky(path: &Path, negative: bool) {
    let pixel = |x: usize, y: usize| match (x, y) {
        (40..42, 9) => (900.0f32, 800.0f32, 500.0f32),
        (3, 30) if negative => (-0.25, 0.5, 0.5),
        _ => (0.1, 0.2, 0.5),
    };
    if path.extension().is_some_and(|extension| extension == "exr") {
        return exr::prelude::write_rgb_file(path, 64, 32, pixel).unwrap();
    }
    let image = ImageBuffer::from_fn(64, 32, |x, y| {
        let (red, green, blue) = pixel(x as usize, y as usize);
        Rgb([red, green, blue])
    });
    image::DynamicImage::ImageRgb32F(image).save(path).unwrap();
}

fn table(output: &Output) -> Vec<[f64; 7]> {
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x,y,z,pdf,red,green,blue"));
    lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect()
}

#[test]
fn directions_estimate_the_light_of_the_map() {
    let folder = tempfile::tempdir().unwrap();
    for (name, tolerance) in [("sky.exr", 0.02), ("sky.hdr", 0.03)] {
        let path = folder.path().join(name);
        sky(&path, false);
        // All light: solid angles of the rows, exactly.
        let row = |y: f64| (std::f64::consts::PI * y / 32.0).cos();
        let pixel = |y: f64| std::f64::consts::TAU / 64.0 * (row(y) - row(y + 1.0));
        let truth = 0.2 * 4.0 * std::f64::consts::PI + 2.0 * (800.0 - 0.2) * pixel(9.0);
        for method in ["sobol", "progressive", "warp"] {
            let map = path.to_str().unwrap();
            let output = run(&["envmap", map, "-n", "1000", "-o", "-", "--method", method]);
            let lights = table(&output);
            assert_eq!(lights.len(), 1000);
            let mut green = 0.0;
            for [x, y, z, pdf, _, g, _] in lights {
                assert!((x * x + y * y + z * z - 1.0).abs() < 1e-14);
                green += g / (1000.0 * pdf);
            }
            assert!((green / truth - 1.0).abs() < tolerance, "{name} {method}: {green} {truth}");
        }
    }
}

#[test]
fn mistakes_are_one_line_and_negative_light_needs_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("negative.exr");
    sky(&map, true);
    let map = map.to_str().unwrap();
    let output = run(&["envmap", map, "-n", "10", "-o", "-"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty());
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert_eq!(complaint.lines().count(), 1);
    assert!(complaint.contains("red of pixel (3, 30) is -0.25"), "{complaint}");
    assert!(complaint.contains("--negative zero"), "{complaint}");
    let output = run(&["envmap", map, "-n", "10", "-o", "-", "--negative", "zero"]);
    assert_eq!(table(&output).len(), 10);
    assert_eq!(table(&run(&["envmap", map, "-n", "0", "-o", "-", "--negative", "zero"])).len(), 0);

    let photo = folder.path().join("photo.png");
    image::DynamicImage::new_rgb8(4, 4).save(&photo).unwrap();
    let output = run(&["envmap", photo.to_str().unwrap(), "-n", "10", "-o", "-"]);
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains("holds no radiance"), "{complaint}");

    let black = folder.path().join("black.exr");
    exr::prelude::write_rgb_file(&black, 8, 4, |_, _| (0.0f32, 0.0f32, 0.0f32)).unwrap();
    let output = run(&["envmap", black.to_str().unwrap(), "-n", "10", "-o", "-"]);
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains("is black"), "{complaint}");
}

/// Writes a black sky with one bright pixel.
fn spot(path: &Path, at: (usize, usize)) {
    let pixel =
        |x: usize, y: usize| if (x, y) == at { (5.0f32, 5.0, 5.0) } else { (0.0, 0.0, 0.0) };
    exr::prelude::write_rgb_file(path, 64, 32, pixel).unwrap();
}

#[test]
fn a_spot_lies_where_the_frame_puts_it() {
    let folder = tempfile::tempdir().unwrap();
    let direction = |at, options: &[&str]| {
        let path = folder.path().join("spot.exr");
        spot(&path, at);
        let mut arguments = vec!["envmap", path.to_str().unwrap(), "-n", "1", "-o", "-"];
        arguments.extend(options);
        let [x, y, z, ..] = table(&run(&arguments))[0];
        [x, y, z]
    };
    // Right of the center, left of it, and just past the seam, all near the horizon; and the zenith.
    let (right, left, seam, up) = ((48, 15), (16, 15), (0, 15), (0, 0));
    let expected = [
        ("pbrt", [-1, -2, 3], "pbrt"),
        ("mitsuba", [3, -1, 2], "mitsuba"),
        ("blender", [1, -2, 3], "cycles"),
        ("gltf", [1, 3, 2], "threejs"),
        ("openexr", [3, -1, 2], "usd"),
    ];
    // ±1, ±2, ±3: the axes ±x, ±y, ±z of the center, of what is right of it, and of up. Mitsuba's and
    // OpenEXR's right is -x.
    let along = |[x, y, z]: [f64; 3], axis: i32| {
        [x, y, z][axis.unsigned_abs() as usize - 1] * f64::from(axis.signum()) > 0.98
    };
    for (name, [center, to_right, zenith], alias) in expected {
        for name in [name, alias] {
            let options = ["--frame", name];
            assert!(along(direction(right, &options), to_right), "{name} right");
            assert!(along(direction(left, &options), -to_right), "{name} left");
            assert!(along(direction(seam, &options), -center), "{name} seam");
            assert!(along(direction(up, &options), zenith), "{name} up");
        }
    }
    assert!(along(direction(right, &[]), -2), "pbrt's is the default");
    // Counterclockwise from above: -y to +x.
    let turned = direction(right, &["--frame", "blender", "--rotate", "90"]);
    assert!(along(turned, 1), "{turned:?}");
    let back = direction(right, &["--frame", "blender", "--rotate", "-90", "--method", "warp"]);
    assert!(along(back, -1), "{back:?}");
}

#[test]
fn a_spot_in_a_file_lies_right_of_the_center_as_seen_from_inside() {
    // 100 × 50 pixels of black but for two in row 25: blue in column 50, red in column 60.
    let map = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/right.hdr");
    let angle = |column: f64| (std::f64::consts::TAU * (column - 50.0) / 100.0).sin_cos();
    let height = (std::f64::consts::PI * 25.5 / 50.0).cos();
    // Right of +x is -y where z is up and coordinates are right-handed; right of +z is -x where y is.
    let expected = [
        ("blender", (|(sin, cos), up| [cos, -sin, up]) as fn((f64, f64), f64) -> [f64; 3]),
        ("openexr", |(sin, cos), up| [-sin, up, cos]),
    ];
    for (frame, place) in expected {
        let lights = table(&run(&["envmap", map, "-n", "64", "-o", "-", "--frame", frame]));
        assert_eq!(lights.len(), 64);
        let mut reds = 0;
        for [x, y, z, _, red, green, blue] in lights {
            let column = match [red, green, blue] {
                [1.0, 0.0, 0.0] => 60.5,
                [0.0, 0.0, 1.0] => 50.5,
                other => panic!("{other:?} is in no pixel"),
            };
            reds += usize::from(red > 0.0);
            // Half a pixel is 1.8°, both ways.
            for (found, at) in [x, y, z].into_iter().zip(place(angle(column), height)) {
                assert!((found - at).abs() < 0.035, "{frame}: ({x}, {y}, {z}), {column}");
            }
        }
        // As their luminances, 0.2126 and 0.0722.
        assert!((46..=50).contains(&reds), "{reds}");
    }
}

#[test]
fn every_kind_of_component_that_is_no_radiance_has_its_option() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.exr");
    let kinds = [
        (f32::NAN, "--nan zero", vec!["--nan", "zero"]),
        (f32::INFINITY, "--infinite clamp=V", vec!["--infinite", "clamp=2"]),
        (f32::INFINITY, "--infinite clamp=V", vec!["--infinite", "zero"]),
        (f32::NEG_INFINITY, "--infinite zero", vec!["--infinite", "zero", "--negative", "zero"]),
        (-1.0, "--negative zero", vec!["--negative", "zero"]),
    ];
    for (value, hint, options) in kinds {
        let pixel = |x, _| if x == 5 { (value, 0.5, 0.5) } else { (0.25f32, 0.25, 0.25) };
        exr::prelude::write_rgb_file(&path, 16, 8, pixel).unwrap();
        let mut arguments = vec!["envmap", path.to_str().unwrap(), "-n", "64", "-o", "-"];
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(1));
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert!(complaint.contains("red of pixel (5, 0)"), "{complaint}");
        assert!(complaint.contains(hint), "{value}: {complaint}");
        arguments.extend(&options);
        let reds: Vec<f64> = table(&run(&arguments)).iter().map(|light| light[4]).collect();
        let expected = if options[1] == "clamp=2" { 2.0 } else { 0.0 };
        assert!(reds.contains(&expected) && reds.contains(&0.25), "{value} {options:?}");
    }
}

#[test]
fn interpolated_light_needs_its_own_method() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spot.exr");
    spot(&path, (0, 9));
    let map = path.to_str().unwrap();
    let bilinear = ["envmap", map, "-n", "256", "-o", "-", "--filter", "bilinear"];
    let lights = table(&run(&bilinear));
    // The pixel and its neighbors, of which the seam is between two: nine times the area.
    assert!(lights.iter().any(|light| light[4] < 0.5) && lights.iter().any(|light| light[4] > 4.0));
    let total: f64 = lights.iter().map(|light| light[4] / (256.0 * light[3])).sum();
    let rows = |y: f64| (std::f64::consts::PI * y / 32.0).cos();
    let exact = 5.0 * std::f64::consts::TAU / 64.0 * (rows(9.0) - rows(10.0));
    assert!((total / exact - 1.0).abs() < 0.01, "{total} {exact}");
    let output = run(&[&bilinear[..], &["--method", "progressive"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("--method sobol"));
}

#[test]
fn exact_stippling_has_exactly_as_many_dots_and_grows_by_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let photo = folder.path().join("ramp.png");
    let image = ImageBuffer::from_fn(120, 90, |x, y| image::Luma([(x + y) as u8]));
    image::DynamicImage::ImageLuma8(image).save(&photo).unwrap();
    let photo = photo.to_str().unwrap();
    let dots = |n: &str| {
        let options = ["--refine", "0", "--centers", "fixed", "-o", "-", "--quiet"];
        let output = run(&[&["stipple", photo, "--exact", n], &options[..]].concat());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let all = dots("1234");
    assert_eq!(all.lines().count(), 1 + 1234);
    for n in ["0", "1", "500"] {
        let some = dots(n);
        assert_eq!(some.lines().count(), 1 + n.parse::<usize>().unwrap());
        assert!(all.starts_with(&some));
    }
    let both = run(&["stipple", photo, "--exact", "5", "-n", "5", "-o", "-"]);
    assert_eq!(both.status.code(), Some(2));
}
