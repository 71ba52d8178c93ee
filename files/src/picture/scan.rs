//! Pictures too large to be held, read by windows.

use std::ops::Range;
use std::path::Path;

use super::area::Area;
use super::aspect::Squares;
use super::plane::Decoded;
use super::source::Source;
use super::{Format, PictureError, Tone, Wanted, caught, decode_format, detect, limits};
#[cfg(feature = "every-format")]
use super::{openexr, tiff};

/// A photograph, opened to be read by windows.
///
/// Of TIFF and OpenEXR files a window takes the strips, tiles or blocks that hold any of its pixels, so that neither
/// the file nor the picture has to fit the memory limit of 1 GiB; a window, with a strip, tile or block, has to.
/// Pictures of other formats, and OpenEXR files of which some channels have fewer samples than pixels, are decoded
/// once, are kept, and have to fit. A TIFF file that has to be rewritten before it can be decoded (palettes, Lab,
/// odd numbers of bits, pages other than the first) is kept as it is and has to be no longer than the limit.
///
/// ```no_run
/// # use std::path::Path;
/// # use twelvefold_files::picture::{Scan, Tone};
/// let mut scan = Scan::open(Path::new("map.tif"), Tone::default(), None)?;
/// let (width, height) = scan.size();
/// let corner = scan.window(width - 100..width, height - 50..height)?;
/// assert_eq!(corner.len(), 100 * 50);
/// # Ok::<(), twelvefold_files::picture::PictureError>(())
/// ```
pub struct Scan {
    format: Format,
    pixels: Pixels,
    /// From the pixels to square ones.
    squares: Squares,
    warnings: Vec<String>,
    /// What was decoded for the last window, if that is much more than the window.
    band: Option<(Area, Vec<f32>)>,
}

/// The most pixels of [`Scan::band`]: 256 MiB of them.
const BAND: usize = 1 << 26;

/// Where a scan's pixels are.
enum Pixels {
    /// Decoded.
    Whole(Decoded<f32>),
    #[cfg(feature = "every-format")]
    Tiff(Box<tiff::Page<f32>>),
    #[cfg(feature = "every-format")]
    OpenExr(Box<openexr::Blocks<f32>>),
}

impl Scan {
    /// Opens the photograph at `path`, or for `-` on standard input; of an OpenEXR file the layer of this name.
    ///
    /// # Errors
    /// [`PictureError`], also for what is kept as it is or decoded and does not fit the limit.
    pub fn open(path: &Path, tone: Tone, layer: Option<&str>) -> Result<Self, PictureError> {
        Self::of_source(Source::open(path)?, path, Wanted { tone, layer, radiance: false })
    }

    /// Opens what a file of this name holds.
    pub(super) fn of_source(
        mut source: Source,
        path: &Path,
        wanted: Wanted<'_>,
    ) -> Result<Self, PictureError> {
        let format = detect(&mut source, path, wanted)?;
        let pixels = caught(format, || Pixels::of(format, source, wanted))?;
        let squares = Squares::of(pixels.size(), pixels.aspect());
        // Borders between pixels are counted in fractions of either.
        let countable = |old: usize, new: usize| old.checked_mul(new.saturating_add(1)).is_some();
        let ((width, height), (across, down)) = (pixels.size(), squares.size);
        if width == 0 || height == 0 {
            return Err(PictureError::Empty);
        }
        if !(countable(width, across) && countable(height, down)) {
            return Err(limits::too_large(width, height, 0));
        }
        let mut warnings = pixels.warnings().to_vec();
        warnings.extend(squares.warning());
        Ok(Self { format, pixels, squares, warnings, band: None })
    }

    /// Pixels across and down, upright and square.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        self.squares.size
    }

    /// Whether windows are read when they are asked for; if not, the whole picture was decoded and is kept.
    #[must_use]
    pub fn reads_windows(&self) -> bool {
        !matches!(self.pixels, Pixels::Whole(_))
    }

    /// As of [`Picture`](super::Picture).
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The least and greatest brightness of a float file's pixels, before exposure and clipping: of all, or where
    /// windows are read of those that were decoded.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        match &self.pixels {
            Pixels::Whole(picture) => picture.range,
            #[cfg(feature = "every-format")]
            Pixels::Tiff(page) => page.range(),
            #[cfg(feature = "every-format")]
            Pixels::OpenExr(blocks) => blocks.range(),
        }
    }

    /// Importance of the pixels in these columns and rows, row by row from the top, each row from the left: the same
    /// numbers as of [`read_layer`](super::read_layer). Without columns or rows there are none.
    ///
    /// Takes time and memory for the window and for what is decoded to have it: tiles and blocks to their borders,
    /// strips across all of the picture. If that is more than twice the window and at most 64 million pixels, it is
    /// kept until another window needs something else, so that windows side by side decode their strips once.
    ///
    /// # Errors
    /// [`PictureError::Outside`] if not all of them are there, [`PictureError::TooLarge`] and
    /// [`PictureError::LargeParts`] beyond the memory limit, before any pixel is read; and what may be wrong with a
    /// file where the window is. Other windows can still be read.
    pub fn window(
        &mut self,
        columns: Range<usize>,
        rows: Range<usize>,
    ) -> Result<Vec<f32>, PictureError> {
        let (width, height) = self.squares.size;
        if columns.end > width || rows.end > height {
            return Err(PictureError::Outside { width, height });
        }
        let window = Area { columns, rows };
        if window.is_empty() {
            return Ok(Vec::new());
        }
        let stored = self.squares.stored(&window);
        let mut importance = caught(self.format, || self.read(&stored))?;
        if self.squares.warning().is_some() {
            importance = self.squares.drawn(&window, &stored, &importance)?;
        }
        // Resampling rounds.
        importance.iter_mut().for_each(|value| *value = value.clamp(0.0, 1.0));
        Ok(importance)
    }

    /// The pixels of a window, as they are stored.
    fn read(&mut self, window: &Area) -> Result<Vec<f32>, PictureError> {
        let Self { pixels, band, .. } = self;
        if let Some((area, band)) = band
            && area.covers(window)
        {
            return Ok(window.cut(area, band));
        }
        let reach = pixels.reach(window);
        if reach.count() / 2 > window.count() && reach.count() <= BAND {
            // Room for the new one.
            *band = None;
            // What is amiss outside of the window does not matter.
            if let Ok(importance) = pixels.window(&reach) {
                let part = window.cut(&reach, &importance);
                *band = Some((reach, importance));
                return Ok(part);
            }
        }
        pixels.window(window)
    }
}

impl Pixels {
    fn of(format: Format, mut source: Source, wanted: Wanted<'_>) -> Result<Self, PictureError> {
        match format {
            #[cfg(feature = "every-format")]
            Format::Tiff => Ok(Self::Tiff(Box::new(tiff::Page::open(source, wanted)?))),
            #[cfg(feature = "every-format")]
            Format::OpenExr if openexr::in_blocks(&mut source, wanted)? => {
                Ok(Self::OpenExr(Box::new(openexr::Blocks::open(source, wanted)?)))
            }
            _ => {
                source.check()?;
                Ok(Self::Whole(decode_format(format, source, wanted)?))
            }
        }
    }

    /// Pixels across and down, upright, as they are stored.
    fn size(&self) -> (usize, usize) {
        match self {
            Self::Whole(picture) => (picture.width, picture.height),
            #[cfg(feature = "every-format")]
            Self::Tiff(page) => page.size(),
            #[cfg(feature = "every-format")]
            Self::OpenExr(blocks) => blocks.size(),
        }
    }

    /// Width of a pixel over its height.
    fn aspect(&self) -> f64 {
        match self {
            Self::Whole(picture) => picture.aspect,
            #[cfg(feature = "every-format")]
            Self::Tiff(page) => page.aspect,
            #[cfg(feature = "every-format")]
            Self::OpenExr(blocks) => blocks.aspect(),
        }
    }

    fn warnings(&self) -> &[String] {
        match self {
            Self::Whole(picture) => &picture.warnings,
            #[cfg(feature = "every-format")]
            Self::Tiff(page) => &page.warnings,
            #[cfg(feature = "every-format")]
            Self::OpenExr(_) => &[],
        }
    }

    /// All that is decoded for a window.
    fn reach(&self, window: &Area) -> Area {
        match self {
            Self::Whole(_) => window.clone(),
            #[cfg(feature = "every-format")]
            Self::Tiff(page) => page.reach(window),
            #[cfg(feature = "every-format")]
            Self::OpenExr(blocks) => blocks.reach(window),
        }
    }

    /// Those of a window, which must lie in the picture.
    fn window(&mut self, window: &Area) -> Result<Vec<f32>, PictureError> {
        match self {
            Self::Whole(picture) => {
                let (width, height) = window.size();
                limits::check(width, height, 0)?;
                let whole = Area::whole((picture.width, picture.height));
                Ok(window.cut(&whole, &picture.pixels))
            }
            #[cfg(feature = "every-format")]
            Self::Tiff(page) => Ok(page.window(window)?.pixels),
            #[cfg(feature = "every-format")]
            Self::OpenExr(blocks) => Ok(blocks.window(window)?.pixels),
        }
    }
}
