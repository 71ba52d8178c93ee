//! Numbers, rectangles and names among the arguments.

use glam::DVec2;
use pyo3::prelude::*;
use twelvefold::{Amount, Domain};

use crate::error;

/// Where a point is, or how large: (x, y, width, height).
pub(crate) type Rectangle = (f64, f64, f64, f64);

/// A rectangle as a domain.
pub(crate) fn domain(name: &str, rectangle: Rectangle) -> PyResult<Domain> {
    let (x, y, width, height) = rectangle;
    Domain::new(DVec2::new(x, y), DVec2::new(width, height))
        .map_err(|reason| error::value(format!("{name} is {rectangle:?}: {reason}")))
}

/// A whole number from 0 up.
pub(crate) fn whole<T>(name: &str, number: &Bound<'_, PyAny>, most: T) -> PyResult<T>
where
    T: for<'a, 'py> FromPyObject<'a, 'py, Error = PyErr> + std::fmt::Display + PartialOrd,
{
    let bad = |is: &str| format!("{name} is {is}; it should be a whole number from 0 to {most}");
    let text = || number.repr().map_or_else(|_| "no number".to_owned(), |text| text.to_string());
    let number_of = |index: Bound<'_, PyAny>| index.extract::<T>().ok().filter(|n| *n <= most);
    match number.call_method0("__index__") {
        Ok(index) => number_of(index).ok_or_else(|| error::value(bad(&text()))),
        Err(_) => Err(error::kind(bad(&text()))),
    }
}

/// A seed.
pub(crate) fn seed(number: &Bound<'_, PyAny>) -> PyResult<u64> {
    whole("seed", number, u64::MAX)
}

/// A number of points, all of which are kept.
pub(crate) fn count(number: &Bound<'_, PyAny>) -> PyResult<usize> {
    whole("n", number, 1 << 32)
}

/// About how many points.
pub(crate) fn amount(n: Option<f64>, density: Option<f64>) -> PyResult<Amount> {
    match (n, density) {
        (Some(n), None) => Ok(Amount::Points(n)),
        (None, Some(density)) => Ok(Amount::Density(density)),
        (None, None) => Err(error::value("give n or density")),
        (Some(_), Some(_)) => Err(error::value("give n or density, not both")),
    }
}

/// One of a few words, as what it stands for.
pub(crate) fn choice<T: Copy>(name: &str, word: &str, choices: &[(&str, T)]) -> PyResult<T> {
    match choices.iter().find(|(known, _)| *known == word) {
        Some((_, meaning)) => Ok(*meaning),
        None => {
            let known: Vec<_> = choices.iter().map(|(known, _)| format!("'{known}'")).collect();
            let known = known.join(", ");
            Err(error::value(format!("{name} is '{word}'; it should be one of {known}")))
        }
    }
}
