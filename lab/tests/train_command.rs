//! `twelvefold-lab train`, from rules to a file that the library reads.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;
use twelvefold::bake::displacement::Displacements;

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_twelvefold-lab"))
}

/// The names in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn train(target: &Path, arguments: &[&str]) -> Output {
    program()
        .args(["train", "--tiny", "--quiet", "-o"])
        .arg(target)
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn the_same_seed_trains_the_same_bytes_with_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let [one, two, other] =
        ["one.bin", "two.bin", "other.bin"].map(|name| folder.path().join(name));
    for (target, arguments) in [
        (&one, ["--seed", "7", "--threads", "1"]),
        (&two, ["--seed", "7", "--threads", "2"]),
        (&other, ["--seed", "8", "--threads", "2"]),
    ] {
        let output = train(target, &arguments);
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    }
    let bytes = fs::read(&one).unwrap();
    assert!(bytes == fs::read(&two).unwrap());
    assert!(bytes != fs::read(&other).unwrap());
    let table = Displacements::from_bytes(&bytes).unwrap();
    assert!(table.fits(twelvefold::Tables::built_in().rules().digits()));
    assert!(table.provenance.contains("--seed 7"), "{}", table.provenance);
    assert!(table.smooth.slots().iter().any(|slot| slot.longest() > 0.0));
    assert_eq!(names(folder.path()), ["one.bin", "other.bin", "two.bin"]);
}

#[test]
fn a_damaged_table_is_not_measured() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("damaged.bin");
    let mut bytes = include_bytes!("../../tables/relaxed.bin").to_vec();
    bytes[5000] ^= 1;
    fs::write(&file, bytes).unwrap();
    let output = program().args(["train", "--measure"]).arg(&file).output().unwrap();
    assert!(!output.status.success() && output.stdout.is_empty(), "{output:?}");
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(complaint.contains(file.to_str().unwrap()) && complaint.contains("checksum"));
}
