//! Reading a photograph into importance: format by content, memory by header, tone by option.

mod limits;
mod openexr;
mod plane;
mod radiance;
mod raster;
pub mod srgb;
mod tiff;
mod tone;

use std::error::Error;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufReader, Read as _, Seek as _};
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;

pub use radiance::{Radiance, read_radiance};
pub use tone::Tone;

/// How many dots each pixel of a photograph deserves.
#[derive(Debug)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Importance in 0..=1, row by row from the top, each row from the left.
    pub importance: Vec<f32>,
}

impl Picture {
    /// The sum of all importance: the area, in pixels, of black that would hold as many dots.
    pub fn total(&self) -> f64 {
        // Row sums lose nothing that matters and keep the additions of a large picture accurate.
        let rows = self.importance.chunks(self.width);
        rows.map(|row| row.iter().map(|&value| f64::from(value)).sum::<f64>()).sum()
    }
}

/// The formats read, told apart by their first bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Png,
    Jpeg,
    Tiff,
    Hdr,
    OpenExr,
}

impl Format {
    /// The format of a file that begins with `start`.
    fn of(start: &[u8]) -> Option<Self> {
        const SIGNATURES: [(&[u8], Format); 9] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"II*\0", Format::Tiff),
            (b"MM\0*", Format::Tiff),
            (b"II+\0", Format::Tiff),
            (b"MM\0+", Format::Tiff),
            (b"#?RADIANCE", Format::Hdr),
            (b"#?RGBE", Format::Hdr),
            (b"\x76\x2f\x31\x01", Format::OpenExr),
        ];
        SIGNATURES.iter().find(|(signature, _)| start.starts_with(signature)).map(|&(_, f)| f)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Tiff => "TIFF",
            Self::Hdr => "Radiance HDR",
            Self::OpenExr => "OpenEXR",
        })
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
    /// The first bytes are those of no format read here.
    UnknownFormat,
    /// The file is longer than the memory limit.
    TooLong { bytes: u64 },
    /// The header asks for more memory than the limit; `bytes` is `None` past 64 bits.
    TooLarge { width: usize, height: usize, bytes: Option<u64> },
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
            Self::UnknownFormat => {
                out.write_str("is not a PNG, JPEG, TIFF, Radiance HDR or OpenEXR file")
            }
            Self::TooLong { bytes } => write!(
                out,
                "is {} MiB long, more than the limit of {} MiB",
                bytes >> 20,
                limits::MEMORY_LIMIT >> 20
            ),
            Self::TooLarge { width, height, bytes } => {
                write!(out, "has {width} x {height} pixels, which need ")?;
                match bytes {
                    Some(bytes) => write!(out, "{} MiB", bytes.div_ceil(1 << 20))?,
                    None => out.write_str("over 16 EiB")?,
                }
                write!(out, " of memory, more than the limit of {} MiB", limits::MEMORY_LIMIT >> 20)
            }
            Self::NotRadiance(format) => write!(
                out,
                "is a {format} file, which holds no radiance; Radiance HDR and OpenEXR files do"
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

impl Error for PictureError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Decode(_, reason) => Some(reason.as_ref()),
            _ => None,
        }
    }
}

impl From<io::Error> for PictureError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Reads the photograph at `path`, upright, as importance.
///
/// Transparent pixels are laid over white. In float files, negative values count as zero and values
/// above one as white. Takes at most 1 GiB for pixels.
///
/// # Errors
/// [`PictureError`].
pub fn read(path: &Path, tone: Tone) -> Result<Picture, PictureError> {
    let (format, file) = open(path)?;
    caught(format, || match format {
        Format::Png => raster::png(file, tone),
        Format::Jpeg => raster::jpeg(file, tone),
        Format::Hdr => raster::hdr(file, tone),
        Format::Tiff => tiff::read(file, tone),
        Format::OpenExr => openexr::read(file, tone),
    })
}

/// Opens the file at `path` and tells its format; the reader stands at its start.
fn open(path: &Path) -> Result<(Format, BufReader<File>), PictureError> {
    // Opening a pipe would wait for somebody to write to it.
    let metadata = fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(PictureError::NotAFile);
    }
    // Some decoders hold the whole file, or a header as long as the file.
    if metadata.len() > limits::MEMORY_LIMIT {
        return Err(PictureError::TooLong { bytes: metadata.len() });
    }
    let mut file = BufReader::new(File::open(path)?);
    let mut start = Vec::with_capacity(16);
    file.by_ref().take(16).read_to_end(&mut start)?;
    file.rewind()?;
    let format = Format::of(&start).ok_or(PictureError::UnknownFormat)?;
    Ok((format, file))
}

/// Runs a decoder; if it panics on a malformed file, that is an error like any other.
///
/// The decoders are other people's code, and some of them have paths that index past the end when a
/// header lies.
fn caught<T>(
    format: Format,
    decode: impl FnOnce() -> Result<T, PictureError>,
) -> Result<T, PictureError> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let result = panic::catch_unwind(AssertUnwindSafe(decode));
    panic::set_hook(hook);
    result.unwrap_or_else(|_| Err(PictureError::Decode(format, "the file is malformed".into())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_their_first_bytes() {
        assert_eq!(Format::of(b"\x89PNG\r\n\x1a\n...."), Some(Format::Png));
        assert_eq!(Format::of(b"#?RGBE\n"), Some(Format::Hdr));
        assert_eq!(Format::of(b"MM\0*"), Some(Format::Tiff));
        for none in [&b""[..], b"\x89PN", b"GIF89a", b"P5 1 1 255"] {
            assert_eq!(Format::of(none), None);
        }
    }

    #[test]
    fn the_total_of_a_large_plane_is_exact_to_a_pixel() {
        let picture = Picture { width: 3000, height: 3000, importance: vec![0.1; 9_000_000] };
        assert!((picture.total() - 900_000.0).abs() < 0.1);
    }
}
