//! How many dots a place of a photograph should have, by how dark it is.

use std::fmt;

use twelvefold_stipple::gain;

use crate::args::{DotGain, StippleOptions};
use crate::format::Format;

/// What a photograph's darkness becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Importance {
    /// Itself.
    Plain,
    /// The share of area whose overlapping dots cover as much.
    Corrected,
    /// Its square, for a line.
    Squared,
}

/// What the options ask for.
pub(crate) fn importance(options: &StippleOptions, format: Format) -> Importance {
    let paper = &options.paper;
    // A pen's dots lie apart, so that none of their ink is lost; a list of points has no ink.
    let lies_apart = paper.pen.is_some() || format.is_list();
    let gain = if lies_apart { DotGain::Ignore } else { DotGain::Correct };
    match options.dot_gain.unwrap_or(gain) {
        _ if paper.line => Importance::Squared,
        DotGain::Correct => Importance::Corrected,
        DotGain::Ignore => Importance::Plain,
    }
}

impl Importance {
    /// Turns pixels' darkness, 0 to 1, into it.
    pub(crate) fn of_darkness(self, pixels: &mut [f32]) {
        match self {
            Self::Plain => {}
            Self::Corrected => gain::correct(pixels),
            Self::Squared => gain::square(pixels),
        }
    }
}

/// The photograph has nothing to put dots on.
#[derive(Debug)]
pub(crate) struct Blank {
    pub(crate) invert: bool,
    /// Of a float file.
    pub(crate) range: Option<(f64, f64)>,
}

impl fmt::Display for Blank {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.range {
            Some((least, greatest)) if !self.invert && least >= 1.0 => write!(
                out,
                "is brighter than 1, which is white, everywhere ({least:.3} to {greatest:.3}); \
                 try --exposure {}",
                -greatest.log2().ceil().max(1.0)
            ),
            _ => out.write_str(if self.invert {
                "is all black, which leaves no place for dots; try without --invert"
            } else {
                "is all white, which leaves no place for dots; try --invert"
            }),
        }
    }
}

impl std::error::Error for Blank {}
