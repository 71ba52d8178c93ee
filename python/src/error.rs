//! Errors of the library as Python exceptions.

use pyo3::PyErr;
use pyo3::exceptions::{PyMemoryError, PyTypeError, PyValueError};

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
