//! Pixels on their way into maps: views of the caller's, checked, counted as the policy says, summed.

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
    /// The number of pixels is not width × height.
    Length {
        /// width × height, saturating.
        expected: usize,
        /// The number of pixels.
        found: usize,
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
                write!(f, "{found} pixels where width times height is {expected}")
            }
            Self::InvalidPixel { x, y, value } => {
                write!(f, "pixel ({x}, {y}) is {value}: importance must be finite and not negative")
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

/// Pixels in rows. Values count as they are: an 8-bit 255 is importance 255.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum PixelData<'a> {
    /// Single-precision numbers.
    F32(&'a [f32]),
    /// 8 bits.
    U8(&'a [u8]),
    /// 16 bits.
    U16(&'a [u16]),
}

impl PixelData<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F32(data) => data.len(),
            Self::U8(data) => data.len(),
            Self::U16(data) => data.len(),
        }
    }
}

/// A rectangle of pixels: row `y` is `width` pixels from index `y · stride` on.
#[derive(Clone, Copy, Debug)]
pub struct PixelView<'a> {
    data: PixelData<'a>,
    pub(super) width: usize,
    pub(super) height: usize,
    stride: usize,
}

impl<'a> PixelView<'a> {
    /// Rows without gaps, or `None` if the number of pixels is not `width` × `height`.
    #[must_use]
    pub fn new(data: PixelData<'a>, width: usize, height: usize) -> Option<Self> {
        (width.checked_mul(height)? == data.len()).then_some(())?;
        Self::strided(data, width, height, width)
    }

    /// Rows that begin `stride` pixels apart, or `None` if `stride` is less than `width` or the last
    /// row ends after the data.
    #[must_use]
    pub fn strided(
        data: PixelData<'a>,
        width: usize,
        height: usize,
        stride: usize,
    ) -> Option<Self> {
        let end = match height.checked_sub(1) {
            None => 0,
            Some(last) => last.checked_mul(stride)?.checked_add(width)?,
        };
        (width <= stride && end <= data.len()).then_some(Self { data, width, height, stride })
    }

    /// Copies row `y` < height to `to`, `width` pixels.
    #[inline(always)]
    pub(super) fn copy_row(&self, y: usize, to: &mut [f32]) {
        let row = y * self.stride..y * self.stride + self.width;
        match self.data {
            PixelData::F32(data) => to.copy_from_slice(&data[row]),
            PixelData::U8(data) => {
                to.iter_mut().zip(&data[row]).for_each(|(to, from)| *to = f32::from(*from));
            }
            PixelData::U16(data) => {
                to.iter_mut().zip(&data[row]).for_each(|(to, from)| *to = f32::from(*from));
            }
        }
    }

    /// Row `y` if it is of single-precision numbers: integers need no check.
    pub(super) fn unchecked_row(&self, y: usize) -> Option<&'a [f32]> {
        match self.data {
            PixelData::F32(data) => Some(&data[y * self.stride..][..self.width]),
            _ => None,
        }
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
