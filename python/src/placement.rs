//! A placement that is kept across calls: the same seed and domain without finding its place again.

use pyo3::prelude::*;
use twelvefold::Constant;

use crate::arrays;
use crate::sampling::{self, Wish};

/// Where in the tiling a domain lies; see the package's documentation.
#[pyclass(frozen, module = "twelvefold")]
pub(crate) struct Placement {
    inner: twelvefold::Placement<'static>,
    seed: u64,
}

#[pymethods]
impl Placement {
    #[new]
    #[pyo3(signature = (domain = (0.0, 0.0, 1.0, 1.0), seed = 0))]
    fn new(domain: (f64, f64, f64, f64), seed: u64) -> PyResult<Self> {
        let inner = twelvefold::Placement::new(arrays::domain(domain)?, seed);
        Ok(Self { inner, seed })
    }

    /// (x, y, width, height).
    #[getter]
    fn domain(&self) -> (f64, f64, f64, f64) {
        let domain = self.inner.domain();
        (domain.min().x, domain.min().y, domain.size().x, domain.size().y)
    }

    /// The seed.
    #[getter]
    fn seed(&self) -> u64 {
        self.seed
    }

    fn __repr__(&self) -> String {
        format!("Placement(domain={:?}, seed={})", self.domain(), self.seed)
    }

    /// As the function `sample`, of this placement.
    #[pyo3(signature = (importance = None, n = None, *, density = None, relaxed = true, dtype = None, weights = false, part = None))]
    #[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        importance: Option<&Bound<'py, PyAny>>,
        n: Option<f64>,
        density: Option<f64>,
        relaxed: bool,
        dtype: Option<Bound<'py, PyAny>>,
        weights: bool,
        part: Option<(usize, usize)>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let dtype = match dtype {
            Some(dtype) => dtype,
            None => "float32".into_pyobject(py)?.into_any(),
        };
        let wish = Wish::new((n, density), relaxed, &dtype, weights, part)?;
        match importance {
            None => sampling::receive(py, &self.inner, &Constant::ONE, wish),
            Some(array) => {
                let map = arrays::map("importance", array, Some(self.inner.domain()))?;
                sampling::receive(py, &self.inner, &map, wish)
            }
        }
    }
}
