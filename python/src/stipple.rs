//! Dots that draw a picture.

use glam::DVec2;
use pyo3::prelude::*;
use twelvefold::estimate::exactly_relaxed;
use twelvefold::refine::Refiner;
use twelvefold::{Amount, InvalidPixels, Limits, Pixels, Placement, Sampling, StippleMap};

use crate::arrays::Image;
use crate::tone::{self, Tone};
use crate::work::{self, Stop};
use crate::{arguments, error, output};

/// The most iterations, as in the program.
const MOST_ITERATIONS: u32 = 1000;

/// Dots of a picture; see the package's documentation.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
pub(crate) fn stipple<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    n: &Bound<'py, PyAny>,
    refine: &Bound<'py, PyAny>,
    best: &Bound<'py, PyAny>,
    exact: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    invert: &Bound<'py, PyAny>,
    linear: &Bound<'py, PyAny>,
    black: &Bound<'py, PyAny>,
    white: Option<&Bound<'py, PyAny>>,
    gamma: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let n = arguments::count(n)?;
    let refine = arguments::whole("refine", refine, MOST_ITERATIONS)?;
    let best = arguments::flag("best", best)?;
    if best && refine == 0 {
        return Err(error::value("best moves refined dots, and refine=0 asks for none"));
    }
    let seed = arguments::seed(seed)?;
    let exact = arguments::flag("exact", exact)?;
    let tone = Tone {
        linear: arguments::flag("linear", linear)?,
        invert: arguments::flag("invert", invert)?,
        black: arguments::given("black", black)?,
        white: arguments::number("white", white)?,
        gamma: arguments::given("gamma", gamma)?,
    };
    let image = tone::importance("image", image, tone)?;
    if n > 0 && image.2.iter().all(|pixel| *pixel == 0.0) {
        let blank = if tone.invert { "black" } else { "white" };
        return Err(error::value(format!("image is {blank}, which leaves no place for dots")));
    }
    let dots = work::run(py, move |stop| {
        let mut dots = if exact {
            exact_dots(copied(&image)?, n, seed)?
        } else {
            dots(copied(&image)?, n, seed)?
        };
        if refine > 0 {
            refined(&image, &mut dots, refine, best, stop)?;
        }
        Ok(dots.iter().map(|dot| dot.as_vec2().to_array()).collect())
    })?;
    output::rows::<f32, 2>(py, dots)
}

/// An image for a map, which keeps its pixels.
fn copied((width, height, pixels): &Image) -> PyResult<Image> {
    let mut copy = Vec::new();
    copy.try_reserve_exact(pixels.len()).map_err(|_| error::memory(size_of_val(&pixels[..])))?;
    copy.extend_from_slice(pixels);
    Ok((*width, *height, copy))
}

/// Exactly n dots, relaxed, in the order of the walk.
fn exact_dots((width, height, pixels): Image, n: usize, seed: u64) -> PyResult<Vec<DVec2>> {
    let map = Pixels::new(width, height, pixels, InvalidPixels::Reject)
        .and_then(|pixels| StippleMap::new(pixels, n as f64))
        .map_err(error::map)?;
    let placement = Placement::new(map.domain(), seed);
    let made = exactly_relaxed::<DVec2, _>(&placement, &map, n, Limits::default());
    Ok(made.map_err(error::exact)?.iter().map(|point| point.position).collect())
}

/// About n dots, relaxed, in the order of the walk.
fn dots((width, height, pixels): Image, n: usize, seed: u64) -> PyResult<Vec<DVec2>> {
    let n = n as f64;
    let map = Pixels::new(width, height, pixels, InvalidPixels::Reject)
        .and_then(|pixels| StippleMap::new(pixels, n))
        .map_err(error::map)?;
    let placement = Placement::new(map.domain(), seed);
    let sampling = Sampling::new(&placement, &map, Amount::Points(n)).map_err(error::sampling)?;
    let sampling = sampling.relaxed().map_err(error::sampling)?;
    let mut shards = twelvefold::Shards::<DVec2>::new();
    shards.sample(&sampling).map_err(error::sampling)?;
    let mut dots = Vec::new();
    let bytes = shards.len().saturating_mul(size_of::<DVec2>());
    dots.try_reserve_exact(shards.len()).map_err(|_| error::memory(bytes))?;
    shards.parts().for_each(|part| dots.extend_from_slice(part));
    Ok(dots)
}

/// Moves dots so that they draw the image better, as long as that is wanted.
fn refined(
    (width, height, pixels): &Image,
    dots: &mut [DVec2],
    iterations: u32,
    best: bool,
    stop: &Stop,
) -> PyResult<()> {
    let mut refiner = Refiner::new(*width, *height, pixels, dots).map_err(error::refine)?;
    for _ in 0..iterations {
        if stop.wanted() {
            return Ok(());
        }
        refiner.step();
    }
    if best {
        refiner.polish().map_err(error::refine)?;
    }
    refiner.write(dots).map_err(error::refine)
}
