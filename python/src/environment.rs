//! Directions towards the light of an environment map.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use twelvefold::estimate::{Warp, exactly};
use twelvefold::light::{
    Filter, Frame, InfiniteRadiance, LightSampler, NanRadiance, NegativeRadiance, RadiancePolicy,
    Sobol,
};
use twelvefold::{EnvironmentError, EnvironmentMap, EnvironmentSample, Limits, Placement};

use crate::work::{self, Stop};
use crate::{arguments, arrays, error, output};

/// How directions are chosen.
#[derive(Clone, Copy, Debug)]
enum Method {
    Sobol(Filter),
    Progressive,
    Warp,
}

/// Directions, their pdf and radiance; see the package's documentation.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
pub(crate) fn environment<'py>(
    py: Python<'py>,
    map: &Bound<'py, PyAny>,
    n: &Bound<'py, PyAny>,
    method: &Bound<'py, PyAny>,
    frame: &Bound<'py, PyAny>,
    rotate: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    filter: &Bound<'py, PyAny>,
    negative: &Bound<'py, PyAny>,
    infinite: &Bound<'py, PyAny>,
    nan: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyTuple>> {
    let n = arguments::count(n)?;
    let seed = arguments::seed(seed)?;
    let filter = arguments::choice(
        "filter",
        filter,
        &[("nearest", Filter::Nearest), ("bilinear", Filter::Bilinear)],
    )?;
    let method = arguments::choice(
        "method",
        method,
        &[
            ("sobol", Method::Sobol(filter)),
            ("progressive", Method::Progressive),
            ("warp", Method::Warp),
        ],
    )?;
    if filter == Filter::Bilinear && !matches!(method, Method::Sobol(_)) {
        return Err(error::value("filter='bilinear' needs method='sobol'"));
    }
    let rotate = arguments::number("rotate", Some(rotate))?.unwrap_or_default();
    if !rotate.is_finite() {
        return Err(error::value(format!("rotate is {rotate}; it should be finite")));
    }
    let frame = arguments::choice(
        "frame",
        frame,
        &[
            ("pbrt", Frame::PBRT),
            ("mitsuba", Frame::MITSUBA),
            ("blender", Frame::BLENDER),
            ("gltf", Frame::GLTF),
            ("openexr", Frame::OPENEXR),
        ],
    )?;
    let frame = frame.rotated(rotate);
    let zero = |name, word, reject, zero| {
        arguments::choice(name, word, &[("reject", reject), ("zero", zero)])
    };
    let mut policy = RadiancePolicy { infinite: infinite_policy(infinite)?, ..Default::default() };
    if zero("negative", negative, false, true)? {
        policy.negative = NegativeRadiance::Zero;
    }
    if zero("nan", nan, false, true)? {
        policy.nan = NanRadiance::Zero;
    }
    let (width, height, pixels) = arrays::light("map", map)?;
    let lights = work::run(py, move |stop| {
        let sky = EnvironmentMap::new(width, height, pixels, policy).map_err(of_map)?;
        lights(sky.in_frame(frame), n, method, seed, stop)
    })?;
    let arrays = [
        output::rows(py, lights.directions)?,
        output::column(py, lights.pdf),
        output::rows(py, lights.radiance)?,
    ];
    PyTuple::new(py, arrays)
}

/// 'reject', 'zero', or the number that counts for it.
fn infinite_policy(policy: &Bound<'_, PyAny>) -> PyResult<InfiniteRadiance> {
    match policy.extract::<f32>() {
        Ok(most) if most >= 0.0 && most.is_finite() => return Ok(InfiniteRadiance::Clamp(most)),
        Ok(most) => {
            return Err(error::value(format!(
                "infinite is {most}; as a number it is finite and not negative"
            )));
        }
        Err(_) => {}
    }
    arguments::choice(
        "infinite",
        policy,
        &[("reject", InfiniteRadiance::Reject), ("zero", InfiniteRadiance::Zero)],
    )
}

/// What is wrong with a map's pixels, as Python counts, and what can be done about it.
fn of_map(reason: EnvironmentError) -> PyErr {
    let EnvironmentError::InvalidPixel { x, y, channel, value } = reason else {
        return error::value(format!("map: {reason}"));
    };
    let help = match value {
        _ if value.is_nan() => "nan='zero' takes such as 0",
        f32::INFINITY => "infinite=V takes such as V, infinite='zero' as 0",
        f32::NEG_INFINITY => "negative='zero' with infinite='zero' takes such as 0",
        _ => "negative='zero' takes negative ones as 0",
    };
    error::value(format!("map[{y}, {x}, {channel}] is {value}, which is no radiance; {help}"))
}

/// Samples of light, column by column.
#[derive(Default)]
struct Lights {
    directions: Vec<[f64; 3]>,
    pdf: Vec<f64>,
    radiance: Vec<[f32; 3]>,
}

impl Lights {
    /// Of samples of which some are still wanted.
    fn collect(
        n: usize,
        samples: impl Iterator<Item = EnvironmentSample>,
        stop: &Stop,
    ) -> PyResult<Self> {
        let mut lights = Self::default();
        let short = |_| error::memory(n.saturating_mul(size_of::<EnvironmentSample>()));
        lights.directions.try_reserve_exact(n).map_err(short)?;
        lights.pdf.try_reserve_exact(n).map_err(short)?;
        lights.radiance.try_reserve_exact(n).map_err(short)?;
        for (i, light) in samples.enumerate() {
            if i % 65_536 == 0 && stop.wanted() {
                break;
            }
            lights.directions.push(light.direction.to_array());
            lights.pdf.push(light.pdf);
            lights.radiance.push(light.radiance);
        }
        Ok(lights)
    }
}

/// n samples of a map's light.
fn lights(
    sky: EnvironmentMap,
    n: usize,
    method: Method,
    seed: u64,
    stop: &Stop,
) -> PyResult<Lights> {
    let importance = sky.importance();
    let black = || error::value("map is black, which leaves no light to look for");
    let points = match method {
        _ if n == 0 => Vec::new(),
        Method::Sobol(filter) => {
            let lights = LightSampler::new(&sky, filter).ok_or_else(black)?;
            let sequence = Sobol::new(seed);
            // n is at most 2³², and so the last index fits.
            let samples = (0..n).map(|i| lights.sample(sequence.point(i as u32)));
            return Lights::collect(n, samples, stop);
        }
        Method::Warp => {
            let warp = Warp::new(importance).ok_or_else(black)?;
            warp.level(n, seed, Limits::default()).map_err(error::exact)?
        }
        Method::Progressive if importance.mean() == 0.0 => return Err(black()),
        Method::Progressive => {
            let placement = Placement::new(importance.domain(), seed);
            exactly(&placement, importance, n, Limits::default()).map_err(error::exact)?
        }
    };
    Lights::collect(n, points.iter().map(|point| sky.sample(point.position)), stop)
}
