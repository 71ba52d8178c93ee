//! Pages, pens and marks; where dots lie on paper, and in which order; PDF and NPY.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{complaint_about, csv, dots, photograph, program, stipple, strokes};

/// Runs with these options and an output of this name; returns it and what was said.
pub(crate) fn drawn(photo: &Path, name: &str, options: &[&str]) -> (Vec<u8>, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    let output = stipple(photo, &[&["-o", path.to_str().unwrap()], options].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && output.stdout.is_empty(), "{options:?}: {said}");
    (fs::read(path).unwrap(), said)
}

fn svg(options: &[&str]) -> String {
    String::from_utf8(drawn(&photograph(), "a.svg", options).0).unwrap()
}

/// A gray picture of this size in a folder.
fn picture(folder: &TempDir, width: u32, height: u32, level: u8) -> PathBuf {
    let path = folder.path().join("picture.png");
    image::GrayImage::from_pixel(width, height, image::Luma([level])).save(&path).unwrap();
    path
}

pub(crate) fn least_distance(places: &[[f64; 2]]) -> f64 {
    // Sorted by x, so that only those near in x are compared.
    let mut sorted = places.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut least = f64::INFINITY;
    for (i, [x, y]) in sorted.iter().enumerate() {
        for [u, v] in &sorted[i + 1..] {
            if u - x >= least {
                break;
            }
            least = least.min((u - x).hypot(v - y));
        }
    }
    least
}

fn travel(places: &[[f64; 2]]) -> f64 {
    places.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
}

#[test]
fn a_page_is_in_millimeters_and_has_no_background_but_the_one_asked_for() {
    for (options, width, height) in [
        (&["--page", "a5"][..], "148", "210"),
        (&["--page", "A5", "--landscape"], "210", "148"),
        (&["--page", "8x10in"], "203.2", "254"),
        (&["--page", "120x80.5", "--margin", "0.25in"], "120", "80.5"),
    ] {
        let text = svg(&[options, &["-n", "500"]].concat());
        let size =
            format!(" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">");
        assert!(text.contains(&size), "{options:?}: {}", &text[..300]);
        assert!(!text.contains("<rect"));
    }
    let paper = svg(&["--page", "a5", "-n", "500", "--paper", "ivory"]);
    assert!(paper.contains("<rect width=\"148\" height=\"210\" fill=\"#fffff0\"/>"));
    let dark = svg(&["--page", "a5", "-n", "500", "--invert"]);
    assert!(dark.contains("inkscape:label=\"white\"") && dark.contains(" stroke=\"white\""));
    assert!(!dark.contains("<rect"));
}

#[test]
fn no_dot_of_a_pen_crosses_the_margins_or_comes_nearer_than_its_width() {
    let folder = TempDir::new().unwrap();
    // All black: as many dots as can be. A photograph: dots of every density.
    for (photo, options, pen) in [
        (picture(&folder, 60, 40, 0), &["--margin", "3"][..], 0.5),
        (photograph(), &["--margin", "3"], 0.4),
        (photograph(), &["--margin", "3", "--refine", "0"], 0.6),
    ] {
        let pen_text = pen.to_string();
        let options = [&["--page", "60x46", "--pen", &pen_text], options].concat();
        let (bytes, said) = drawn(&photo, "a.svg", &options);
        let places = strokes(std::str::from_utf8(&bytes).unwrap());
        assert!(least_distance(&places) >= pen - 1e-9, "{}", least_distance(&places));
        let border = 3.0 + pen / 2.0;
        for [x, y] in &places {
            assert!((border - 1e-9..=60.0 - border - 0.01 + 1e-9).contains(x), "{x}");
            assert!((border - 1e-9..=46.0 - border + 1e-9).contains(y), "{y}");
        }
        assert!(said.contains(&format!("{} points in ", places.len())), "{said}");
        assert!(said.contains(&format!("a {pen} mm pen fills")), "{said}");
    }
    // Dots of a black rectangle cover 0.8 of it.
    let (bytes, _) = drawn(
        &picture(&folder, 60, 40, 0),
        "a.csv",
        &["--page", "60x40", "--margin", "0", "--pen", "0.5"],
    );
    let count = dots(std::str::from_utf8(&bytes).unwrap()).len() as f64;
    let share = count * std::f64::consts::PI * 0.25 * 0.25 / (60.0 * 40.0);
    assert!((0.77..0.8).contains(&share), "{share}");
}

#[test]
fn more_dots_than_a_page_holds_are_an_error_that_says_how_many() {
    let options = ["-o", "-", "--page", "a5", "--pen", "0.5", "-n", "1000000"];
    let complaint = complaint_about("--points", &stipple(&photograph(), &options));
    assert!(complaint.starts_with("1000000 dots do not fit on the page"), "{complaint}");
    let capacity = complaint.rsplit(' ').next().unwrap();
    let options = ["--page", "a5", "--pen", "0.5", "-n", capacity, "--refine", "1"];
    assert!(!csv(&photograph(), &options).is_empty());
}

#[test]
fn the_picture_lies_in_the_middle_and_a_named_page_turns_with_it() {
    let folder = TempDir::new().unwrap();
    let wide = picture(&folder, 90, 30, 100);
    let (bytes, said) = drawn(&wide, "a.svg", &["--page", "a5", "--pen", "1"]);
    assert!(said.contains("on 210 x 148 mm, turned"), "{said}");
    let places = strokes(std::str::from_utf8(&bytes).unwrap());
    let range = |k: usize| {
        let values = || places.iter().map(|place| place[k]);
        (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max))
    };
    let ((left, right), (top, bottom)) = (range(0), range(1));
    assert!((left + right - 210.0).abs() < 1.0 && (top + bottom - 148.0).abs() < 1.0);
    assert!(left < 12.0 && ((right - left) / (bottom - top) - 3.0).abs() < 0.1);
}

#[test]
fn each_mark_is_its_strokes() {
    let options = ["--page", "a5", "--pen", "0.5", "-n", "900"];
    let with = |more: &[&str]| svg(&[&options, more].concat());
    let count = strokes(&with(&[])).len();
    assert!(count.abs_diff(900) < 20);
    for (marks, more, in_a_dot) in [
        ("tap", &[][..], 0),
        ("ring", &["--dot-size", "0.9"], 1),
        ("ring", &["--dot-size", "1.9mm"], 2),
    ] {
        let text = with(&[&["--marks", marks], more].concat());
        // Of a dot within rings, the move to each inner one counts too.
        assert_eq!(strokes(&text).len(), count * in_a_dot.max(1), "{marks}");
        let half_circles = text.split("<path").skip(1).map(|path| path.matches('a').count());
        assert_eq!(half_circles.sum::<usize>(), 2 * in_a_dot * count);
        assert!(text.contains("stroke-width=\"0.5"));
    }
    // Without a page there is a ground for what is seen, and none for what a pen draws.
    assert!(svg(&["-n", "90"]).contains("<rect"));
    assert!(!svg(&["-n", "90", "--marks", "tap"]).contains("<rect"));
}

#[test]
fn orders_hold_the_same_dots_and_the_short_one_travels_least() {
    let options = ["--page", "a5", "-n", "4000"];
    let places = |more: &[&str]| strokes(&svg(&[&options, more].concat()));
    let sorted = |places: &[[f64; 2]]| {
        let whole = |t: f64| (t * 1e3).round() as i64;
        let mut sorted: Vec<_> = places.iter().map(|[x, y]| (whole(*x), whole(*y))).collect();
        sorted.sort_unstable();
        sorted
    };
    let none = places(&["--order", "none"]);
    let short = places(&["--order", "short"]);
    assert_eq!(sorted(&none), sorted(&short));
    assert!(travel(&short) < 0.25 * travel(&none), "{} {}", travel(&short), travel(&none));
    assert_eq!(places(&[]), none);
    assert_eq!(places(&["--marks", "tap"]), short);

    // A beginning of ranked dots has its share in every part of the picture.
    let ranked = places(&["--order", "rank", "--refine", "0"]);
    let raw = places(&["--order", "none", "--refine", "0"]);
    assert_eq!(sorted(&ranked), sorted(&raw));
    let left = |places: &[[f64; 2]]| {
        places.iter().filter(|place| place[0] < 74.0).count() as f64 / places.len() as f64
    };
    assert!((left(&ranked[..1000]) - left(&raw)).abs() < 0.02);
}

#[test]
fn a_line_is_one_stroke_through_all_dots() {
    for options in [&["--page", "a5", "--pen", "0.6"][..], &["-n", "2000"]] {
        let text = svg(&[options, &["--line"]].concat());
        let document = roxmltree::Document::parse(&text).unwrap();
        let paths: Vec<_> = document.descendants().filter_map(|node| node.attribute("d")).collect();
        assert_eq!((paths.len(), paths[0].matches(['M', 'm']).count()), (1, 1));
        let places = strokes(&text);
        let table = csv(&photograph(), &[options, &["--line"]].concat());
        let listed = dots(&table);
        assert_eq!(places.len(), listed.len());
        for ([x, y], (u, v)) in places.iter().zip(listed) {
            assert!((x - f64::from(u)).abs() < 1e-3 && (y - f64::from(v)).abs() < 1e-3);
        }
        assert!(!crosses_itself(&places));
    }
}

/// Whether any two strokes of a line that do not follow each other have a point in common.
fn crosses_itself(places: &[[f64; 2]]) -> bool {
    let whole = |t: f64| (t * 1e3).round() as i64;
    let places: Vec<_> = places.iter().map(|&[x, y]| [whole(x), whole(y)]).collect();
    let side = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    let apart = |p: [i64; 2], q: [i64; 2], r: [i64; 2], s: [i64; 2]| {
        (0..2).any(|k| p[k].max(q[k]) < r[k].min(s[k]) || r[k].max(s[k]) < p[k].min(q[k]))
    };
    (0..places.len() - 1).any(|i| {
        let [a, b] = [places[i], places[i + 1]];
        (i + 2..places.len() - 1).any(|j| {
            let [c, d] = [places[j], places[j + 1]];
            !apart(a, b, c, d)
                && side(a, b, c) * side(a, b, d) <= 0
                && side(c, d, a) * side(c, d, b) <= 0
        })
    })
}

#[test]
fn formats_are_chosen_by_name_or_by_word() {
    let options = ["-n", "500", "--quiet"];
    for (format, start) in [
        ("svg", &b"<svg "[..]),
        ("png", b"\x89PNG"),
        ("pdf", b"%PDF-"),
        ("csv", b"x,y\n"),
        ("npy", b"\x93NUMPY"),
    ] {
        let output = program()
            .arg("stipple")
            .arg(photograph())
            .args(["-o", "-", "--format", format])
            .args(options)
            .output()
            .unwrap();
        assert!(output.status.success() && output.stdout.starts_with(start), "{format}");
        let (by_name, _) = drawn(&photograph(), &format!("a.{format}"), &options);
        assert!(by_name == output.stdout, "{format}");
        let (by_word, _) =
            drawn(&photograph(), "a.dots", &[&options[..], &["--format", format]].concat());
        assert!(by_word == output.stdout, "{format}");
    }
}

#[test]
fn npy_holds_the_dots_of_csv() {
    for options in [&["-n", "700"][..], &["-n", "700", "--page", "a5"]] {
        let (bytes, _) = drawn(&photograph(), "a.npy", options);
        let listed = dots(&csv(&photograph(), options));
        let text = String::from_utf8_lossy(&bytes[10..128]).into_owned();
        assert!(text.contains(&format!("'shape': ({}, 2)", listed.len())), "{text}");
        let numbers: Vec<f32> = bytes[128..]
            .chunks_exact(4)
            .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
            .collect();
        assert_eq!(numbers, listed.iter().flat_map(|&(x, y)| [x, y]).collect::<Vec<f32>>());
    }
}

#[test]
fn a_png_of_a_page_has_its_pixels_in_an_inch() {
    let (bytes, _) =
        drawn(&photograph(), "a.png", &["--page", "2x1in", "-n", "300", "--dpi", "100"]);
    let chunk = bytes.windows(4).position(|part| part == b"pHYs").unwrap() + 4;
    assert_eq!(bytes[chunk..chunk + 9], [0, 0, 15, 97, 0, 0, 15, 97, 1]);
    let pixels = image::load_from_memory(&bytes).unwrap();
    assert_eq!((pixels.width(), pixels.height()), (200, 100));
    let paper = ["--page", "2x1in", "-n", "300", "--dpi", "100", "--paper", "#123456"];
    let colors = image::load_from_memory(&drawn(&photograph(), "a.png", &paper).0).unwrap();
    assert_eq!(colors.into_rgb8().get_pixel(0, 0).0, [0x12, 0x34, 0x56]);
}

#[test]
fn mistakes_are_one_line() {
    let run = |options: &[&str]| stipple(&photograph(), &[&["-o", "-"], options].concat());
    for (subject, options, expected) in [
        ("--margin", &["--page", "20x20", "--margin", "10"][..], "leave no room for a dot"),
        ("--dot-size", &["--dot-size", "1mm", "--format", "svg"], "needs a --page"),
        ("--dot-size", &["--page", "a4", "--pen", "1", "--dot-size", "2"], "is not for a pen"),
        ("--marks ring", &["--marks", "ring"], "needs the width of a --pen"),
        (
            "--dot-size",
            &["--page", "a4", "--pen", "1", "--marks", "ring", "--dot-size", "0.5"],
            "is less than",
        ),
        ("--dpi", &["--page", "a5", "--dpi", "300", "--format", "svg"], "no effect on SVG"),
        ("--dpi", &["--page", "a5", "--dpi", "300", "--format", "npy"], "no effect on NPY"),
        ("--scale", &["--scale", "2"], "no effect on CSV"),
        ("--paper", &["--paper", "ivory", "--format", "npy"], "no effect on NPY"),
        ("--dot-size", &["--page", "a4", "--dot-size", "2"], "no effect on CSV"),
        ("--points", &["--line", "-n", "2000000"], "at most 1000000 dots"),
        ("--points", &["--order", "short", "-n", "20000000"], "at most 10000000 dots"),
    ] {
        let complaint = complaint_about(subject, &run(options));
        assert!(complaint.contains(expected), "{options:?}: {complaint}");
    }
    for options in [
        &["--page", "a9"][..],
        &["--page", "0x10"],
        &["--page", "a4", "--scale", "2"],
        &["--page", "a4", "--margin", "-1"],
        &["--page", "a4", "--pen", "0"],
        &["--page", "a4", "--pen", "1px"],
        &["--page", "a4", "--dpi", "0"],
        &["--page", "a4", "--pen", "1", "--dot-gain", "correct"],
        &["--pen", "0.3"],
        &["--margin", "3"],
        &["--landscape"],
        &["--dpi", "300"],
        &["--marks", "blob"],
        &["--order", "long"],
        &["--paper", "papyrus"],
        &["--format", "gif"],
        &["--line", "--marks", "tap"],
        &["--line", "--order", "rank"],
        &["--line", "--exact", "100"],
    ] {
        assert_eq!(run(options).status.code(), Some(2), "{options:?}");
    }
}
