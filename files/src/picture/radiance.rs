//! Reading light: pictures whose pixels are linear radiance, as stored, negative ones included.

use std::path::Path;

use super::{Format, PictureError, caught, limits, open, openexr, raster};

/// Linear red, green and blue, row by row from the top, each row from the left.
#[derive(Debug, Default)]
pub struct Radiance {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// `width` · `height` pixels. Any float: what to do with NaN and negative ones is for the caller.
    pub pixels: Vec<[f32; 3]>,
}

impl Radiance {
    /// All black.
    ///
    /// # Errors
    /// [`PictureError::Empty`] without pixels, and [`PictureError::TooLarge`] beyond the memory limit
    /// or what the system gives.
    pub(super) fn black(width: usize, height: usize) -> Result<Self, PictureError> {
        // Decoded and converted, with the importance of each pixel.
        let bytes = 2 * size_of::<[f32; 3]>();
        let count = limits::check(width, height, bytes)?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| limits::too_large(width, height, bytes))?;
        pixels.resize(count, [0.0; 3]);
        Ok(Self { width, height, pixels })
    }
}

/// Reads the radiance in the Radiance HDR or OpenEXR file at `path`.
///
/// # Errors
/// [`PictureError`]; [`PictureError::NotRadiance`] for the formats that hold tones for a display.
pub fn read_radiance(path: &Path) -> Result<Radiance, PictureError> {
    let (format, file) = open(path)?;
    caught(format, || match format {
        Format::Hdr => raster::hdr_radiance(file),
        Format::OpenExr => openexr::read_radiance(file),
        other => Err(PictureError::NotRadiance(other)),
    })
}
