//! `twelvefold frames`: moving pictures, drawn with equal dots that stay where nothing moves.

use std::io::{self, Write as _};
use std::ops::ControlFlow;

use twelvefold_files::failure::Failure;
use twelvefold_files::progress::Progress;

use crate::frames::input::{Input, is_stream};
use crate::frames::options::FramesOptions;
use crate::frames::output::{Kind, Target};
use crate::frames::plan::{Plan, importance};
use crate::report;
use crate::stipple::tones::Blank;

/// Runs the subcommand.
pub(crate) fn run(options: &FramesOptions) -> Result<(), Failure> {
    refuse_of_stream(options)?;
    let mut target = Target::open(options)?;
    let kind = target.kind();
    refuse_as(options, kind)?;
    let mut input = Input::open(options, importance(options, kind))?;
    let number = input.next_number();
    target.check(number, input.next_file().as_deref())?;
    let Some(first) = input.first()? else {
        let blank = Blank { invert: options.tone.invert, range: None };
        return Err(report::of_input(&options.input, blank));
    };
    let plan = Plan::new(options, first, kind)?;

    let expected = input.count().map_or(0.0, |frames| frames as f64 * plan.dots);
    let mut progress = Progress::new(expected, options.quiet || expected == 0.0);
    let mut frames = 0;
    while let Some(frame) = input.frame()? {
        plan.check(&frame.picture)?;
        match target.draw(&frame, &plan, input.rate(), &mut progress)? {
            ControlFlow::Continue(()) => frames += 1,
            ControlFlow::Break(()) => return Ok(()),
        }
    }
    target.finish()?;
    let (points, time) = progress.finish();
    if !options.quiet {
        let seconds = time.as_secs_f64();
        let plural = if frames == 1 { "" } else { "s" };
        // Stderr may be closed; the frames are written all the same.
        let _ = writeln!(
            io::stderr(),
            "twelvefold: {frames} frame{plural} of {points} points in {seconds:.3} s",
        );
    }
    Ok(())
}

/// What cannot be asked of frames that come as a stream.
fn refuse_of_stream(options: &FramesOptions) -> Result<(), Failure> {
    if options.input.as_os_str() != "-" && !is_stream(&options.input) {
        return Ok(());
    }
    let given = [
        ("--first", options.first.is_some()),
        ("--last", options.last.is_some()),
        ("--part", options.part.is_some()),
        ("--layer", options.layer.is_some()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
        return Err(Failure::about(option, "is for numbered files, and this is a stream"));
    }
    match options.tone.exposure {
        Some(_) => Err(Failure::about("--exposure", "is for float files, and this is a stream")),
        None => Ok(()),
    }
}

/// What has no effect on frames of this kind.
fn refuse_as(options: &FramesOptions, kind: Kind) -> Result<(), Failure> {
    let idle = match kind {
        Kind::Stream if options.part.is_some() => {
            return Err(Failure::about("--part", "draws numbered files; a stream has all frames"));
        }
        Kind::Stream => None,
        Kind::Files(_) if options.rate.is_some() => Some("--rate"),
        Kind::Files(format) if format.is_list() && options.scale.is_some() => Some("--scale"),
        Kind::Files(format) if format.is_list() && options.dot_size.is_some() => Some("--dot-size"),
        Kind::Files(_) => None,
    };
    match idle {
        Some(option) => Err(Failure::about(option, "has no effect on these files; leave it out")),
        None => Ok(()),
    }
}
