//! Why points cannot be made: one kind of error for placements, samplings and walks.

use core::fmt;

use glam::DVec2;

use crate::tiling::MAX_LEVEL;

/// Why points could not be made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SamplingError {
    /// The amount is NaN, infinite or negative.
    Amount {
        /// The number.
        value: f64,
    },
    /// A count was asked for, but the importance does not know its integral.
    UnknownIntegral,
    /// A count was asked for, but the importance is 0 everywhere, or so close to it that no finite
    /// density makes up for it.
    NoImportance,
    /// More points are expected than [`Limits::points`](crate::Limits::points).
    TooManyPoints {
        /// The number expected.
        expected: f64,
        /// The limit.
        limit: u64,
    },
    /// The density asked for is past the deepest level whose ranks fit 64 bits.
    TooDense {
        /// The center of the region with that density.
        near: DVec2,
    },
    /// An upper bound is NaN, infinite or negative.
    InvalidBound {
        /// The center of the region asked about.
        near: DVec2,
        /// The bound.
        bound: f64,
    },
    /// A value is NaN, negative, or above the bound of a region that holds its point.
    InvalidValue {
        /// The point.
        at: DVec2,
        /// The value.
        value: f64,
        /// The bound.
        bound: f64,
    },
    /// The walk visited more tiles than [`Limits::tiles`](crate::Limits::tiles).
    TilesLimit {
        /// The limit.
        limit: u64,
    },
    /// The placement's tables have no displacements.
    NoDisplacements,
    /// Weights were asked for of relaxed points, which have none: estimates from them would be biased.
    Relaxed,
    /// There is no such part.
    Part {
        /// Which part.
        index: usize,
        /// Of how many.
        of: usize,
    },
    /// The position type cannot tell the points of the domain apart: it is too far from the origin for
    /// any number of this precision to lie in it, its short side is not well above the rounding of
    /// positions (for `f32`, sides past 1 to 43,690), or its sizes leave the precision's range (for
    /// `f32`, a diagonal outside of some 10⁻³⁰ … 10³⁷).
    Precision,
    /// The memory for the points is not to be had.
    Memory {
        /// How much was asked for.
        bytes: usize,
    },
}

impl fmt::Display for SamplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Amount { value } => write!(f, "{value} is not an amount of points: it should be finite and not negative"),
            Self::UnknownIntegral => f.write_str(
                "a number of points needs an importance that knows its integral over the domain",
            ),
            Self::NoImportance => f.write_str("the importance is zero everywhere, or next to it"),
            Self::TooManyPoints { expected, limit } => {
                write!(f, "about {expected:.0} points are expected, the limit is {limit}")
            }
            Self::TooDense { near } => write!(
                f,
                "the density near ({}, {}) is past the deepest level, {MAX_LEVEL}",
                near.x, near.y
            ),
            Self::InvalidBound { near, bound } => {
                write!(f, "the upper bound near ({}, {}) is {bound}", near.x, near.y)
            }
            Self::InvalidValue { at, value, bound } => write!(
                f,
                "the importance at ({}, {}) is {value}, not between 0 and its bound {bound}",
                at.x, at.y
            ),
            Self::TilesLimit { limit } => write!(f, "the walk visited its limit of {limit} tiles"),
            Self::NoDisplacements => f.write_str("the tables have no displacements, which relaxed points need"),
            Self::Relaxed => f.write_str(
                "relaxed points have no unbiased weights: use points that are not relaxed for estimates",
            ),
            Self::Part { index, of } => write!(f, "there is no part {index} (from 0) of {of}"),
            Self::Precision => {
                f.write_str("positions of this precision cannot resolve the domain")
            }
            Self::Memory { bytes } => write!(f, "the points need {bytes} bytes of memory"),
        }
    }
}

impl core::error::Error for SamplingError {}
