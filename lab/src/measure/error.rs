//! What cannot be measured, and why.

use core::error::Error;
use core::fmt;

use glam::DVec2;

/// Why a measure has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeasureError {
    /// A coordinate of the point with this index is infinite or not a number.
    NotFinite {
        /// The first such point.
        point: usize,
    },
    /// The point with this index lies outside of the unit square.
    OutsideUnitSquare {
        /// The first such point.
        point: usize,
    },
    /// Too few points, or values, are in what is measured.
    TooFew {
        /// As many are.
        found: usize,
        /// At least so many must be.
        needed: usize,
    },
    /// The value with this index is not a number.
    NotANumber {
        /// The first such value.
        value: usize,
    },
    /// A window that is empty or not finite.
    Window {
        /// Its corner.
        min: DVec2,
        /// Its size.
        size: DVec2,
    },
    /// The window is so much longer than wide that its spectrum has more frequencies than points.
    TooElongated {
        /// Its size.
        size: DVec2,
    },
    /// All points lie on the border of the window, where a spectrum gives them no weight.
    OnBorder,
    /// The pixels do not fill whole rows, at least one, of at least one pixel.
    NotRows {
        /// Pixels a row.
        width: usize,
        /// Pixels in all.
        pixels: usize,
    },
    /// A pixel is not a number, or outside of the range that the image allows.
    Pixel {
        /// The first such pixel.
        x: usize,
        /// Its row.
        y: usize,
    },
    /// No pixel of the image is above 0.
    AllZero,
    /// Blocks that expect less than one point, or a number of them that is none.
    PointsPerBlock(f64),
}

impl fmt::Display for MeasureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { point } => write!(f, "point {point} is not finite"),
            Self::OutsideUnitSquare { point } => {
                write!(f, "point {point} lies outside of the unit square")
            }
            Self::TooFew { found, needed } => {
                write!(f, "{found} points are too few: {needed} are needed")
            }
            Self::NotANumber { value } => write!(f, "value {value} is not a number"),
            Self::Window { min, size } => {
                let (x, y, width, height) = (min.x, min.y, size.x, size.y);
                write!(f, "the window {x},{y},{width},{height} is empty or not finite")
            }
            Self::TooElongated { size } => {
                let (width, height) = (size.x, size.y);
                write!(f, "a window of {width} × {height} is too elongated for so few points")
            }
            Self::OnBorder => write!(f, "all points lie on the border of the window"),
            Self::NotRows { width, pixels } => {
                write!(f, "{pixels} pixels are no rows of {width}")
            }
            Self::Pixel { x, y } => write!(f, "pixel ({x}, {y}) is out of range"),
            Self::AllZero => write!(f, "the image is 0 everywhere"),
            Self::PointsPerBlock(points) => {
                write!(f, "a block cannot expect {points} points: at least one")
            }
        }
    }
}

impl Error for MeasureError {}
