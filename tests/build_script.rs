//! What a user of `cargo build` sees: rules and depth choose the tables, and a broken rule stops the
//! build with a sentence. The build script is run as cargo runs it, from a copy of its inputs.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The build script that cargo compiled for this crate, next to the outputs it wrote.
fn build_script() -> PathBuf {
    // OUT_DIR is …/build/twelvefold-HASH/out of the run; the executable lies in a sibling folder.
    let out = Path::new(env!("OUT_DIR_OF_BUILD"));
    let builds = out.ancestors().nth(2).expect("the build folder");
    let mut scripts: Vec<_> = std::fs::read_dir(builds)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.file_name().unwrap().to_string_lossy().starts_with("twelvefold-"))
        .map(|path| path.join("build-script-build"))
        .filter(|path| path.exists())
        .collect();
    scripts.sort_by_key(|path| std::fs::metadata(path).unwrap().modified().unwrap());
    scripts.pop().expect("a compiled build script")
}

fn run(digits: &str, depth: Option<&str>) -> (Output, Option<Vec<u8>>) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("tables")).unwrap();
    std::fs::write(folder.path().join("tables/digits.txt"), digits).unwrap();
    let mut command = Command::new(build_script());
    command.current_dir(folder.path()).env("OUT_DIR", folder.path()).env_remove("TWELVEFOLD_DEPTH");
    if let Some(depth) = depth {
        command.env("TWELVEFOLD_DEPTH", depth);
    }
    let output = command.output().unwrap();
    (output, std::fs::read(folder.path().join("tables.bin")).ok())
}

const DIGITS: &str = include_str!("../tables/digits.txt");

#[test]
fn the_depth_is_chosen_by_the_environment() {
    for depth in 1..=3 {
        let (output, bytes) = run(DIGITS, Some(&depth.to_string()));
        assert!(output.status.success());
        assert_eq!(twelvefold::Tables::from_bytes(&bytes.unwrap()).unwrap().depth(), depth);
    }
    let (_, bytes) = run(DIGITS, None);
    let depth = twelvefold::Tables::from_bytes(&bytes.unwrap()).unwrap().depth();
    assert_eq!(depth, twelvefold::bake::DEFAULT_DEPTH);
}

#[test]
fn a_broken_rule_or_depth_stops_the_build_with_a_sentence() {
    let cases = [
        (DIGITS.replace("d: 0", "d: 1"), None, "equation 1 does not give digit 1 of parent d"),
        (DIGITS.replace("8 9 1 2 3", "8 9 1 1 3"), None, "digit 1 stands twice under tile type b"),
        (DIGITS.replace("8 9 1 2 3", "8 9 1 2"), None, "needs 5 digits, found 4"),
        (DIGITS.replace("\nc:", "\nq:"), None, "a rule begins with a tile type"),
        (String::new(), None, "tile type a has no rule"),
        (DIGITS.to_owned(), Some("0"), "baked depth 0 is not between 1 and 4"),
        (DIGITS.to_owned(), Some("five"), "TWELVEFOLD_DEPTH=five"),
    ];
    for (digits, depth, sentence) in cases {
        let (output, bytes) = run(&digits, depth);
        assert!(!output.status.success(), "{sentence}");
        let printed = String::from_utf8(output.stdout).unwrap();
        let error = printed.lines().find(|line| line.starts_with("cargo::error=")).unwrap();
        assert!(error.contains(sentence), "{error}");
        assert!(bytes.is_none());
    }
}
