//! Vectors as NumPy arrays, without a copy.

use numpy::{Element, PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;

/// An array (items, N).
pub(crate) fn rows<'py, T: Element, const N: usize>(
    py: Python<'py>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = rows.len();
    Ok(PyArray1::from_vec(py, rows.into_flattened()).reshape([count, N])?.into_any())
}

/// An array (items,).
pub(crate) fn column<T: Element>(py: Python<'_>, items: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, items).into_any()
}
