//! `twelvefold stipple`: a photograph drawn with equal dots.

use crate::args::StippleOptions;
use crate::failure::Failure;

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    Err(Failure::at(&options.photo, "the sampler is being written"))
}
