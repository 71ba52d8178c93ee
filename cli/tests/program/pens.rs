//! Drawings in color: pens, their layers, and the colors that come back.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::paper::{drawn, least_distance};
use crate::{complaint as complaint_of, csv, photograph, stipple, strokes};

/// A color picture in a folder: what a place, from 0 to 1 each way, looks like.
fn picture(folder: &TempDir, size: u32, color: impl Fn(f64, f64) -> [u8; 3]) -> PathBuf {
    let path = folder.path().join("picture.png");
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(size);
    image::RgbImage::from_fn(size, size, |x, y| image::Rgb(color(at(x), at(y))))
        .save(&path)
        .unwrap();
    path
}

/// The dots of a table with pens.
fn penned(csv: &str) -> Vec<([f64; 2], &str)> {
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("x,y,pen"));
    lines
        .map(|line| {
            let parts: Vec<&str> = line.split(',').collect();
            ([parts[0].parse().unwrap(), parts[1].parse().unwrap()], parts[2])
        })
        .collect()
}

fn decode(encoded: u8) -> f64 {
    let c = f64::from(encoded) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The mean light of a part of a PNG picture.
fn mean_light(png: &[u8], [left, top, width, height]: [f64; 4]) -> [f64; 3] {
    let image = image::load_from_memory(png).unwrap().to_rgb8();
    let (across, down) = (f64::from(image.width()), f64::from(image.height()));
    let inside = |x: f64, y: f64| {
        x >= left * across
            && x < (left + width) * across
            && y >= top * down
            && y < (top + height) * down
    };
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for (x, y, pixel) in image.enumerate_pixels() {
        if inside(f64::from(x) + 0.5, f64::from(y) + 0.5) {
            count += 1.0;
            (0..3).for_each(|c| sum[c] += decode(pixel.0[c]));
        }
    }
    sum.map(|sum| sum / count)
}

#[test]
fn seen_from_afar_the_colors_of_the_photograph_come_back() {
    let folder = TempDir::new().unwrap();
    // Colors that these inks can make with three quarters of the area covered.
    let quarters = [[230, 200, 190], [201, 214, 238], [240, 230, 170], [190, 188, 186]];
    let photo =
        picture(&folder, 80, |x, y| quarters[usize::from(x > 0.5) + 2 * usize::from(y > 0.5)]);
    for options in [&["--pens", "cmyk"][..], &["--pens", "cmyk", "--gcr", "0"]] {
        let options = [options, &["-n", "1600", "--scale", "5"]].concat();
        let (png, _) = drawn(&photo, "a.png", &options);
        for (quarter, color) in quarters.into_iter().enumerate() {
            let corner = [0.05 + 0.5 * (quarter % 2) as f64, 0.05 + 0.5 * (quarter / 2) as f64];
            let found = mean_light(&png, [corner[0], corner[1], 0.4, 0.4]);
            for c in 0..3 {
                let wanted = decode(color[c]);
                assert!((found[c] - wanted).abs() < 0.025, "{color:?} {c}: {found:?} {wanted}");
            }
        }
    }
}

#[test]
fn what_is_too_dark_keeps_its_hue_or_its_differences() {
    let folder = TempDir::new().unwrap();
    let photo = picture(&folder, 60, |x, _| if x < 0.5 { [120, 20, 20] } else { [10, 10, 10] });
    let light = |shadows: &[&str]| {
        let options = [&["--pens", "red,black", "-n", "1500", "--scale", "4"], shadows].concat();
        let (png, _) = drawn(&photo, "a.png", &options);
        [0.05, 0.55].map(|left| mean_light(&png, [left, 0.05, 0.4, 0.9]))
    };
    for shadows in [&[][..], &["--shadows", "keep"]] {
        let [red, black] = light(shadows);
        assert!(red[0] > red[1] + 0.08 && red[0] > black[0] + 0.08, "{red:?} {black:?}");
        assert!((black[0] - 0.25).abs() < 0.03 && (black[0] - black[2]).abs() < 0.03);
    }
}

#[test]
fn every_pen_has_a_layer_light_to_dark_with_a_stroke_for_each_of_its_dots() {
    let folder = TempDir::new().unwrap();
    let photo =
        picture(&folder, 64, |x, y| [200, (90.0 + 150.0 * x) as u8, (60.0 + 150.0 * y) as u8]);
    let options = &["--page", "a5", "--pen", "1", "--pens", "black,#c33,teal", "--marks", "tap"];
    let (bytes, said) = drawn(&photo, "a.svg", options);
    let svg = String::from_utf8(bytes).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let table = drawn(&photo, "a.csv", options).0;
    let table = String::from_utf8(table).unwrap();
    let dots = penned(&table);
    assert_eq!(strokes(&svg).len(), dots.len());
    let mut names = Vec::new();
    for layer in document.descendants().filter(|node| node.has_tag_name("g")) {
        let label = |node: &roxmltree::Node<'_, '_>| {
            let found = node.attributes().find(|attribute| attribute.name() == "label");
            let label = found.unwrap().value();
            // Before what holds digits there is the layer's number.
            label.rsplit(' ').next().unwrap().to_owned()
        };
        let name = label(&layer);
        let strokes: usize = layer
            .children()
            .filter_map(|path| path.attribute("d"))
            .map(|path| path.matches('h').count())
            .sum();
        assert_eq!(strokes, dots.iter().filter(|(_, pen)| *pen == name).count());
        assert!(strokes > 20 && said.contains(&format!(", {strokes} {name}")), "{said}");
        names.push((name, layer.attribute("stroke").unwrap().to_owned()));
    }
    let expected = [("teal", "#008080"), ("#c33", "#cc3333"), ("black", "black")];
    assert_eq!(names, expected.map(|(name, color)| (name.to_owned(), color.to_owned())));
    // No two dots of whichever pens nearer than the pen is wide, and the layers one after the other.
    let places: Vec<[f64; 2]> = dots.iter().map(|(place, _)| *place).collect();
    assert!(least_distance(&places) >= 1.0 - 1e-4);
    let changes = dots.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
    assert_eq!(changes, 2);

    let pdf = drawn(&photo, "a.pdf", options).0;
    let pdf = String::from_utf8_lossy(&pdf);
    assert_eq!(pdf.matches("/Type /OCG").count(), 3);
    assert!(pdf.contains("(teal)") && pdf.contains("(#c33)") && pdf.contains("/L3 8 0 R"));
    let npy = drawn(&photo, "a.npy", options).0;
    let shape = format!("'shape': ({}, 3)", dots.len());
    assert!(String::from_utf8_lossy(&npy[..128]).contains(&shape));
    assert_eq!(npy[npy.len() - 4..], 2.0f32.to_le_bytes());
}

#[test]
fn dots_of_pens_lie_apart_and_inside_without_a_page_too() {
    let folder = TempDir::new().unwrap();
    // As dense as can be up to the borders.
    let photo = picture(&folder, 40, |x, _| if x < 0.5 { [0; 3] } else { [120, 20, 20] });
    let options = &["--pens", "black,red", "--exact", "600"];
    let table = csv(&photo, options);
    let places: Vec<[f64; 2]> = penned(&table).into_iter().map(|(place, _)| place).collect();
    assert_eq!(places.len(), 600);
    assert!(places.iter().flatten().all(|t| (0.0..40.0).contains(t)));
    let (svg, _) = drawn(&photo, "a.svg", options);
    let svg = String::from_utf8(svg).unwrap();
    let width = svg.split_once("stroke-width=\"").unwrap().1.split_once('"').unwrap().0;
    assert!(least_distance(&places) >= width.parse::<f64>().unwrap() - 2e-3, "{width}");
}

#[test]
fn exactly_so_many_dots_are_drawn_by_all_pens_together_the_same_every_time() {
    let folder = TempDir::new().unwrap();
    let photo = picture(&folder, 50, |x, y| [(255.0 * x) as u8, (255.0 * y) as u8, 128]);
    for options in [
        &["--exact", "777", "--pens", "cmyk"][..],
        &["--exact", "777", "--pens", "cmyk", "--refine", "0", "--order", "rank"],
        &["--exact", "777", "--pens", "cmyk", "--page", "a4", "--pen", "0.5"],
    ] {
        let table = csv(&photo, options);
        assert_eq!(penned(&table).len(), 777);
        assert_eq!(table, csv(&photo, options));
    }
    assert_eq!(csv(&photo, &["--exact", "0", "--pens", "cmyk"]), "x,y,pen\n");
}

#[test]
fn a_black_pen_alone_draws_a_light_gray_photograph_as_no_pens_do_in_linear_light() {
    let folder = TempDir::new().unwrap();
    // Nowhere darker than three quarters covered.
    let photo = picture(&folder, 60, |x, _| [(140.0 + 110.0 * x) as u8; 3]);
    let without =
        crate::dots(&csv(&photo, &["--linear", "--exact", "900", "--dot-gain", "ignore"]));
    let table = csv(&photo, &["--pens", "black", "--exact", "900", "--order", "none"]);
    let pens = penned(&table);
    assert!(pens.iter().all(|(_, pen)| *pen == "black"));
    // The same tone, to a few dots in each tenth.
    for tenth in 0..10 {
        let inside = |x: f64| (x / 6.0) as usize == tenth;
        let one = without.iter().filter(|(x, _)| inside(f64::from(*x))).count() as f64;
        let other = pens.iter().filter(|([x, _], _)| inside(*x)).count() as f64;
        assert!((one - other).abs() <= 3.0 + 0.03 * one, "{tenth}: {one} {other}");
    }
}

#[test]
fn levels_transparency_and_dark_paper_count() {
    let folder = TempDir::new().unwrap();
    let photo = picture(&folder, 40, |_, _| [160, 150, 140]);
    let (plain, _) = drawn(&photo, "a.png", &["--pens", "cmyk", "-n", "900"]);
    let (lighter, _) = drawn(&photo, "a.png", &["--pens", "cmyk", "-n", "900", "--gamma", "2"]);
    let all = [0.1, 0.1, 0.8, 0.8];
    assert!(mean_light(&lighter, all)[1] > mean_light(&plain, all)[1] + 0.1);
    let dark = ["--pens", "white,orange", "--paper", "#101010", "-n", "900", "--scale", "4"];
    let (png, _) = drawn(&photo, "a.png", &dark);
    let found = mean_light(&png, all);
    assert!((found[1] - decode(150)).abs() < 0.03, "{found:?}");

    let path = folder.path().join("half.png");
    image::RgbaImage::from_fn(40, 40, |x, _| {
        image::Rgba([200, 90, 80, if x < 20 { 0 } else { 255 }])
    })
    .save(&path)
    .unwrap();
    let table = csv(&path, &["--pens", "cmyk", "-n", "300"]);
    assert!(penned(&table).iter().all(|([x, _], _)| *x >= 20.0));
}

#[test]
fn malformed_lists_of_pens_are_one_clear_line() {
    let photo = photograph();
    let complaint = |options: &[&str]| {
        let output = stipple(&photo, &[&["-o", "-"], options].concat());
        assert!(!output.status.success() && output.stdout.is_empty(), "{options:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    for (list, expected) in [
        ("blurple", "\"blurple\" is not a color"),
        ("black,#0008", "\"#0008\" is not a color"),
        (",", "no pen"),
        ("red,#f00", "red and #f00 are one color"),
        ("cmyk,a,b", "\"a\" is not a color"),
        (
            "#000001,#000002,#000003,#000004,#000005,#000006,cmyk,red,green,blue",
            "13 pens, more than 12",
        ),
    ] {
        let said = complaint(&["--pens", list]);
        let lines: Vec<&str> = said.lines().filter(|line| line.contains(expected)).collect();
        assert_eq!(lines.len(), 1, "{list}: {said}");
    }
    let white = complaint(&["--pens", "black,white"]);
    assert_eq!(white.lines().count(), 1);
    assert!(white.contains("--pens: white is the paper's color"), "{white}");
    for conflict in [&["--line"][..], &["--invert"], &["--linear"], &["--dot-gain", "correct"]] {
        let said = complaint(&[&["--pens", "cmyk"], conflict].concat());
        assert!(said.contains("cannot be used with"), "{said}");
    }
    for alone in [&["--gcr", "0.5"][..], &["--shadows", "keep"]] {
        assert!(complaint(alone).contains("--pens"));
    }
    assert!(complaint(&["--pens", "cmyk", "--gcr", "2"]).contains("not a number from 0 to 1"));
    let folder = TempDir::new().unwrap();
    let blank = picture(&folder, 8, |_, _| [255; 3]);
    let said = complaint_of(&blank, &["--pens", "cmyk"]);
    assert!(said.contains("no color that these pens"), "{said}");
}

#[test]
fn what_is_written_does_not_depend_on_threads() {
    let folder = TempDir::new().unwrap();
    let photo = picture(&folder, 64, |x, y| [(255.0 * y) as u8, 140, (255.0 * x) as u8]);
    let table = |threads: &str| {
        let arguments = ["-o", "-", "--quiet", "-n", "2500", "--pens", "cmyk"];
        let mut program = crate::program();
        program.arg("stipple").arg(Path::new(&photo)).args(arguments);
        program.env("RAYON_NUM_THREADS", threads).output().unwrap().stdout
    };
    assert_eq!(table("1"), table("3"));
}
