//! Errors of the library as Python exceptions: `MemoryError` where memory is short, `ValueError` else.

use pyo3::PyErr;
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyTypeError, PyValueError};
use twelvefold::estimate::ExactError;
use twelvefold::refine::RefineError;
use twelvefold::{MapError, SamplingError};

/// A value that cannot be used: `ValueError`, with the library's own sentence.
pub(crate) fn value(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An argument of the wrong kind: `TypeError`.
pub(crate) fn kind(message: impl Into<String>) -> PyErr {
    PyTypeError::new_err(message.into())
}

/// No memory for this many bytes: `MemoryError`.
pub(crate) fn memory(bytes: usize) -> PyErr {
    PyMemoryError::new_err(format!("{bytes} bytes are needed"))
}

/// What only a mistake in this package can cause: `RuntimeError`.
pub(crate) fn internal(message: &'static str) -> PyErr {
    PyRuntimeError::new_err(message)
}

pub(crate) fn sampling(error: SamplingError) -> PyErr {
    match error {
        SamplingError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        _ => value(error),
    }
}

pub(crate) fn exact(error: ExactError) -> PyErr {
    match error {
        ExactError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        ExactError::Sampling(error) => sampling(error),
        _ => value(error),
    }
}

pub(crate) fn map(error: MapError) -> PyErr {
    match error {
        MapError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        _ => value(error),
    }
}

pub(crate) fn refine(error: RefineError) -> PyErr {
    match error {
        RefineError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        _ => value(error),
    }
}
