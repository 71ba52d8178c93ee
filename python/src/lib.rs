//! The Python door to twelvefold: arrays in, arrays out, and nothing of the sampling itself.
//!
//! `arguments`, `arrays` and `tone` read what Python hands in; `work` runs the library without
//! Python's lock and listens for Ctrl-C; `output` hands arrays back. One file for each function between.

mod arguments;
mod arrays;
mod environment;
mod error;
mod exact;
mod measure;
mod mesh;
mod output;
mod placement;
mod sampling;
mod stipple;
mod tone;
mod work;

use pyo3::prelude::*;

/// The compiled half of the package `twelvefold`; its Python half has the documentation.
#[pymodule]
#[pyo3(name = "_native")]
fn native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<placement::Placement>()?;
    module.add_function(wrap_pyfunction!(stipple::stipple, module)?)?;
    module.add_function(wrap_pyfunction!(placement::sample, module)?)?;
    module.add_function(wrap_pyfunction!(placement::exactly, module)?)?;
    module.add_function(wrap_pyfunction!(environment::environment, module)?)?;
    module.add_function(wrap_pyfunction!(mesh::mesh_points, module)?)?;
    module.add_function(wrap_pyfunction!(measure::measure, module)?)
}
