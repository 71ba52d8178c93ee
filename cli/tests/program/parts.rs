//! A drawing made in parts, as by several machines.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use tempfile::TempDir;
use tiff::encoder::colortype::Gray8;
use tiff::encoder::{Rational, TiffEncoder};

use crate::{complaint_about, names, photograph, program, stipple};

/// So many dots that the photograph has several cells.
const MANY: &str = "2500000";

/// Draws a photograph, or a part of it, into the folder.
fn drawn(folder: &Path, photo: &Path, name: &str, options: &[&str]) -> PathBuf {
    let path = folder.join(name);
    let all =
        [&["-n", MANY, "--refine", "0", "-q", "-o", path.to_str().unwrap()], options].concat();
    let output = stipple(photo, &all);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    path
}

fn merged(folder: &Path, parts: &[PathBuf], name: &str) -> Output {
    program().arg("merge").args(parts).arg("-o").arg(folder.join(name)).output().unwrap()
}

/// A photograph of 600 × 431 pixels in strips of 40 rows, whose last one is lower.
fn strips(folder: &Path) -> PathBuf {
    let path = folder.join("strips.tif");
    let (width, height) = (600, 431);
    let pixels: Vec<u8> =
        (0..width * height).map(|i| (40 + (i % width / 3 + i / width / 4) % 200) as u8).collect();
    let mut file = fs::File::create(&path).unwrap();
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut image = encoder.new_image::<Gray8>(width, height).unwrap();
    image.rows_per_strip(40).unwrap();
    image.x_resolution(Rational { n: 1, d: 1 });
    image.y_resolution(Rational { n: 1, d: 1 });
    image.write_data(&pixels).unwrap();
    path
}

#[test]
fn parts_one_after_the_other_are_the_whole() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for (photo, ending, options) in [
        (photograph(), "csv", &[][..]),
        (photograph(), "svg", &["--invert", "--scale", "2"]),
        (photograph(), "svg", &["--page", "a4", "--white", "240"]),
        (strips(folder), "npy", &["--linear", "--seed", "3"]),
        (strips(folder), "svg", &["--dot-gain", "ignore"]),
    ] {
        let whole = fs::read(drawn(folder, &photo, &format!("whole.{ending}"), options)).unwrap();
        // With a survey and without one.
        let survey = folder.join("survey.json");
        let tone: Vec<&str> = options
            .chunks(2)
            .filter(|option| ["--invert", "--white", "--linear"].contains(&option[0]))
            .flat_map(
                |option| if option[0] == "--white" { option.to_vec() } else { vec![option[0]] },
            )
            .collect();
        let output = program()
            .arg("survey")
            .arg(&photo)
            .args(&tone)
            .arg("-o")
            .arg(&survey)
            .output()
            .unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        let parts: Vec<PathBuf> = (1..=3)
            .map(|i| {
                let part = format!("{i}/3");
                let mut options = [&["--part", &part], options].concat();
                if i != 2 {
                    options.extend(["--survey", survey.to_str().unwrap()]);
                }
                drawn(folder, &photo, &format!("part-{i}.{ending}"), &options)
            })
            .collect();
        let output = merged(folder, &parts, &format!("merged.{ending}"));
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        assert!(fs::read(folder.join(format!("merged.{ending}"))).unwrap() == whole);
        if ending != "npy" {
            let joined: Vec<u8> = parts.iter().flat_map(|part| fs::read(part).unwrap()).collect();
            assert!(joined == whole, "{ending} {options:?}");
        }
    }
}

#[test]
fn more_parts_than_cells_are_empty_and_fit_all_the_same() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for ending in ["csv", "svg", "npy"] {
        let few = |name: &str, options: &[&str]| {
            let path = folder.join(name);
            let all =
                [&["-n", "900", "--refine", "0", "-q", "-o", path.to_str().unwrap()], options];
            assert!(stipple(&photograph(), &all.concat()).status.success());
            path
        };
        let whole = few(&format!("whole.{ending}"), &[]);
        let parts: Vec<PathBuf> = (1..=4)
            .map(|i| few(&format!("{i}.{ending}"), &["--part", &format!("{i}/4")]))
            .collect();
        let name = format!("merged.{ending}");
        assert!(merged(folder, &parts, &name).status.success());
        assert!(fs::read(folder.join(name)).unwrap() == fs::read(whole).unwrap(), "{ending}");
    }
}

#[test]
fn what_is_not_all_parts_in_order_is_not_put_together() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let part = |i: usize, ending: &str| {
        let (name, part) = (format!("{i}.{ending}"), format!("{i}/3"));
        drawn(folder, &photograph(), &name, &["--part", &part])
    };
    let [a, b, c] = [1, 2, 3].map(|i| part(i, "svg"));
    let [x, y, z] = [1, 2, 3].map(|i| part(i, "csv"));
    let [n, o] = [1, 2].map(|i| part(i, "npy"));
    let cut = |from: &Path, name: &str, less: usize| {
        let bytes = fs::read(from).unwrap();
        let path = folder.join(name);
        fs::write(&path, &bytes[..bytes.len() - less]).unwrap();
        path
    };
    let (cut_table, cut_array) = (cut(&y, "cut.csv", 3), cut(&o, "cut.npy", 3));
    let cut_rows = cut(&o, "rows.npy", 8);
    let text = folder.join("text");
    fs::write(&text, "Dear sir or madam,\n").unwrap();
    let before = names(folder);
    for (parts, culprit, reason) in [
        (vec![&b, &a, &c], &b, "is not the first part"),
        (vec![&a, &b], &b, "is not the last part"),
        (vec![&a, &c, &b], &c, "is a last part"),
        (vec![&a, &a, &c], &a, "is a first part"),
        (vec![&y, &x, &z], &y, "is not the first part"),
        (vec![&x, &y, &x], &x, "is a first part"),
        (vec![&x, &b, &z], &b, "is of another kind"),
        (vec![&n, &y], &y, "is of another kind"),
        (vec![&x, &cut_table], &cut_table, "ends early"),
        (vec![&n, &cut_array], &cut_array, "ends early"),
        (vec![&n, &cut_rows], &cut_rows, "ends early"),
        (vec![&x, &text], &text, "is no part"),
    ] {
        let parts: Vec<PathBuf> = parts.into_iter().cloned().collect();
        let said = complaint_about(culprit.to_str().unwrap(), &merged(folder, &parts, "merged"));
        assert!(said.starts_with(reason), "{said}");
    }
    // Nor is a part replaced by the whole.
    let said = complaint_about(y.to_str().unwrap(), &merged(folder, &[x, y.clone(), z], "2.csv"));
    assert!(said.contains("it is the file to read"), "{said}");
    assert_eq!(names(folder), before);
}

#[test]
fn what_cannot_be_a_part_is_refused() {
    let folder = TempDir::new().unwrap();
    let out = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let refused = |options: &[&str]| {
        let output = stipple(&photograph(), &[&["--part", "1/2", "-n", "900"], options].concat());
        complaint_about("--part", &output)
    };
    assert!(refused(&["-o", &out("a.png")]).contains("CSV, SVG and NPY"));
    assert!(refused(&["-o", &out("a.pdf")]).contains("CSV, SVG and NPY"));
    assert!(refused(&["-o", &out("a.csv"), "--refine", "3"]).contains("to refine one"));
    assert!(refused(&["-o", &out("a.csv"), "--centers", "fixed"]).contains("relaxed"));
    for options in [&["--exact", "900"][..], &["--best"], &["--line"], &["--order", "short"]] {
        let part = ["--part", "1/2", "-o", &out("a.csv")];
        let output = stipple(&photograph(), &[&part[..], options].concat());
        assert_eq!(output.status.code(), Some(2), "{options:?}");
    }
    for name in ["a.npy", "a.pdf"] {
        let output = stipple(&photograph(), &["-n", "50000001", "-o", &out(name)]);
        assert!(complaint_about("--points", &output).contains("choose CSV or SVG"));
    }
    for part in ["0/2", "3/2", "2", "1/0", "a/b"] {
        let output = stipple(&photograph(), &["--part", part, "-o", &out("a.csv")]);
        assert_eq!(output.status.code(), Some(2), "{part}");
    }
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_survey_is_of_one_photograph_read_in_one_way() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let survey = folder.join("survey.json");
    let survey = survey.to_str().unwrap();
    let surveyed = |photo: &Path, tone: &[&str]| {
        let run = program().arg("survey").arg(photo).args(tone).args(["-o", survey]).output();
        assert!(run.unwrap().status.success());
    };
    let said = |options: &[&str]| {
        let part = ["--part", "1/2", "-n", "900", "-o", "-", "--survey", survey];
        complaint_about(survey, &stipple(&photograph(), &[&part, options].concat()))
    };
    surveyed(&photograph(), &[]);
    for tone in [&["--linear"][..], &["--invert"], &["--white", "250"], &["--gamma", "2"]] {
        assert!(said(tone).contains("other options for the photograph's tone"));
        surveyed(&photograph(), tone);
        assert!(said(&[]).contains("other options for the photograph's tone"));
        surveyed(&photograph(), &[]);
    }
    surveyed(&strips(folder), &[]);
    assert!(said(&[]).contains("another photograph"));
    let text = fs::read_to_string(survey).unwrap();
    fs::write(survey, text.replace("\"version\": 1", "\"version\": 7")).unwrap();
    assert!(said(&[]).contains("version 7"));
    fs::write(survey, &text[..text.len() / 2]).unwrap();
    assert!(said(&[]).contains("is no survey"));
    fs::write(survey, "x,y\n1,2\n").unwrap();
    assert!(said(&[]).contains("is no survey"));
    fs::remove_file(survey).unwrap();
    assert!(said(&[]).contains("cannot be read"));
}
