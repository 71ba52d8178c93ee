//! The program as its user meets it: files in, files out, one line when something is wrong.
mod envmap;
mod files;
mod frames;
mod hostile;
mod inputs;
mod measure;
mod outputs;
mod paper;
mod parts;
mod pens;
mod said;
mod tiling;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The example photograph, 512 × 512 gray.
fn photograph() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/photographs/camera.png")
}

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_twelvefold"))
}

/// Runs `twelvefold stipple PHOTO ARGUMENTS…`.
fn stipple<A: AsRef<OsStr>>(photo: &Path, arguments: &[A]) -> Output {
    program().arg("stipple").arg(photo).args(arguments).output().unwrap()
}

/// The dots of a run that must succeed in silence, as CSV.
fn csv(photo: &Path, arguments: &[&str]) -> String {
    let output = stipple(photo, &[&["-o", "-", "--quiet"], arguments].concat());
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && complaint.is_empty(), "{}: {complaint}", photo.display());
    String::from_utf8(output.stdout).unwrap()
}

/// The coordinates of a CSV table.
fn dots(csv: &str) -> Vec<(f32, f32)> {
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("x,y"));
    lines
        .map(|line| {
            let (x, y) = line.split_once(',').unwrap();
            (x.parse().unwrap(), y.parse().unwrap())
        })
        .collect()
}

/// Where the strokes of a drawing begin: of each dot, or along a line.
fn strokes(svg: &str) -> Vec<[f64; 2]> {
    let document = roxmltree::Document::parse(svg).unwrap();
    let mut strokes = Vec::new();
    for path in document.descendants().filter_map(|node| node.attribute("d")) {
        let mut pen = [0.0; 2];
        let commands = path.match_indices(|c: char| c.is_ascii_alphabetic()).map(|(at, _)| at);
        let ends = commands.clone().skip(1).chain([path.len()]);
        for (start, end) in commands.zip(ends) {
            let numbers = numbers(&path[start + 1..end]);
            match &path[start..=start] {
                "M" | "m" | "l" => {
                    for step in numbers.chunks_exact(2) {
                        pen = [pen[0] + step[0], pen[1] + step[1]];
                        strokes.push(pen);
                    }
                }
                "h" => pen[0] += numbers[0],
                // Half a circle, there and back.
                "a" => pen[0] += numbers[5],
                other => panic!("{other}"),
            }
        }
    }
    strokes
}

/// Numbers as SVG has them: a minus or a second point begins another.
fn numbers(text: &str) -> Vec<f64> {
    let mut words: Vec<String> = vec![String::new()];
    for character in text.chars() {
        match words.last_mut() {
            Some(word) if character.is_ascii_digit() => word.push(character),
            Some(word) if character == '.' && !word.contains('.') => word.push(character),
            _ if character.is_whitespace() => words.push(String::new()),
            _ => words.push(character.to_string()),
        }
    }
    words.iter().filter(|word| !word.is_empty()).map(|word| word.parse().unwrap()).collect()
}

/// What a run that must fail says: one line, which begins with the program and `subject`.
fn complaint_about(subject: &str, output: &Output) -> String {
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let text = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    let start = format!("twelvefold: {subject}: ");
    assert!(text.starts_with(&start), "{text}");
    text[start.len()..].trim_end().to_owned()
}

/// What a run says that must fail because of its photograph.
fn complaint(photo: &Path, arguments: &[&str]) -> String {
    let output = stipple(photo, &[&["-o", "-"], arguments].concat());
    assert!(output.stdout.is_empty());
    complaint_about(photo.to_str().unwrap(), &output)
}

/// The names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn the_tables_are_those_of_the_library() {
    use sha2::Digest as _;
    let output = program().arg("tables").output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
    let text = String::from_utf8(output.stdout).unwrap();
    let tables = twelvefold::Tables::built_in();
    let hash: String =
        sha2::Sha256::digest(tables.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name)).unwrap();
        line[name.len()..].trim().to_owned()
    };
    assert_eq!(field("depth"), tables.depth().to_string());
    assert_eq!(field("bytes"), tables.as_bytes().len().to_string());
    assert_eq!(field("sha-256"), hash);
    assert_eq!(field("levels"), twelvefold::tiling::MAX_LEVEL.to_string());
    if tables.depth() == 3 {
        assert_eq!(field("entries"), "a 2521, b 2716, c 2716, d 2716");
    }
}

#[test]
fn a_wrong_command_line_is_explained_and_fails_with_2() {
    for arguments in [
        &["stipple"][..],
        &["stipple", "a.png", "-o", "b.svg", "--points", "4000000001"],
        &["stipple", "a.png", "-o", "b.svg", "--points", "-3"],
        &["stipple", "a.png", "-o", "b.svg", "--scale", "0"],
        &["stipple", "a.png", "-o", "b.svg", "--dot-size", "NaN"],
        &["stipple", "a.png", "-o", "b.svg", "--seed", "x"],
    ] {
        let output = program().args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty());
    }
}
