//! `twelvefold tiling`, run as a program.
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::process::{Command, Output, Stdio};

use twelvefold::Tables;
use twelvefold::tiling::{Cyclotomic, FCode, TileCounts, TileType};
use twelvefold_lab::paper::LAMBDA;

const HEADER: &str = "fcode,tile,rotation,z0,z1,z2,z3,rank,threshold,x,y";

fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_twelvefold"));
    command.arg("tiling").args(arguments);
    command
}

fn run(arguments: &[&str]) -> Output {
    program(arguments).output().unwrap()
}

fn list(root: TileType, levels: usize) -> String {
    let output = run(&["--root", &root.letter().to_string(), "--levels", &levels.to_string()]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The single line on stderr of a run that must fail with exit code 1 and print nothing.
fn complaint(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(output.stdout.is_empty());
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

#[test]
fn every_row_of_every_root_agrees_with_the_library() {
    let tables = Tables::built_in();
    for root in TileType::ALL {
        for levels in 0..=4 {
            let text = list(root, levels);
            let mut lines = text.lines();
            assert_eq!(lines.next(), Some(HEADER));
            let count = TileCounts::of(root).at(levels).unwrap() as usize;
            let mut seen = vec![false; count];
            for line in lines {
                let fields: Vec<&str> = line.split(',').collect();
                assert_eq!(fields.len(), 11, "{line}");
                let code = FCode::parse(root, fields[0]).unwrap();
                assert_eq!(code.level(), levels);
                let tile = code.tile(&tables.rules()).unwrap();
                assert_eq!(fields[1], tile.kind.letter().to_string(), "{line}");
                assert_eq!(fields[2], tile.rotation.to_string(), "{line}");
                let z = Cyclotomic(std::array::from_fn(|i| fields[3 + i].parse().unwrap()));
                assert_eq!(z, tile.center, "{line}");
                let rank: usize = fields[7].parse().unwrap();
                assert_eq!(rank as u64, code.rank(), "{line}");
                assert!(!std::mem::replace(&mut seen[rank], true), "rank {rank} twice");
                let [threshold, x, y] = [8, 9, 10].map(|i| fields[i].parse::<f64>().unwrap());
                assert_eq!(threshold, rank as f64 / count as f64, "{line}");
                let edges = LAMBDA.powi(levels as i32);
                let [expected_x, expected_y] = z.to_f64().map(|v| v / edges);
                assert!((x - expected_x).abs() < 1e-14 && (y - expected_y).abs() < 1e-14, "{line}");
            }
            assert!(seen.into_iter().all(|seen| seen), "{root:?} level {levels}");
        }
    }
}

#[test]
fn the_root_itself_is_level_0() {
    assert_eq!(list(TileType::C, 0), format!("{HEADER}\n,c,0,0,0,0,0,0,0,0,0\n"));
}

#[test]
fn a_level_past_the_last_is_an_error_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tiles.csv");
    for levels in ["17", "1000000"] {
        let arguments = ["--root", "a", "--levels", levels, "-o", file.to_str().unwrap()];
        let text = complaint(&arguments);
        assert!(text.contains("--levels") && text.contains(levels), "{text}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_file_holds_what_standard_output_would_and_nothing_else_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("tiles.csv");
    let output = run(&["--root", "b", "--levels", "2", "-o", file.to_str().unwrap()]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
    assert_eq!(fs::read_to_string(&file).unwrap(), list(TileType::B, 2));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let dash = run(&["--root", "b", "--levels", "2", "-o", "-"]);
    assert_eq!(dash.stdout, list(TileType::B, 2).into_bytes());
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("no/tiles.csv");
    let text = complaint(&["--root", "a", "--levels", "1", "-o", path.to_str().unwrap()]);
    assert!(text.contains("tiles.csv"), "{text}");
    let text = complaint(&["--root", "a", "--levels", "1", "-o", folder.path().to_str().unwrap()]);
    assert!(text.contains("is a folder"), "{text}");
}

#[test]
fn wrong_options_are_refused_by_name() {
    for (arguments, named) in [
        (["--root", "e", "--levels", "1"], "--root"),
        (["--root", "a", "--levels", "-1"], "-1"),
        (["--root", "a", "--levels", "two"], "--levels"),
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2));
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(named), "{text}");
    }
}

/// The deepest level has 10¹⁸ tiles: reading a few and closing the pipe must end the program, quietly.
#[test]
fn the_deepest_level_streams_and_a_closed_pipe_is_no_error() {
    let mut child = program(&["--root", "d", "--levels", "16"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let first: Vec<String> = lines.take(2000).map(Result::unwrap).collect();
    // The reader is dropped here, which closes the pipe.
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
    assert_eq!(first[0], HEADER);
    for line in &first[1..] {
        let fields: Vec<&str> = line.split(',').collect();
        let code = FCode::parse(TileType::D, fields[0]).unwrap();
        assert_eq!((code.level(), code.rank().to_string()), (16, fields[7].to_owned()));
    }
}
