//! Importance from pixels, constant over each pixel.

use alloc::vec::Vec;
use core::fmt;

use glam::DVec2;

use super::Importance;
use super::pyramid::MaxPyramid;
use crate::domain::{Domain, Region};

/// What to do with pixels that are no importance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum InvalidPixels {
    /// NaN, infinite and negative pixels are errors.
    #[default]
    Reject,
    /// Negative pixels (not −∞) count as 0, as left by the ringing of a resampled HDR picture; NaN and
    /// infinities are errors.
    ZeroNegative,
    /// Negative, NaN and infinite pixels count as 0.
    ZeroAll,
}

/// Why pixels are no importance map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MapError {
    /// The width or the height is 0.
    Empty {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The number of pixels is not width × height.
    Length {
        /// width × height, saturating.
        expected: usize,
        /// The number of pixels.
        found: usize,
    },
    /// The first pixel, row by row, that is no importance.
    InvalidPixel {
        /// Its column, from 0.
        x: usize,
        /// Its row, from 0.
        y: usize,
        /// Its value.
        value: f32,
    },
    /// A dirty rectangle or patch does not lie within the map.
    OutsideMap,
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { width, height } => {
                write!(f, "an importance map cannot be {width} by {height} pixels")
            }
            Self::Length { expected, found } => {
                write!(f, "{found} pixels where width times height is {expected}")
            }
            Self::InvalidPixel { x, y, value } => {
                write!(f, "pixel ({x}, {y}) is {value}: importance must be finite and not negative")
            }
            Self::OutsideMap => f.write_str("the rectangle does not lie within the map"),
        }
    }
}

impl core::error::Error for MapError {}

/// An image as importance: each pixel's value holds over the pixel's whole half-open square.
///
/// The image is stretched over a [`Domain`], by default [0, width) × [0, height): x to the right,
/// y down, row by row. Outside its domain the nearest pixel counts. Keeps a max pyramid, a third of
/// the pixels' memory.
#[derive(Clone, Debug)]
pub struct ImageMap {
    width: usize,
    height: usize,
    pixels: Vec<f32>,
    pyramid: MaxPyramid,
    /// Σ pixels, summed in row order.
    sum: f64,
    domain: Domain,
    texels_per_unit: DVec2,
}

impl ImageMap {
    /// A map of `width` × `height` pixels, row by row, over [0, width) × [0, height). O(pixels).
    ///
    /// # Errors
    /// [`MapError`] for no pixels, another number than width × height, and the first pixel that
    /// `invalid` does not admit.
    pub fn new(
        width: usize,
        height: usize,
        mut pixels: Vec<f32>,
        invalid: InvalidPixels,
    ) -> Result<Self, MapError> {
        if width == 0 || height == 0 {
            return Err(MapError::Empty { width, height });
        }
        let expected = width.saturating_mul(height);
        if pixels.len() != expected {
            return Err(MapError::Length { expected, found: pixels.len() });
        }
        let size = DVec2::new(width as f64, height as f64);
        let mut sum = 0.0;
        for (y, row) in pixels.chunks_exact_mut(width).enumerate() {
            sum +=
                admit(row, invalid).map_err(|(x, value)| MapError::InvalidPixel { x, y, value })?;
        }
        let domain =
            Domain::new(DVec2::ZERO, size).map_err(|_| MapError::Empty { width, height })?;
        let pyramid = MaxPyramid::new(&pixels, width, height);
        Ok(Self { width, height, pixels, pyramid, sum, domain, texels_per_unit: DVec2::ONE })
    }

    /// The same pixels stretched over another rectangle.
    #[must_use]
    pub fn over(mut self, domain: Domain) -> Self {
        self.domain = domain;
        self.texels_per_unit = DVec2::new(self.width as f64, self.height as f64) / domain.size();
        self
    }

    /// The rectangle that the image covers.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// Pixels a row and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The pixels, row by row, as they count (after [`InvalidPixels`]).
    #[must_use]
    pub fn pixels(&self) -> &[f32] {
        &self.pixels
    }

    /// The mean pixel.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.pixels.len() as f64
    }

    /// Column and row of the pixel under a point, clamped to the image.
    fn texel(&self, at: DVec2) -> (usize, usize) {
        let t = (at - self.domain.min()) * self.texels_per_unit;
        // `as` takes negative numbers and NaN to 0.
        ((t.x as usize).min(self.width - 1), (t.y as usize).min(self.height - 1))
    }
}

/// Applies the policy to a row and sums it; the first column that it does not admit otherwise.
fn admit(row: &mut [f32], invalid: InvalidPixels) -> Result<f64, (usize, f32)> {
    let mut sum = 0.0;
    for (x, pixel) in row.iter_mut().enumerate() {
        let value = *pixel;
        if !(0.0..f32::INFINITY).contains(&value) {
            match invalid {
                InvalidPixels::ZeroAll => *pixel = 0.0,
                InvalidPixels::ZeroNegative if value < 0.0 && value.is_finite() => *pixel = 0.0,
                _ => return Err((x, value)),
            }
        }
        sum += f64::from(*pixel);
    }
    Ok(sum)
}

impl Importance for ImageMap {
    fn value(&self, at: DVec2) -> f64 {
        let (x, y) = self.texel(at);
        f64::from(self.pixels[y * self.width + x])
    }

    fn upper_bound(&self, region: &Region) -> f64 {
        let (x0, y0) = self.texel(region.centre - region.radius);
        let (x1, y1) = self.texel(region.centre + region.radius);
        f64::from(self.pyramid.max(&self.pixels, self.width, [x0, x1], [y0, y1]))
    }

    fn integral(&self, domain: &Domain) -> Option<f64> {
        if *domain == self.domain {
            return Some(self.mean() * domain.area());
        }
        Some(self.integral_over(domain))
    }
}

impl ImageMap {
    /// ∫ over any rectangle, pixel by pixel: O(pixels covered).
    fn integral_over(&self, domain: &Domain) -> f64 {
        // Edges of the pixels' cells along one axis; the border pixels reach to infinity.
        let lengths = |min: f64, max: f64, origin: f64, scale: f64, count: usize| {
            let (a, b) = ((min - origin) * scale, (max - origin) * scale);
            let first = (a as usize).min(count - 1);
            let last = (b as usize).min(count - 1);
            (first..=last).map(move |i| {
                let from = if i == first { a } else { i as f64 };
                let to = if i == last { b } else { (i + 1) as f64 };
                (i, (to - from) / scale)
            })
        };
        let (min, max, origin) = (domain.min(), domain.max(), self.domain.min());
        let scale = self.texels_per_unit;
        lengths(min.y, max.y, origin.y, scale.y, self.height)
            .map(|(y, dy)| {
                let row = &self.pixels[y * self.width..][..self.width];
                let row_sum: f64 = lengths(min.x, max.x, origin.x, scale.x, self.width)
                    .map(|(x, dx)| f64::from(row[x]) * dx)
                    .sum();
                row_sum * dy
            })
            .sum()
    }
}
