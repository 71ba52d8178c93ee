//! What files say of their pixels: which way up, in what colors, of what shape; and every kind by name and on
//! standard input.

use std::fs::{self, File};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

use exr::prelude::{self as openexr, WritableImage as _};
use image::{DynamicImage, GrayImage, ImageEncoder as _, ImageFormat};
use tempfile::TempDir;
use tiff::encoder::{Rational, TiffEncoder, colortype};
use tiff::tags::{ResolutionUnit, Tag};

use crate::inputs::{
    HEIGHT, POINTS, WIDTH, assert_alike, level, light, pixels, reference, samples,
};
use crate::{csv, dots, program};

fn written(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// The reference picture.
fn upright() -> DynamicImage {
    GrayImage::from_raw(WIDTH as u32, HEIGHT as u32, pixels(level)).unwrap().into()
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A PNG file with another chunk before its pixels.
fn with_chunk(png: &[u8], name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(name);
    hasher.update(data);
    // Behind the signature and the header.
    let (start, rest) = png.split_at(33);
    let mut out = start.to_vec();
    out.extend((data.len() as u32).to_be_bytes());
    out.extend(name);
    out.extend(data);
    out.extend(hasher.finalize().to_be_bytes());
    out.extend(rest);
    out
}

/// Exif data that say nothing but an orientation.
fn exif(orientation: u8) -> Vec<u8> {
    let mut bytes = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    bytes.extend([orientation, 0, 0, 0, 0, 0, 0]);
    bytes
}

/// Runs with a file on standard input.
fn piped(path: &Path, arguments: &[&str]) -> Output {
    let mut command = program();
    command.args(["stipple", "-", "-o", "-", "--quiet"]).args(arguments);
    command.stdin(Stdio::from(File::open(path).unwrap())).output().unwrap()
}

/// What is said of a file on standard error, which must be drawn all the same, and its dots.
fn remark(path: &Path) -> (String, Vec<(f32, f32)>) {
    let output = crate::stipple(path, &["-o", "-", "--points", "2000", "--refine", "0"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{text}");
    (text, dots(&String::from_utf8(output.stdout).unwrap()))
}

#[test]
fn png_and_webp_are_turned_as_their_exif_data_say() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    for (orientation, stored) in [
        (1, upright()),
        (2, upright().fliph()),
        (3, upright().rotate180()),
        (4, upright().flipv()),
        (5, upright().rotate90().fliph()),
        (6, upright().rotate270()),
        (7, upright().rotate270().fliph()),
        (8, upright().rotate90()),
    ] {
        let png = with_chunk(&encoded(&stored, ImageFormat::Png), b"eXIf", &exif(orientation));
        let path = written(&folder, "turned.png", &png);
        assert_alike(&format!("png {orientation}"), &csv(&path, POINTS), &expected, 0.0);
        let mut webp = Vec::new();
        let mut encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut webp);
        encoder.set_exif_metadata(exif(orientation)).unwrap();
        let color = stored.to_rgb8();
        encoder
            .encode(&color, color.width(), color.height(), image::ExtendedColorType::Rgb8)
            .unwrap();
        let path = written(&folder, "turned.webp", &webp);
        assert_alike(&format!("webp {orientation}"), &csv(&path, POINTS), &expected, 0.0);
    }
}

/// An sRGB-encoded value, and its light.
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn encode(light: f64) -> f64 {
    if light <= 0.0031308 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// Colors of Display P3, all within sRGB: reds, which are duller in numbers than they are, beside black.
fn muted(x: usize, y: usize) -> [u8; 3] {
    if x < WIDTH / 2 { [0; 3] } else { [200 + level(x, y) / 16, 60, 45] }
}

/// The luma, in sRGB, of such a color.
fn meant(color: [u8; 3]) -> f64 {
    // As published.
    const TO_SRGB: [[f64; 3]; 3] = [
        [1.224_940_2, -0.224_940_2, 0.0],
        [-0.042_056_9, 1.042_056_9, 0.0],
        [-0.019_637_6, -0.078_636_0, 1.098_273_6],
    ];
    let light = color.map(|value| decode(f64::from(value) / 255.0));
    let srgb = TO_SRGB.map(|row| (0..3).map(|i| row[i] * light[i]).sum::<f64>());
    let [red, green, blue] = srgb.map(encode);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

#[test]
fn colors_are_those_meant_however_a_file_says_them() {
    let folder = TempDir::new().unwrap();
    let gray: Vec<u16> = pixels(|x, y| (meant(muted(x, y)) * 65535.0).round() as u16);
    let gray = image::ImageBuffer::from_raw(WIDTH as u32, HEIGHT as u32, gray).unwrap();
    let gray = DynamicImage::ImageLuma16(gray);
    let expected = csv(&written(&folder, "gray.png", &encoded(&gray, ImageFormat::Png)), POINTS);
    let color = image::RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, samples(muted)).unwrap();
    let plain = encoded(&color.clone().into(), ImageFormat::Png);
    let as_srgb = csv(&written(&folder, "plain.png", &plain), POINTS);
    // Taken as sRGB, the reds are lighter, and so the black has more of the dots.
    let of_black =
        |table: &str| dots(table).iter().filter(|dot| dot.0 < WIDTH as f32 / 2.0).count();
    assert!(of_black(&as_srgb) > of_black(&expected) + 15);

    let chromaticities: Vec<u8> =
        [31270u32, 32900, 68000, 32000, 26500, 69000, 15000, 6000].map(u32::to_be_bytes).concat();
    let profile = moxcms::ColorProfile::new_display_p3().encode().unwrap();
    let mut webp = Vec::new();
    let mut encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut webp);
    encoder.set_icc_profile(profile.clone()).unwrap();
    encoder.encode(&color, WIDTH as u32, HEIGHT as u32, image::ExtendedColorType::Rgb8).unwrap();
    let deflated = {
        use std::io::Write as _;
        let mut out =
            flate2::write::ZlibEncoder::new(b"P3\0\0".to_vec(), flate2::Compression::fast());
        out.write_all(&profile).unwrap();
        out.finish().unwrap()
    };
    for (name, bytes) in [
        ("cicp.png", with_chunk(&plain, b"cICP", &[12, 13, 0, 1])),
        ("chrm.png", with_chunk(&plain, b"cHRM", &chromaticities)),
        ("iccp.png", with_chunk(&plain, b"iCCP", &deflated)),
        ("icc.webp", webp),
    ] {
        let found = csv(&written(&folder, name, &bytes), POINTS);
        assert_alike(name, &found, &expected, 0.01);
    }
    // The best known says it, whatever others say.
    let both = with_chunk(&with_chunk(&plain, b"cHRM", &chromaticities), b"sRGB", &[0]);
    assert_eq!(csv(&written(&folder, "both.png", &both), POINTS), as_srgb);
}

#[test]
fn pixels_that_are_not_square_are_drawn_in_shape_with_a_word() {
    let folder = TempDir::new().unwrap();
    let check = |name: &str, path: &Path, [width, height]: [usize; 2]| {
        let (text, dots) = remark(path);
        assert!(text.contains("times as wide as high"), "{name}: {text}");
        let most =
            dots.iter().fold([0f32; 2], |most, dot| [most[0].max(dot.0), most[1].max(dot.1)]);
        for (most, side) in most.into_iter().zip([width, height]) {
            assert!(most < side as f32 && most > side as f32 * 0.93, "{name}: {most} of {side}");
        }
    };
    let [wide, high] = [[2 * WIDTH, HEIGHT], [WIDTH, 2 * HEIGHT]];

    let mut jpeg = encoded(&upright(), ImageFormat::Jpeg);
    assert_eq!(&jpeg[6..11], b"JFIF\0");
    for (unit, density, shape) in [(0, [1, 2], wide), (1, [144, 72], high), (2, [50, 100], wide)] {
        jpeg[13] = unit;
        jpeg[14..18].copy_from_slice(&[0, density[0], 0, density[1]]);
        check("jpeg", &written(&folder, "density.jpg", &jpeg), shape);
    }

    let path = folder.path().join("density.tif");
    let mut encoder = TiffEncoder::new(File::create(&path).unwrap()).unwrap();
    let mut page = encoder.new_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32).unwrap();
    page.resolution_unit(ResolutionUnit::Inch);
    page.x_resolution(Rational { n: 300, d: 2 });
    page.y_resolution(Rational { n: 300, d: 1 });
    page.write_data(&pixels(level)).unwrap();
    drop(encoder);
    check("tiff", &path, wide);

    let png =
        with_chunk(&encoded(&upright(), ImageFormat::Png), b"pHYs", b"\0\0\0\x02\0\0\0\x01\0");
    check("png", &written(&folder, "density.png", &png), high);

    let path = folder.path().join("aspect.exr");
    let gray = openexr::SpecificChannels::build()
        .with_channel("Y")
        .with_pixel_fn(|at: openexr::Vec2<usize>| (light(level(at.x(), at.y())),));
    let mut file = openexr::Image::from_channels((WIDTH, HEIGHT), gray);
    file.attributes.pixel_aspect = 2.0;
    file.write().to_file(&path).unwrap();
    check("openexr", &path, wide);

    let hdr = hdr("PIXASPECT=2\n", |_, row| row.to_vec());
    check("radiance", &written(&folder, "aspect.hdr", &hdr), high);
}

/// Radiance's four bytes for a color of light.
fn rgbe(color: [f32; 3]) -> [u8; 4] {
    let most = color.iter().fold(0f32, |most, &value| most.max(value));
    if most < 1e-30 {
        return [0; 4];
    }
    let exponent = most.log2().floor() as i32 + 1;
    let [red, green, blue] = color.map(|value| (value * 256.0 / 2f32.powi(exponent)) as u8);
    [red, green, blue, (exponent + 128) as u8]
}

/// The reference picture as Radiance HDR with another line in its header, each row stored by `store`.
fn hdr(line: &str, store: impl Fn(usize, &[[u8; 4]]) -> Vec<[u8; 4]>) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\n{line}\n-Y {HEIGHT} +X {WIDTH}\n").into_bytes();
    for y in 0..HEIGHT {
        let row: Vec<_> = (0..WIDTH).map(|x| rgbe([light(level(x, y)); 3])).collect();
        bytes.extend(store(y, &row).concat());
    }
    bytes
}

#[test]
fn radiance_files_of_old_run_lengths_other_axes_and_corrected_colors() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    // Eight bits of mantissa lose a little.
    let check = |name: &str, bytes: &[u8]| {
        let path = written(&folder, "file.hdr", bytes);
        assert_alike(name, &csv(&path, POINTS), &expected, 0.06);
    };
    check("plain", &hdr("FORMAT=32-bit_rle_rgbe\n", |_, row| row.to_vec()));
    let runs = |_: usize, row: &[[u8; 4]]| {
        let mut out = Vec::new();
        for run in row.chunk_by(|a, b| a == b) {
            out.push(run[0]);
            if run.len() > 1 {
                out.push([1, 1, 1, run.len() as u8 - 1]);
            }
        }
        out
    };
    check("old runs", &hdr("", runs));

    // A long row of one color: the digits of its run's length, the least first.
    let mut bytes = b"#?RGBE\n\n-Y 1 +X 700\n".to_vec();
    let dark = rgbe([0.25; 3]);
    bytes.extend([dark, [1, 1, 1, 0x2b], [1, 1, 1, 2], rgbe([1.0; 3]), [1, 1, 1, 143]].concat());
    let path = written(&folder, "long.hdr", &bytes);
    let dots = dots(&csv(&path, &["--points", "300", "--refine", "0"]));
    assert!(dots.len() > 270 && dots.iter().all(|&(x, _)| x < 556.0));

    let scaled = |factor: [f32; 3], line: &str| {
        let mut bytes = format!("#?RADIANCE\n{line}\n-Y {HEIGHT} +X {WIDTH}\n").into_bytes();
        for light in pixels(|x, y| light(level(x, y))) {
            bytes.extend(rgbe(factor.map(|factor| light * factor)));
        }
        bytes
    };
    check("COLORCORR", &scaled([2.0, 0.5, 1.25], "COLORCORR= 2 .5 1.25\n"));
    check(
        "COLORCORR and EXPOSURE",
        &scaled([4.0, 1.0, 0.5], "EXPOSURE=2\nCOLORCORR=2 .5 .25\nCOLORCORR=1 1 1\n"),
    );
    // White is where X, Y and Z are equal.
    check("XYZE", &scaled([1.0; 3], "FORMAT=32-bit_rle_xyze\n"));
}

#[test]
fn every_kind_is_read_by_name_and_on_standard_input() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    let color = DynamicImage::ImageRgb8(upright().to_rgb8());
    let mut files = vec![
        ("file.png", encoded(&color, ImageFormat::Png), 0.0),
        ("file.jpg", encoded(&color, ImageFormat::Jpeg), 0.3),
        ("file.webp", encoded(&color, ImageFormat::WebP), 0.0),
        ("file.bmp", encoded(&color, ImageFormat::Bmp), 0.0),
        ("file.tga", encoded(&color, ImageFormat::Tga), 0.0),
        ("file.qoi", encoded(&color, ImageFormat::Qoi), 0.0),
        ("file.gif", encoded(&DynamicImage::ImageRgba8(color.to_rgba8()), ImageFormat::Gif), 0.2),
        ("gray.pgm", encoded(&upright(), ImageFormat::Pnm), 0.0),
        ("color.ppm", encoded(&color, ImageFormat::Pnm), 0.0),
        ("file.hdr", hdr("", |_, row| row.to_vec()), 0.06),
    ];
    let wide = DynamicImage::ImageRgba16(color.to_rgba16());
    files.push(("file.ff", encoded(&wide, ImageFormat::Farbfeld), 0.0));
    let mut plain = format!("P2 # levels\n{WIDTH} {HEIGHT}\n255\n");
    pixels(level).iter().for_each(|level| plain += &format!("{level} "));
    files.push(("plain.pgm", plain.into_bytes(), 0.0));
    let mut tiff = Cursor::new(Vec::new());
    TiffEncoder::new(&mut tiff)
        .unwrap()
        .write_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32, &pixels(level))
        .unwrap();
    files.push(("file.tif", tiff.into_inner(), 0.0));
    for big_endian in [false, true] {
        let mut pfm = format!("Pf\n{WIDTH} {HEIGHT}\n{}1.0\n", if big_endian { "" } else { "-" })
            .into_bytes();
        for y in (0..HEIGHT).rev() {
            for x in 0..WIDTH {
                let light = light(level(x, y));
                pfm.extend(if big_endian { light.to_be_bytes() } else { light.to_le_bytes() });
            }
        }
        files.push((if big_endian { "big.pfm" } else { "file.pfm" }, pfm, 0.002));
    }
    let path = folder.path().join("file.exr");
    openexr::write_rgb_file(&path, WIDTH, HEIGHT, |x, y| {
        let light = light(level(x, y));
        (light, light, light)
    })
    .unwrap();
    files.push(("file.exr", fs::read(&path).unwrap(), 0.002));
    for (name, bytes, tolerance) in files {
        let path = written(&folder, name, &bytes);
        let found = csv(&path, POINTS);
        assert_alike(name, &found, &expected, tolerance);
        let output = piped(&path, POINTS);
        assert!(output.status.success() && output.stderr.is_empty(), "{name}: {output:?}");
        assert_eq!(String::from_utf8(output.stdout).unwrap(), found, "{name}");
        // What it is called is nothing.
        if name != "file.tga" {
            assert_eq!(csv(&written(&folder, "other.jpg", &bytes), POINTS), found, "{name}");
        }
    }
}

#[test]
fn what_is_not_read_is_named_with_what_to_do_on_standard_input_too() {
    let folder = TempDir::new().unwrap();
    let long = format!("<?xml version=\"1.0\"?>\n<!-- {} -->\n<svg/>", "x".repeat(2000));
    for (bytes, name, advice) in [
        (&b"\0\0\0\x18ftypheic\0\0\0\0mif1heic"[..], "a HEIC file", "export it"),
        (b"\0\0\0\x18ftypavif\0\0\0\0mif1avif", "an AVIF file", "save it as PNG"),
        (b"\xff\x0a\0\0\0\0\0\0", "a JPEG XL file", "save it as PNG"),
        (b"\0\0\0\x0cJXL \r\n\x87\n", "a JPEG XL file", "save it as PNG"),
        (b"8BPS\0\x01\0\0", "a Photoshop file", "save it as PNG"),
        (b"%PDF-1.7\n", "a PDF file", "render it"),
        (long.as_bytes(), "an SVG file", "render it"),
        (b"FUJIFILMCCD-RAW 0201", "a Fujifilm raw (RAF) file", "develop it"),
        (b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom", "a Canon raw (CR3) file", "develop it"),
    ] {
        let path = written(&folder, "photo.jpg", bytes);
        let text = crate::complaint(&path, &[]);
        assert!(text.contains(name) && text.contains(advice), "{text}");
        let output = piped(&path, &[]);
        let text = crate::complaint_about("standard input", &output);
        assert!(text.contains(name) && text.contains(advice), "{text}");
    }
}

#[test]
fn envmap_and_measure_say_what_stipple_says() {
    let folder = TempDir::new().unwrap();
    let mut png = with_chunk(&encoded(&upright(), ImageFormat::Png), b"pHYs", b"\0\0");
    let path = written(&folder, "photo.png", &png);
    let (said, _) = remark(&path);
    let warning = said.lines().find(|line| line.contains("warning: ")).unwrap();
    assert!(warning.contains("pHYs"), "{said}");
    let list = written(&folder, "points.csv", b"x,y\n3,4\n20,20\n9,9\n");
    let measure = |photo: &Path| {
        let arguments = ["measure", list.to_str().unwrap(), "--image", photo.to_str().unwrap()];
        program().args(arguments).output().unwrap()
    };
    let output = measure(&path);
    assert!(output.status.success());
    assert_eq!(String::from_utf8(output.stderr).unwrap(), format!("{warning}\n"));
    png.truncate(png.len() - 12);
    let output = measure(&written(&folder, "photo.png", &png));
    assert!(String::from_utf8(output.stderr).unwrap().contains("no end chunk"));

    // A profile of no use in an environment of floats.
    let path = folder.path().join("light.tif");
    let mut encoder = TiffEncoder::new(File::create(&path).unwrap()).unwrap();
    let mut page = encoder.new_image::<colortype::RGB32Float>(8, 4).unwrap();
    page.encoder().write_tag(Tag::IccProfile, &b"no profile"[..]).unwrap();
    page.write_data(&[0.5; 96]).unwrap();
    drop(encoder);
    let output =
        program().args(["envmap", path.to_str().unwrap(), "-n", "4", "-o", "-"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && said.contains("warning: its color profile"), "{said}");
}
