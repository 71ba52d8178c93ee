//! Pixels in rows, read many at a time: the nearest one, four mixed, the extremes of a square.

mod bilinear;
mod extremes;
mod nearest;
mod round;
mod side;

pub(super) use bilinear::{Grid, SAME_SIDE};
pub(super) use extremes::{Extremes, Texels};
pub(super) use nearest::Lattice;

/// Points read in one pass.
pub(super) const RUN: usize = 64;
