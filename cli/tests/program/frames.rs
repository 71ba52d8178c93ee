//! Moving pictures: numbered files and streams, in and out.

use std::collections::HashMap;
use std::fs;
use std::io::{Read as _, Write as _};
use std::path::Path;
use std::process::{Output, Stdio};

use image::{GrayImage, Luma};
use tempfile::TempDir;

use crate::{complaint_about, dots, names, program};

const SIDE: u32 = 240;

/// A still texture, and on the left a disc that moves and darkens.
fn frame(number: u32) -> GrayImage {
    GrayImage::from_fn(SIDE, SIDE, |x, y| {
        let (u, v) = (f64::from(x), f64::from(y));
        let center = 40.0 + 25.0 * f64::from(number);
        let inside = (u - 30.0).powi(2) + (v - center).powi(2) < 25.0 * 25.0;
        let still = 130.0 + 60.0 * (u / 19.0).sin() * (v / 13.0).cos() + 50.0 * (u / 240.0);
        Luma([if inside { 80 - 20 * number as u8 } else { still as u8 }])
    })
}

/// A folder with frames 3 to 6 in it.
fn photographs() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("out")).unwrap();
    for number in 0..4 {
        frame(number).save(folder.path().join(format!("in{:04}.png", number + 3))).unwrap();
    }
    folder
}

/// Runs `twelvefold frames ARGUMENTS…` in a folder, with this on standard input.
fn frames(folder: &Path, arguments: &[&str], stdin: &[u8]) -> Output {
    let mut command = program();
    command.current_dir(folder).arg("frames").args(arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    let bytes = stdin.to_vec();
    // Whoever does not want it closes the pipe.
    let writer = std::thread::spawn(move || pipe.write_all(&bytes));
    let output = child.wait_with_output().unwrap();
    let _ = writer.join().unwrap();
    output
}

/// What a run wrote that must succeed in silence.
fn drawn(folder: &Path, arguments: &[&str], stdin: &[u8]) -> Vec<u8> {
    let output = frames(folder, &[arguments, &["--quiet"]].concat(), stdin);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.is_empty(), "{arguments:?}: {text}");
    output.stdout
}

fn listed(folder: &Path, number: u32) -> Vec<(f32, f32)> {
    dots(&fs::read_to_string(folder.join(format!("out/{number:04}.csv"))).unwrap())
}

/// A stream of frames, gray of the full range.
fn stream(words: &str, frames: &[GrayImage]) -> Vec<u8> {
    let (width, height) = frames[0].dimensions();
    let mut bytes = format!("YUV4MPEG2 W{width} H{height} {words}\n").into_bytes();
    for frame in frames {
        bytes.extend(b"FRAME\n");
        bytes.extend(frame.as_raw());
    }
    bytes
}

/// The header and the luma of each frame of a stream of 4:2:0.
fn luma(stream: &[u8]) -> (String, Vec<Vec<u8>>) {
    let end = stream.iter().position(|&byte| byte == b'\n').unwrap();
    let header = String::from_utf8(stream[..end].to_vec()).unwrap();
    let side = |letter| {
        let word = header.split(' ').find_map(|word| word.strip_prefix(letter)).unwrap();
        word.parse::<usize>().unwrap()
    };
    let (width, height) = (side('W'), side('H'));
    let length = width * height + 2 * width.div_ceil(2) * height.div_ceil(2);
    let mut rest = &stream[end + 1..];
    let mut frames = Vec::new();
    while !rest.is_empty() {
        rest = rest.strip_prefix(b"FRAME\n").unwrap();
        let (frame, after) = rest.split_at(length);
        let (luma, chroma) = frame.split_at(width * height);
        assert!(chroma.iter().all(|&value| value == 128));
        frames.push(luma.to_vec());
        rest = after;
    }
    (header, frames)
}

/// The share of the dots of a frame, of those that `counts` says, which lie within a tenth of their spacing of a dot
/// of another frame.
fn stay(
    before: &[(f32, f32)],
    after: &[(f32, f32)],
    counts: impl Fn(f32, f32) -> bool,
) -> (usize, f64) {
    let cell = |(x, y): (f32, f32)| ((x / 8.0) as i32, (y / 8.0) as i32);
    let grid = |dots: &[(f32, f32)]| {
        let mut grid: HashMap<(i32, i32), Vec<(f32, f32)>> = HashMap::new();
        dots.iter().for_each(|&dot| grid.entry(cell(dot)).or_default().push(dot));
        grid
    };
    let nearest = |grid: &HashMap<_, Vec<(f32, f32)>>, (x, y): (f32, f32), itself: bool| {
        let (column, row) = cell((x, y));
        let cells = (-1..=1).flat_map(|u| (-1..=1).map(move |v| (column + u, row + v)));
        let dots = cells.filter_map(|cell| grid.get(&cell)).flatten();
        let distances = dots.map(|&(u, v)| (u - x).hypot(v - y));
        distances.filter(|&distance| !itself || distance > 0.0).fold(8.0, f32::min)
    };
    let (old, new) = (grid(before), grid(after));
    let (mut all, mut same) = (0, 0);
    for &(x, y) in before.iter().filter(|&&(x, y)| counts(x, y)) {
        all += 1;
        let spacing = nearest(&old, (x, y), true);
        same += usize::from(nearest(&new, (x, y), false) <= spacing / 10.0);
    }
    (all, same as f64 / all as f64)
}

/// The figures are said with `--nocapture`.
#[test]
fn dots_stay_where_nothing_moves() {
    let folder = photographs();
    let path = folder.path();
    // The disc keeps to the left of column 55.
    let still = |x: f32, _: f32| x > 60.0;
    let shares = |arguments: &[&str]| {
        let common = ["in%04d.png", "-o", "out/%04d.csv", "-n", "12000"];
        drawn(path, &[&common, arguments].concat(), b"");
        assert_eq!(names(&path.join("out")), ["0003.csv", "0004.csv", "0005.csv", "0006.csv"]);
        let lists: Vec<_> = (3..7).map(|number| listed(path, number)).collect();
        let pairs = lists.windows(2).map(|pair| stay(&pair[0], &pair[1], still));
        let (counts, shares): (Vec<_>, Vec<_>) = pairs.unzip();
        assert!(counts.iter().all(|&count| count > 5_000));
        shares
    };
    let raw = shares(&[]);
    let refined = shares(&["--refine", "10"]);
    let alone: Vec<_> = (3..7)
        .map(|number| {
            let photo = path.join(format!("in{number:04}.png"));
            dots(&crate::csv(&photo, &["--refine", "0", "-n", "12000"]))
        })
        .collect();
    let alone: Vec<_> = alone.windows(2).map(|pair| stay(&pair[0], &pair[1], still).1).collect();
    println!(
        "share of dots that stay: {raw:.4?}, refined {refined:.4?}, each by itself {alone:.4?}"
    );
    assert!(raw.iter().all(|&share| share > 0.99), "{raw:?}");
    assert!(refined.iter().zip(&raw).all(|(refined, raw)| refined < raw));
    assert!(alone.iter().zip(&raw).all(|(alone, raw)| alone < raw));
}

#[test]
fn the_first_frame_is_drawn_as_a_photograph_is() {
    let folder = photographs();
    let path = folder.path();
    for (ending, options) in [
        ("svg", &["--gamma", "1.2"][..]),
        ("png", &["--scale", "2", "--dot-size", "3", "-n", "2000"]),
        ("pdf", &["--invert", "--dot-gain", "ignore"]),
        ("csv", &["--linear", "--seed", "5", "-n", "2000"]),
        ("npy", &[]),
    ] {
        let out = format!("out/%04d.{ending}");
        let photo = path.join("in0003.png");
        let alone = path.join(format!("alone.{ending}"));
        drawn(path, &[&["in%04d.png", "-o", &out, "--last", "3"], options].concat(), b"");
        let of_photo = ["--quiet", "--refine", "0", "-o", alone.to_str().unwrap()];
        assert!(crate::stipple(&photo, &[&of_photo, options].concat()).status.success());
        let found = fs::read(path.join(format!("out/0003.{ending}"))).unwrap();
        assert!(found == fs::read(&alone).unwrap(), "{ending}");
    }
}

#[test]
fn streams_are_read_and_drawn_as_files_are() {
    let folder = photographs();
    let path = folder.path();
    let all: Vec<_> = (0..4).map(frame).collect();
    let video = stream("F30000:1001 Ip A1:1 Cmono XCOLORRANGE=FULL", &all);
    let options = ["-n", "3000", "--scale", "0.5"];
    let of_stream = drawn(path, &[&["-", "-o", "-"], &options[..]].concat(), &video);
    let (header, frames) = luma(&of_stream);
    assert!(header.starts_with("YUV4MPEG2 W120 H120 F30000:1001 Ip A1:1 C420jpeg"), "{header}");
    assert_eq!(frames.len(), 4);
    // The same from a file, into a file.
    fs::write(path.join("a.y4m"), &video).unwrap();
    drawn(path, &[&["a.y4m", "-o", "b.Y4M"], &options[..]].concat(), b"");
    assert!(fs::read(path.join("b.Y4M")).unwrap() == of_stream);
    // The same from photographs, at the rate that is asked for.
    let of_files = [&["in%04d.png", "-o", "-", "--rate", "30000/1001"], &options[..]].concat();
    assert!(drawn(path, &of_files, b"") == of_stream);
    // And into pictures, which count from 1.
    drawn(path, &[&["a.y4m", "-o", "out/%d.png"], &options[..]].concat(), b"");
    assert_eq!(names(&path.join("out")), ["1.png", "2.png", "3.png", "4.png"]);
    for (number, luma) in frames.iter().enumerate() {
        let png = image::open(path.join(format!("out/{}.png", number + 1))).unwrap().into_luma8();
        let expected =
            png.pixels().map(|pixel| (16.0 + f64::from(pixel.0[0]) * 219.0 / 255.0).round() as u8);
        assert!(expected.eq(luma.iter().copied()));
    }
    let plain = drawn(path, &["in%04d.png", "-o", "-", "-n", "10"], b"");
    assert!(luma(&plain).0.contains(" F25:1 "));
}

#[test]
fn streams_of_other_kinds_and_shapes_are_read() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let gray = |width, height| GrayImage::from_fn(width, height, |x, _| Luma([16 + 10 * x as u8]));
    // Odd sizes have color differences for the pixels at the border too.
    let mut odd = stream("C420jpeg", &[gray(5, 3)]);
    odd.extend([77; 12]);
    odd.extend(b"FRAME Xwhatever\n");
    odd.extend(gray(5, 3).as_raw());
    odd.extend([99; 12]);
    let (header, frames) = luma(&drawn(path, &["-", "-o", "-", "-n", "4"], &odd));
    assert!(header.starts_with("YUV4MPEG2 W5 H3 F25:1 ") && frames.len() == 2);
    assert_eq!(frames[0], frames[1]);
    // Ten bits, the same picture.
    let mut ten = b"YUV4MPEG2 W5 H3 C420p10\n".to_vec();
    for _ in 0..2 {
        ten.extend(b"FRAME\n");
        ten.extend(gray(5, 3).iter().flat_map(|&sample| (4 * u16::from(sample)).to_le_bytes()));
        ten.extend([1; 24]);
    }
    assert_eq!(luma(&drawn(path, &["-", "-o", "-", "-n", "4"], &ten)).1, frames);
    // Pixels twice as wide as high.
    let wide = stream("Cmono A2:1", &[gray(5, 3)]);
    let (header, frames) = luma(&drawn(path, &["-", "-o", "-", "-n", "4"], &wide));
    assert!(header.starts_with("YUV4MPEG2 W10 H3 ") && frames.len() == 1);
}

#[test]
fn parts_are_the_frames_of_all() {
    let folder = photographs();
    let path = folder.path();
    fs::create_dir(path.join("parts")).unwrap();
    let options = ["in%04d.png", "-n", "2000", "-o"];
    drawn(path, &[&options[..], &["out/%04d.svg"]].concat(), b"");
    for (of, counts) in [(2, vec![2, 2]), (3, vec![1, 1, 2]), (5, vec![0, 1, 1, 1, 1])] {
        for (i, count) in counts.iter().enumerate() {
            let before = names(&path.join("parts")).len();
            let part = format!("{}/{of}", i + 1);
            drawn(path, &[&options[..], &["parts/%04d.svg", "--part", &part]].concat(), b"");
            assert_eq!(names(&path.join("parts")).len() - before, *count, "{part}");
        }
        for name in names(&path.join("out")) {
            let of = |folder: &str| fs::read(path.join(folder).join(&name)).unwrap();
            assert!(of("out") == of("parts"), "{name}");
            fs::remove_file(path.join("parts").join(&name)).unwrap();
        }
    }
    drawn(path, &[&options[..], &["parts/%04d.svg", "--first", "4", "--last", "5"]].concat(), b"");
    assert_eq!(names(&path.join("parts")), ["0004.svg", "0005.svg"]);
}

#[test]
fn blank_frames_have_no_dots_and_the_first_other_one_gives_the_number() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let white = GrayImage::from_pixel(SIDE, SIDE, Luma([255]));
    let all = [white.clone(), white.clone(), frame(0), white.clone(), frame(0)];
    let video = stream("Cmono XCOLORRANGE=FULL", &all);
    drawn(path, &["-", "-o", "%d.csv", "-n", "2000"], &video);
    let counts: Vec<_> = (1..6)
        .map(|number| dots(&fs::read_to_string(path.join(format!("{number}.csv"))).unwrap()).len())
        .collect();
    assert!(counts[2].abs_diff(2000) < 60, "{counts:?}");
    assert_eq!(counts, [0, 0, counts[2], 0, counts[2]]);
    let (_, frames) = luma(&drawn(path, &["-", "-o", "-", "-n", "2000"], &video));
    assert!(frames[0].iter().all(|&luma| luma == 235) && frames[0] == frames[3]);
    let blank = self::frames(path, &["-", "-o", "-"], &stream("Cmono XCOLORRANGE=FULL", &[white]));
    assert!(complaint_about("standard input", &blank).contains("is all white"));
}

#[test]
fn what_is_amiss_is_said_and_leaves_whole_frames_only() {
    let folder = photographs();
    let path = folder.path();
    let said = |subject: &str, arguments: &[&str], stdin: &[u8]| {
        complaint_about(subject, &frames(path, arguments, stdin))
    };
    let video = |words: &str| stream(words, &[frame(0), frame(1)]);
    let of_stream = |bytes: &[u8]| said("standard input", &["-", "-o", "x.y4m"], bytes);
    assert!(of_stream(b"").contains("is empty"));
    assert!(of_stream(b"\x89PNG").contains("not a YUV4MPEG2 stream"));
    assert!(of_stream(&video("It")).contains("interlaced"));
    assert!(of_stream(&video("Ib")).contains("interlaced"));
    assert!(of_stream(&video("C440")).contains("C440"));
    assert!(of_stream(&video("Q9")).contains("\"Q9\""));
    assert!(of_stream(b"YUV4MPEG2 W9 H9\n").contains("has no frames"));
    assert!(of_stream(b"YUV4MPEG2 W0 H9\n").contains("has no pixels"));
    let whole = video("Cmono");
    let cut = &whole[..whole.len() - 1];
    assert!(of_stream(cut).contains("ends within frame 2"));
    assert!(!path.join("x.y4m").exists());
    let cut = said("standard input", &["-", "-o", "out/%d.svg", "--quiet"], cut);
    assert!(cut.contains("ends within frame 2"));
    assert_eq!(names(&path.join("out")), ["1.svg"]);

    frame(0).save(path.join("in0008.png")).unwrap();
    GrayImage::from_pixel(20, 30, Luma([9])).save(path.join("in0007.png")).unwrap();
    let size = said("in0007.png", &["in%04d.png", "-o", "-", "--quiet"], b"");
    assert!(size.contains("20 x 30 pixels, but the first frame has 240 x 240"));
    fs::remove_file(path.join("in0007.png")).unwrap();
    let gap = frames(path, &["in%04d.png", "-o", "out/%04d.csv"], b"");
    let gap = String::from_utf8(gap.stderr).unwrap();
    assert!(
        gap.contains("in0007.png: warning: is missing; the 1 file after it are not drawn"),
        "{gap}"
    );
    assert!(gap.contains("4 frames of "), "{gap}");

    for (subject, arguments, part) in [
        ("in.png", &["in.png", "-o", "-"][..], "neither numbered files"),
        ("no%04d.png", &["no%04d.png", "-o", "-"], "name of no file"),
        ("in%s.png", &["in%s.png", "-o", "-"], "not one number"),
        ("in0011.png", &["in%04d.png", "-o", "-", "--first", "11"], "is not there"),
        ("in0007.png", &["in%04d.png", "-o", "-", "--last", "8"], "is missing"),
        ("out.svg", &["in%04d.png", "-o", "out.svg"], "neither numbered files"),
        ("out/%d.bmp", &["in%04d.png", "-o", "out/%d.bmp"], "none of the endings"),
        ("no/3.svg", &["in%04d.png", "-o", "no/%d.svg"], "no folder"),
        ("in0003.png", &["in%04d.png", "-o", "in%04d.png"], "the file to read"),
        ("--part", &["-", "-o", "-", "--part", "1/2"], "numbered files"),
        ("--part", &["in%04d.png", "-o", "-", "--part", "1/2"], "a stream has all frames"),
        ("--first", &["-", "-o", "-", "--first", "2"], "this is a stream"),
        ("--exposure", &["-", "-o", "-", "--exposure", "2"], "float files"),
        ("--rate", &["in%04d.png", "-o", "out/%d.svg", "--rate", "5"], "no effect"),
        ("--scale", &["in%04d.png", "-o", "out/%d.csv", "--scale", "2"], "no effect"),
        ("no.y4m", &["no.y4m", "-o", "-"], "cannot be read"),
    ] {
        let text = said(subject, &[arguments, &["--quiet"]].concat(), b"");
        assert!(text.contains(part), "{arguments:?}: {text}");
    }
}

#[test]
fn who_has_seen_enough_may_close_the_stream() {
    let folder = photographs();
    let mut command = program();
    command.current_dir(folder.path()).args(["frames", "in%04d.png", "-o", "-"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut start = [0; 9];
    child.stdout.take().unwrap().read_exact(&mut start).unwrap();
    assert_eq!(&start, b"YUV4MPEG2");
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
}
