//! The file that dots are drawn in.

use std::fmt;

use glam::DVec2;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::Output;
use twelvefold_files::picture::PictureError;
use twelvefold_files::progress::Progress;
use twelvefold_stipple::drawing::{Drawing, DrawingError, Layer};

use super::plan::Plan;
use crate::args::StippleOptions;
use crate::format::Format;
use crate::report::of_output;

/// Opens the output before the photograph is read: a mistake in its name shows at once.
pub(crate) fn open(options: &StippleOptions) -> Result<(Format, Output), Failure> {
    let path = &options.output;
    let (format, output) = if path.as_os_str() == "-" {
        (options.format.unwrap_or(Format::Csv), Output::standard())
    } else {
        let format = options.format.or_else(|| Format::of(path)).ok_or_else(|| {
            let reason = "has none of the endings .svg, .png, .pdf, .csv and .npy; see --format";
            Failure::at(path, reason)
        })?;
        let output = Output::create_from(path, &options.photo);
        (format, output.map_err(|error| of_output(path, error))?)
    };
    match idle(options, format) {
        Some(option) => {
            let format = format!("{format:?}").to_uppercase();
            Err(Failure::about(option, format!("has no effect on {format}; leave it out")))
        }
        None => Ok((format, output)),
    }
}

/// An option that was given and that changes nothing in files of this format.
fn idle(options: &StippleOptions, format: Format) -> Option<&'static str> {
    let paper = &options.paper;
    // Dots of pens lie apart by their size, and have colors by that of the paper.
    let by_size = paper.pen.is_some() || paper.pens.is_some();
    [
        ("--dpi", paper.dpi.is_some() && format != Format::Png),
        ("--scale", options.scale.is_some() && format.is_list()),
        ("--paper", paper.paper.is_some() && paper.pens.is_none() && format.is_list()),
        ("--dot-size", options.dot_size.is_some() && !by_size && format.is_list()),
    ]
    .into_iter()
    .find_map(|(option, idle)| idle.then_some(option))
}

/// The one layer of a drawing without `--pens`.
pub(crate) fn layer(plan: &Plan) -> Layer {
    Layer { name: plan.ink.svg(), color: plan.ink }
}

/// Draws a dot, and counts it.
///
/// # Errors
/// The system's.
pub(crate) fn put(
    drawing: &mut dyn Drawing,
    dot: DVec2,
    progress: &mut Progress,
) -> Result<(), DrawError> {
    progress.point();
    drawing.dot(dot).map_err(|error| DrawError::Drawing(error.into()))
}

/// Why drawing stopped.
#[derive(Debug)]
pub(crate) enum DrawError {
    Drawing(DrawingError),
    /// The photograph could not be read further.
    Picture(PictureError),
    /// Fewer dots than asked for lie a pen's width apart.
    NotExact {
        asked: usize,
        found: usize,
    },
}

impl fmt::Display for DrawError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawing(error) => error.fmt(out),
            Self::Picture(error) => error.fmt(out),
            Self::NotExact { asked, found } => {
                write!(out, "of {asked} dots only {found} lie a pen's width apart; ask for fewer")
            }
        }
    }
}

impl std::error::Error for DrawError {}
