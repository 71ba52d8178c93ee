//! Where drawn frames go: numbered files or a stream.

use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::progress::Progress;
use twelvefold_files::y4m::Rate;
use twelvefold_stipple::drawing::{Drawing, DrawingError, Y4m};
use twelvefold_stipple::error::DotsError;
use twelvefold_stipple::raw::Step;

use super::input::{Frame, is_stream};
use super::options::FramesOptions;
use super::pattern::Pattern;
use super::plan::Plan;
use crate::format::Format;
use crate::report;
use crate::stipple::drawn::{DrawError, put};

/// What frames are written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Files(Format),
    Stream,
}

impl Kind {
    /// Whether it holds places only, and nothing is drawn.
    pub(crate) fn is_list(self) -> bool {
        matches!(self, Self::Files(format) if format.is_list())
    }
}

/// The place of frames that are drawn.
pub(crate) enum Target {
    Files { pattern: Pattern, format: Format },
    Stream { path: PathBuf, output: BufWriter<Output>, rate: Option<Rate>, begun: bool },
}

impl Target {
    /// Opens what the options name.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn open(options: &FramesOptions) -> Result<Self, Failure> {
        let path = &options.output;
        let of_output = |error| report::of_output(path, error);
        if path.as_os_str() == "-" || is_stream(path) {
            let output = if path.as_os_str() == "-" {
                Output::standard()
            } else {
                Output::create_from(path, &options.input).map_err(of_output)?
            };
            let output = BufWriter::with_capacity(1 << 16, output);
            return Ok(Self::Stream {
                path: path.clone(),
                output,
                rate: options.rate,
                begun: false,
            });
        }
        let Some(pattern) = Pattern::of(path).map_err(|reason| Failure::at(path, reason))? else {
            let reason = "is neither numbered files, such as out/%04d.svg, nor a .y4m file";
            return Err(Failure::at(path, reason));
        };
        let format = Format::of(&pattern.path(0)).ok_or_else(|| {
            Failure::at(path, "has none of the endings .svg, .png, .pdf, .csv and .npy")
        })?;
        Ok(Self::Files { pattern, format })
    }

    pub(crate) fn kind(&self) -> Kind {
        match self {
            Self::Files { format, .. } => Kind::Files(*format),
            Self::Stream { .. } => Kind::Stream,
        }
    }

    /// Fails if the file of this frame cannot be written; leaves the folder as it is.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn check(&self, number: u64, read: Option<&Path>) -> Result<(), Failure> {
        match self {
            Self::Files { pattern, .. } => create(&pattern.path(number), read).map(|_| ()),
            Self::Stream { .. } => Ok(()),
        }
    }

    /// Draws a frame; breaks off if whoever reads the stream has had enough. A stream has so many frames a second
    /// unless it was asked for others.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        plan: &Plan,
        default: Option<Rate>,
        progress: &mut Progress,
    ) -> Result<ControlFlow<()>, Failure> {
        let look = plan.look(frame.file.as_deref(), frame.number);
        match self {
            Self::Files { pattern, format } => {
                let path = pattern.path(frame.number);
                let mut output = create(&path, frame.file.as_deref())?;
                let drawn = format
                    .begin(&mut output, &look)
                    .map_err(of_drawing)
                    .and_then(|drawing| fill(drawing, frame, plan, progress));
                drawn.map_err(|error| failure(error, &path, frame))?;
                output.commit().map_err(|error| report::of_output(&path, error))?;
            }
            Self::Stream { path, output, rate, begun } => {
                let begin = if *begun {
                    Ok(())
                } else {
                    Y4m::begin(&mut *output, &look, rate.or(default).unwrap_or_default())
                };
                *begun = true;
                let drawn = begin
                    .and_then(|()| Y4m::new(&mut *output, &look))
                    .map_err(of_drawing)
                    .and_then(|drawing| fill(Box::new(drawing), frame, plan, progress))
                    // Whoever sees frames as they come need not wait.
                    .and_then(|()| output.flush().map_err(|error| of_drawing(error.into())));
                match drawn {
                    Err(DotsError::Taker(DrawError::Drawing(DrawingError::Io(error))))
                        if error.kind() == ErrorKind::BrokenPipe =>
                    {
                        return Ok(ControlFlow::Break(()));
                    }
                    drawn => drawn.map_err(|error| failure(error, path, frame))?,
                }
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Ends a stream.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self::Stream { path, output, .. } = self else { return Ok(()) };
        let written = match output.into_inner() {
            Ok(output) => output.commit(),
            Err(error) => Err(OutputError::Io(error.into_error())),
        };
        report::finish(&path, written)
    }
}

fn create(path: &Path, read: Option<&Path>) -> Result<Output, Failure> {
    let output = match read {
        Some(read) => Output::create_from(path, read),
        None => Output::create(path),
    };
    output.map_err(|error| report::of_output(path, error))
}

fn of_drawing(error: DrawingError) -> DotsError<DrawError> {
    DotsError::Taker(DrawError::Drawing(error))
}

fn fill(
    mut drawing: Box<dyn Drawing + '_>,
    frame: &Frame,
    plan: &Plan,
    progress: &mut Progress,
) -> Result<(), DotsError<DrawError>> {
    let failed = |error: io::Error| of_drawing(error.into());
    drawing.layer(&plan.layer).map_err(failed)?;
    plan.frames.place(&frame.picture, |step| match step {
        Step::Dot(dot) => put(&mut *drawing, plan.place(dot), progress),
        Step::Cut => drawing.cut().map_err(|error| DrawError::Drawing(error.into())),
    })?;
    drawing.finish().map_err(failed)
}

/// The failure of a frame that was to be written at `path`.
fn failure(error: DotsError<DrawError>, path: &Path, frame: &Frame) -> Failure {
    match error {
        DotsError::Taker(DrawError::Drawing(DrawingError::Io(error))) => {
            report::of_output(path, OutputError::Io(error))
        }
        DotsError::Taker(error) => Failure::at(path, error),
        error => match &frame.file {
            Some(file) => Failure::at(file, error),
            None => Failure::about(&format!("frame {}", frame.number), error),
        },
    }
}
