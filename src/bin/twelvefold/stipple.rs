//! `twelvefold stipple`: a photograph drawn with equal dots.

use crate::args::StippleOptions;
use crate::failure::Failure;
use crate::picture::{self, Tone};

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    let tone = Tone { linear: options.linear, invert: options.invert };
    let picture =
        picture::read(&options.photo, tone).map_err(|e| Failure::at(&options.photo, e))?;
    eprintln!("{} x {} total {}", picture.width, picture.height, picture.total());
    Ok(())
}
