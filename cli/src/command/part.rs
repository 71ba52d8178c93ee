//! `twelvefold stipple --part I/N`: some cells of a photograph's dots, from the pixels that those need.

use std::ops::Range;

use twelvefold::{Cell, Mosaic};
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::Scan;
use twelvefold_files::progress::Progress;
use twelvefold_stipple::drawing::{DrawingError, Piece};
use twelvefold_stipple::error::DotsError;
use twelvefold_stipple::raw::{self, Step};
use twelvefold_stipple::wish::Centers;

use crate::args::StippleOptions;
use crate::format::Format;
use crate::part::Part;
use crate::report;
use crate::stipple::drawn::{DrawError, layer, open, put};
use crate::stipple::plan::Plan;
use crate::stipple::tones::{Blank, Importance, importance};
use crate::survey::Survey;

/// What a cell's map takes while it is made, a pixel.
const MAP_BYTES: usize = 30;

/// So that it takes 2 GiB at most.
const MOST_PIXELS: usize = (2 << 30) / MAP_BYTES;

/// Draws one part.
pub(crate) fn run(options: &StippleOptions, part: Part) -> Result<(), Failure> {
    let (format, mut output) = open(options)?;
    refuse(options, format)?;
    let photo = &options.photo;
    let (tone, layer) = (options.tone.tone()?, options.layer.as_deref());
    let mut scan =
        Scan::open(photo, tone, layer).map_err(|error| report::of_input(photo, error))?;
    if !options.quiet {
        report::warn(photo, scan.warnings());
    }
    let survey = match &options.survey {
        Some(path) => Survey::read(path, scan.size(), photo, tone, layer)
            .map_err(|error| report::of_input(path, error))?,
        None => Survey::of(&mut scan, photo, tone, layer)
            .map_err(|error| report::of_input(photo, error))?,
    };
    let importance = importance(options, format);
    let darkness = match importance {
        Importance::Corrected => survey.corrected,
        // Lines are not drawn in parts.
        Importance::Plain | Importance::Squared => survey.plain,
    };
    if darkness.total == 0.0 && options.points != Some(0) {
        let blank = Blank { invert: options.tone.invert, range: survey.range };
        return Err(report::of_input(photo, blank));
    }
    let mut plan = Plan::new(options, &darkness, format)
        .map_err(|error| Failure::about(error.option(), error))?;
    plan.look.piece = Piece { first: part.is_first(), last: part.is_last() };
    plan.wish.refine = 0;

    let count = plan.wish.count.number();
    let mosaic = Mosaic::new((darkness.width, darkness.height), darkness.mean, count)
        .map_err(|error| report::of_input(photo, error))?;
    let pixels = |cell: Cell| cell.columns().len().saturating_mul(cell.rows().len());
    let most = mosaic.part(part.index, part.of).map(pixels).max().unwrap_or(0);
    if most > MOST_PIXELS {
        let mebibytes = most.saturating_mul(MAP_BYTES) >> 20;
        let reason = format!(
            "takes {mebibytes} MiB for so few dots of so large a photograph; make it smaller"
        );
        return Err(Failure::about("--part", reason));
    }
    let expected = count / part.of as f64;
    let mut progress = Progress::new(expected, options.quiet);
    let drawn = draw(
        format,
        (&mut scan, importance),
        (&plan, mosaic.part(part.index, part.of)),
        &mut output,
        &mut progress,
    );
    let (points, time) = progress.finish();
    match drawn {
        Ok(()) => {}
        Err(DotsError::Taker(DrawError::Drawing(DrawingError::Io(error)))) => {
            return report::finish(&options.output, Err(OutputError::Io(error)));
        }
        Err(error) => return Err(report::of_input(photo, error)),
    }
    report::finish(&options.output, output.commit())?;
    if !options.quiet {
        report::points(points, time, &format!(", part {} of {}", part.index + 1, part.of));
    }
    Ok(())
}

/// What a part cannot be.
fn refuse(options: &StippleOptions, format: Format) -> Result<(), Failure> {
    let reason = match format {
        Format::Csv | Format::Svg | Format::Npy => None,
        Format::Png | Format::Pdf => {
            Some("draws CSV, SVG and NPY, which can be put together again")
        }
    };
    let reason = reason.or(match options.refine {
        None | Some(0) => None,
        Some(_) => Some("draws dots as the tiling gives them: to refine one takes all others"),
    });
    let reason = reason.or(match options.centers.centers() {
        Centers::Relaxed => None,
        Centers::Fixed => Some("draws relaxed dots; leave out --centers fixed"),
    });
    reason.map_or(Ok(()), |reason| Err(Failure::about("--part", reason)))
}

fn draw(
    format: Format,
    (scan, importance): (&mut Scan, Importance),
    (plan, cells): (&Plan, impl Iterator<Item = Cell>),
    output: &mut Output,
    progress: &mut Progress,
) -> Result<(), DotsError<DrawError>> {
    let failed = |error: DrawingError| DotsError::Taker(DrawError::Drawing(error));
    let mut drawing = format.begin(output, &plan.look).map_err(failed)?;
    drawing.layer(&layer(plan)).map_err(|error| failed(error.into()))?;
    let read = |columns: Range<usize>, rows: Range<usize>| {
        let mut pixels = scan
            .window(columns, rows)
            .map_err(|error| DotsError::Taker(DrawError::Picture(error)))?;
        importance.of_darkness(&mut pixels);
        Ok(pixels)
    };
    raw::cells(cells, plan.wish, read, |step, _| match step {
        Step::Dot(dot) => put(&mut *drawing, plan.look.sheet.place(dot), progress),
        Step::Cut => drawing.cut().map_err(|error| DrawError::Drawing(error.into())),
    })?;
    drawing.finish().map_err(|error| failed(error.into()))
}
