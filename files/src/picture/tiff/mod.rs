//! TIFF: strips or tiles, chunky or planar, one at a time, so that a picture is never held twice.

mod lab;
mod layout;
mod pages;
mod relabel;

use std::io::{ErrorKind, Seek as _};

use image::metadata::Orientation;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{TiffError, TiffResult, TiffUnsupportedError};

use super::area::Area;
use super::color::{self, Space};
use super::paint::warned;
use super::plane::{self, Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Sample, Tone, Toner, Wanted, limits};
use layout::{Layout, Region};
use relabel::{Meaning, unpacked};

/// The most bytes of one strip or tile, decoded; some writers make the whole picture one strip.
const CHUNK_LIMIT: usize = limits::MEMORY_LIMIT as usize;

/// The number of this compression.
const JPEG: u16 = 7;

/// Reads the largest page of a TIFF file that is not marked as a smaller version of another: gray, color,
/// palette, CMYK, Lab or JPEG color differences, 1 to 64 bits unsigned or 16 to 64 bits float, with or
/// without alpha.
pub(super) fn read<P: Pixel>(
    source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let mut page = Page::open(source, wanted)?;
    page.layout.check(size_of::<P>() - size_of::<f32>())?;
    let decoded = page.window(&Area::whole(page.size()))?;
    Ok(Decoded { aspect: page.aspect, warnings: page.warnings, ..decoded })
}

/// The page of a file that [`read`] reads, opened to be read by windows.
pub(super) struct Page<P> {
    decoder: Decoder<Source>,
    layout: Layout,
    orientation: Orientation,
    /// Width of an upright pixel over its height.
    pub(super) aspect: f64,
    /// As of [`super::Picture`].
    pub(super) warnings: Vec<String>,
    float: bool,
    painter: Painter<P>,
    /// Where each strip or tile ends, if these are JPEG files, which a decoder fills up that end early.
    ends: Vec<u64>,
    /// Of the file.
    length: u64,
}

impl<P: Pixel> Page<P> {
    /// Reads what there is beside the pixels.
    pub(super) fn open(mut source: Source, wanted: Wanted<'_>) -> Result<Self, PictureError> {
        let page = pages::choose(&mut source)?;
        let (mut source, meaning) = match &page {
            Some(page) => relabel::relabeled(source, page)?,
            // What is wrong is for the decoder to say.
            None => (source, Meaning::Stored),
        };
        let length = source.length()?;
        source.rewind()?;
        let mut decoder_limits = Limits::default();
        decoder_limits.decoding_buffer_size = CHUNK_LIMIT;
        decoder_limits.intermediate_buffer_size = CHUNK_LIMIT;
        let mut decoder = Decoder::new(source).map_err(failure)?.with_limits(decoder_limits);
        let mut layout = Layout::of(&mut decoder)?;
        match &meaning {
            Meaning::Bits(kind) => layout = layout.of_bits(kind),
            Meaning::Palette(_) => layout.colors = Colors::Rgb,
            Meaning::Stored | Meaning::Lab(_) => {}
        }
        let float = decoder
            .find_tag_unsigned_vec::<u16>(Tag::SampleFormat)
            .map_err(failure)?
            .is_some_and(|formats| formats.first() == Some(&3));
        if wanted.radiance && !(float && matches!(layout.colors, Colors::Gray | Colors::Rgb)) {
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
            // Lab says all of a color itself.
            Some(profile) if !matches!(meaning, Meaning::Lab(_)) => {
                let found = color::profile(&profile, layout.colors.count());
                warned("its color profile", found, &mut warnings)
            }
            _ => Space::default(),
        };
        let mut density = |tag| decoder.find_tag(tag).ok().flatten().and_then(ratio);
        let aspect = match (density(Tag::XResolution), density(Tag::YResolution)) {
            (Some(across), Some(down)) => plane::upright_aspect(down / across, orientation),
            _ => 1.0,
        };
        let painter = Painter {
            tone: wanted.tone,
            colors: layout.colors,
            alpha: layout.alpha,
            space,
            meaning,
            toner: None,
            palette: Vec::new(),
        };
        let compression = decoder.find_tag_unsigned::<u16>(Tag::Compression).map_err(failure)?;
        let ends = if compression == Some(JPEG) { ends(&mut decoder)? } else { Vec::new() };
        Ok(Self { decoder, layout, orientation, aspect, warnings, float, painter, ends, length })
    }

    /// Pixels across and down, upright, as they are stored.
    pub(super) fn size(&self) -> (usize, usize) {
        plane::upright((self.layout.width, self.layout.height), self.orientation)
    }

    /// All that is decoded for a window.
    pub(super) fn reach(&self, window: &Area) -> Area {
        let size = (self.layout.width, self.layout.height);
        let stored = plane::stored(size, self.orientation, window);
        plane::shown(size, self.orientation, &stored.widened(self.layout.chunk, size))
    }

    /// The least and greatest brightness of a float file's pixels that were read.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        self.painter.toner.as_ref().filter(|_| self.float).and_then(Toner::range)
    }

    /// The pixels of a window, which must lie in the picture. Strips and tiles that hold none of them are not read.
    ///
    /// # Errors
    /// [`PictureError::TooLarge`] and [`PictureError::LargeParts`] before anything is read.
    pub(super) fn window(&mut self, window: &Area) -> Result<Decoded<P>, PictureError> {
        self.layout.check_window(window.size())?;
        let size = (self.layout.width, self.layout.height);
        let mut plane = Plane::of_window(size, self.orientation, P::NOTHING, window)?;
        for region in self.layout.regions(&plane.stored().clone()) {
            let end = |chunk: &u32| self.ends.get(*chunk as usize);
            if region.chunks.iter().filter_map(end).any(|&end| end > self.length) {
                return Err(PictureError::Truncated(Format::Tiff));
            }
            let chunks: Vec<DecodingResult> = region
                .chunks
                .iter()
                .map(|&chunk| self.decoder.read_chunk(chunk))
                .collect::<TiffResult<_>>()
                .map_err(failure)?;
            self.painter.paint(&mut plane, &self.layout, &region, &chunks)?;
        }
        plane.finish(self.painter.toner.as_ref().filter(|_| self.float))
    }
}

/// Where each strip or tile ends.
fn ends(decoder: &mut Decoder<Source>) -> Result<Vec<u64>, PictureError> {
    let (offsets, lengths) = match decoder.get_chunk_type() {
        ChunkType::Strip => (Tag::StripOffsets, Tag::StripByteCounts),
        ChunkType::Tile => (Tag::TileOffsets, Tag::TileByteCounts),
    };
    let mut of = |tag| decoder.get_tag_u64_vec(tag).map_err(failure);
    let (offsets, lengths) = (of(offsets)?, of(lengths)?);
    Ok(offsets
        .into_iter()
        .zip(lengths)
        .map(|(start, length)| start.saturating_add(length))
        .collect())
}

/// What turns samples into pixels.
struct Painter<P> {
    tone: Tone,
    colors: Colors,
    alpha: Alpha,
    space: Space,
    meaning: Meaning,
    /// Both made for the first samples.
    toner: Option<Toner>,
    palette: Vec<Option<P>>,
}

impl<P: Pixel> Painter<P> {
    /// Sets the pixels of a region from its decoded chunks.
    fn paint(
        &mut self,
        plane: &mut Plane<P>,
        layout: &Layout,
        region: &Region,
        chunks: &[DecodingResult],
    ) -> Result<(), PictureError> {
        macro_rules! paint {
            ($variant:ident) => {{
                let parts: Option<Vec<_>> = chunks
                    .iter()
                    .map(|chunk| match chunk {
                        DecodingResult::$variant(samples) => Some(samples.as_slice()),
                        _ => None,
                    })
                    .collect();
                let parts = parts.ok_or_else(|| unsupported("samples of several types"))?;
                self.fill(plane, region, &parts)
            }};
        }
        match (chunks.first(), &self.meaning) {
            (Some(DecodingResult::U8(packed)), Meaning::Bits(kind)) => {
                let shape = [kind.row(), region.width * kind.samples, region.height];
                let mut samples = unpacked(packed, shape, kind.bits, 65535);
                if kind.inverted {
                    samples.iter_mut().for_each(|sample| *sample = 65535 - *sample);
                }
                self.fill(plane, region, &[&samples])
            }
            (Some(DecodingResult::U8(packed)), _) if layout.bits < 8 => {
                let bits = usize::from(layout.bits);
                let number = matches!(self.meaning, Meaning::Palette(_));
                let full = if number { (1 << bits) - 1 } else { 65535 };
                let shape = [(region.width * bits).div_ceil(8), region.width, region.height];
                let samples = unpacked(packed, shape, bits, full);
                self.fill(plane, region, &[&samples])
            }
            (Some(DecodingResult::U8(_)), _) => paint!(U8),
            (Some(DecodingResult::U16(_)), _) => paint!(U16),
            (Some(DecodingResult::U32(_)), _) => paint!(U32),
            (Some(DecodingResult::U64(_)), _) => paint!(U64),
            (Some(DecodingResult::F16(_) | DecodingResult::F32(_) | DecodingResult::F64(_)), _)
                if !matches!(layout.colors, Colors::Gray | Colors::Rgb) =>
            {
                Err(unsupported("float inks"))
            }
            (Some(DecodingResult::F16(_)), _) => paint!(F16),
            (Some(DecodingResult::F32(_)), _) => paint!(F32),
            (Some(DecodingResult::F64(_)), _) => paint!(F64),
            _ => Err(unsupported("signed samples, which have no white,")),
        }
    }

    /// Sets them from its samples.
    fn fill<S: Sample>(
        &mut self,
        plane: &mut Plane<P>,
        region: &Region,
        parts: &[&[S]],
    ) -> Result<(), PictureError> {
        let Self { tone, colors, alpha, space, meaning, toner, palette } = self;
        match meaning {
            Meaning::Palette(table) => {
                let toner = toner.get_or_insert_with(|| {
                    Toner::new::<u16>(*tone, Colors::Rgb, Alpha::None, space.clone())
                });
                if palette.is_empty() {
                    *palette = table.iter().map(|color| P::of(toner, color)).collect();
                }
                region.fill(plane, parts, 1, |pixel| {
                    // A number beyond the palette's end is no color.
                    let index = pixel[0].index()?;
                    palette.get(index).copied().unwrap_or(Some(P::NOTHING))
                })
            }
            Meaning::Lab(lab) => {
                let toner = toner.get_or_insert_with(|| {
                    Toner::new::<f32>(*tone, Colors::Rgb, *alpha, Space::default())
                });
                let bits = 8 * size_of::<S>() as u32;
                region.fill(plane, parts, toner.samples(), |pixel| {
                    let number = |i: usize| pixel[i].index().unwrap_or(0);
                    let [red, green, blue] = lab.light([number(0), number(1), number(2)], bits);
                    let alpha = pixel.get(3).map_or(1.0, |alpha| alpha.fraction() as f32);
                    P::of(toner, &[red, green, blue, alpha])
                })
            }
            Meaning::Stored | Meaning::Bits(_) => {
                let toner = toner
                    .get_or_insert_with(|| Toner::new::<S>(*tone, *colors, *alpha, space.clone()));
                region.fill(plane, parts, toner.samples(), |pixel| P::of(toner, pixel))
            }
        }
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

fn unsupported(what: &str) -> PictureError {
    PictureError::Decode(Format::Tiff, format!("{what} are not supported").into())
}

fn failure(error: TiffError) -> PictureError {
    match error {
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            PictureError::Truncated(Format::Tiff)
        }
        TiffError::IoError(error) => PictureError::Io(error),
        TiffError::UnsupportedError(TiffUnsupportedError::UnsupportedCompressionMethod(method)) => {
            let reason = format!(
                "compression {method:?} is not supported; save it with LZW, Deflate or none"
            );
            PictureError::Decode(Format::Tiff, reason.into())
        }
        error => PictureError::Decode(Format::Tiff, Box::new(error)),
    }
}
