//! TIFF: strips or tiles, chunky or planar, one at a time, so that a picture is never held twice.

use std::io::{ErrorKind, Seek as _};

use image::metadata::Orientation;
use tiff::ColorType;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{TiffError, TiffResult};

use super::color::{self, Space};
use super::paint::warned;
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Sample, Toner, Wanted, limits};

/// The most bytes of one strip or tile, decoded; some writers make the whole picture one strip.
const CHUNK_LIMIT: usize = limits::MEMORY_LIMIT as usize;

/// Values of the tags `ExtraSamples` and `PlanarConfiguration`.
const ASSOCIATED_ALPHA: u16 = 1;
const UNASSOCIATED_ALPHA: u16 = 2;
const PLANAR: u16 = 2;

/// `NewSubfileType` bits of a page that is a smaller version of another, and of one that is a mask;
/// `SubfileType`'s number for the former.
const REDUCED: u32 = 1;
const MASK: u32 = 4;
const OLD_REDUCED: u32 = 2;

/// Pages looked at.
const MOST_PAGES: usize = 1000;

/// Tags of camera files, whose pixels are not yet colors.
const DNG_VERSION: u16 = 50706;

/// Reads the largest page of a TIFF file that is not marked as a smaller version of another: gray,
/// color, CMYK or JPEG color differences, 1 to 64 bits unsigned or 16 to 64 bits float, with or
/// without alpha.
pub(super) fn read<P: Pixel>(
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    source.rewind()?;
    let mut decoder_limits = Limits::default();
    decoder_limits.decoding_buffer_size = CHUNK_LIMIT;
    decoder_limits.intermediate_buffer_size = CHUNK_LIMIT;
    let mut decoder = Decoder::new(source).map_err(failure)?.with_limits(decoder_limits);
    let camera = decoder.find_tag(Tag::from_u16_exhaustive(DNG_VERSION)).ok().flatten();
    if camera.is_some() {
        return Err(PictureError::Foreign {
            name: "a DNG",
            advice: "develop it to TIFF, PNG or JPEG first",
        });
    }
    full_page(&mut decoder)?;
    let file = Layout::of(&mut decoder, size_of::<P>() - size_of::<f32>())?;
    let float = decoder
        .find_tag_unsigned_vec::<u16>(Tag::SampleFormat)
        .map_err(failure)?
        .is_some_and(|formats| formats.first() == Some(&3));
    if wanted.radiance && !(float && matches!(file.colors, Colors::Gray | Colors::Rgb)) {
        return Err(PictureError::NotRadiance(Format::Tiff));
    }
    if wanted.tone.exposure.is_some() && !float {
        return Err(PictureError::NoExposure(Format::Tiff));
    }
    // Written as BYTE, SHORT or LONG; what is out of range turns nothing.
    let orientation = decoder
        .find_tag_unsigned::<u32>(Tag::Orientation)
        .ok()
        .flatten()
        .and_then(|number| Orientation::from_exif(u8::try_from(number).ok()?))
        .unwrap_or(Orientation::NoTransforms);
    let mut warnings = Vec::new();
    let profile = decoder.find_tag(Tag::IccProfile).ok().flatten();
    let space = match profile.and_then(|value| value.into_u8_vec().ok()) {
        None => Space::default(),
        Some(profile) => {
            let found = color::profile(&profile, file.colors.count());
            warned("its color profile", found, &mut warnings)
        }
    };
    let mut plane = Plane::new((file.width, file.height), orientation, P::NOTHING)?;
    let mut density = |tag| decoder.find_tag(tag).ok().flatten().and_then(ratio);
    if let (Some(across), Some(down)) = (density(Tag::XResolution), density(Tag::YResolution)) {
        plane.set_aspect(down / across);
    }
    plane.warn(warnings);

    let mut toner = None;
    for region in file.regions() {
        let chunks: Vec<DecodingResult> = region
            .chunks
            .iter()
            .map(|&chunk| decoder.read_chunk(chunk))
            .collect::<TiffResult<_>>()
            .map_err(failure)?;
        macro_rules! paint {
            ($variant:ident, $type:ty) => {{
                let parts: Option<Vec<&[$type]>> = chunks
                    .iter()
                    .map(|chunk| match chunk {
                        DecodingResult::$variant(samples) => Some(samples.as_slice()),
                        _ => None,
                    })
                    .collect();
                let parts = parts.ok_or_else(|| unsupported("samples of several types"))?;
                let toner = toner.get_or_insert_with(|| {
                    Toner::new::<$type>(wanted.tone, file.colors, file.alpha, space.clone())
                });
                paint(&mut plane, &region, &parts, toner)?;
            }};
        }
        match chunks.first() {
            Some(DecodingResult::U8(packed)) if file.bits < 8 => {
                let samples = unpacked(packed, &region, file.bits);
                let toner = toner.get_or_insert_with(|| {
                    Toner::new::<u8>(wanted.tone, file.colors, file.alpha, space.clone())
                });
                paint(&mut plane, &region, &[&samples], toner)?;
            }
            Some(DecodingResult::U8(_)) => paint!(U8, u8),
            Some(DecodingResult::U16(_)) => paint!(U16, u16),
            Some(DecodingResult::U32(_)) => paint!(U32, u32),
            Some(DecodingResult::U64(_)) => paint!(U64, u64),
            Some(DecodingResult::F16(_) | DecodingResult::F32(_) | DecodingResult::F64(_))
                if !matches!(file.colors, Colors::Gray | Colors::Rgb) =>
            {
                return Err(unsupported("float inks"));
            }
            Some(DecodingResult::F16(_)) => paint!(F16, exr::prelude::f16),
            Some(DecodingResult::F32(_)) => paint!(F32, f32),
            Some(DecodingResult::F64(_)) => paint!(F64, f64),
            _ => return Err(unsupported("signed samples, which have no white,")),
        }
    }
    plane.finish(toner.as_ref())
}

/// Turns to the page to show.
fn full_page(decoder: &mut Decoder<Source>) -> Result<(), PictureError> {
    let mut best: Option<(u64, usize)> = None;
    let mut pages = 0;
    for index in 0..MOST_PAGES {
        pages = index + 1;
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten();
        let old = decoder.find_tag_unsigned::<u32>(Tag::SubfileType).ok().flatten();
        let part =
            kind.is_some_and(|bits| bits & (REDUCED | MASK) != 0) || old == Some(OLD_REDUCED);
        if !part && let Ok((width, height)) = decoder.dimensions() {
            let area = u64::from(width) * u64::from(height);
            if best.is_none_or(|(most, _)| area > most) {
                best = Some((area, index));
            }
        }
        // A page that cannot be read ends the list; those before it can be shown.
        if !decoder.more_images() || decoder.next_image().is_err() {
            break;
        }
    }
    match best {
        Some((_, index)) => decoder.seek_to_image(index).map_err(failure),
        None if pages == 1 => Ok(()),
        None => Err(unsupported("files of nothing but thumbnails and masks")),
    }
}

/// A fraction above zero.
fn ratio(value: tiff::decoder::ifd::Value) -> Option<f64> {
    use tiff::decoder::ifd::Value;
    let ratio = match value {
        Value::Rational(above, below) => f64::from(above) / f64::from(below),
        Value::List(values) => return ratio(values.into_iter().next()?),
        _ => return None,
    };
    (ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

/// What the header says about the pixels.
struct Layout {
    width: usize,
    height: usize,
    bits: u8,
    colors: Colors,
    alpha: Alpha,
    /// Width and height of a strip or tile.
    chunk: (usize, usize),
    /// Whether each sample has strips or tiles of its own.
    planar: bool,
}

/// The part of a picture that one strip or tile covers, with the chunk numbers that hold it.
struct Region {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    /// One number, or one for each sample of a planar file.
    chunks: Vec<u32>,
}

impl Layout {
    fn of(decoder: &mut Decoder<Source>, more: usize) -> Result<Self, PictureError> {
        let (width, height) = decoder.dimensions().map_err(failure)?;
        let (width, height) = (width as usize, height as usize);
        let color = decoder.colortype().map_err(failure)?;
        let extra = decoder
            .find_tag_unsigned_vec::<u16>(Tag::ExtraSamples)
            .map_err(failure)?
            .and_then(|kinds| kinds.first().copied());
        let tagged = match extra {
            Some(ASSOCIATED_ALPHA) => Alpha::Associated,
            Some(UNASSOCIATED_ALPHA) => Alpha::Straight,
            _ => Alpha::None,
        };
        // A fourth color sample that no tag explains is alpha to most writers.
        let assumed = if tagged == Alpha::None { Alpha::Straight } else { tagged };
        let (colors, alpha) = match color {
            // Extra samples of a gray file make it "multiband".
            ColorType::Gray(_) => (Colors::Gray, Alpha::None),
            ColorType::Multiband { .. } => (Colors::Gray, tagged),
            ColorType::GrayA(_) => (Colors::Gray, assumed),
            ColorType::RGB(_) => (Colors::Rgb, Alpha::None),
            ColorType::RGBA(_) => (Colors::Rgb, assumed),
            ColorType::CMYK(_) => (Colors::Cmyk, Alpha::None),
            ColorType::CMYKA(_) => (Colors::Cmyk, assumed),
            ColorType::YCbCr(8) => (Colors::YCbCr, Alpha::None),
            other => return Err(unsupported(&format!("{other:?} pixels"))),
        };
        let bits = color.bit_depth();
        if !matches!(bits, 8 | 16 | 32 | 64) && !matches!(color, ColorType::Gray(1 | 2 | 4)) {
            return Err(unsupported(&format!("{color:?} pixels")));
        }
        let planar = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(failure)?
            == Some(PLANAR)
            && color.num_samples() > 1;
        // Checked before the chunk size is asked for; a chunk is never larger than the picture.
        let samples = usize::from(color.num_samples());
        limits::check(width, height, samples * usize::from(bits).div_ceil(8) + more)?;
        let chunk = match decoder.get_chunk_type() {
            ChunkType::Strip => {
                let rows = decoder
                    .find_tag_unsigned::<u32>(Tag::RowsPerStrip)
                    .map_err(failure)?
                    .unwrap_or(u32::MAX);
                (width, (rows as usize).min(height))
            }
            ChunkType::Tile => {
                let (width, height) = decoder.chunk_dimensions();
                (width as usize, height as usize)
            }
        };
        if chunk.0 == 0 || chunk.1 == 0 {
            return Err(unsupported("strips or tiles without pixels"));
        }
        Ok(Self { width, height, bits, colors, alpha, chunk, planar })
    }

    /// The regions, in file order.
    fn regions(&self) -> impl Iterator<Item = Region> {
        let across = self.width.div_ceil(self.chunk.0);
        let down = self.height.div_ceil(self.chunk.1);
        let planes = if self.planar {
            self.colors.count() + usize::from(self.alpha != Alpha::None)
        } else {
            1
        };
        (0..across * down).map(move |index| {
            let left = index % across * self.chunk.0;
            let top = index / across * self.chunk.1;
            Region {
                left,
                top,
                width: self.chunk.0.min(self.width - left),
                height: self.chunk.1.min(self.height - top),
                // There are at most as many chunks as pixels, which fit the memory limit.
                chunks: (0..planes).map(|plane| (plane * across * down + index) as u32).collect(),
            }
        })
    }
}

/// Sets the pixels of `region`. `parts` holds its samples: all interleaved in one part, or each in a
/// part of its own.
fn paint<P: Pixel, S: Sample>(
    plane: &mut Plane<P>,
    region: &Region,
    parts: &[&[S]],
    toner: &Toner,
) -> Result<(), PictureError> {
    let count = region.width * region.height;
    let used = toner.samples();
    // Samples that nobody asked for may follow those that count.
    let stride = parts[0].len() / count;
    let complete = match parts {
        [interleaved] => interleaved.len() == count * stride && stride >= used,
        // The decoder hands over the padding rows of the lowest tiles of all planes but the first.
        separate => separate.len() >= used && separate.iter().all(|part| part.len() >= count),
    };
    if !complete {
        return Err(unsupported("strips or tiles of an unexpected size"));
    }
    let mut pixel = Vec::with_capacity(used);
    for index in 0..count {
        pixel.clear();
        match parts {
            [interleaved] => pixel.extend_from_slice(&interleaved[index * stride..][..used]),
            separate => pixel.extend(separate[..used].iter().map(|part| part[index])),
        }
        let (x, y) = (region.left + index % region.width, region.top + index / region.width);
        plane.set(x, y, P::of(toner, &pixel));
    }
    Ok(())
}

/// Samples of 1, 2 or 4 bits, each row of which begins on a byte, stretched to 8 bits.
fn unpacked(packed: &[u8], region: &Region, bits: u8) -> Vec<u8> {
    let (bits, top) = (usize::from(bits), (1u16 << bits) - 1);
    let row_bytes = (region.width * bits).div_ceil(8).max(1);
    let mut samples = Vec::with_capacity(region.width * region.height);
    for row in packed.chunks_exact(row_bytes) {
        samples.extend((0..region.width).map(|x| {
            let place = x * bits;
            let sample = u16::from(row[place / 8]) >> (8 - bits - place % 8) & top;
            // 255 is a multiple of 1, 3 and 15, so this is exact and below 256.
            (sample * (255 / top)) as u8
        }));
    }
    samples
}

fn unsupported(what: &str) -> PictureError {
    PictureError::Decode(Format::Tiff, format!("{what} are not supported").into())
}

fn failure(error: TiffError) -> PictureError {
    match error {
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            PictureError::Truncated(Format::Tiff)
        }
        TiffError::IoError(error) => PictureError::Io(error),
        error => PictureError::Decode(Format::Tiff, Box::new(error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_samples_stretch_to_eight_bits_row_by_row() {
        let region = Region { left: 0, top: 0, width: 3, height: 2, chunks: vec![0] };
        assert_eq!(unpacked(&[0b1010_0000, 0b0100_0000], &region, 1), [255, 0, 255, 0, 255, 0]);
        assert_eq!(unpacked(&[0b0001_1011, 0b1110_0100], &region, 2), [0, 85, 170, 255, 170, 85]);
        assert_eq!(unpacked(&[0x0f, 0x80, 0x12, 0x30], &region, 4), [0, 255, 136, 17, 34, 51]);
    }

    #[test]
    fn regions_cover_every_pixel_once_and_planes_have_chunks_of_their_own() {
        let layout = Layout {
            width: 10,
            height: 7,
            bits: 8,
            colors: Colors::Rgb,
            alpha: Alpha::None,
            chunk: (4, 3),
            planar: true,
        };
        let mut covered = [[0; 10]; 7];
        let mut chunks = Vec::new();
        for region in layout.regions() {
            for row in &mut covered[region.top..][..region.height] {
                for pixel in &mut row[region.left..][..region.width] {
                    *pixel += 1;
                }
            }
            chunks.extend(region.chunks);
        }
        assert_eq!(covered, [[1; 10]; 7]);
        chunks.sort_unstable();
        assert_eq!(chunks, (0..27).collect::<Vec<_>>());
    }
}
