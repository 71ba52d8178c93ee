//! Pixels on their way into maps: checked, counted as the policy says, summed.

use alloc::vec::Vec;
use core::fmt;

/// What to do with pixels that cannot be an importance.
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

/// Why pixels are not an importance map.
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
    /// The number of pixels is not width × height, or too few for a view's rows.
    Length {
        /// How many there should be, saturating.
        expected: usize,
        /// The number of pixels.
        found: usize,
    },
    /// The rows of a view begin nearer to each other than they are wide.
    Stride {
        /// Pixels from row to row.
        stride: usize,
        /// Pixels a row.
        width: usize,
    },
    /// The first pixel, row by row, that cannot be an importance.
    InvalidPixel {
        /// Its column, from 0.
        x: usize,
        /// Its row, from 0.
        y: usize,
        /// Its value.
        value: f32,
    },
    /// The mean of an image that is not in one piece is NaN, infinite or negative.
    InvalidMean {
        /// The mean.
        mean: f64,
    },
    /// A dirty rectangle or patch does not lie within the map.
    OutsideMap,
    /// The memory for the map is not to be had.
    Memory {
        /// How much was asked for.
        bytes: usize,
    },
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { width, height } => {
                write!(f, "an importance map cannot be {width} by {height} pixels")
            }
            Self::Length { expected, found } => {
                write!(f, "{found} pixels where {expected} are needed")
            }
            Self::Stride { stride, width } => {
                write!(f, "rows of {width} pixels cannot begin {stride} pixels apart")
            }
            Self::InvalidPixel { x, y, value } => {
                write!(f, "pixel ({x}, {y}) is {value}: importance must be finite and not negative")
            }
            Self::InvalidMean { mean } => {
                write!(f, "a mean importance of {mean}: it must be finite and not negative")
            }
            Self::OutsideMap => f.write_str("the rectangle does not lie within the map"),
            Self::Memory { bytes } => write!(f, "the map needs {bytes} bytes of memory"),
        }
    }
}

impl core::error::Error for MapError {}

/// An empty vector with room for `len`.
pub(super) fn with_room<T>(len: usize) -> Result<Vec<T>, MapError> {
    let mut items = Vec::new();
    let bytes = len.saturating_mul(size_of::<T>());
    items.try_reserve_exact(len).map_err(|_| MapError::Memory { bytes })?;
    Ok(items)
}

/// `len` zeros, or whatever `item` is.
pub(super) fn filled<T: Clone>(item: T, len: usize) -> Result<Vec<T>, MapError> {
    let mut items = with_room(len)?;
    items.resize(len, item);
    Ok(items)
}

/// Pixels that are an importance: a rectangle of finite numbers that are not negative, row by row.
///
/// Checked once, for every map that is made of them.
///
/// ```
/// use twelvefold::{ImageMap, InvalidPixels, MapError, Pixels};
/// let pixels = Pixels::new(3, 2, vec![0.0, 1.0, 1.0, 0.0, 4.0, -4.0], InvalidPixels::ZeroNegative)?;
/// assert_eq!((pixels.size(), pixels.mean()), ((3, 2), 1.0));
/// let map = ImageMap::new(pixels)?;
///
/// let error = Pixels::new(2, 1, vec![0.5, f32::NAN], InvalidPixels::Reject).unwrap_err();
/// assert!(matches!(error, MapError::InvalidPixel { x: 1, y: 0, .. }));
/// # Ok::<(), MapError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pixels {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f32>,
    /// Σ of each row.
    pub(super) row_sums: Vec<f64>,
    /// Σ of those.
    pub(super) sum: f64,
}

impl Pixels {
    /// `width` × `height` pixels, row by row. O(pixels); `values` is not copied.
    ///
    /// # Errors
    /// [`MapError`] for no pixels, another number than width × height, and the first pixel that
    /// `invalid` does not admit.
    pub fn new(
        width: usize,
        height: usize,
        mut values: Vec<f32>,
        invalid: InvalidPixels,
    ) -> Result<Self, MapError> {
        if width == 0 || height == 0 {
            return Err(MapError::Empty { width, height });
        }
        let expected = width.saturating_mul(height);
        if values.len() != expected {
            return Err(MapError::Length { expected, found: values.len() });
        }
        for (y, row) in values.chunks_exact_mut(width).enumerate() {
            admit(row, invalid).map_err(|(x, value)| MapError::InvalidPixel { x, y, value })?;
        }
        let mut row_sums: Vec<f64> = with_room(height)?;
        row_sums.extend(values.chunks_exact(width).map(sum));
        let sum = sum(&row_sums);
        Ok(Self { width, height, values, row_sums, sum })
    }

    /// Pixels a row and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The pixels, row by row, as they count (after [`InvalidPixels`]).
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The mean pixel.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.values.len() as f64
    }

    /// The sum of a row of an image.
    #[must_use]
    pub fn sum_of_row(row: &[f32]) -> f64 {
        sum(row)
    }

    /// The mean pixel of an image from the [sums](Self::sum_of_row) of all its rows, which may have come in several
    /// pieces: to the bit the [`mean`](Self::mean) of the image in one piece. 0 without pixels.
    #[must_use]
    pub fn mean_of_rows(width: usize, row_sums: &[f64]) -> f64 {
        let pixels = width.saturating_mul(row_sums.len());
        if pixels > 0 { sum(row_sums) / pixels as f64 } else { 0.0 }
    }
}

/// Whether all are finite and not negative. One pass, no branch a pixel.
#[inline(always)]
pub(super) fn are_valid(row: &[f32]) -> bool {
    row.iter().fold(true, |all, v| all & (*v >= 0.0) & (*v < f32::INFINITY))
}

/// Whether a pixel that is no importance counts as 0 under the policy.
fn counts_as_zero(value: f32, invalid: InvalidPixels) -> bool {
    match invalid {
        InvalidPixels::ZeroAll => true,
        InvalidPixels::ZeroNegative => value < 0.0 && value.is_finite(),
        InvalidPixels::Reject => false,
    }
}

/// The first column that the policy does not admit, and its value.
#[inline(always)]
pub(super) fn first_refused(row: &[f32], invalid: InvalidPixels) -> Option<(usize, f32)> {
    if are_valid(row) {
        return None;
    }
    let refused = |(_, value): &(usize, f32)| {
        !are_valid(core::slice::from_ref(value)) && !counts_as_zero(*value, invalid)
    };
    row.iter().copied().enumerate().find(refused)
}

/// Replaces what is no importance by 0, in a row of which nothing is refused.
#[inline(always)]
pub(super) fn replace(row: &mut [f32]) {
    for pixel in row {
        *pixel = if (*pixel >= 0.0) & (*pixel < f32::INFINITY) { *pixel } else { 0.0 };
    }
}

/// Replaces what the policy replaces, or the first column that it does not admit, and its value.
pub(super) fn admit(row: &mut [f32], invalid: InvalidPixels) -> Result<(), (usize, f32)> {
    match first_refused(row, invalid) {
        Some(refused) => Err(refused),
        None => {
            if invalid != InvalidPixels::Reject {
                replace(row);
            }
            Ok(())
        }
    }
}

/// Σ, in a fixed order that vector instructions can follow: lane i adds up the numbers i, i + 16, …;
/// then the halves of the lanes are added until one is left.
#[inline(always)]
pub(super) fn sum<T: Copy + Into<f64>>(numbers: &[T]) -> f64 {
    let mut lanes = [0.0f64; 16];
    let (runs, rest) = numbers.as_chunks::<16>();
    for run in runs {
        for (lane, number) in lanes.iter_mut().zip(run) {
            *lane += (*number).into();
        }
    }
    for (lane, number) in lanes.iter_mut().zip(rest) {
        *lane += (*number).into();
    }
    let mut width = 8;
    while width > 0 {
        for i in 0..width {
            lanes[i] += lanes[i + width];
        }
        width /= 2;
    }
    lanes[0]
}
