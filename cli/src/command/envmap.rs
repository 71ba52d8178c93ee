//! `twelvefold envmap`: directions towards the light of an environment map.

use std::fmt;
use std::io::{self, BufWriter, ErrorKind, Write};

use twelvefold::estimate::{Warp, exactly};
use twelvefold::{EnvironmentError, EnvironmentMap, InvalidPixels, Limits, Placement};

use crate::args::{EnvmapOptions, Method, Negative};
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture;

/// Runs the subcommand.
pub(crate) fn run(options: &EnvmapOptions) -> Result<(), Failure> {
    let of_map = |reason: Box<dyn std::error::Error>| {
        if options.map.as_os_str() == "-" {
            Failure::about("standard input", reason)
        } else {
            Failure::at(&options.map, reason)
        }
    };
    let standard = options.output.as_os_str() == "-";
    let of_output = |error: OutputError| {
        if standard {
            Failure::about("standard output", error)
        } else {
            Failure::at(&options.output, error)
        }
    };
    // Opened before the map is read: a mistake in its name shows at once.
    let mut output = if standard {
        Output::standard()
    } else {
        Output::create_from(&options.output, &options.map).map_err(of_output)?
    };

    let picture = picture::read_radiance(&options.map).map_err(|error| of_map(error.into()))?;
    let invalid = match options.negative {
        Negative::Reject => InvalidPixels::Reject,
        Negative::Zero => InvalidPixels::ZeroNegative,
    };
    let map = EnvironmentMap::new(picture.width, picture.height, picture.pixels, invalid)
        .map_err(|error| of_map(Box::new(BadMap(error))))?;
    let importance = map.importance();
    let n = options.directions as usize;
    if importance.mean() == 0.0 && n > 0 {
        return Err(of_map("is black, which leaves no light to look for".into()));
    }
    let points = match (options.method, Warp::new(importance)) {
        (Method::Warp, Some(warp)) => warp.level(n, options.seed, Limits::default()),
        _ => exactly(
            &Placement::new(importance.domain(), options.seed),
            importance,
            n,
            Limits::default(),
        ),
    }
    .map_err(|error| of_map(error.into()))?;

    let lights = points.iter().map(|point| map.sample(point.position));
    let written = write(&mut output, lights).map_err(OutputError::from);
    match written.and_then(|()| output.commit()) {
        // Whoever read the directions has had enough of them.
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(of_output),
    }
}

/// Writes the table. Numbers are the shortest decimals that read back as the same floats.
fn write(
    output: &mut impl Write,
    lights: impl Iterator<Item = twelvefold::EnvironmentSample>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, output);
    out.write_all(b"x,y,z,pdf,red,green,blue\n")?;
    for light in lights {
        let [x, y, z] = light.direction.to_array();
        let [red, green, blue] = light.radiance;
        writeln!(out, "{x},{y},{z},{},{red},{green},{blue}", light.pdf)?;
    }
    out.flush()
}

/// An error of the map's pixels, with what can be done about it.
#[derive(Debug)]
struct BadMap(EnvironmentError);

impl fmt::Display for BadMap {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(out)?;
        match self.0 {
            EnvironmentError::InvalidPixel { value, .. } if value < 0.0 && value.is_finite() => {
                out.write_str("; --negative zero takes negative ones as 0")
            }
            _ => Ok(()),
        }
    }
}

impl std::error::Error for BadMap {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.0)
    }
}
