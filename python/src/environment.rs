//! Directions towards the light of an environment map.

use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use twelvefold::estimate::{Warp, Weighted, exactly};
use twelvefold::{EnvironmentMap, InvalidPixels, Limits, Placement};

use crate::{arrays, error};

/// Directions, their pdf and radiance; see the package's documentation.
#[pyfunction]
#[pyo3(signature = (map, n, method, seed, negative))]
pub(crate) fn environment<'py>(
    py: Python<'py>,
    map: &Bound<'py, PyAny>,
    n: usize,
    method: &str,
    seed: u64,
    negative: &str,
) -> PyResult<Bound<'py, PyTuple>> {
    let (width, height, pixels) = arrays::light("map", map)?;
    let invalid = match negative {
        "reject" => InvalidPixels::Reject,
        "zero" => InvalidPixels::ZeroNegative,
        _ => {
            return Err(error::value(format!(
                "negative is {negative:?}; it should be 'reject' or 'zero'"
            )));
        }
    };
    let warped = match method {
        "progressive" => false,
        "warp" => true,
        _ => {
            return Err(error::value(format!(
                "method is {method:?}; it should be 'progressive' or 'warp'"
            )));
        }
    };
    let sky =
        py.detach(|| EnvironmentMap::new(width, height, pixels, invalid)).map_err(error::value)?;
    let points = py.detach(|| directions(&sky, n, warped, seed)).map_err(error::value)?;

    let mut columns = (Vec::new(), Vec::new(), Vec::new());
    for point in &points {
        let light = sky.sample(point.position);
        columns.0.extend(light.direction.to_array());
        columns.1.push(light.pdf);
        columns.2.extend(light.radiance);
    }
    let directions = PyArray1::from_vec(py, columns.0).reshape([points.len(), 3])?.into_any();
    let pdf = PyArray1::from_vec(py, columns.1).into_any();
    let radiance = PyArray1::from_vec(py, columns.2).reshape([points.len(), 3])?.into_any();
    PyTuple::new(py, [directions, pdf, radiance])
}

/// Positions in the image.
fn directions(
    sky: &EnvironmentMap,
    n: usize,
    warped: bool,
    seed: u64,
) -> Result<Vec<Weighted>, twelvefold::estimate::ExactError> {
    let importance = sky.importance();
    match Warp::new(importance).filter(|_| warped) {
        Some(warp) => warp.level(n, seed, Limits::default()),
        None => {
            exactly(&Placement::new(importance.domain(), seed), importance, n, Limits::default())
        }
    }
}
