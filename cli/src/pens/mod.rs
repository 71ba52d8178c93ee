//! Several pens: their colours, and how much of each a place of the picture needs.

mod list;
mod separation;

pub(crate) use list::{Pen, PenError, parse};
pub(crate) use separation::{Amounts, Separation};

/// The most pens of one drawing: more than any carousel holds, and few enough to try all mixtures.
pub(crate) const MAX_PENS: usize = 12;
