//! `twelvefold stipple`: a photograph drawn with equal dots.

use std::fmt;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

use glam::DVec2;
use twelvefold::estimate::exactly;
use twelvefold::{
    Amount, Domain, ImageMap, Importance, InvalidPixels, Limits, Placement, Sample, Sampling,
    SamplingError, StippleMap,
};

use crate::args::{Centres, MAX_POINTS, StippleOptions};
use crate::drawing::{Csv, Drawing, Png, PngError, Style, Svg};
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::{self, Levels, Tone};
use twelvefold_files::progress::Progress;

/// Black area, in squared pixels, that gets one dot when no number is asked for: a dot every 3 pixels.
const AREA_PER_DOT: f64 = 9.0;

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    let photo = &options.photo;
    let of_photo = |reason: Box<dyn std::error::Error>| {
        if photo.as_os_str() == "-" {
            Failure::about("standard input", reason)
        } else {
            Failure::at(photo, reason)
        }
    };
    let (kind, mut output) = open(options)?;

    let tone = tone(options)?;
    let picture = picture::read_layer(photo, tone, options.layer.as_deref())
        .map_err(|error| of_photo(error.into()))?;
    if !options.quiet {
        for warning in &picture.warnings {
            let warning = of_photo(format!("warning: {warning}").into());
            let _ = writeln!(io::stderr(), "twelvefold: {warning}");
        }
    }
    let black = picture.total();
    let points = match options.points.or(options.exact) {
        Some(points) => points as f64,
        None => (black / AREA_PER_DOT).round().clamp(1.0, MAX_POINTS as f64),
    };
    if black == 0.0 && points > 0.0 {
        return Err(of_photo(Box::new(Blank { invert: options.invert, range: picture.range })));
    }
    // Dots in a squared pixel of black.
    let density = points / black;
    let style = Style {
        width: picture.width,
        height: picture.height,
        scale: options.scale,
        dot_size: options.dot_size.unwrap_or_else(|| default_dot_size(density)),
        spacing: 1.0 / density.sqrt(),
        white_on_black: options.invert,
        linear: options.linear,
        title: photo.file_name().unwrap_or(photo.as_os_str()).to_string_lossy().into_owned(),
        description: format!(
            "Stippled with {}{points} dots by twelvefold {}, seed {}",
            if options.exact.is_some() { "" } else { "about " },
            env!("CARGO_PKG_VERSION"),
            options.seed
        ),
    };

    let mut progress = Progress::new(points, options.quiet);
    let (width, height, pixels) = (picture.width, picture.height, picture.importance);
    let invalid = InvalidPixels::Reject;
    let to = (&mut output, &style, &mut progress);
    let drawn = match (options.exact, options.centres.unwrap_or(Centres::Relaxed)) {
        (Some(n), _) => {
            let map = ImageMap::new(width, height, pixels, invalid)
                .map_err(|error| of_photo(error.into()))?;
            let placement = Placement::new(map.domain(), options.seed);
            let dots = exactly(&placement, &map, n as usize, Limits::default())
                .map_err(|error| of_photo(error.into()))?;
            let mut positions = dots.iter().map(|dot| Ok(dot.position));
            draw_as(kind, &mut positions, map.domain(), to)
        }
        (None, Centres::Fixed) => {
            let map = ImageMap::new(width, height, pixels, invalid)
                .map_err(|error| of_photo(error.into()))?;
            let placement = Placement::new(map.domain(), options.seed);
            let sampling = Sampling::new(&placement, &map, Amount::Points(points));
            let sampling = sampling.map_err(|error| of_photo(error.into()))?;
            draw_sampling(kind, &sampling, to)
        }
        (None, Centres::Relaxed) => {
            let map = StippleMap::new(width, height, pixels, invalid, points)
                .map_err(|error| of_photo(error.into()))?;
            let placement = Placement::new(map.domain(), options.seed);
            let sampling = Sampling::new(&placement, &map, Amount::Points(points))
                .and_then(Sampling::relaxed)
                .map_err(|error| of_photo(error.into()))?;
            draw_sampling(kind, &sampling, to)
        }
    };
    let written = match drawn {
        Ok(()) => output.commit(),
        Err(DrawError::Write(error)) => Err(error.into()),
        Err(DrawError::Picture(error)) => {
            progress.finish();
            return Err(Failure::at(&options.output, error));
        }
        Err(DrawError::Sampling(error)) => {
            progress.finish();
            return Err(of_photo(error.into()));
        }
    };
    let (points, time) = progress.finish();
    match written {
        Ok(()) => {}
        // Whoever read the points has had enough of them.
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => return Ok(()),
        Err(error) => return Err(of_output(&options.output, error)),
    }
    if !options.quiet {
        let seconds = time.as_secs_f64();
        // Stderr may be closed; the points are written all the same.
        let _ = writeln!(
            io::stderr(),
            "twelvefold: {points} points in {seconds:.3} s, {:.0} points a second",
            points as f64 / seconds.max(1e-9)
        );
    }
    Ok(())
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

/// The diameter at which `density` dots in a squared pixel have an area of one squared pixel.
fn default_dot_size(density: f64) -> f64 {
    if density > 0.0 { (4.0 / (std::f64::consts::PI * density)).sqrt() } else { 1.0 }
}

/// Where drawn dots go: the file, how they look, and who is told of them.
type Target<'a> = (&'a mut Output, &'a Style, &'a mut Progress);

/// Draws every point of `sampling` as a file of this kind.
fn draw_sampling(
    kind: Kind,
    sampling: &Sampling<'_, impl Importance>,
    to: Target<'_>,
) -> Result<(), DrawError> {
    // In 64 bits because 32 would be too few in a picture with sides of very different length.
    let mut positions =
        sampling.points()?.map(|point| point.map(|Sample::<DVec2> { position, .. }| position));
    draw_as(kind, &mut positions, sampling.placement().domain(), to)
}

/// Draws dots as a file of this kind.
fn draw_as(
    kind: Kind,
    positions: &mut dyn Iterator<Item = Result<DVec2, SamplingError>>,
    domain: Domain,
    (output, style, progress): Target<'_>,
) -> Result<(), DrawError> {
    match kind {
        Kind::Csv => draw(positions, domain, Csv::new(output)?, progress),
        Kind::Svg => draw(positions, domain, Svg::new(output, style)?, progress),
        Kind::Png => {
            let png = Png::new(output, style).map_err(DrawError::Picture)?;
            draw(positions, domain, png, progress)
        }
    }
}

/// Puts every dot into `drawing`.
fn draw(
    positions: &mut dyn Iterator<Item = Result<DVec2, SamplingError>>,
    domain: Domain,
    mut drawing: impl Drawing,
    progress: &mut Progress,
) -> Result<(), DrawError> {
    let end = domain.max();
    for position in positions {
        let DVec2 { x, y } = position?;
        drawing.dot(narrowed(x, end.x), narrowed(y, end.y))?;
        progress.point();
    }
    Ok(drawing.finish()?)
}

/// The 32-bit float nearest to `coordinate` of those below `end`.
fn narrowed(coordinate: f64, end: f64) -> f32 {
    let narrow = coordinate as f32;
    if f64::from(narrow) < end { narrow } else { narrow.next_down() }
}

/// Why drawing stopped.
#[derive(Debug)]
enum DrawError {
    Sampling(SamplingError),
    Write(io::Error),
    Picture(PngError),
}

impl From<SamplingError> for DrawError {
    fn from(error: SamplingError) -> Self {
        Self::Sampling(error)
    }
}

impl From<io::Error> for DrawError {
    fn from(error: io::Error) -> Self {
        Self::Write(error)
    }
}

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

    #[test]
    fn dots_of_the_default_size_cover_black_once() {
        let density = 1.0 / AREA_PER_DOT;
        let diameter = default_dot_size(density);
        let area = std::f64::consts::PI * diameter * diameter / 4.0;
        assert!((area * density - 1.0).abs() < 1e-12);
    }
}
