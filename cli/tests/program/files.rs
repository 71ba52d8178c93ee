//! Where results go, and what is left behind when they cannot.

use std::fs;
use std::process::Stdio;

use tempfile::TempDir;

use crate::{complaint_about, names, photograph, program, stipple};

#[test]
fn other_endings_are_refused_before_the_photograph_is_read() {
    for name in ["dots.jpg", "dots", "dots.svg.gz", ".svg"] {
        let output = stipple("/no/such/photograph".as_ref(), &["-o", name]);
        let expected = "has none of the endings .svg, .png, .pdf, .csv and .npy; see --format";
        assert_eq!(complaint_about(name, &output), expected);
    }
}

#[test]
fn targets_that_are_no_files_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("folder.csv");
    fs::create_dir(&target).unwrap();
    let target = target.to_str().unwrap();
    assert_eq!(
        complaint_about(target, &stipple(&photograph(), &["-o", target])),
        "is a folder, not a file"
    );
    let target = folder.path().join("none/dots.csv");
    let target = target.to_str().unwrap();
    let complaint = complaint_about(target, &stipple(&photograph(), &["-o", target]));
    assert!(complaint.starts_with("cannot be written: there is no folder "), "{complaint}");
}

#[test]
fn the_photograph_is_never_overwritten() {
    let folder = TempDir::new().unwrap();
    let photo = folder.path().join("photo.png");
    fs::copy(photograph(), &photo).unwrap();
    let target = folder.path().join("./photo.png");
    let target = target.to_str().unwrap();
    let complaint = complaint_about(target, &stipple(&photo, &["-o", target]));
    assert_eq!(complaint, "would be replaced, but it is the file to read");
    assert_eq!(fs::read(&photo).unwrap(), fs::read(photograph()).unwrap());
}

#[test]
fn a_run_that_fails_keeps_the_old_file_and_leaves_nothing_new() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("dots.png");
    fs::write(&target, "old").unwrap();
    let options = ["-o", target.to_str().unwrap(), "--scale", "1000000"];
    let complaint = complaint_about(options[1], &stipple(&photograph(), &options));
    assert!(complaint.ends_with("choose a smaller --scale"), "{complaint}");
    let missing = folder.path().join("missing.jpg");
    complaint_about(missing.to_str().unwrap(), &stipple(&missing, &options[..2]));
    assert_eq!(fs::read(&target).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["dots.png"]);
}

#[test]
fn whoever_closes_the_pipe_has_enough() {
    for points in ["10", "500000"] {
        let mut child = program()
            .arg("stipple")
            .arg(photograph())
            .args(["-o", "-", "--points", points])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{output:?}");
    }
    let mut child = program().arg("tables").stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

#[cfg(target_os = "linux")]
mod linux {
    use std::os::unix::fs::symlink;
    use std::process::Command;

    use super::*;

    #[test]
    fn a_full_disk_is_an_error_however_few_bytes_there_are() {
        let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        for points in ["0", "10", "100000"] {
            let output = program()
                .arg("stipple")
                .arg(photograph())
                .args(["-o", "-", "--points", points])
                .stdout(full())
                .output()
                .unwrap();
            let complaint = complaint_about("standard output", &output);
            assert!(complaint.contains("No space left"), "{complaint}");
        }
        let output = program().arg("tables").stdout(full()).output().unwrap();
        complaint_about("standard output", &output);
    }

    #[test]
    fn a_device_is_written_and_not_replaced() {
        let folder = TempDir::new().unwrap();
        for name in ["full.csv", "full.svg", "full.png"] {
            let target = folder.path().join(name);
            symlink("/dev/full", &target).unwrap();
            let target_name = target.to_str().unwrap();
            let output = stipple(&photograph(), &["-o", target_name]);
            let complaint = complaint_about(target_name, &output);
            assert!(complaint.contains("No space left"), "{complaint}");
            assert_eq!(fs::read_link(&target).unwrap().to_str(), Some("/dev/full"));
        }
        assert_eq!(names(folder.path()).len(), 3);
    }

    #[test]
    fn a_named_pipe_gets_the_points() {
        let folder = TempDir::new().unwrap();
        let pipe = folder.path().join("pipe.csv");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().unwrap();
        let output =
            stipple(&photograph(), &["-o", pipe.to_str().unwrap(), "--points", "3000", "--quiet"]);
        assert!(output.status.success(), "{output:?}");
        let read = reader.wait_with_output().unwrap().stdout;
        assert_eq!(
            String::from_utf8(read).unwrap(),
            crate::csv(&photograph(), &["--points", "3000"])
        );
    }

    #[test]
    fn a_folder_that_takes_no_files_is_an_error() {
        // Nobody, not even root, can make files there.
        for target in ["/proc/dots.csv", "/sys/dots.svg"] {
            let output = stipple(&photograph(), &["-o", target]);
            let complaint = complaint_about(target, &output);
            assert!(complaint.starts_with("cannot be written: "), "{complaint}");
        }
    }

    #[test]
    fn a_full_file_system_leaves_no_file_and_keeps_an_old_one() {
        // A limit on the size of files stops writing as a full disk does.
        let folder = TempDir::new().unwrap();
        for (name, old) in [("new.csv", None), ("old.csv", Some("old"))] {
            let target = folder.path().join(name);
            if let Some(old) = old {
                fs::write(&target, old).unwrap();
            }
            let output = Command::new("sh")
                .args(["-c", "trap '' XFSZ; ulimit -f 64 && exec \"$0\" \"$@\""])
                .arg(env!("CARGO_BIN_EXE_twelvefold"))
                .arg("stipple")
                .arg(photograph())
                .args(["--points", "100000", "-o", target.to_str().unwrap()])
                .output()
                .unwrap();
            let complaint = complaint_about(target.to_str().unwrap(), &output);
            assert!(complaint.contains("File too large"), "{complaint}");
        }
        assert_eq!(names(folder.path()), ["old.csv"]);
        assert_eq!(fs::read(folder.path().join("old.csv")).unwrap(), b"old");
    }

    #[test]
    fn an_interrupted_run_takes_its_unfinished_file_with_it() {
        let folder = TempDir::new().unwrap();
        let target = folder.path().join("dots.svg");
        for signal in ["-INT", "-TERM"] {
            let mut child = program()
                .arg("stipple")
                .arg(photograph())
                .args(["--points", "50000000", "-o", target.to_str().unwrap()])
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            let started = std::time::Instant::now();
            while names(folder.path()).is_empty() {
                assert!(started.elapsed().as_secs() < 20, "no temporary file");
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
            // The handler is set a moment after the file appears.
            std::thread::sleep(std::time::Duration::from_millis(100));
            let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
            assert!(kill.unwrap().success());
            assert_eq!(child.wait().unwrap().code(), Some(130));
            assert_eq!(names(folder.path()), [""; 0]);
        }
    }

    #[test]
    fn memory_is_in_proportion_to_the_picture() {
        // 16 million pixels: 48 MB of colors and 64 MB of importance, whatever is drawn.
        let folder = TempDir::new().unwrap();
        let photo = folder.path().join("large.png");
        let small = image::open(photograph()).unwrap();
        let large = small.resize_exact(4000, 4000, image::imageops::FilterType::Nearest);
        large.to_rgb8().save(&photo).unwrap();
        // Refined dots need a list of them, and some numbers a pixel more.
        for (name, refine, kilobytes) in [
            ("dots.csv", "0", 614_400),
            ("dots.svg", "0", 614_400),
            ("dots.png", "0", 614_400),
            ("refined.svg", "1", 614_400),
        ] {
            let target = folder.path().join(name);
            let output = Command::new("sh")
                .args(["-c", &format!("ulimit -v {kilobytes} && exec \"$0\" \"$@\"")])
                .arg(env!("CARGO_BIN_EXE_twelvefold"))
                .arg("stipple")
                .arg(&photo)
                .args(["--points", "1000000", "--refine", refine, "-o", target.to_str().unwrap()])
                .output()
                .unwrap();
            assert!(output.status.success(), "{output:?}");
        }
    }
}
