//! `twelvefold stipple`: a photograph drawn with equal dots.

use std::fmt;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

use glam::DVec2;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::{self, Levels, Picture, Tone};
use twelvefold_files::progress::Progress;

use crate::args::{Centers, DotGain, StippleOptions};
use crate::drawing::{Csv, Drawing, Png, PngError, Style, Svg};
use crate::stipple::budget::{default_count, default_dot_size};
use crate::stipple::dots::{self, Count, DotsError, Wish};
use crate::stipple::gain;

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    let (kind, mut output) = open(options)?;
    let mut picture = read(options)?;
    let gain = options.dot_gain.unwrap_or(kind.dot_gain());
    if gain == DotGain::Correct {
        gain::correct(&mut picture.importance);
    }
    let wish = wish(options, picture.total());
    let style = style(options, &picture, wish.count);
    let mut progress = Progress::new(wish.count.number(), options.quiet);
    let to = Target { output: &mut output, style: &style, progress: &mut progress };
    let drawn = draw_as(kind, picture, wish, to);
    let (points, time) = progress.finish();
    match drawn {
        Ok(()) => {}
        Err(DotsError::Taker(DrawError::Write(error))) => {
            return finish(options, Err(OutputError::Io(error)));
        }
        Err(DotsError::Taker(DrawError::Picture(error))) => {
            return Err(Failure::at(&options.output, error));
        }
        Err(error) => return Err(of_photo(options, error)),
    }
    finish(options, output.commit())?;
    if !options.quiet {
        let seconds = time.as_secs_f64();
        let streamed = match (options.refine, wish.refine) {
            (None, 0) => ", not refined since so many are drawn as they come (see --refine)",
            _ => "",
        };
        // Stderr may be closed; the points are written all the same.
        let _ = writeln!(
            io::stderr(),
            "twelvefold: {points} points in {seconds:.3} s, {:.0} points a second{streamed}",
            points as f64 / seconds.max(1e-9)
        );
    }
    Ok(())
}

/// A failure about the photograph, by the name that the user knows it by.
fn of_photo(options: &StippleOptions, reason: impl Into<Box<dyn std::error::Error>>) -> Failure {
    if options.photo.as_os_str() == "-" {
        Failure::about("standard input", reason)
    } else {
        Failure::at(&options.photo, reason)
    }
}

/// Reads the photograph, which must not be blank if dots are to be drawn.
fn read(options: &StippleOptions) -> Result<Picture, Failure> {
    let picture = picture::read_layer(&options.photo, tone(options)?, options.layer.as_deref())
        .map_err(|error| of_photo(options, error))?;
    if !options.quiet {
        for warning in &picture.warnings {
            let warning = of_photo(options, format!("warning: {warning}"));
            let _ = writeln!(io::stderr(), "twelvefold: {warning}");
        }
    }
    let nothing = options.points == Some(0) || options.exact == Some(0);
    if picture.total() == 0.0 && !nothing {
        let blank = Blank { invert: options.invert, range: picture.range };
        return Err(of_photo(options, blank));
    }
    Ok(picture)
}

/// What the options ask for, of a picture whose importance adds up to `black`.
fn wish(options: &StippleOptions, black: f64) -> Wish {
    let count = match (options.exact, options.points) {
        (Some(count), _) => Count::Exactly(count as usize),
        (None, Some(count)) => Count::About(count as f64),
        (None, None) => Count::About(default_count(black)),
    };
    let iterations = dots::default_iterations(count.number());
    Wish {
        count,
        centers: options.centers.unwrap_or(Centers::Relaxed),
        seed: options.seed,
        refine: options.refine.map_or(iterations, usize::from),
    }
}

fn style(options: &StippleOptions, picture: &Picture, count: Count) -> Style {
    // Dots in a squared pixel of black.
    let density = count.number() / picture.total();
    let photo = &options.photo;
    let (about, count) = match count {
        Count::About(count) => ("about ", count),
        Count::Exactly(count) => ("", count as f64),
    };
    Style {
        width: picture.width,
        height: picture.height,
        scale: options.scale,
        dot_size: options.dot_size.unwrap_or_else(|| default_dot_size(density)),
        spacing: 1.0 / density.sqrt(),
        white_on_black: options.invert,
        linear: options.linear,
        title: photo.file_name().unwrap_or(photo.as_os_str()).to_string_lossy().into_owned(),
        description: format!(
            "Stippled with {about}{count} dots by twelvefold {}, seed {}",
            env!("CARGO_PKG_VERSION"),
            options.seed
        ),
    }
}

/// A file that could not be written is an error, unless whoever read it has had enough.
fn finish(options: &StippleOptions, written: Result<(), OutputError>) -> Result<(), Failure> {
    match written {
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| of_output(&options.output, error)),
    }
}

/// The tone that the options ask for.
fn tone(options: &StippleOptions) -> Result<Tone, Failure> {
    let plain = Levels::default();
    let levels = Levels {
        black: options.black.unwrap_or(plain.black),
        white: options.white.unwrap_or(plain.white),
        gamma: options.gamma.unwrap_or(plain.gamma),
    };
    if levels.black >= levels.white {
        let reason = format!("{} is not below --white {}", levels.black, levels.white);
        return Err(Failure::about("--black", reason));
    }
    Ok(Tone {
        linear: options.linear,
        invert: options.invert,
        levels: (levels != plain).then_some(levels),
        exposure: options.exposure,
    })
}

/// What to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Csv,
    Svg,
    Png,
}

impl Kind {
    /// The kind that the name of a file asks for.
    fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [("csv", Self::Csv), ("svg", Self::Svg), ("png", Self::Png)]
            .into_iter()
            .find_map(|(name, kind)| extension.eq_ignore_ascii_case(name).then_some(kind))
    }

    /// Ink is drawn so that it covers what is dark; a list of points has no ink.
    fn dot_gain(self) -> DotGain {
        match self {
            Self::Csv => DotGain::Ignore,
            Self::Svg | Self::Png => DotGain::Correct,
        }
    }
}

/// Opens the output before the photograph is read: a mistake in its name shows at once.
fn open(options: &StippleOptions) -> Result<(Kind, Output), Failure> {
    let path = &options.output;
    if path.as_os_str() == "-" {
        return Ok((Kind::Csv, Output::standard()));
    }
    let kind = Kind::of(path)
        .ok_or_else(|| Failure::at(path, "has none of the endings .svg, .png and .csv"))?;
    let output =
        Output::create_from(path, &options.photo).map_err(|error| of_output(path, error))?;
    Ok((kind, output))
}

fn of_output(path: &Path, error: OutputError) -> Failure {
    if path.as_os_str() == "-" {
        Failure::about("standard output", error)
    } else {
        Failure::at(path, error)
    }
}

/// Where drawn dots go: the file, how they look, and who is told of them.
struct Target<'a> {
    output: &'a mut Output,
    style: &'a Style,
    progress: &'a mut Progress,
}

/// Draws a picture's dots as a file of this kind.
fn draw_as(
    kind: Kind,
    picture: Picture,
    wish: Wish,
    Target { output, style, progress }: Target<'_>,
) -> Result<(), DotsError<DrawError>> {
    let write = |error| DotsError::Taker(DrawError::Write(error));
    match kind {
        Kind::Csv => draw(picture, wish, Csv::new(output).map_err(write)?, progress),
        Kind::Svg => draw(picture, wish, Svg::new(output, style).map_err(write)?, progress),
        Kind::Png => {
            let png = Png::new(output, style)
                .map_err(|error| DotsError::Taker(DrawError::Picture(error)))?;
            draw(picture, wish, png, progress)
        }
    }
}

/// Puts every dot into `drawing`.
fn draw(
    picture: Picture,
    wish: Wish,
    mut drawing: impl Drawing,
    progress: &mut Progress,
) -> Result<(), DotsError<DrawError>> {
    let end = DVec2::new(picture.width as f64, picture.height as f64);
    dots::place(
        picture,
        wish,
        || {},
        |DVec2 { x, y }| {
            progress.point();
            drawing.dot(narrowed(x, end.x), narrowed(y, end.y)).map_err(DrawError::Write)
        },
    )?;
    drawing.finish().map_err(|error| DotsError::Taker(DrawError::Write(error)))
}

/// The 32-bit float nearest to `coordinate` of those below `end`.
fn narrowed(coordinate: f64, end: f64) -> f32 {
    let narrow = coordinate as f32;
    if f64::from(narrow) < end { narrow } else { narrow.next_down() }
}

/// Why drawing stopped.
#[derive(Debug)]
enum DrawError {
    Write(io::Error),
    Picture(PngError),
}

impl fmt::Display for DrawError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Write(error) => error.fmt(out),
            Self::Picture(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for DrawError {}

/// The photograph has nothing to put dots on.
#[derive(Debug)]
struct Blank {
    invert: bool,
    /// Of a float file.
    range: Option<(f64, f64)>,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_chooses_the_kind_in_any_case() {
        assert_eq!(Kind::of(Path::new("a/b.SVG")), Some(Kind::Svg));
        assert_eq!(Kind::of(Path::new("x.tar.csv")), Some(Kind::Csv));
        for none in ["svg", ".png", "x.jpg", "x.", "png/x"] {
            assert_eq!(Kind::of(Path::new(none)), None, "{none}");
        }
    }

    #[test]
    fn rounding_never_carries_a_dot_onto_the_open_border() {
        for end in [1.0, 451.0, 4000.0, 16_777_217.0, 1e8 + 1.0] {
            let narrow = narrowed(f64::next_down(end), end);
            assert!(f64::from(narrow) < end && f64::from(narrow.next_up()) >= end, "{end}");
        }
        assert_eq!(narrowed(0.1, 1.0), 0.1);
    }
}
