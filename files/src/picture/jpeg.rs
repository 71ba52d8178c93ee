//! JPEG: gray, color or inks, with its profile and Exif data, and whole even if its end marker is lost.

use image::metadata::Orientation;
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

use super::color::{self, Space};
use super::paint::{paint, warned};
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, exif, limits};

const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];
const START_OF_SCAN: u8 = 0xda;

/// Reads a JPEG file, upright as its Exif data say.
pub(super) fn read<P: Pixel>(
    source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let mut bytes = source.into_bytes()?;
    let mut warnings = Vec::new();
    let shape = Shape::of(&bytes);
    // The decoder paints what it cannot find gray and says nothing.
    if !shape.ended {
        if !is_complete(&bytes, &shape)? {
            return Err(PictureError::Truncated(Format::Jpeg));
        }
        bytes.extend(END_OF_IMAGE);
        warnings.push("it has no end marker, but all its pixels".to_owned());
    }
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(&bytes[..]), options());
    decoder.decode_headers().map_err(failure)?;
    let stored = decoder.input_colorspace().unwrap_or(ColorSpace::YCbCr);
    let inks = matches!(stored, ColorSpace::CMYK | ColorSpace::YCCK);
    let mut space = Space::default();
    let mut by_inks = false;
    let profile = match decoder.icc_profile() {
        None if shape.profile => Some(Err("parts of it are missing".to_owned())),
        None => None,
        Some(profile) => {
            let channels = match stored {
                ColorSpace::Luma => 1,
                _ if inks => 4,
                _ => 3,
            };
            Some(color::profile(&profile, channels))
        }
    };
    if let Some(found) = profile {
        by_inks = inks && found.is_ok();
        space = warned("its color profile", found, &mut warnings);
    }
    let (output, colors) = match stored {
        ColorSpace::Luma => (ColorSpace::Luma, Colors::Gray),
        // Inks by way of red and green and blue would be what the profile is there to avoid.
        _ if by_inks => (stored, Colors::Cmyk),
        _ => (ColorSpace::RGB, Colors::Rgb),
    };
    let (width, height) = decoder.dimensions().ok_or(PictureError::Empty)?;
    let channels = colors.count();
    let needed = channels + size_of::<P>() - size_of::<f32>();
    let count = limits::check(width, height, needed)?;
    decoder.set_options(options().jpeg_set_out_colorspace(output));
    let mut pixels = Vec::new();
    let length = count * channels;
    pixels.try_reserve_exact(length).map_err(|_| limits::too_large(width, height, needed))?;
    pixels.resize(length, 0);
    decoder.decode_into(&mut pixels).map_err(failure)?;
    if by_inks {
        pixels.as_chunks_mut().0.iter_mut().for_each(|pixel| *pixel = amounts(*pixel, stored));
    }

    let orientation = match decoder.exif() {
        Some(exif) => exif::orientation(exif, &mut warnings),
        None => Orientation::NoTransforms,
    };
    let mut plane = Plane::new((width, height), orientation, P::NOTHING)?;
    if let Some((across, down)) = shape.density {
        plane.set_aspect(f64::from(down) / f64::from(across));
    }
    plane.warn(warnings);
    let toner = Toner::new::<u8>(wanted.tone, colors, Alpha::None, space);
    paint(&mut plane, width, &toner, &pixels, |[byte]| byte);
    plane.finish(Some(&toner))
}

/// How much of each ink, of samples as Adobe's programs store them, and all others after them: how much paper
/// shows, or that as luma and color differences.
fn amounts([a, b, c, black]: [u8; 4], stored: ColorSpace) -> [u8; 4] {
    if stored != ColorSpace::YCCK {
        return [a, b, c, black].map(|sample| 255 - sample);
    }
    let (luma, blue, red) = (f64::from(a), f64::from(b) - 128.0, f64::from(c) - 128.0);
    let colors = [luma + 1.402 * red, luma - 0.344136 * blue - 0.714136 * red, luma + 1.772 * blue];
    // What is called red here is how much of cyan there is, for it is paper that was subtracted.
    let [cyan, magenta, yellow] = colors.map(|value| value.round().clamp(0.0, 255.0) as u8);
    [cyan, magenta, yellow, 255 - black]
}

fn options() -> DecoderOptions {
    DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX)
}

fn failure(error: DecodeErrors) -> PictureError {
    match error {
        DecodeErrors::ExhaustedData => PictureError::Truncated(Format::Jpeg),
        error => PictureError::Decode(Format::Jpeg, error.to_string().into()),
    }
}

/// Whether all pixels of a file without an end are there: whatever might follow changes none.
fn is_complete(bytes: &[u8], shape: &Shape) -> Result<bool, PictureError> {
    // In passes, a pixel has a value long before it has its value.
    if !shape.all_passes {
        return Ok(false);
    }
    let decoded = |filler: u8| -> Result<Vec<u8>, PictureError> {
        let mut longer = Vec::new();
        longer
            .try_reserve_exact(bytes.len() + 258)
            .map_err(|_| PictureError::TooLong { bytes: bytes.len() as u64 })?;
        longer.extend_from_slice(bytes);
        longer.extend((0..=255u8).map(|i| i.wrapping_mul(37).wrapping_add(filler) & 0x7f));
        longer.extend(END_OF_IMAGE);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(&longer[..]), options());
        decoder.decode_headers().map_err(failure)?;
        let (width, height) = decoder.dimensions().ok_or(PictureError::Empty)?;
        limits::check(width, height, 8)?;
        decoder.decode().map_err(failure)
    };
    Ok(match (decoded(0), decoded(91)) {
        (Ok(first), Ok(second)) => first == second,
        (Err(error @ (PictureError::TooLarge { .. } | PictureError::Empty)), _) => {
            return Err(error);
        }
        _ => false,
    })
}

/// What the markers say that the decoder does not tell.
#[derive(Default)]
struct Shape {
    /// Whether an end-of-image marker follows the first scan.
    ///
    /// Within a scan the byte FF is always followed by 00 or a restart marker, so FF D9 can only be the
    /// marker; before the scan it may belong to a thumbnail.
    ended: bool,
    /// Whether a pass begins for the last bit of each frequency of each color.
    all_passes: bool,
    /// Whether there is a part of a color profile.
    profile: bool,
    /// Pixels in a length, across and down.
    density: Option<(u16, u16)>,
}

/// The least bit of each frequency of a color that any pass so far holds.
struct Passes {
    color: u8,
    bits: [u8; 64],
}

impl Passes {
    /// Takes the header of a pass into account.
    fn see(of: &mut [Self], header: &[u8]) {
        let Some((&count, rest)) = header.split_first() else { return };
        let Some((colors, rest)) = rest.split_at_checked(2 * usize::from(count)) else { return };
        let &[first, last, bits, ..] = rest else { return };
        for color in colors.chunks_exact(2) {
            let Some(passes) = of.iter_mut().find(|passes| passes.color == color[0]) else {
                continue;
            };
            let range = usize::from(first)..=usize::from(last.min(63));
            for least in passes.bits.get_mut(range).unwrap_or_default() {
                *least = (*least).min(bits & 15);
            }
        }
    }
}

impl Shape {
    fn of(bytes: &[u8]) -> Self {
        let mut shape = Self::default();
        let mut passes: Vec<Passes> = Vec::new();
        let mut scanning = false;
        let mut rest = bytes.get(2..).unwrap_or_default();
        loop {
            match rest {
                // Any number of FF may precede a marker; within a scan 00 and restarts follow it.
                [0xff, 0xff, ..] => rest = &rest[1..],
                [0xff, 0 | 0xd0..=0xd7, after @ ..] if scanning => rest = after,
                [0xff, 0xd9, ..] if scanning => {
                    shape.ended = true;
                    break;
                }
                [0xff, marker, body @ ..] if body.len() >= 2 => {
                    let length = usize::from(u16::from_be_bytes([body[0], body[1]])).max(2);
                    let data = body.get(2..length).unwrap_or_default();
                    match (marker, data) {
                        (0xe0, [b'J', b'F', b'I', b'F', 0, _, _, _, a, b, c, d, ..]) => {
                            let density =
                                (u16::from_be_bytes([*a, *b]), u16::from_be_bytes([*c, *d]));
                            shape.density = (density.0 > 0 && density.1 > 0).then_some(density);
                        }
                        (0xe2, data) => shape.profile |= data.starts_with(b"ICC_PROFILE\0"),
                        (0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf, data) => {
                            let colors = data.get(6..).unwrap_or_default().chunks_exact(3);
                            let unseen = |color: &[u8]| Passes { color: color[0], bits: [255; 64] };
                            passes = colors.map(unseen).collect();
                        }
                        (&START_OF_SCAN, data) => {
                            scanning = true;
                            Passes::see(&mut passes, data);
                        }
                        _ => {}
                    }
                    rest = body.get(length..).unwrap_or_default();
                }
                // Not at a marker, which is for the decoder to judge; it also skips stray bytes.
                [_, after @ ..] => rest = after,
                [] => break,
            }
        }
        let mut bits = passes.iter().flat_map(|passes| passes.bits);
        shape.all_passes = !passes.is_empty() && bits.all(|bit| bit == 0);
        shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_a_thumbnail_is_not_the_end_of_the_photograph() {
        let whole = [
            &b"\xff\xd8\xff\xe1\x00\x06\xff\xd9..\xff\xff\xda\x00\x02scan"[..],
            b"\xff\x00\xff\xd0scan\xff\xd9trailer",
        ]
        .concat();
        assert!(Shape::of(&whole).ended);
        let end = whole.len() - b"\xd9trailer".len();
        for cut in 0..=end {
            assert!(!Shape::of(&whole[..cut]).ended, "{cut}");
        }
    }
}
