//! Why dots could not be refined.

use core::fmt;

/// Classes at most: as many as an exchange of neighbors is worth its memory, a number a dot and class.
pub(super) const MOST_CLASSES: usize = 64;

/// Why dots could not be refined.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RefineError {
    /// The number of pixels is not width × height.
    Size {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
        /// Pixels given.
        pixels: usize,
    },
    /// A pixel is NaN, infinite or negative.
    Pixel {
        /// Its column.
        x: usize,
        /// Its row.
        y: usize,
        /// Its value.
        value: f32,
    },
    /// There are dots, but no pixel is above 0.
    NoInk,
    /// A coordinate of this point is NaN or infinite.
    Point {
        /// Its index.
        index: usize,
    },
    /// The buffer for the dots holds another number of them.
    Length {
        /// Dots being refined.
        expected: usize,
        /// Length of the buffer.
        found: usize,
    },
    /// There is no class, or there are more than [`Classes::MOST`](super::Classes::MOST).
    Classes {
        /// How many.
        count: usize,
    },
    /// There is not enough memory.
    Memory {
        /// How many bytes were asked for, beyond what was held already.
        bytes: usize,
    },
}

impl fmt::Display for RefineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height, pixels } => {
                write!(f, "a picture of {width} × {height} with {pixels} pixels")
            }
            Self::Pixel { x, y, value } => {
                write!(f, "pixel ({x}, {y}) is {value}; importance is finite and at least 0")
            }
            Self::NoInk => f.write_str("no pixel is above 0, so that dots have no place"),
            Self::Point { index } => write!(f, "point {index} is not finite"),
            Self::Length { expected, found } => {
                write!(f, "a buffer of {found} for {expected} dots")
            }
            Self::Classes { count } => {
                write!(f, "{count} classes of dots; from 1 to {MOST_CLASSES} are possible")
            }
            Self::Memory { bytes } => write!(f, "refining needs {bytes} bytes more than there are"),
        }
    }
}

impl core::error::Error for RefineError {}

/// An empty vector with room for `len`, or the error that says how much was missing.
pub(super) fn reserve<T>(len: usize) -> Result<alloc::vec::Vec<T>, RefineError> {
    let mut room = alloc::vec::Vec::new();
    room.try_reserve_exact(len)
        .map_err(|_| RefineError::Memory { bytes: len.saturating_mul(size_of::<T>()) })?;
    Ok(room)
}

/// `len` copies of `value`.
pub(super) fn filled<T: Clone>(len: usize, value: T) -> Result<alloc::vec::Vec<T>, RefineError> {
    let mut room = reserve(len)?;
    room.resize(len, value);
    Ok(room)
}
