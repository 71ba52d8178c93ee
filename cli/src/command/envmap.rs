//! `twelvefold envmap`: directions towards the light of an environment map.

use std::fmt;
use std::io::{self, BufWriter, ErrorKind, Write};

use twelvefold::estimate::{Warp, exactly};
use twelvefold::light::{
    Filter, LightSampler, NanRadiance, NegativeRadiance, RadiancePolicy, Sobol,
};
use twelvefold::{EnvironmentError, EnvironmentMap, EnvironmentSample, Limits, Placement};

use crate::args::{EnvmapOptions, FilterName, Method, Nan, Negative};
use crate::report;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture;

/// Runs the subcommand.
pub(crate) fn run(options: &EnvmapOptions) -> Result<(), Failure> {
    let filter = match options.filter {
        FilterName::Nearest => Filter::Nearest,
        FilterName::Bilinear if options.method == Method::Sobol => Filter::Bilinear,
        FilterName::Bilinear => {
            return Err(Failure::about("--filter bilinear", "needs --method sobol"));
        }
    };
    let of_map = |reason: Box<dyn std::error::Error>| report::of_input(&options.map, reason);
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
    report::warn(&options.map, &picture.warnings);
    let map = EnvironmentMap::new(picture.width, picture.height, picture.pixels, policy(options))
        .map_err(|error| of_map(Box::new(BadMap(error))))?
        .in_frame(options.frame.frame().rotated(options.rotate));
    let importance = map.importance();
    let n = options.directions as usize;
    if importance.mean() == 0.0 && n > 0 {
        return Err(of_map("is black, which leaves no light to look for".into()));
    }
    let points = match (options.method, Warp::new(importance)) {
        (Method::Sobol, _) => Ok(Vec::new()),
        (Method::Warp, Some(warp)) => warp.level(n, options.seed, Limits::default()),
        _ => exactly(
            &Placement::new(importance.domain(), options.seed),
            importance,
            n,
            Limits::default(),
        ),
    }
    .map_err(|error| of_map(error.into()))?;

    let written = match (options.method, LightSampler::new(&map, filter)) {
        (Method::Sobol, Some(lights)) => {
            let sequence = Sobol::new(options.seed);
            // No more than ten million.
            write(&mut output, (0..n as u32).map(|i| lights.sample(sequence.point(i))))
        }
        _ => write(&mut output, points.iter().map(|point| map.sample(point.position))),
    };
    match written.map_err(OutputError::from).and_then(|()| output.commit()) {
        // Whoever read the directions has had enough of them.
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(of_output),
    }
}

/// What the options make of components that are no radiance.
fn policy(options: &EnvmapOptions) -> RadiancePolicy {
    let mut policy = RadiancePolicy { infinite: options.infinite, ..RadiancePolicy::default() };
    if options.negative == Negative::Zero {
        policy.negative = NegativeRadiance::Zero;
    }
    if options.nan == Nan::Zero {
        policy.nan = NanRadiance::Zero;
    }
    policy
}

/// Writes the table. Numbers are the shortest decimals that read back as the same floats.
fn write(
    output: &mut impl Write,
    lights: impl Iterator<Item = EnvironmentSample>,
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
        let EnvironmentError::InvalidPixel { value, .. } = self.0 else { return Ok(()) };
        out.write_str(match value {
            _ if value.is_nan() => "; --nan zero takes such as 0",
            f32::INFINITY => "; --infinite clamp=V takes such as V, --infinite zero as 0",
            f32::NEG_INFINITY => "; --negative zero with --infinite zero takes such as 0",
            _ => "; --negative zero takes negative ones as 0",
        })
    }
}

impl std::error::Error for BadMap {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.0)
    }
}
