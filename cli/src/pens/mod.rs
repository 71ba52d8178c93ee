//! Several pens: their colors, and how much of each a place of the picture needs.

mod inks;
mod list;
mod separation;

pub(crate) use inks::{Inks, InksError};
pub(crate) use list::{Pen, Pens};
use separation::Separation;
pub(crate) use separation::Shadows;

/// The most pens of one drawing: more than any carousel holds.
pub(crate) const MAX_PENS: usize = 12;
