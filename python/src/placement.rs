//! A placement that is kept across calls, and the two functions that use one or make their own.

use std::sync::Arc;

use glam::DVec2;
use pyo3::prelude::*;
use twelvefold::{Constant, Domain};

use crate::sampling::{self, Wish};
use crate::{arguments, arrays, error, exact};

/// Where in the tiling a domain lies; the package's Python half gives it methods.
#[pyclass(frozen, module = "twelvefold._native")]
pub(crate) struct Placement {
    inner: Arc<twelvefold::Placement<'static>>,
}

#[pymethods]
impl Placement {
    #[new]
    fn new(
        domain: &Bound<'_, PyAny>,
        seed: &Bound<'_, PyAny>,
        density: Option<&Bound<'_, PyAny>>,
        seamless: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let domain = arguments::domain("domain", domain)?;
        let seed = arguments::seed(seed)?;
        let seamless = arguments::flag("seamless", seamless)?;
        let inner = match arguments::number("density", density)? {
            None => made(domain, seed, seamless)?,
            Some(density) if seamless => {
                return Err(error::value(format!(
                    "density is {density}, but the levels of a seamless placement are settled: \
                     give one of the two"
                )));
            }
            Some(density) => twelvefold::Placement::aligned(domain, seed, density)
                .map_err(|reason| error::value(format!("density is {density}: {reason}")))?,
        };
        Ok(Self { inner: Arc::new(inner) })
    }

    #[getter]
    fn domain(&self) -> (f64, f64, f64, f64) {
        let domain = self.inner.domain();
        (domain.min().x, domain.min().y, domain.size().x, domain.size().y)
    }
}

/// A domain's placement, with a border or without one.
fn made(domain: Domain, seed: u64, seamless: bool) -> PyResult<twelvefold::Placement<'static>> {
    if seamless {
        twelvefold::Placement::seamless(domain, seed).map_err(error::sampling)
    } else {
        Ok(twelvefold::Placement::new(domain, seed))
    }
}

/// A placement to use, or what one is made of.
struct Place<'a, 'py> {
    kept: Option<&'a Bound<'py, Placement>>,
    domain: Option<Domain>,
    seed: u64,
    seamless: bool,
}

impl<'a, 'py> Place<'a, 'py> {
    fn new(
        kept: Option<&'a Bound<'py, Placement>>,
        domain: Option<&Bound<'_, PyAny>>,
        seed: &Bound<'_, PyAny>,
        seamless: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let domain = domain.map(|domain| arguments::domain("domain", domain)).transpose()?;
        let domain = kept.map(|kept| kept.get().inner.domain()).or(domain);
        let seed = arguments::seed(seed)?;
        Ok(Self { kept, domain, seed, seamless: arguments::flag("seamless", seamless)? })
    }

    /// The placement, of this domain if none is given.
    fn placement(&self, of_importance: Domain) -> PyResult<Arc<twelvefold::Placement<'static>>> {
        match self.kept {
            Some(kept) => Ok(Arc::clone(&kept.get().inner)),
            None => {
                let domain = self.domain.unwrap_or(of_importance);
                Ok(Arc::new(made(domain, self.seed, self.seamless)?))
            }
        }
    }
}

/// The domain of an image's own pixels.
fn pixels((width, height, _): &arrays::Image) -> PyResult<Domain> {
    Domain::new(DVec2::ZERO, DVec2::new(*width as f64, *height as f64)).map_err(error::value)
}

/// Points on `importance` (an array, or nothing for uniform density); see the package's documentation.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python's keywords, each by its name")]
pub(crate) fn sample<'py>(
    py: Python<'py>,
    kept: Option<&Bound<'py, Placement>>,
    domain: Option<&Bound<'py, PyAny>>,
    seed: &Bound<'py, PyAny>,
    seamless: &Bound<'py, PyAny>,
    importance: Option<&Bound<'py, PyAny>>,
    n: Option<&Bound<'py, PyAny>>,
    density: Option<&Bound<'py, PyAny>>,
    relaxed: &Bound<'py, PyAny>,
    double: bool,
    weights: &Bound<'py, PyAny>,
    ranks: &Bound<'py, PyAny>,
    part: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let amount = arguments::amount(n, density)?;
    let part = part.map(arguments::part).transpose()?;
    let wish = Wish {
        amount,
        relaxed: arguments::flag("relaxed", relaxed)?,
        double,
        weights: arguments::flag("weights", weights)?,
        ranks: arguments::flag("ranks", ranks)?,
        part,
    }
    .check()?;
    let place = Place::new(kept, domain, seed, seamless)?;
    match importance {
        None => sampling::receive(py, place.placement(Domain::UNIT)?, || Ok(Constant::ONE), wish),
        Some(array) => {
            let image = arrays::importance("importance", array)?;
            let placement = place.placement(pixels(&image)?)?;
            let domain = placement.domain();
            sampling::receive(py, placement, move || arrays::map(image, domain), wish)
        }
    }
}

/// Exactly n points in progressive order; see the package's documentation.
#[pyfunction]
pub(crate) fn exactly<'py>(
    py: Python<'py>,
    kept: Option<&Bound<'py, Placement>>,
    domain: Option<&Bound<'py, PyAny>>,
    seed: &Bound<'py, PyAny>,
    seamless: &Bound<'py, PyAny>,
    importance: Option<&Bound<'py, PyAny>>,
    n: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let n = arguments::count(n)?;
    let place = Place::new(kept, domain, seed, seamless)?;
    match importance {
        None => exact::receive(py, place.placement(Domain::UNIT)?, || Ok(Constant::ONE), n),
        Some(array) => {
            let image = arrays::importance("importance", array)?;
            let placement = place.placement(pixels(&image)?)?;
            let domain = placement.domain();
            exact::receive(py, placement, move || arrays::map(image, domain), n)
        }
    }
}
