//! Files that say more of their pixels than their pixels do: each a small one of its kind.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, GrayImage, ImageFormat, Luma};
use moxcms::ColorProfile;

use super::*;

const LINEAR: Tone = Tone { linear: true, invert: false, levels: None, exposure: None };

pub(super) fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

pub(super) fn picture(name: &str, tone: Tone) -> Picture {
    read(&sample(name), tone).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Mean importance.
pub(super) fn darkness(picture: &Picture) -> f64 {
    picture.total() / (picture.width * picture.height) as f64
}

pub(super) fn of_bytes<T>(bytes: &[u8], read: impl Fn(&Path) -> T) -> T {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), bytes).unwrap();
    read(file.path())
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

fn slope() -> GrayImage {
    GrayImage::from_fn(24, 16, |x, y| Luma([(x * 10 + y) as u8]))
}

#[test]
fn curves_of_integer_files_are_followed() {
    for (name, tone, expected) in [
        ("gama1_16.png", Tone::default(), 0.500),
        // Half of it is mid-gray, of .786 darkness, and half of that black, half white.
        ("gama1_16.png", LINEAR, 0.643),
        ("icc_linear8.png", Tone::default(), 0.500),
    ] {
        let found = darkness(&picture(name, tone));
        assert!((found - expected).abs() < 0.004, "{name}: {found}");
    }
    let color = read_color(&sample("gama1_16.png"), Tone::default(), None).unwrap();
    let gray = |[red, green, blue, alpha]: &[f32; 4]| {
        (red - 0.214).abs() < 1e-3 && red == green && green == blue && *alpha == 1.0
    };
    assert_eq!(color.pixels.iter().filter(|pixel| gray(pixel)).count(), 64 * 64 / 2);
}

#[test]
fn the_same_profile_means_the_same_in_png_jpeg_and_tiff() {
    let profile = ColorProfile::new_gray_with_gamma(1.0).encode().unwrap();
    let gray = GrayImage::from_pixel(24, 16, Luma([128]));
    // Half the light is .735 encoded.
    let expected = 1.0 - srgb::encode(128.0 / 255.0);

    let mut png = Vec::new();
    let mut info = ::png::Info::with_size(24, 16);
    info.color_type = ::png::ColorType::Grayscale;
    info.icc_profile = Some(profile.clone().into());
    let mut writer = ::png::Encoder::with_info(&mut png, info).unwrap().write_header().unwrap();
    writer.write_image_data(gray.as_raw()).unwrap();
    drop(writer);

    let plain = {
        let mut out = Vec::new();
        let encoder = ::image::codecs::jpeg::JpegEncoder::new_with_quality(&mut out, 100);
        gray.write_with_encoder(encoder).unwrap();
        out
    };
    let mut jpeg = plain[..2].to_vec();
    // In two parts, as long profiles are.
    let (first, second) = profile.split_at(profile.len() / 2);
    for (number, part) in [(1u8, first), (2, second)] {
        jpeg.extend([0xff, 0xe2]);
        jpeg.extend((part.len() as u16 + 16).to_be_bytes());
        jpeg.extend(b"ICC_PROFILE\0");
        jpeg.extend([number, 2]);
        jpeg.extend(part);
    }
    jpeg.extend(&plain[2..]);

    let mut tiff = Cursor::new(Vec::new());
    let mut encoder = ::tiff::encoder::TiffEncoder::new(&mut tiff).unwrap();
    let mut page = encoder.new_image::<::tiff::encoder::colortype::Gray8>(24, 16).unwrap();
    page.encoder().write_tag(::tiff::tags::Tag::IccProfile, &profile[..]).unwrap();
    page.write_data(gray.as_raw()).unwrap();

    for (name, bytes) in [("png", png), ("jpeg", jpeg), ("tiff", tiff.into_inner())] {
        let found = of_bytes(&bytes, |path| read(path, Tone::default())).unwrap();
        assert!(found.warnings.is_empty(), "{name}: {:?}", found.warnings);
        assert!((darkness(&found) - expected).abs() < 4e-3, "{name}: {}", darkness(&found));
    }
}

#[test]
fn a_profile_of_no_use_is_a_warning() {
    let mut png = Vec::new();
    let mut info = ::png::Info::with_size(24, 16);
    info.color_type = ::png::ColorType::Grayscale;
    info.icc_profile = Some(b"no profile".to_vec().into());
    let mut writer = ::png::Encoder::with_info(&mut png, info).unwrap().write_header().unwrap();
    writer.write_image_data(slope().as_raw()).unwrap();
    drop(writer);
    let found = of_bytes(&png, |path| read(path, Tone::default())).unwrap();
    assert!(found.warnings[0].contains("sRGB is assumed"), "{:?}", found.warnings);
    let plain = encoded(&slope().into(), ImageFormat::Png);
    let plain = of_bytes(&plain, |path| read(path, Tone::default())).unwrap();
    assert_eq!(found.importance, plain.importance);
}

#[test]
fn transparent_is_nothing_in_both_senses() {
    let tone = Tone { invert: true, ..Tone::default() };
    let logo = picture("logo_white.png", tone);
    for (i, &value) in logo.importance.iter().enumerate() {
        let (x, y) = (i % logo.width, i / logo.width);
        assert!(value == 0.0 || (20..=100).contains(&x) && (10..=90).contains(&y));
    }
    assert!((logo.total() - 5145.0).abs() < 60.0, "{}", logo.total());
    assert_eq!(picture("logo_white.png", Tone::default()).total(), 0.0);
}

#[test]
fn all_of_a_radiance_header_is_followed() {
    let plain = picture("crlf.hdr", Tone::default());
    for name in ["exp2.hdr", "mx.hdr"] {
        assert_eq!(picture(name, Tone::default()).importance, plain.importance, "{name}");
    }
    let mean = darkness(&picture("gam.hdr", Tone::default()));
    assert!((mean - darkness(&plain)).abs() < 0.01, "{mean}");
    let turned = picture("pxpy.hdr", Tone::default());
    assert_eq!((turned.width, turned.height), (64, 32));
    let light = read_radiance(&sample("e_exp.hdr")).unwrap();
    // A lit pixel of white, and nothing brighter.
    assert_eq!(light.pixels.iter().filter(|pixel| **pixel == [1.0; 3]).count(), 1);
    assert!(light.pixels.iter().flatten().all(|&value| value <= 1.0));
}

#[test]
fn radiance_pixels_come_in_eight_orders() {
    // Four colors; each header says where the first pixel lies and which way the rows run.
    for (axes, expected) in [
        ("-Y 2 +X 2", [0, 1, 2, 3]),
        ("-Y 2 -X 2", [1, 0, 3, 2]),
        ("+Y 2 -X 2", [3, 2, 1, 0]),
        ("+Y 2 +X 2", [2, 3, 0, 1]),
        ("+X 2 -Y 2", [0, 2, 1, 3]),
        ("-X 2 -Y 2", [2, 0, 3, 1]),
        ("-X 2 +Y 2", [3, 1, 2, 0]),
        ("+X 2 +Y 2", [1, 3, 0, 2]),
    ] {
        let mut bytes =
            format!("#?RGBE\r\nEXPOSURE=.5\r\nEXPOSURE=2\r\n\r\n{axes}\r\n").into_bytes();
        for value in [0u8, 32, 64, 128] {
            bytes.extend([value, value, value, 129]);
        }
        let found = of_bytes(&bytes, |path| read(path, LINEAR)).unwrap();
        let expected = expected.map(|i| 1.0 - [0.0, 0.25, 0.5, 1.0][i]);
        assert_eq!(found.importance, expected, "{axes}");
        for end in 0..bytes.len() {
            assert!(of_bytes(&bytes[..end], |path| read(path, LINEAR)).is_err(), "{axes} {end}");
        }
    }
}

#[test]
fn environments_come_as_float_tiff_and_not_as_cubes() {
    let light = read_radiance(&sample("e_f32.tif")).unwrap();
    assert_eq!((light.width, light.height), (16, 8));
    let refused = |result: Result<Radiance, PictureError>| {
        assert!(matches!(result, Err(PictureError::NotLatitudeLongitude(_))), "{result:?}");
    };
    refused(read_radiance(&sample("e_cubeattr.exr")));
    for (width, height) in [(4, 4), (8, 6), (6, 8), (12, 2), (2, 12)] {
        let mut bytes = format!("PF\n{width} {height}\n-1\n").into_bytes();
        bytes.resize(bytes.len() + width * height * 12, 0);
        refused(of_bytes(&bytes, read_radiance));
    }
}

#[test]
fn pages_orientation_layers_and_shape_are_those_meant() {
    let size = |name| {
        let found = picture(name, Tone::default());
        (found.width, found.height)
    };
    assert_eq!(size("thumb_first.tif"), (64, 64));
    assert_eq!(size("exif_long.jpg"), (32, 64));
    assert_eq!(size("blender_ml.exr"), (64, 64));
    assert_eq!(size("phys21.png"), (128, 64));
    assert_eq!(size("f_webp.webp"), (64, 64));
    let layered = |name| read_layer(&sample("blender_ml.exr"), Tone::default(), Some(name));
    assert!(layered("ViewLayer.Combined").is_ok() && layered("ViewLayer.Depth").is_err());
}

#[test]
fn a_file_that_lacks_its_end_alone_is_drawn_and_one_that_lacks_pixels_is_not() {
    let found = picture("noeoi.jpg", Tone::default());
    assert!(found.warnings[0].contains("no end marker"));
    let whole = fs::read(sample("noeoi.jpg")).unwrap();
    for end in (1..whole.len() - 1).step_by(5) {
        let cut = of_bytes(&whole[..end], |path| read(path, Tone::default()));
        assert!(cut.is_err(), "{end} of {}", whole.len());
    }
    let png = encoded(&slope().into(), ImageFormat::Png);
    let found = of_bytes(&png[..png.len() - 12], |path| read(path, Tone::default())).unwrap();
    assert!(found.warnings[0].contains("no end chunk"));
    for end in 0..png.len() - 16 {
        assert!(of_bytes(&png[..end], |path| read(path, Tone::default())).is_err(), "{end}");
    }
}

#[test]
fn every_common_format_holds_the_same_picture() {
    let image = DynamicImage::ImageRgb8(DynamicImage::from(slope()).into_rgb8());
    let expected = encoded(&image, ImageFormat::Png);
    let expected = of_bytes(&expected, |path| read(path, Tone::default())).unwrap();
    for format in [ImageFormat::WebP, ImageFormat::Bmp, ImageFormat::Pnm, ImageFormat::Qoi] {
        let bytes = encoded(&image, format);
        let found = of_bytes(&bytes, |path| read(path, Tone::default())).unwrap();
        assert_eq!(found.importance, expected.importance, "{format:?}");
        for end in (0..bytes.len() * 3 / 4).step_by(17) {
            assert!(of_bytes(&bytes[..end], |path| read(path, Tone::default())).is_err());
        }
    }
    // These have alpha.
    let image = DynamicImage::ImageRgba8(image.into_rgba8());
    let bytes = encoded(&image, ImageFormat::Gif);
    let found = of_bytes(&bytes, |path| read(path, Tone::default())).unwrap();
    assert!((darkness(&found) - darkness(&expected)).abs() < 0.02);
    let bytes = encoded(&image, ImageFormat::Tga);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.TGA");
    fs::write(&path, bytes).unwrap();
    assert_eq!(read(&path, Tone::default()).unwrap().importance, expected.importance);
}

#[test]
fn luminance_of_an_openexr_file_is_its_tone_and_color_differences_its_color() {
    let orange = [0.8, 0.3, 0.1];
    let luminance = 0.2126 * orange[0] + 0.7152 * orange[1] + 0.0722 * orange[2];
    for name in ["yc_none.exr", "yc_zip.exr", "yc_piz.exr"] {
        let found = picture(name, Tone::default());
        assert_eq!((found.width, found.height), (16, 10));
        let color = read_color(&sample(name), Tone::default(), None).unwrap();
        let radiance = read_radiance(&sample(name)).unwrap();
        for (i, &value) in found.importance.iter().enumerate() {
            let (left, edge) = (i % 16 < 8, i % 16 == 7);
            let tone = 1.0 - srgb::encode(if left { 0.5 } else { luminance }) as f32;
            assert!((value - tone).abs() < 1e-3, "{name} {i}: {value} {tone}");
            let expected = if left { [0.5; 3] } else { orange };
            // Between two samples of hue lies a mixture.
            let near = |k: usize| (f64::from(color.pixels[i][k]) - expected[k]).abs() < 2e-3;
            assert!(edge || (0..3).all(near), "{name} {i}: {:?}", color.pixels[i]);
        }
        for (light, color) in radiance.pixels.iter().zip(&color.pixels) {
            assert!((0..3).all(|k| (light[k] - color[k]).abs() < 1e-6), "{light:?} {color:?}");
        }
    }
}

#[test]
fn inks_of_jpeg_files_follow_their_profile_and_without_one_mix_ideally() {
    let lightness = [100.0, 60.0, 50.0, 90.0, 20.0];
    for name in ["inks.jpg", "inks_ycck.jpg"] {
        let found = picture(name, Tone::default());
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
        for (patch, lightness) in lightness.iter().enumerate() {
            let expected = 1.0 - srgb::encode(color::of_root((lightness + 16.0) / 116.0));
            let value = f64::from(found.importance[8 * found.width + 8 * patch + 4]);
            assert!((value - expected).abs() < 0.02, "{name} {patch}: {value} {expected}");
        }
        let bytes = fs::read(sample(name)).unwrap();
        let start = bytes.windows(4).position(|w| w == b"ICC_").unwrap() - 4;
        let length = usize::from(u16::from_be_bytes([bytes[start + 2], bytes[start + 3]]));
        let bare = [&bytes[..start], &bytes[start + 2 + length..]].concat();
        let found = of_bytes(&bare, |path| read(path, Tone::default())).unwrap();
        for (patch, expected) in [0.0, 0.2126, 0.7152, 0.0722, 1.0].iter().enumerate() {
            let value = found.importance[8 * found.width + 8 * patch + 4];
            assert!((value - expected).abs() < 0.02, "{name} {patch}: {value} {expected}");
        }
        // Part one of two alone.
        let mut part = bytes;
        part[start + 17] = 2;
        let found = of_bytes(&part, |path| read(path, Tone::default())).unwrap();
        assert!(found.warnings[0].contains("missing"), "{:?}", found.warnings);
    }
}

#[test]
fn a_progressive_jpeg_is_whole_when_its_last_pass_is() {
    let whole = fs::read(sample("progressive.jpg")).unwrap();
    let expected = picture("progressive.jpg", Tone::default());
    let end = whole.len() - 2;
    let found = of_bytes(&whole[..end], |path| read(path, Tone::default())).unwrap();
    assert!(found.warnings[0].contains("no end marker"));
    assert_eq!(found.importance, expected.importance);
    for end in (0..end - 1).step_by(3) {
        assert!(of_bytes(&whole[..end], |path| read(path, Tone::default())).is_err(), "{end}");
    }
}

/// A PNG file with these chunks before its pixels.
fn png_with(chunks: &[(&[u8; 4], &[u8])], sum: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let picture = DynamicImage::from(slope()).into_rgb8();
    let mut encoder = ::png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(::png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&picture).unwrap();
    drop(writer);
    let (start, rest) = bytes.split_at(33);
    let mut file = start.to_vec();
    for (name, data) in chunks {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(&name[..]);
        hasher.update(data);
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(&name[..]);
        file.extend(*data);
        file.extend((hasher.finalize() ^ sum).to_be_bytes());
    }
    [&file, rest].concat()
}

#[test]
fn malformed_chunks_of_png_files_are_passed_over_with_a_word() {
    let plain = of_bytes(&png_with(&[], 0), |path| read(path, Tone::default())).unwrap();
    assert!(plain.warnings.is_empty());
    let cases: [(&[u8; 4], &[u8]); 18] = [
        (b"iCCP", b"name\0\0not deflated"),
        (b"iCCP", b""),
        (b"iCCP", b"no end of the name"),
        (b"eXIf", b""),
        (b"eXIf", b"not a directory"),
        (b"gAMA", b"\0\0"),
        (b"gAMA", b"\0\0\0\0"),
        (b"cHRM", b"\0\0\0"),
        (b"cHRM", &[0; 32]),
        (b"pHYs", b"\0"),
        (b"sRGB", b""),
        (b"sRGB", b"\x09"),
        (b"cICP", b"\x01"),
        (b"cICP", b"\xff\xff\xff\xff"),
        (b"cICP", b"\x63\x63\0\x01"),
        (b"acTL", b"\0"),
        (b"tRNS", b"\0"),
        (b"fcTL", b"\0"),
    ];
    for (name, data) in cases {
        let shown = String::from_utf8_lossy(name);
        let found = of_bytes(&png_with(&[(name, data)], 0), |path| read(path, Tone::default()));
        let found = found.unwrap_or_else(|error| panic!("{shown}: {error}"));
        assert_eq!(found.importance, plain.importance, "{shown}");
        // What tells nothing of the still picture may be passed over in silence.
        let silent = matches!(name, b"acTL" | b"fcTL" | b"tRNS");
        assert!(silent || !found.warnings.is_empty(), "{shown} {data:?}");
        let found = of_bytes(&png_with(&[(name, data)], 1), |path| read(path, Tone::default()));
        let found = found.unwrap();
        assert_eq!(found.importance, plain.importance, "{shown}");
        assert!(found.warnings.iter().any(|w| w.contains(&*shown)), "{:?}", found.warnings);
    }
    // Pixels that their checksum disowns are not shown.
    let mut bytes = png_with(&[], 0);
    let end = bytes.len() - 12;
    bytes[end - 1] ^= 1;
    assert!(of_bytes(&bytes, |path| read(path, Tone::default())).is_err());
}
