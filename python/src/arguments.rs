//! Numbers, rectangles and names among the arguments.

use glam::DVec2;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use twelvefold::{Amount, Domain};

use crate::error;

/// An argument as it is written in Python.
fn shown(argument: &Bound<'_, PyAny>) -> String {
    argument.repr().map_or_else(|_| "unreadable".to_owned(), |text| text.to_string())
}

/// An argument of a simple type.
fn simple<'py, T: FromPyObjectOwned<'py>>(
    name: &str,
    argument: &Bound<'py, PyAny>,
    wanted: &str,
) -> PyResult<T> {
    argument
        .extract()
        .map_err(|_| error::kind(format!("{name} is {}; it should be {wanted}", shown(argument))))
}

/// True or False.
pub(crate) fn flag(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<bool> {
    simple(name, argument, "True or False")
}

/// A number, or nothing.
pub(crate) fn number(name: &str, argument: Option<&Bound<'_, PyAny>>) -> PyResult<Option<f64>> {
    argument.map(|argument| given(name, argument)).transpose()
}

/// A number that is there.
pub(crate) fn given(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<f64> {
    simple(name, argument, "a number")
}

/// The items of a sequence of this length: a tuple, a list, an array.
fn items<'py, const N: usize>(
    name: &str,
    wanted: &str,
    sequence: &Bound<'py, PyAny>,
) -> PyResult<[Bound<'py, PyAny>; N]> {
    let bad = || error::kind(format!("{name} should be {wanted}"));
    let items: Vec<_> =
        sequence.try_iter().map_err(|_| bad())?.take(N + 1).collect::<PyResult<_>>()?;
    items.try_into().map_err(|_| bad())
}

/// (x, y, width, height).
pub(crate) type Rectangle = (f64, f64, f64, f64);

pub(crate) fn rectangle(name: &str, sequence: &Bound<'_, PyAny>) -> PyResult<Rectangle> {
    let wanted = "four numbers (x, y, width, height)";
    let items = items::<4>(name, wanted, sequence)?;
    let number = |item: &Bound<'_, PyAny>| {
        item.extract::<f64>().map_err(|_| error::kind(format!("{name} should be {wanted}")))
    };
    Ok((number(&items[0])?, number(&items[1])?, number(&items[2])?, number(&items[3])?))
}

/// A rectangle as a domain.
pub(crate) fn domain(name: &str, sequence: &Bound<'_, PyAny>) -> PyResult<Domain> {
    let rectangle = rectangle(name, sequence)?;
    let (x, y, width, height) = rectangle;
    Domain::new(DVec2::new(x, y), DVec2::new(width, height))
        .map_err(|reason| error::value(format!("{name} is {rectangle:?}: {reason}")))
}

/// Part i of how many.
pub(crate) fn part(sequence: &Bound<'_, PyAny>) -> PyResult<(usize, usize)> {
    let [index, of] = items("part", "two whole numbers (i, count)", sequence)?;
    Ok((whole("part[0]", &index, MOST_PARTS)?, whole("part[1]", &of, MOST_PARTS)?))
}

/// More would have no point each of the most that there can be.
const MOST_PARTS: usize = 1 << 32;

/// A whole number from 0 up.
pub(crate) fn whole<T>(name: &str, number: &Bound<'_, PyAny>, most: T) -> PyResult<T>
where
    T: for<'a, 'py> FromPyObject<'a, 'py, Error = PyErr> + std::fmt::Display + PartialOrd,
{
    let bad = |is: &str| format!("{name} is {is}; it should be a whole number from 0 to {most}");
    let number_of = |index: Bound<'_, PyAny>| index.extract::<T>().ok().filter(|n| *n <= most);
    match number.call_method0("__index__") {
        Ok(index) => number_of(index).ok_or_else(|| error::value(bad(&shown(number)))),
        Err(_) => Err(error::kind(bad(&shown(number)))),
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
pub(crate) fn amount(
    n: Option<&Bound<'_, PyAny>>,
    density: Option<&Bound<'_, PyAny>>,
) -> PyResult<Amount> {
    match (number("n", n)?, number("density", density)?) {
        (Some(n), None) => Ok(Amount::Points(n)),
        (None, Some(density)) => Ok(Amount::Density(density)),
        (None, None) => Err(error::value("give n or density")),
        (Some(_), Some(_)) => Err(error::value("give n or density, not both")),
    }
}

/// One of a few words, as what it stands for.
pub(crate) fn choice<T: Copy>(
    name: &str,
    word: &Bound<'_, PyAny>,
    choices: &[(&str, T)],
) -> PyResult<T> {
    let word: String = simple(name, word, "a word")?;
    match choices.iter().find(|(known, _)| **known == word) {
        Some((_, meaning)) => Ok(*meaning),
        None => {
            let known: Vec<_> = choices.iter().map(|(known, _)| format!("'{known}'")).collect();
            let known = known.join(", ");
            Err(error::value(format!("{name} is '{word}'; it should be one of {known}")))
        }
    }
}
