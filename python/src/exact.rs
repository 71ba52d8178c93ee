//! Exactly n points in progressive order, with weights.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use twelvefold::{Importance, Limits, Placement, estimate};

use crate::{error, output, work};

/// n points and their weights as arrays.
pub(crate) fn receive<'py, I: Importance>(
    py: Python<'py>,
    placement: Arc<Placement<'static>>,
    importance: impl FnOnce() -> PyResult<I> + Send + 'static,
    n: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let (points, weights) = work::run(py, move |_| {
        let importance = importance()?;
        let made = estimate::exactly(&placement, &importance, n, Limits::default());
        let made = made.map_err(error::exact)?;
        let points: Vec<[f64; 2]> = made.iter().map(|point| point.position.to_array()).collect();
        let weights: Vec<f64> = made.iter().map(|point| point.weight).collect();
        Ok((points, weights))
    })?;
    let arrays = [output::rows(py, points)?, output::column(py, weights)];
    Ok(PyTuple::new(py, arrays)?.into_any())
}
