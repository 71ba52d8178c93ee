//! Every format, depth and kind of pixel, read to the same importance.

use std::fs::File;
use std::io::{BufWriter, Cursor};
use std::path::Path;

use exr::prelude::{self as openexr, WritableImage as _};
use image::{DynamicImage, ExtendedColorType, ImageEncoder as _, ImageFormat};
use tempfile::TempDir;
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::{ExtraSamples, Tag};

use crate::{complaint, csv, dots};

pub(crate) const WIDTH: usize = 40;
pub(crate) const HEIGHT: usize = 30;

/// An 8-bit gray level with edges and slopes.
pub(crate) fn level(x: usize, y: usize) -> u8 {
    let slope = x * 6 + y / 2;
    if (x / 10 + y / 10).is_multiple_of(2) { slope as u8 } else { 255 - slope as u8 }
}

/// One value for each pixel.
pub(crate) fn pixels<T>(of: impl Fn(usize, usize) -> T) -> Vec<T> {
    (0..WIDTH * HEIGHT).map(|i| of(i % WIDTH, i / WIDTH)).collect()
}

/// Several samples for each pixel.
pub(crate) fn samples<T, const N: usize>(of: impl Fn(usize, usize) -> [T; N]) -> Vec<T> {
    pixels(of).into_iter().flatten().collect()
}

/// Linear light of an 8-bit level.
pub(crate) fn light(level: u8) -> f32 {
    let encoded = f64::from(level) / 255.0;
    let light =
        if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
    light as f32
}

/// Fixed centers: a pixel that differs moves no dot but its own.
pub(crate) const POINTS: &[&str] = &["--points", "2000", "--centers", "fixed", "--refine", "0"];

/// The dots of the same picture as the plainest of files.
pub(crate) fn reference(folder: &Path) -> String {
    let path = folder.join("reference.png");
    let gray = pixels(level);
    image::save_buffer(&path, &gray, WIDTH as u32, HEIGHT as u32, image::ColorType::L8).unwrap();
    csv(&path, POINTS)
}

/// Asserts that two tables differ in at most `tolerance` of their lines.
pub(crate) fn assert_alike(name: &str, found: &str, expected: &str, tolerance: f64) {
    let lines =
        |table: &str| table.lines().map(str::to_owned).collect::<std::collections::BTreeSet<_>>();
    let (found, expected) = (lines(found), lines(expected));
    let different = found.symmetric_difference(&expected).count() as f64 / expected.len() as f64;
    assert!(different <= tolerance, "{name}: {different}");
}

fn write_png(path: &Path, bytes: &[u8], color: ExtendedColorType) {
    let file = BufWriter::new(File::create(path).unwrap());
    let encoder = image::codecs::png::PngEncoder::new(file);
    encoder.write_image(bytes, WIDTH as u32, HEIGHT as u32, color).unwrap();
}

#[test]
fn png_of_every_depth() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    let wide = |level: u8| (u16::from(level) * 257).to_ne_bytes();
    let files: [(&str, Vec<u8>, ExtendedColorType); 7] = [
        ("la8", samples(|x, y| [level(x, y), 255]), ExtendedColorType::La8),
        ("rgb8", samples(|x, y| [level(x, y); 3]), ExtendedColorType::Rgb8),
        (
            "rgba8",
            samples(|x, y| {
                let level = level(x, y);
                [level, level, level, 255]
            }),
            ExtendedColorType::Rgba8,
        ),
        ("l16", samples(|x, y| wide(level(x, y))), ExtendedColorType::L16),
        ("la16", samples(|x, y| [wide(level(x, y)), [255; 2]]).concat(), ExtendedColorType::La16),
        ("rgb16", samples(|x, y| [wide(level(x, y)); 3]).concat(), ExtendedColorType::Rgb16),
        (
            "rgba16",
            samples(|x, y| {
                let level = wide(level(x, y));
                [level, level, level, [255; 2]]
            })
            .concat(),
            ExtendedColorType::Rgba16,
        ),
    ];
    for (name, bytes, color) in files {
        let path = folder.path().join(name).with_extension("png");
        write_png(&path, &bytes, color);
        assert_alike(name, &csv(&path, POINTS), &expected, 0.0);
    }
}

#[test]
fn png_of_few_bits_and_palettes() {
    let folder = TempDir::new().unwrap();
    let black_and_white = |x: usize, y: usize| level(x, y) >= 128;
    let full = folder.path().join("full.png");
    let bytes = pixels(|x, y| if black_and_white(x, y) { 255 } else { 0 });
    write_png(&full, &bytes, ExtendedColorType::L8);
    let expected = csv(&full, POINTS);

    for palette in [false, true] {
        let path = folder.path().join("packed.png");
        let file = BufWriter::new(File::create(&path).unwrap());
        let mut encoder = png::Encoder::new(file, WIDTH as u32, HEIGHT as u32);
        encoder.set_depth(png::BitDepth::One);
        encoder.set_color(png::ColorType::Grayscale);
        if palette {
            encoder.set_color(png::ColorType::Indexed);
            // The other way round: 1 is black.
            encoder.set_palette(vec![255, 255, 255, 0, 0, 0]);
        }
        let mut bytes = vec![0u8; WIDTH / 8 * HEIGHT];
        for i in 0..WIDTH * HEIGHT {
            let set = black_and_white(i % WIDTH, i / WIDTH) != palette;
            bytes[i / 8] |= u8::from(set) << (7 - i % 8);
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&bytes).unwrap();
        writer.finish().unwrap();
        assert_alike("packed", &csv(&path, POINTS), &expected, 0.0);
    }
}

#[test]
fn jpeg_gray_and_color_whatever_the_file_is_called() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    for (name, bytes, color) in [
        ("gray.png", pixels(level), ExtendedColorType::L8),
        ("color", samples(|x, y| [level(x, y); 3]), ExtendedColorType::Rgb8),
    ] {
        let path = folder.path().join(name);
        let file = BufWriter::new(File::create(&path).unwrap());
        let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(file, 100);
        encoder.write_image(&bytes, WIDTH as u32, HEIGHT as u32, color).unwrap();
        assert_alike(name, &csv(&path, POINTS), &expected, 0.1);
    }
}

#[test]
fn a_photograph_on_its_side_is_turned_upright() {
    let folder = TempDir::new().unwrap();
    let upright = image::GrayImage::from_raw(WIDTH as u32, HEIGHT as u32, pixels(level)).unwrap();
    let stored = DynamicImage::ImageLuma8(upright).rotate270();
    let mut jpeg = Cursor::new(Vec::new());
    image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 100)
        .encode_image(&stored)
        .unwrap();
    // An Exif block with the one entry "Orientation: 6", to be turned clockwise by 90 degrees.
    let exif =
        b"\xff\xe1\x00\x22Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
    let (start, rest) = jpeg.get_ref().split_at(2);
    let path = folder.path().join("turned.jpg");
    std::fs::write(&path, [start, exif, rest].concat()).unwrap();
    assert_alike("turned", &csv(&path, POINTS), &reference(folder.path()), 0.1);
}

#[test]
fn tiff_of_every_depth() {
    fn write<C: colortype::ColorType>(path: &Path, data: &[C::Inner])
    where
        [C::Inner]: tiff::encoder::TiffValue,
    {
        let file = BufWriter::new(File::create(path).unwrap());
        let mut encoder = TiffEncoder::new(file).unwrap();
        encoder.write_image::<C>(WIDTH as u32, HEIGHT as u32, data).unwrap();
    }
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    let path = folder.path().join("file.tif");
    let check = |name: &str, tolerance: f64| {
        assert_alike(name, &csv(&path, POINTS), &expected, tolerance);
    };
    let wide = |x, y| u16::from(level(x, y)) * 257;
    write::<colortype::Gray8>(&path, &pixels(level));
    check("gray 8", 0.0);
    write::<colortype::Gray16>(&path, &pixels(wide));
    check("gray 16", 0.0);
    write::<colortype::Gray32>(&path, &pixels(|x, y| u32::from(level(x, y)) * 0x0101_0101));
    check("gray 32", 0.0);
    write::<colortype::Gray32Float>(&path, &pixels(|x, y| light(level(x, y))));
    check("gray float", 0.002);
    write::<colortype::Gray64Float>(&path, &pixels(|x, y| f64::from(light(level(x, y)))));
    check("gray double", 0.002);
    write::<colortype::RGB8>(&path, &samples(|x, y| [level(x, y); 3]));
    check("rgb 8", 0.0);
    write::<colortype::RGB16>(&path, &samples(|x, y| [wide(x, y); 3]));
    check("rgb 16", 0.0);
    write::<colortype::RGB32Float>(&path, &samples(|x, y| [light(level(x, y)); 3]));
    check("rgb float", 0.002);
    let opaque = |x, y| {
        let level = level(x, y);
        [level, level, level, 255]
    };
    write::<colortype::RGBA8>(&path, &samples(opaque));
    check("rgba 8", 0.0);
    write::<colortype::CMYK8>(&path, &samples(|x, y| [0, 0, 0, 255 - level(x, y)]));
    check("cmyk 8", 0.01);
}

#[test]
fn tiff_in_many_strips_compressed_and_with_alpha_on_gray() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("file.tif");
    let file = BufWriter::new(File::create(&path).unwrap());
    let mut encoder =
        TiffEncoder::new(file).unwrap().with_compression(tiff::encoder::Compression::Lzw);
    let mut picture = encoder.new_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32).unwrap();
    picture.extra_samples(&[ExtraSamples::UnassociatedAlpha]).unwrap();
    picture.rows_per_strip(7).unwrap();
    // Black, and alpha such that white shines through as much as in the reference.
    picture.write_data(&samples(|x, y| [0, 255 - level(x, y)])).unwrap();
    drop(encoder);
    assert_alike("gray alpha", &csv(&path, POINTS), &reference(folder.path()), 0.01);
}

#[test]
fn tiff_on_its_side_is_turned_upright() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("file.tif");
    let file = BufWriter::new(File::create(&path).unwrap());
    let mut encoder = TiffEncoder::new(file).unwrap();
    let mut picture = encoder.new_image::<colortype::Gray8>(WIDTH as u32, HEIGHT as u32).unwrap();
    picture.encoder().write_tag(Tag::Orientation, 3u16).unwrap();
    picture.write_data(&pixels(|x, y| level(WIDTH - 1 - x, HEIGHT - 1 - y))).unwrap();
    drop(encoder);
    assert_alike("half a turn", &csv(&path, POINTS), &reference(folder.path()), 0.0);
}

#[test]
fn radiance_hdr_with_either_signature() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("file.hdr");
    let mut bytes = Vec::new();
    let colors = pixels(|x, y| image::Rgb([light(level(x, y)); 3]));
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&colors, WIDTH, HEIGHT).unwrap();
    let expected = reference(folder.path());
    std::fs::write(&path, &bytes).unwrap();
    // The format has eight bits for the mantissa.
    assert_alike("radiance", &csv(&path, POINTS), &expected, 0.06);
    assert!(bytes.starts_with(b"#?RADIANCE\n"));
    std::fs::write(&path, [b"#?RGBE\n", &bytes[b"#?RADIANCE\n".len()..]].concat()).unwrap();
    assert_alike("rgbe", &csv(&path, POINTS), &expected, 0.06);
}

#[test]
fn openexr_float_half_gray_and_alpha() {
    let folder = TempDir::new().unwrap();
    let expected = reference(folder.path());
    let path = folder.path().join("file.exr");
    let value = |x, y| light(level(x, y));

    openexr::write_rgb_file(&path, WIDTH, HEIGHT, |x, y| {
        let value = value(x, y);
        (value, value, value)
    })
    .unwrap();
    assert_alike("rgb float", &csv(&path, POINTS), &expected, 0.002);

    openexr::write_rgb_file(&path, WIDTH, HEIGHT, |x, y| {
        let value = openexr::f16::from_f32(value(x, y));
        (value, value, value)
    })
    .unwrap();
    assert_alike("rgb half", &csv(&path, POINTS), &expected, 0.01);

    let gray = openexr::SpecificChannels::build()
        .with_channel("Y")
        .with_pixel_fn(|position: openexr::Vec2<usize>| (value(position.x(), position.y()),));
    openexr::Image::from_channels((WIDTH, HEIGHT), gray).write().to_file(&path).unwrap();
    assert_alike("gray float", &csv(&path, POINTS), &expected, 0.002);

    // Black that covers what the reference lacks of white: in OpenEXR, colors come multiplied.
    openexr::write_rgba_file(&path, WIDTH, HEIGHT, |x, y| (0.0, 0.0, 0.0, 1.0 - value(x, y)))
        .unwrap();
    assert_alike("alpha", &csv(&path, POINTS), &expected, 0.002);
}

#[test]
fn transparent_is_white() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("file.png");
    let opaque = |x: usize| if x < WIDTH / 2 { 0 } else { 255 };
    write_png(&path, &samples(|x, _| [0, 0, 0, opaque(x)]), ExtendedColorType::Rgba8);
    let dots = dots(&csv(&path, &["--points", "500"]));
    assert!(dots.len() > 450);
    assert!(dots.iter().all(|&(x, _)| x >= (WIDTH / 2) as f32));
}

#[test]
fn negative_floats_are_black_and_those_above_one_white() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("file.exr");
    for linear in [&[][..], &["--linear"]] {
        openexr::write_rgb_file(&path, WIDTH, HEIGHT, |x, _| {
            let value = if x < 10 { -5.0f32 } else { 900.0 };
            (value, value, value)
        })
        .unwrap();
        let dots = dots(&csv(&path, &[&["--points", "300"], linear].concat()));
        assert!(dots.len() > 270);
        assert!(dots.iter().all(|&(x, _)| x < 10.0));
    }
}

#[test]
fn a_nan_or_infinity_is_named_by_its_pixel() {
    let folder = TempDir::new().unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let value = |x, y| if (x, y) == (7, 3) || y > 20 { bad } else { 0.5 };
        let path = folder.path().join("file.exr");
        openexr::write_rgb_file(&path, WIDTH, HEIGHT, |x, y| (0.5f32, value(x, y), 0.5)).unwrap();
        let expected = "holds a NaN or an infinity, first at pixel (7, 3)";
        assert_eq!(complaint(&path, &[]), expected);

        let path = folder.path().join("file.tif");
        let mut encoder = TiffEncoder::new(File::create(&path).unwrap()).unwrap();
        encoder
            .write_image::<colortype::Gray32Float>(WIDTH as u32, HEIGHT as u32, &pixels(value))
            .unwrap();
        assert_eq!(complaint(&path, &[]), expected);
    }
}

#[test]
fn pictures_of_one_row_one_column_and_one_pixel() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("thin.png");
    for (width, height) in [(1, 1), (1, 200), (200, 1), (1, 5000)] {
        let mut picture = image::GrayImage::new(width, height);
        if width * height > 1 {
            picture.put_pixel(0, 0, image::Luma([255]));
        }
        picture.save_with_format(&path, ImageFormat::Png).unwrap();
        let dots = dots(&csv(&path, &["--points", "1000"]));
        assert!(dots.len().abs_diff(1000) < 50, "{width} x {height}: {}", dots.len());
        for (x, y) in dots {
            assert!(0.0 <= x && x < width as f32 && 0.0 <= y && y < height as f32);
            assert!(width * height == 1 || x >= 1.0 || y >= 1.0, "({x}, {y}) is on white");
        }
    }
}

#[test]
fn a_picture_without_a_place_for_dots_suggests_the_other_way() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("plain.png");
    for (level, option, other) in [(255, None, "try --invert"), (0, Some("--invert"), "without")] {
        let plain = image::GrayImage::from_pixel(9, 9, image::Luma([level]));
        plain.save(&path).unwrap();
        let options: Vec<&str> = option.into_iter().collect();
        assert!(complaint(&path, &options).contains(other));
        // No dots were asked for, and none is what there is room for.
        assert_eq!(csv(&path, &[&["--points", "0"], &options[..]].concat()), "x,y\n");
    }
}
