//! Points of a density: `sample`, and exactly n of them: `exactly`.

use glam::{DVec2, Vec2};
use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use twelvefold::estimate::{self, Weighting};
use twelvefold::{Amount, Constant, Domain, Importance, Limits, Position, Sampling, SamplingError};

use crate::interrupt::{self, Stop};
use crate::{arrays, error};

/// Points between two looks for an interrupt: some ten milliseconds.
const BLOCK: f64 = 1_000_000.0;

/// What is wanted of a call of `sample`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wish {
    pub(crate) amount: Amount,
    pub(crate) relaxed: bool,
    pub(crate) double: bool,
    pub(crate) weights: bool,
    /// Part i of n.
    pub(crate) part: Option<(usize, usize)>,
}

impl Wish {
    /// The wish that Python's arguments say.
    ///
    /// # Errors
    /// `ValueError` for both amounts or none, an unknown dtype, and weights of relaxed points.
    pub(crate) fn new(
        (n, density): (Option<f64>, Option<f64>),
        relaxed: bool,
        dtype: &Bound<'_, PyAny>,
        weights: bool,
        part: Option<(usize, usize)>,
    ) -> PyResult<Self> {
        let amount = match (n, density) {
            (Some(n), None) => Amount::Points(n),
            (None, Some(density)) => Amount::Density(density),
            _ => return Err(error::value("give n or density, and not both")),
        };
        let name: String = dtype
            .py()
            .import("numpy")?
            .call_method1("dtype", (dtype,))?
            .getattr("name")?
            .extract()?;
        let double = match name.as_str() {
            "float32" => false,
            "float64" => true,
            _ => {
                return Err(error::value(format!(
                    "dtype is {name}; it should be float32 or float64"
                )));
            }
        };
        if weights && relaxed {
            return Err(error::value(
                "relaxed points have no unbiased weights: pass relaxed=False",
            ));
        }
        if weights && part.is_some() {
            return Err(error::value("weights are for the whole set: pass no part"));
        }
        Ok(Self { amount, relaxed, double, weights, part })
    }
}

/// Points on `importance` (an array, or nothing for uniform density); see the package's documentation.
#[pyfunction]
#[pyo3(signature = (importance, n, density, relaxed, domain, seed, dtype, weights, part))]
#[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
pub(crate) fn sample<'py>(
    py: Python<'py>,
    importance: Option<&Bound<'py, PyAny>>,
    n: Option<f64>,
    density: Option<f64>,
    relaxed: bool,
    domain: Option<(f64, f64, f64, f64)>,
    seed: u64,
    dtype: &Bound<'py, PyAny>,
    weights: bool,
    part: Option<(usize, usize)>,
) -> PyResult<Bound<'py, PyAny>> {
    let wish = Wish::new((n, density), relaxed, dtype, weights, part)?;
    let domain = domain.map(arrays::domain).transpose()?;
    match importance {
        None => {
            let domain = domain.unwrap_or(Domain::unit());
            let placement = twelvefold::Placement::new(domain, seed);
            receive(py, &placement, &Constant::ONE, wish)
        }
        Some(array) => {
            let map = arrays::map("importance", array, domain)?;
            let placement = twelvefold::Placement::new(map.domain(), seed);
            receive(py, &placement, &map, wish)
        }
    }
}

/// Makes the points of a wish, with Python's lock released.
pub(crate) fn receive<'py, I: Importance + Sync>(
    py: Python<'py>,
    placement: &twelvefold::Placement<'_>,
    importance: &I,
    wish: Wish,
) -> PyResult<Bound<'py, PyAny>> {
    let sampling = Sampling::new(placement, importance, wish.amount).map_err(error::value)?;
    let sampling = if wish.relaxed { sampling.relaxed().map_err(error::value)? } else { sampling };
    if wish.weights {
        let made = interrupt::run(py, |stop| weighted(&sampling, stop))?.map_err(error::value)?;
        let (points, weights): (Vec<DVec2>, Vec<f64>) = made.into_iter().unzip();
        let points = if wish.double {
            pairs64(py, &points)?
        } else {
            pairs32(py, points.iter().map(|p| p.as_vec2()))?
        };
        let weights = PyArray1::from_vec(py, weights).into_any();
        return Ok(PyTuple::new(py, [points, weights])?.into_any());
    }
    if wish.double {
        let points: Vec<DVec2> = interrupt::run(py, |stop| collect(&sampling, wish.part, stop))??;
        pairs64(py, &points)
    } else {
        let points: Vec<Vec2> = interrupt::run(py, |stop| collect(&sampling, wish.part, stop))??;
        pairs32(py, points.into_iter())
    }
}

/// All points of a sampling, or of one of its parts, in the order of the walk.
fn collect<I: Importance, P: Position>(
    sampling: &Sampling<'_, I>,
    part: Option<(usize, usize)>,
    stop: &Stop,
) -> PyResult<Vec<P>> {
    // Pieces of the part: their points, one piece after the other, are the part's.
    let expected = sampling.expected_points().unwrap_or(BLOCK);
    let (index, of) = part.unwrap_or((0, 1));
    if index >= of {
        return Err(error::value(SamplingError::Shard { index, of }));
    }
    let pieces = (expected / of as f64 / BLOCK).ceil().clamp(1.0, 65_536.0) as usize;
    let mut points: Vec<P> = Vec::new();
    for piece in index * pieces..(index + 1) * pieces {
        if stop.wanted() {
            break;
        }
        let sampling = sampling.shard(piece, of * pieces).map_err(error::value)?;
        let mut room = (1.1 * expected / (of * pieces) as f64) as usize + 64;
        let start = points.len();
        loop {
            points.try_reserve(room).map_err(|_| error::memory(room * size_of::<P>()))?;
            points.resize(start + room, P::default());
            let filled = sampling.fill(&mut points[start..]).map_err(error::value)?;
            points.truncate(start + filled.written);
            if filled.complete {
                break;
            }
            room *= 2;
        }
    }
    Ok(points)
}

/// All points with their weights.
fn weighted<I: Importance>(
    sampling: &Sampling<'_, I>,
    stop: &Stop,
) -> Result<Vec<(DVec2, f64)>, SamplingError> {
    let mut made = Vec::new();
    for point in sampling.weighted(Weighting::Density)? {
        if made.len() % 65_536 == 0 && stop.wanted() {
            break;
        }
        let point = point?;
        made.push((point.position, point.weight));
    }
    Ok(made)
}

/// Exactly n points in progressive order; see the package's documentation.
#[pyfunction]
#[pyo3(signature = (importance, n, domain, seed))]
pub(crate) fn exactly<'py>(
    py: Python<'py>,
    importance: Option<&Bound<'py, PyAny>>,
    n: usize,
    domain: Option<(f64, f64, f64, f64)>,
    seed: u64,
) -> PyResult<Bound<'py, PyAny>> {
    let domain = domain.map(arrays::domain).transpose()?;
    let limits = Limits::default();
    let made = match importance {
        None => {
            let placement = twelvefold::Placement::new(domain.unwrap_or(Domain::unit()), seed);
            py.detach(|| estimate::exactly(&placement, &Constant::ONE, n, limits))
        }
        Some(array) => {
            let map = arrays::map("importance", array, domain)?;
            let placement = twelvefold::Placement::new(map.domain(), seed);
            py.detach(|| estimate::exactly(&placement, &map, n, limits))
        }
    };
    let made = made.map_err(error::value)?;
    let points: Vec<DVec2> = made.iter().map(|point| point.position).collect();
    let weights: Vec<f64> = made.iter().map(|point| point.weight).collect();
    let weights = PyArray1::from_vec(py, weights).into_any();
    Ok(PyTuple::new(py, [pairs64(py, &points)?, weights])?.into_any())
}

/// Positions as an array [points, 2] of `float64`.
pub(crate) fn pairs64<'py>(py: Python<'py>, points: &[DVec2]) -> PyResult<Bound<'py, PyAny>> {
    let flat: Vec<f64> = points.iter().flat_map(|p| [p.x, p.y]).collect();
    Ok(PyArray1::from_vec(py, flat).reshape([points.len(), 2])?.into_any())
}

/// Positions as an array [points, 2] of `float32`.
pub(crate) fn pairs32<'py>(
    py: Python<'py>,
    points: impl ExactSizeIterator<Item = Vec2>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = points.len();
    let flat: Vec<f32> = points.flat_map(|p| [p.x, p.y]).collect();
    Ok(PyArray1::from_vec(py, flat).reshape([count, 2])?.into_any())
}
