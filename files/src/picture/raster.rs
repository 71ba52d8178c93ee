//! WebP, GIF, BMP, PNM, Targa, QOI and farbfeld, through the image library's decoders.

use std::io::Seek as _;

use image::codecs::{
    bmp::BmpDecoder, farbfeld::FarbfeldDecoder, gif::GifDecoder, pnm::PnmDecoder, qoi::QoiDecoder,
    tga::TgaDecoder, webp::WebPDecoder,
};
use image::metadata::Orientation;
use image::{ColorType, ImageDecoder, ImageError, Limits};

use super::color::{self, Space};
use super::paint::{paint, warned};
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, exif, limits};

/// Reads a file of this format; of an animation, its first frame.
pub(super) fn read<P: Pixel>(
    format: Format,
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    source.rewind()?;
    match format {
        Format::WebP => decode(format, WebPDecoder::new(source), wanted),
        Format::Gif => decode(format, GifDecoder::new(source), wanted),
        Format::Bmp => decode(format, BmpDecoder::new(source), wanted),
        Format::Pnm => decode(format, PnmDecoder::new(source), wanted),
        Format::Tga => decode(format, TgaDecoder::new(source), wanted),
        Format::Qoi => decode(format, QoiDecoder::new(source), wanted),
        Format::Farbfeld => decode(format, FarbfeldDecoder::new(source), wanted),
        _ => Err(PictureError::UnknownFormat),
    }
}

fn decode<P: Pixel>(
    format: Format,
    decoder: Result<impl ImageDecoder, ImageError>,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let failed = |error: ImageError| failure(format, error);
    let mut decoder = decoder.map_err(failed)?;
    let (width, height) = decoder.dimensions();
    let size = (width as usize, height as usize);
    let color = decoder.color_type();
    let needed = usize::from(color.bytes_per_pixel()) + size_of::<P>() - size_of::<f32>();
    limits::check(size.0, size.1, needed)?;
    let mut decoder_limits = Limits::no_limits();
    decoder_limits.max_alloc = Some(limits::MEMORY_LIMIT);
    decoder.set_limits(decoder_limits).map_err(failed)?;
    let colors = if color.has_color() { Colors::Rgb } else { Colors::Gray };
    let alpha = if color.has_alpha() { Alpha::Straight } else { Alpha::None };
    let mut warnings = Vec::new();
    let space = match decoder.icc_profile() {
        Ok(None) => Space::default(),
        Ok(Some(profile)) => {
            let found = color::profile(&profile, colors.count());
            warned("its color profile", found, &mut warnings)
        }
        Err(error) => warned("its color profile", Err(error.to_string()), &mut warnings),
    };
    let orientation = match decoder.exif_metadata() {
        Ok(Some(exif)) => exif::orientation(&exif, &mut warnings),
        _ => Orientation::NoTransforms,
    };

    let mut bytes = Vec::new();
    let length = usize::try_from(decoder.total_bytes()).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(length).map_err(|_| limits::too_large(size.0, size.1, needed))?;
    bytes.resize(length, 0);
    decoder.read_image(&mut bytes).map_err(failed)?;

    let mut plane = Plane::new(size, orientation, P::NOTHING)?;
    plane.warn(warnings);
    match color {
        ColorType::L8 | ColorType::La8 | ColorType::Rgb8 | ColorType::Rgba8 => {
            let toner = Toner::new::<u8>(wanted.tone, colors, alpha, space);
            paint(&mut plane, size.0, &toner, &bytes, |[byte]| byte);
        }
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => {
            let toner = Toner::new::<u16>(wanted.tone, colors, alpha, space);
            paint(&mut plane, size.0, &toner, &bytes, u16::from_ne_bytes);
        }
        other => {
            return Err(PictureError::Decode(format, format!("{other:?} pixels").into()));
        }
    }
    plane.finish(None)
}

fn failure(format: Format, error: ImageError) -> PictureError {
    match error {
        ImageError::IoError(error) => super::ended(error, format),
        // These name the format themselves, once more.
        ImageError::Decoding(error) => match std::error::Error::source(&error) {
            Some(source) => PictureError::Decode(format, source.to_string().into()),
            None => PictureError::Decode(format, Box::new(error)),
        },
        error => PictureError::Decode(format, Box::new(error)),
    }
}
