//! Files that are broken, or lie.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{complaint, complaint_about, stipple};

fn written(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// One small whole file of each format.
fn specimens() -> Vec<(&'static str, Vec<u8>)> {
    let picture = image::RgbImage::from_fn(24, 18, |x, y| image::Rgb([x as u8, y as u8, 7]));
    let mut specimens = Vec::new();
    for (name, format) in [("png", image::ImageFormat::Png), ("jpg", image::ImageFormat::Jpeg)] {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        specimens.push((name, bytes.into_inner()));
    }
    let colors: Vec<_> =
        picture.pixels().map(|pixel| image::Rgb(pixel.0.map(|v| f32::from(v) / 255.0))).collect();
    let mut bytes = Vec::new();
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&colors, 24, 18).unwrap();
    specimens.push(("hdr", bytes));
    let mut bytes = std::io::Cursor::new(Vec::new());
    tiff::encoder::TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<tiff::encoder::colortype::RGB8>(24, 18, picture.as_raw())
        .unwrap();
    specimens.push(("tif", bytes.into_inner()));
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("specimen.exr");
    exr::prelude::write_rgb_file(&path, 24, 18, |x, y| (x as f32, y as f32, 0.0f32)).unwrap();
    specimens.push(("exr", fs::read(&path).unwrap()));
    specimens
}

#[test]
#[cfg(target_os = "linux")]
fn more_dots_than_memory_is_one_line_and_no_file() {
    let folder = TempDir::new().unwrap();
    let (name, bytes) = specimens().swap_remove(0);
    let photo = written(&folder, name, &bytes);
    // The list of the result does not fit; then that does, but not the candidates.
    for (kilobytes, count, centers) in [
        ("350000", "10000000", "fixed"),
        ("300000", "5000000", "fixed"),
        ("250000", "10000000", "relaxed"),
    ] {
        let target = folder.path().join("dots.csv");
        let output = std::process::Command::new("sh")
            .args(["-c", "ulimit -v $0 && exec \"$@\"", kilobytes])
            .arg(env!("CARGO_BIN_EXE_twelvefold"))
            .arg("stipple")
            .arg(&photo)
            .args(["--exact", count, "--centers", centers, "--quiet", "-o"])
            .arg(&target)
            .output()
            .unwrap();
        let complaint = complaint_about(photo.to_str().unwrap(), &output);
        assert!(complaint.contains("bytes of memory"), "{complaint}");
        assert_eq!(crate::names(folder.path()), [name]);
    }
}

#[test]
fn a_file_that_ends_early_is_an_error_wherever_it_ends() {
    let folder = TempDir::new().unwrap();
    for (name, whole) in specimens() {
        let path = written(&folder, name, &whole);
        assert!(stipple(&path, &["-o", "-"]).status.success(), "{name}");
        // A TIFF file may end in a tag that nobody needs, and a PNG file in its end chunk.
        let needed = whole.len() - if matches!(name, "png" | "tif") { 16 } else { 0 };
        for part in 0..12 {
            let path = written(&folder, name, &whole[..needed * part / 12]);
            complaint(&path, &[]);
        }
        if name != "tif" {
            complaint(&written(&folder, name, &whole[..needed - 1]), &[]);
        }
    }
}

#[test]
fn flipped_bytes_never_crash() {
    let folder = TempDir::new().unwrap();
    let mut state = 1u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for (name, whole) in specimens() {
        for _ in 0..40 {
            let mut bytes = whole.clone();
            for _ in 0..=random(3) {
                let place = random(bytes.len().min(300));
                bytes[place] = [0, 0xff, 0x7f, 0x80, random(256) as u8][random(5)];
            }
            let path = written(&folder, name, &bytes);
            let output = stipple(&path, &["-o", "-", "--points", "10"]);
            match output.status.code() {
                Some(0) => {}
                _ => drop(complaint_about(path.to_str().unwrap(), &output)),
            }
        }
    }
}

#[test]
fn headers_that_ask_for_too_much_are_refused_by_their_size() {
    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut header = b"IHDR".to_vec();
        header.extend([width.to_be_bytes(), height.to_be_bytes()].concat());
        header.extend([16, 6, 0, 0, 0]);
        let checksum = crc32fast::hash(&header).to_be_bytes();
        let data = b"\0\0\0\0IDAT\x35\xaf\x06\x1e";
        [&b"\x89PNG\r\n\x1a\n\0\0\0\x0d"[..], &header, &checksum, data].concat()
    }
    fn tiff(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = b"II*\0\x08\0\0\0\x09\0".to_vec();
        let mut entry = |tag: u16, kind: u16, value: u32| {
            bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
            bytes.extend([1u32.to_le_bytes(), value.to_le_bytes()].concat());
        };
        for (tag, kind, value) in [
            (256, 4, width),
            (257, 4, height),
            (258, 3, 8),
            (259, 3, 1),
            (262, 3, 1),
            (273, 4, 8),
            (277, 3, 1),
            (278, 4, height),
            (279, 4, u32::MAX),
        ] {
            entry(tag, kind, value);
        }
        bytes.extend([0; 4]);
        bytes
    }
    fn hdr(width: u32, height: u32) -> Vec<u8> {
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes()
    }
    /// A small file whose header then claims another display and data window.
    fn exr(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = specimens().pop().unwrap().1;
        let window = [0i32, 0, 23, 17].map(i32::to_le_bytes).concat();
        let claimed = [0, 0, width as i32 - 1, height as i32 - 1].map(i32::to_le_bytes).concat();
        let places: Vec<usize> =
            (0..400).filter(|&i| bytes[i..i + window.len()] == window).collect();
        assert_eq!(places.len(), 2);
        for place in places {
            bytes[place..place + window.len()].copy_from_slice(&claimed);
        }
        // A file of one part need not say how many chunks it has, and then cannot contradict itself.
        let count = (0..400).find(|&i| bytes[i..].starts_with(b"chunkCount")).unwrap();
        bytes[count] = b'x';
        bytes
    }
    let folder = TempDir::new().unwrap();
    type Header = fn(u32, u32) -> Vec<u8>;
    for (name, header) in [
        ("png", png as Header),
        ("tif", tiff as Header),
        ("hdr", hdr as Header),
        ("exr", exr as Header),
    ] {
        for (width, height) in [(100_000, 100_000), (0x2000_0000, 4), (3, 0x2000_0000)] {
            let path = written(&folder, name, &header(width, height));
            let complaint = limited_complaint(&path);
            let expected = format!("has {width} x {height} pixels, which need");
            assert!(complaint.starts_with(&expected), "{name}: {complaint}");
            assert!(complaint.ends_with("more than the limit of 1024 MiB"), "{complaint}");
        }
        // Sides whose product is too much for 64 bits.
        let path = written(&folder, name, &header(0x7fff_ffff, 0x7fff_ffff));
        limited_complaint(&path);
        let path = written(&folder, name, &header(0, 5));
        limited_complaint(&path);
    }
}

/// The complaint of a run that may not take more than 64 MiB.
fn limited_complaint(path: &Path) -> String {
    let mut command = if cfg!(target_os = "linux") {
        let mut shell = std::process::Command::new("sh");
        shell.args([
            "-c",
            "ulimit -v 65536 && exec \"$0\" \"$@\"",
            env!("CARGO_BIN_EXE_twelvefold"),
        ]);
        shell
    } else {
        crate::program()
    };
    let output = command.arg("stipple").arg(path).args(["-o", "-"]).output().unwrap();
    complaint_about(path.to_str().unwrap(), &output)
}

#[test]
fn what_is_no_photograph_says_so() {
    let folder = TempDir::new().unwrap();
    let missing = folder.path().join("missing.png");
    assert!(complaint(&missing, &[]).starts_with("cannot be read: "));
    assert_eq!(complaint(folder.path(), &[]), "is not a regular file");
    let unknown = "is not a PNG, JPEG, TIFF, WebP, GIF, BMP, PNM, PFM, Targa, QOI, farbfeld, \
                   Radiance HDR or OpenEXR file";
    for bytes in [&b""[..], b"x", b"GIF80a..........", b"\x89PNG"] {
        assert_eq!(complaint(&written(&folder, "strange.png", bytes), &[]), unknown);
    }
    if cfg!(unix) {
        assert_eq!(complaint(Path::new("/dev/zero"), &[]), "is not a regular file");
    }
}

#[test]
fn a_file_name_with_a_line_break_stays_on_one_line() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "two\nlines.png", b"x");
    let output = stipple(&path, &["-o", "-"]);
    let shown = path.to_str().unwrap().replace('\n', " ");
    complaint_about(&shown, &output);
}

#[test]
fn points_that_do_not_fit_the_deepest_level_are_refused() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("speck.png");
    // One speck hardly darker than white, and fifty million dots to put on it.
    let mut picture = image::GrayImage::from_pixel(6000, 6000, image::Luma([255]));
    picture.put_pixel(3000, 3000, image::Luma([254]));
    picture.save(&path).unwrap();
    let output = stipple(&path, &["-o", "-", "--points", "50000000"]);
    let complaint = complaint_about(path.to_str().unwrap(), &output);
    assert!(complaint.starts_with("the density near (300"), "{complaint}");
}
