//! The Python door to twelvefold: arrays in, arrays out, and nothing of the sampling itself.
//!
//! Python's lock is released while points are made; between blocks of points Python may interrupt.

mod arrays;

mod environment;
mod error;
mod interrupt;

mod placement;
mod sampling;

use pyo3::prelude::*;

/// The compiled half of the package `twelvefold`; its Python half has the documentation.
#[pymodule]
#[pyo3(name = "_native")]
fn native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<placement::Placement>()?;
    module.add_function(wrap_pyfunction!(sampling::sample, module)?)?;
    module.add_function(wrap_pyfunction!(sampling::exactly, module)?)?;
    module.add_function(wrap_pyfunction!(environment::environment, module)?)
}
