//! Dots that draw a picture.

use std::ops::Range;

use glam::DVec2;
use pyo3::prelude::*;
use twelvefold::estimate::{exactly, exactly_relaxed};
use twelvefold::refine::Refiner;
use twelvefold::{
    Amount, ImageMap, Importance, InvalidPixels, Limits, Mosaic, Pixels, Placement, Sampling,
    SamplingError, StippleMap,
};

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
    relaxed: &Bound<'py, PyAny>,
    seed: &Bound<'py, PyAny>,
    part: Option<&Bound<'py, PyAny>>,
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
    let relaxed = arguments::flag("relaxed", relaxed)?;
    let part = part.map(arguments::part).transpose()?;
    if let Some((index, of)) = part {
        if refine > 0 || exact || !relaxed {
            return Err(error::value(
                "parts are of dots that are neither refined nor exact nor on fixed centers: give refine=0",
            ));
        }
        if index >= of {
            return Err(error::sampling(SamplingError::Part { index, of }));
        }
    }
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
        let mut dots = if relaxed && !exact {
            in_cells(&image, n, seed, part.unwrap_or((0, 1)), stop)?
        } else {
            unrefined(copied(&image)?, n, exact, relaxed, seed)?
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

/// The dots of part i, from 0, of so many, of about n even dots of the image; not all if they are not wanted any
/// more.
fn in_cells(
    image: &Image,
    n: usize,
    seed: u64,
    (index, of): (usize, usize),
    stop: &Stop,
) -> PyResult<Vec<DVec2>> {
    let &(width, height, ref pixels) = image;
    let row_sums: Vec<f64> = pixels.chunks_exact(width).map(Pixels::sum_of_row).collect();
    let mean = Pixels::mean_of_rows(width, &row_sums);
    let mosaic = Mosaic::new((width, height), mean, n as f64).map_err(error::map)?;
    let placement = Placement::new(mosaic.domain(), seed);
    let mut dots = Vec::new();
    for cell in mosaic.part(index, of) {
        if stop.wanted() {
            break;
        }
        let map = cell.map(window(image, cell.columns(), cell.rows())?).map_err(error::map)?;
        let sampling = Sampling::new(&placement, &map, Amount::Points(n as f64));
        let sampling = sampling.and_then(Sampling::relaxed).map_err(error::sampling)?;
        receive(&sampling.clipped(cell.domain()), &mut dots)?;
    }
    Ok(dots)
}

/// The pixels of some columns and rows of an image.
fn window(
    (width, _, pixels): &Image,
    columns: Range<usize>,
    rows: Range<usize>,
) -> PyResult<Pixels> {
    let (across, down) = (columns.len(), rows.len());
    let mut values = Vec::new();
    let bytes = across * down * size_of::<f32>();
    values.try_reserve_exact(across * down).map_err(|_| error::memory(bytes))?;
    for row in pixels.chunks_exact(*width).skip(rows.start).take(down) {
        values.extend(row.iter().skip(columns.start).take(across));
    }
    Pixels::new(across, down, values, InvalidPixels::Reject).map_err(error::map)
}

/// Dots that are exact, or on fixed centers, as the sampling gives them.
fn unrefined(
    (width, height, pixels): Image,
    n: usize,
    exact: bool,
    relaxed: bool,
    seed: u64,
) -> PyResult<Vec<DVec2>> {
    let pixels = Pixels::new(width, height, pixels, InvalidPixels::Reject).map_err(error::map)?;
    if relaxed {
        let map = StippleMap::new(pixels, n as f64).map_err(error::map)?;
        let placement = Placement::new(map.domain(), seed);
        let made = exactly_relaxed(&placement, &map, n, Limits::default());
        return Ok(made.map_err(error::exact)?.iter().map(|dot| dot.position).collect());
    }
    let map = ImageMap::new(pixels).map_err(error::map)?;
    let placement = Placement::new(map.domain(), seed);
    if exact {
        // In progressive order.
        let made = exactly(&placement, &map, n, Limits::default());
        return Ok(made.map_err(error::exact)?.iter().map(|dot| dot.position).collect());
    }
    let sampling = Sampling::new(&placement, &map, Amount::Points(n as f64));
    let mut dots = Vec::new();
    receive(&sampling.map_err(error::sampling)?, &mut dots)?;
    Ok(dots)
}

/// Appends all dots of a sampling.
fn receive<I: Importance + Sync>(
    sampling: &Sampling<'_, I>,
    dots: &mut Vec<DVec2>,
) -> PyResult<()> {
    let mut shards = twelvefold::Shards::<DVec2>::new();
    shards.sample(sampling).map_err(error::sampling)?;
    let bytes = shards.len().saturating_mul(size_of::<DVec2>());
    dots.try_reserve(shards.len()).map_err(|_| error::memory(bytes))?;
    shards.parts().for_each(|part| dots.extend_from_slice(part));
    Ok(())
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
