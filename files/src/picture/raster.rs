//! PNG, JPEG and Radiance HDR, through the image library's decoders.

use std::fs::File;
use std::io::{BufReader, Cursor, Read as _, Seek as _};

use image::codecs::hdr::HdrDecoder;
use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, Limits};

use super::plane::Plane;
use super::tone::{Alpha, Colors, Sample, Tone, Toner};
use super::{Format, Picture, PictureError, Radiance, limits};

/// Reads a PNG file: 1 to 16 bits, gray, colour or palette, with or without alpha.
pub(super) fn png(mut file: BufReader<File>, tone: Tone) -> Result<Picture, PictureError> {
    // The decoder begins with buffers for a row, and says of a row too long only that it is.
    if let Ok(header) = png::Decoder::new(&mut file).read_header_info() {
        let bits = header.bits_per_pixel();
        limits::check(header.width as usize, header.height as usize, bits.div_ceil(8))?;
    }
    file.rewind()?;
    let decoder = PngDecoder::with_limits(file, decoder_limits());
    decode(Format::Png, decoder, tone)
}

/// Reads a JPEG file, upright as its Exif data say.
pub(super) fn jpeg(mut file: BufReader<File>, tone: Tone) -> Result<Picture, PictureError> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    // The decoder paints what it cannot find gray and says nothing.
    if !has_end_of_image(&bytes) {
        return Err(PictureError::Truncated(Format::Jpeg));
    }
    decode(Format::Jpeg, JpegDecoder::new(Cursor::new(bytes)), tone)
}

/// Reads a Radiance HDR file.
pub(super) fn hdr(file: BufReader<File>, tone: Tone) -> Result<Picture, PictureError> {
    // Strict mode refuses the common signature `#?RGBE`; which of them it is has been checked.
    decode(Format::Hdr, HdrDecoder::new_nonstrict(file), tone)
}

/// Reads the radiance in a Radiance HDR file.
pub(super) fn hdr_radiance(file: BufReader<File>) -> Result<Radiance, PictureError> {
    let failed = |error: ImageError| failure(Format::Hdr, error);
    let mut decoder = HdrDecoder::new_nonstrict(file).map_err(failed)?;
    let (width, height) = decoder.dimensions();
    let mut radiance = Radiance::black(width as usize, height as usize)?;
    decoder.set_limits(decoder_limits()).map_err(failed)?;
    let image = DynamicImage::from_decoder(decoder).map_err(failed)?.into_rgb32f();
    for (pixel, stored) in radiance.pixels.iter_mut().zip(image.pixels()) {
        *pixel = stored.0;
    }
    Ok(radiance)
}

fn decoder_limits() -> Limits {
    let mut decoder_limits = Limits::no_limits();
    decoder_limits.max_alloc = Some(limits::MEMORY_LIMIT);
    decoder_limits
}

fn decode(
    format: Format,
    decoder: Result<impl ImageDecoder, ImageError>,
    tone: Tone,
) -> Result<Picture, PictureError> {
    let failed = |error: ImageError| failure(format, error);
    let mut decoder = decoder.map_err(failed)?;
    let (width, height) = decoder.dimensions();
    let size = (width as usize, height as usize);
    let color = decoder.color_type();
    limits::check(size.0, size.1, usize::from(color.bytes_per_pixel()))?;
    decoder.set_limits(decoder_limits()).map_err(failed)?;
    let orientation = decoder.orientation().map_err(failed)?;

    let mut bytes = Vec::new();
    let length = usize::try_from(decoder.total_bytes()).unwrap_or(usize::MAX);
    bytes
        .try_reserve_exact(length)
        .map_err(|_| limits::too_large(size.0, size.1, usize::from(color.bytes_per_pixel())))?;
    bytes.resize(length, 0);
    decoder.read_image(&mut bytes).map_err(failed)?;

    let mut plane = Plane::new(size, orientation, 0.0)?;
    let colors = if color.has_color() { Colors::Rgb } else { Colors::Gray };
    let alpha = if color.has_alpha() { Alpha::Straight } else { Alpha::None };
    match color {
        ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
            paint(&mut plane, size.0, &Toner::new::<u8>(tone, colors, alpha), &bytes, |[byte]| {
                byte
            });
        }
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
            let toner = Toner::new::<u16>(tone, colors, alpha);
            paint(&mut plane, size.0, &toner, &bytes, u16::from_ne_bytes);
        }
        ColorType::Rgb32F | ColorType::Rgba32F => {
            let toner = Toner::new::<f32>(tone, colors, alpha);
            paint(&mut plane, size.0, &toner, &bytes, f32::from_ne_bytes);
        }
        other => {
            return Err(PictureError::Decode(format, format!("{other:?} pixels").into()));
        }
    }
    plane.finish()
}

/// Sets every pixel of `plane` from `bytes`, whose samples are `SIZE` bytes each.
fn paint<S: Sample, const SIZE: usize>(
    plane: &mut Plane,
    width: usize,
    toner: &Toner,
    bytes: &[u8],
    sample: fn([u8; SIZE]) -> S,
) {
    let channels = toner.samples();
    // The most channels are four: red, green, blue and alpha.
    let mut pixel = [sample([0; SIZE]); 4];
    for (y, row) in bytes.chunks_exact(width * channels * SIZE).enumerate() {
        for (x, stored) in row.chunks_exact(channels * SIZE).enumerate() {
            for (value, &bytes) in pixel.iter_mut().zip(stored.as_chunks::<SIZE>().0) {
                *value = sample(bytes);
            }
            plane.set(x, y, toner.importance(&pixel[..channels]));
        }
    }
}

fn failure(format: Format, error: ImageError) -> PictureError {
    match error {
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            PictureError::Truncated(format)
        }
        ImageError::IoError(error) => PictureError::Io(error),
        // These name the format themselves, once more.
        ImageError::Decoding(error) => match std::error::Error::source(&error) {
            Some(source) => PictureError::Decode(format, source.to_string().into()),
            None => PictureError::Decode(format, Box::new(error)),
        },
        error => PictureError::Decode(format, Box::new(error)),
    }
}

/// Whether an end-of-image marker follows the first scan of a JPEG file.
///
/// Within a scan the byte FF is always followed by 00 or a restart marker, so FF D9 can only be the
/// marker; before the scan it may belong to a thumbnail.
fn has_end_of_image(bytes: &[u8]) -> bool {
    const START_OF_SCAN: u8 = 0xda;
    const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];
    let mut rest = bytes.get(2..).unwrap_or_default();
    loop {
        match rest {
            // Any number of FF may precede a marker.
            [0xff, 0xff, ..] => rest = &rest[1..],
            [0xff, START_OF_SCAN, scan @ ..] => return scan.windows(2).any(|w| w == END_OF_IMAGE),
            [0xff, _, high, low, ..] => {
                let length = usize::from(u16::from_be_bytes([*high, *low]));
                rest = rest.get(2 + length.max(2)..).unwrap_or_default();
            }
            // Not at a marker, which is for the decoder to judge; it also skips stray bytes.
            [_, after @ ..] => rest = after,
            [] => return false,
        }
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
        assert!(has_end_of_image(&whole));
        let end = whole.len() - b"\xd9trailer".len();
        for cut in 0..=end {
            assert!(!has_end_of_image(&whole[..cut]), "{cut}");
        }
    }
}
