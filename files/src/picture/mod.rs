//! Reading a photograph into importance: format by content, memory by header, tone by option.

mod area;
mod aspect;
#[cfg(all(test, feature = "every-format"))]
mod cases;
mod cicp;
mod color;
mod directory;
mod exif;
mod format;
mod grays;
mod jpeg;
#[cfg(all(test, feature = "every-format"))]
mod kinds;
mod limits;
#[cfg(feature = "every-format")]
mod openexr;
mod paint;
mod pfm;
mod pixel;
mod plane;
mod png;
mod radiance;
#[cfg(feature = "every-format")]
mod raster;
mod reduced;
mod sample;
mod scan;
#[cfg(all(test, feature = "every-format"))]
mod scans;
mod source;
pub mod srgb;
#[cfg(feature = "every-format")]
mod tiff;
mod tone;

use std::cell::Cell;
use std::error::Error;
use std::fmt;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::Once;

pub use format::Format;
pub(crate) use grays::Grays;
pub use scan::Scan;
pub use tone::{Levels, Tone};

use image::metadata::Orientation;
use pixel::Pixel;
use plane::{Decoded, Plane};
use sample::{Alpha, Colors, Sample};
use source::Source;
use tone::Toner;

/// How many dots each pixel of a photograph deserves.
#[derive(Debug)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Importance in 0..=1, row by row from the top, each row from the left.
    pub importance: Vec<f32>,
    /// The least and greatest brightness of a float file's pixels, before exposure and clipping.
    pub range: Option<(f64, f64)>,
    /// What was assumed or amiss, each a sentence's end that follows the file's name.
    pub warnings: Vec<String>,
}

/// The colors of a photograph.
#[derive(Debug)]
pub struct ColorPicture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Linear sRGB light of the covered part, at least 0 (1 is white), and the part that is covered;
    /// row by row from the top, each row from the left.
    pub pixels: Vec<[f32; 4]>,
    /// As of [`Picture`].
    pub warnings: Vec<String>,
}

/// Linear red, green and blue, row by row from the top, each row from the left.
#[derive(Debug, Default)]
pub struct Radiance {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// `width` · `height` pixels. Any float: what to do with NaN and negative ones is for the caller.
    pub pixels: Vec<[f32; 3]>,
    /// As of [`Picture`].
    pub warnings: Vec<String>,
}

impl ColorPicture {
    /// Stretches each of red, green and blue, encoded, as [`Levels`] say.
    pub fn level(&mut self, levels: Levels) {
        let (black, range) = (levels.black / 255.0, (levels.white - levels.black) / 255.0);
        let leveled = |light: f32| {
            let encoded = srgb::encode(f64::from(light).clamp(0.0, 1.0));
            let stretched = ((encoded - black) / range).clamp(0.0, 1.0);
            srgb::decode(libm::pow(stretched, 1.0 / levels.gamma)) as f32
        };
        for [red, green, blue, _] in &mut self.pixels {
            for light in [red, green, blue] {
                *light = leveled(*light);
            }
        }
    }
}

impl Picture {
    /// The sum of all importance: the area, in pixels, of black that would hold as many dots.
    pub fn total(&self) -> f64 {
        // Row sums lose nothing that matters and keep the additions of a large picture accurate.
        let rows = self.importance.chunks(self.width);
        rows.map(|row| row.iter().map(|&value| f64::from(value)).sum::<f64>()).sum()
    }
}

/// Why a photograph cannot be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum PictureError {
    /// The system could not open or read the file.
    Io(io::Error),
    /// A folder, a device or a pipe.
    NotAFile,
    /// The first bytes are those of no format known here.
    UnknownFormat,
    /// A format that is known by name only, and what can be done about it.
    Foreign { name: &'static str, advice: &'static str },
    /// An environment map of another shape than latitude by longitude.
    NotLatitudeLongitude(&'static str),
    /// An exposure was asked for, of a file that holds no light.
    NoExposure(Format),
    /// A layer was asked for, of a format that has none.
    NoLayers(Format),
    /// The file is longer than the memory limit.
    TooLong { bytes: u64 },
    /// The header asks for more memory than the limit; `bytes` is `None` past 64 bits.
    TooLarge { width: usize, height: usize, bytes: Option<u64> },
    /// Strips, tiles or blocks so large that one of them, beside the window that is read, needs more memory than
    /// the limit.
    LargeParts { width: usize, height: usize, bytes: Option<u64> },
    /// A window that reaches out of the picture, which has this size.
    Outside { width: usize, height: usize },
    /// A format that stores tones for a display, where light is needed.
    NotRadiance(Format),
    /// The header says that there are no pixels.
    Empty,
    /// The file ends early.
    Truncated(Format),
    /// The file is broken, or of a kind that the decoder does not read.
    Decode(Format, Box<dyn Error>),
    /// A pixel of a float file, counted from (0, 0) at the top left as stored, holds a NaN or an
    /// infinity.
    NotFinite { x: usize, y: usize },
}

impl fmt::Display for PictureError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(out, "cannot be read: {error}"),
            Self::NotAFile => out.write_str("is not a regular file"),
            Self::UnknownFormat => out.write_str(
                "is not a PNG, JPEG, TIFF, WebP, GIF, BMP, PNM, PFM, Targa, QOI, farbfeld, \
                 Radiance HDR or OpenEXR file",
            ),
            Self::Foreign { name, advice } => {
                write!(out, "is {name} file, which is not read; {advice}")
            }
            Self::NotLatitudeLongitude(shape) => write!(
                out,
                "is {shape}, not a latitude-longitude map, which is twice as wide as high; \
                 convert it first"
            ),
            Self::NoExposure(format) => write!(
                out,
                "is a {format} file of integers, which hold tones and no light to expose; \
                 --gamma and --white change its tones"
            ),
            Self::NoLayers(format) => write!(out, "is a {format} file, which has no named layers"),
            Self::TooLong { bytes } => write!(
                out,
                "is {} MiB long, more than the limit of {} MiB",
                bytes >> 20,
                limits::MEMORY_LIMIT >> 20
            ),
            Self::TooLarge { width, height, bytes } => {
                write!(out, "has {width} x {height} pixels, which need ")?;
                too_much(out, *bytes)
            }
            Self::LargeParts { width, height, bytes } => {
                write!(
                    out,
                    "holds its pixels in parts of {width} x {height}, which with what is read of them need "
                )?;
                too_much(out, *bytes)?;
                out.write_str("; save it in small tiles")
            }
            Self::Outside { width, height } => {
                write!(out, "has {width} x {height} pixels, fewer than are asked for")
            }
            Self::NotRadiance(format) => write!(
                out,
                "is a {format} file, which holds no radiance; Radiance HDR, OpenEXR, PFM and float TIFF files do"
            ),
            Self::Empty => out.write_str("has no pixels"),
            Self::Truncated(format) => write!(out, "is a {format} file that ends early"),
            Self::Decode(format, reason) => write!(out, "cannot be read as {format}: {reason}"),
            Self::NotFinite { x, y } => {
                write!(out, "holds a NaN or an infinity, first at pixel ({x}, {y})")
            }
        }
    }
}

/// So much memory, which is more than there may be.
fn too_much(out: &mut fmt::Formatter<'_>, bytes: Option<u64>) -> fmt::Result {
    match bytes {
        Some(bytes) => write!(out, "{} MiB", bytes.div_ceil(1 << 20))?,
        None => out.write_str("over 16 EiB")?,
    }
    write!(out, " of memory, more than the limit of {} MiB", limits::MEMORY_LIMIT >> 20)
}

impl Error for PictureError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Decode(_, reason) => Some(reason.as_ref()),
            _ => None,
        }
    }
}

impl PictureError {
    /// What a decoder says, without the name of its format.
    fn reason(&self) -> String {
        match self {
            Self::Decode(_, reason) => reason.to_string(),
            other => other.to_string(),
        }
    }
}

impl From<io::Error> for PictureError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// What is wanted of a file.
#[derive(Clone, Copy)]
struct Wanted<'a> {
    tone: Tone,
    layer: Option<&'a str>,
    /// Light for an environment, rather than a picture.
    radiance: bool,
}

/// Reads the photograph at `path`, or for `-` from standard input, upright and in shape, as importance.
///
/// Transparent pixels deserve no dots. In float files, negative values count as zero and values
/// above one as white. Takes at most 1 GiB for pixels.
///
/// # Errors
/// [`PictureError`].
pub fn read(path: &Path, tone: Tone) -> Result<Picture, PictureError> {
    read_layer(path, tone, None)
}

/// Reads a photograph as [`read`] does, of an OpenEXR file the layer of this name.
///
/// # Errors
/// [`PictureError`].
pub fn read_layer(path: &Path, tone: Tone, layer: Option<&str>) -> Result<Picture, PictureError> {
    Ok(importance(decode(path, Wanted { tone, layer, radiance: false })?))
}

/// Reads a photograph as [`read`] does, from the bytes of a file of this name.
///
/// # Errors
/// [`PictureError`].
pub fn read_bytes(bytes: Vec<u8>, name: &Path, tone: Tone) -> Result<Picture, PictureError> {
    let wanted = Wanted { tone, layer: None, radiance: false };
    Ok(importance(decode_source(Source::of_bytes(bytes)?, name, wanted)?))
}

/// The picture of encoded sRGB pixels, red, green, blue and coverage from 0 to 255 each, row by row from the top.
///
/// # Errors
/// [`PictureError::Empty`] without pixels or with fewer than `width` · `height`, [`PictureError::TooLarge`] beyond
/// the memory limit.
pub fn of_rgba(
    (width, height): (usize, usize),
    rgba: &[u8],
    tone: Tone,
) -> Result<Picture, PictureError> {
    let toner = Toner::new::<u8>(tone, Colors::Rgb, Alpha::Straight, color::Space::default());
    let mut plane = Plane::new((width, height), Orientation::NoTransforms, f32::NOTHING)?;
    let rgba = rgba.get(..width * height * 4).ok_or(PictureError::Empty)?;
    paint::paint(&mut plane, width, &toner, rgba, |[byte]| byte);
    Ok(importance(plane.finish(None)?))
}

/// The picture of decoded importance.
fn importance(decoded: Decoded<f32>) -> Picture {
    let Decoded { width, height, pixels, range, warnings, .. } = decoded;
    let mut importance = pixels;
    // Resampling rounds.
    importance.iter_mut().for_each(|value| *value = value.clamp(0.0, 1.0));
    Picture { width, height, importance, range, warnings }
}

/// Reads the colors of a photograph, upright and in shape; of `tone` only the exposure
/// counts (see [`ColorPicture::level`]).
///
/// # Errors
/// [`PictureError`].
pub fn read_color(
    path: &Path,
    tone: Tone,
    layer: Option<&str>,
) -> Result<ColorPicture, PictureError> {
    let tone = Tone { linear: true, exposure: tone.exposure, ..Tone::default() };
    let decoded = decode(path, Wanted { tone, layer, radiance: false })?;
    let Decoded { width, height, pixels, warnings, .. } = decoded;
    Ok(ColorPicture { width, height, pixels, warnings })
}

/// Reads the radiance of the environment map at `path`: Radiance HDR, OpenEXR, PFM or float TIFF.
///
/// # Errors
/// [`PictureError`]; [`PictureError::NotRadiance`] for formats that hold tones for a display, and
/// [`PictureError::NotLatitudeLongitude`] for what says or looks that it is a cube.
pub fn read_radiance(path: &Path) -> Result<Radiance, PictureError> {
    let wanted = Wanted { tone: Tone::default(), layer: None, radiance: true };
    let Decoded { width, height, pixels, warnings, .. } = decode(path, wanted)?;
    let shape = |across: usize, down: usize| width * down == height * across;
    // A map of a few pixels may be cut to any shape; a cube's faces are larger.
    let cube = [
        ((1, 1), "square"),
        ((6, 1), "a row of the six faces of a cube"),
        ((1, 6), "a column of the six faces of a cube"),
        ((4, 3), "a cross of the six faces of a cube"),
        ((3, 4), "a cross of the six faces of a cube"),
    ];
    let found = cube.iter().find(|&&((across, down), _)| height > 1 && shape(across, down));
    if let Some(&(_, shape)) = found {
        return Err(PictureError::NotLatitudeLongitude(shape));
    }
    Ok(Radiance { width, height, pixels, warnings })
}

/// Reads the file at `path`.
fn decode<P: Pixel>(path: &Path, wanted: Wanted<'_>) -> Result<Decoded<P>, PictureError> {
    decode_source(Source::open(path)?, path, wanted)
}

/// Reads what a file of this name holds.
fn decode_source<P: Pixel>(
    mut source: Source,
    path: &Path,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    source.check()?;
    let format = detect(&mut source, path, wanted)?;
    let decoded = caught(format, || decode_format(format, source, wanted))?;
    // Directions have no shape of pixels.
    if wanted.radiance { Ok(decoded) } else { aspect::squared(decoded) }
}

/// The format of a file of this name, which can hold what is wanted.
fn detect(source: &mut Source, path: &Path, wanted: Wanted<'_>) -> Result<Format, PictureError> {
    let format = Format::detect(source, path)?;
    let float = matches!(format, Format::Hdr | Format::OpenExr | Format::Pfm | Format::Tiff);
    if wanted.radiance && !float {
        return Err(PictureError::NotRadiance(format));
    }
    if wanted.tone.exposure.is_some() && !float {
        return Err(PictureError::NoExposure(format));
    }
    if wanted.layer.is_some() && format != Format::OpenExr {
        return Err(PictureError::NoLayers(format));
    }
    Ok(format)
}

/// Reads a file of this format, in the shape of its pixels.
fn decode_format<P: Pixel>(
    format: Format,
    source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    match format {
        Format::Png => png::read(source, wanted),
        Format::Jpeg => jpeg::read(source, wanted),
        Format::Hdr => radiance::read(source, wanted),
        Format::Pfm => pfm::read(source, wanted),
        #[cfg(feature = "every-format")]
        Format::Tiff => tiff::read(source, wanted),
        #[cfg(feature = "every-format")]
        Format::OpenExr => openexr::read(source, wanted),
        #[cfg(feature = "every-format")]
        other => raster::read(other, source, wanted),
        #[cfg(not(feature = "every-format"))]
        _ => Err(PictureError::UnknownFormat),
    }
}

/// The error of a read that failed, which may be that the file ended.
fn ended(error: io::Error, format: Format) -> PictureError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => PictureError::Truncated(format),
        _ => PictureError::Io(error),
    }
}

/// Runs a decoder; if it panics on a malformed file, that is an error like any other.
///
/// The decoders are other people's code, and some of them have paths that index past the end when a
/// header lies.
fn caught<T>(
    format: Format,
    decode: impl FnOnce() -> Result<T, PictureError>,
) -> Result<T, PictureError> {
    thread_local! {
        /// Whether this thread decodes, so that its panics are not told.
        static QUIET: Cell<bool> = const { Cell::new(false) };
    }
    static HOOK: Once = Once::new();
    // Once, since another thread may decode or panic meanwhile.
    HOOK.call_once(|| {
        let hook = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                hook(panic);
            }
        }));
    });
    let outside = QUIET.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(decode));
    QUIET.set(outside);
    result.unwrap_or_else(|_| Err(PictureError::Decode(format, "the file is malformed".into())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_in_memory_are_read_as_those_of_a_file() {
        let rgba: Vec<u8> = (0..5 * 3 * 4u32).map(|i| (i * 37 % 256) as u8).collect();
        let mut file = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut file, 5, 3);
        encoder.set_color(::png::ColorType::Rgba);
        encoder.write_header().unwrap().write_image_data(&rgba).unwrap();
        for (linear, invert) in [(false, false), (true, false), (false, true), (true, true)] {
            let tone = Tone { linear, invert, ..Tone::default() };
            let read = read_bytes(file.clone(), Path::new("a.png"), tone).unwrap();
            let of_pixels = of_rgba((5, 3), &rgba, tone).unwrap();
            assert_eq!((read.width, read.height), (of_pixels.width, of_pixels.height));
            assert_eq!(read.importance, of_pixels.importance);
        }
        let tone = Tone::default();
        assert!(matches!(of_rgba((5, 4), &rgba, tone), Err(PictureError::Empty)));
        assert!(matches!(of_rgba((0, 3), &rgba, tone), Err(PictureError::Empty)));
        let text = read_bytes(b"dear diary".to_vec(), Path::new("diary.txt"), tone);
        assert!(matches!(text, Err(PictureError::UnknownFormat)));
    }

    #[test]
    fn the_total_of_a_large_plane_is_exact_to_a_pixel() {
        let picture = Picture {
            width: 3000,
            height: 3000,
            importance: vec![0.1; 9_000_000],
            range: None,
            warnings: Vec::new(),
        };
        assert!((picture.total() - 900_000.0).abs() < 0.1);
    }
}
