//! How even points are.

use glam::DVec2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use twelvefold_lab::measure::discrepancy;
use twelvefold_lab::measure::nearest::{self, Summary};
use twelvefold_lab::measure::{MeasureError, Window, fidelity, hexagonal_distance, spectrum};

use crate::arrays::{self, Image};
use crate::{arguments, error, work};

/// The most points of which the low-frequency power, O(n²), is computed: some seconds.
const SPECTRUM_LIMIT: usize = 65_536;

type Table = Vec<(&'static str, f64)>;

/// Measures of points; see the package's documentation.
#[pyfunction]
pub(crate) fn measure<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    window: Option<&Bound<'py, PyAny>>,
    importance: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let points = arrays::points("points", points)?;
    let image =
        importance.map(|importance| arrays::importance("importance", importance)).transpose()?;
    let (x, y, width, height) = match (window, &image) {
        (Some(window), _) => arguments::rectangle("window", window)?,
        (None, Some((width, height, _))) => (0.0, 0.0, *width as f64, *height as f64),
        (None, None) => (0.0, 0.0, 1.0, 1.0),
    };
    let window = Window::new(DVec2::new(x, y), DVec2::new(width, height)).map_err(error::value)?;
    let table = work::run(py, move |_| {
        let mut table = evenness(&points, window)?;
        if let Some(image) = &image {
            table.extend(fidelity_to(image, &points)?);
        }
        Ok(table)
    })?;
    let dict = PyDict::new(py);
    for (name, value) in table {
        dict.set_item(name, value)?;
    }
    Ok(dict)
}

/// The measures that take the density as constant.
fn evenness(points: &[DVec2], window: Window) -> PyResult<Table> {
    let inside: Vec<DVec2> = points.iter().copied().filter(|p| window.contains(*p)).collect();
    if inside.len() < 2 {
        let (all, inside) = (points.len(), inside.len());
        return Err(error::value(format!(
            "points has {all} points, {inside} of them in the window; two are needed"
        )));
    }
    let unit: Vec<DVec2> = inside.iter().map(|p| (*p - window.min()) / window.size()).collect();
    let star = discrepancy::star(&unit).map_err(error::value)?;
    let hexagonal = hexagonal_distance(inside.len() as f64 / window.area());
    let distances = nearest::distances(points, &inside).map_err(error::value)?;
    let distances = distances.iter().map(|distance| distance / hexagonal).collect();
    let distances = Summary::new(distances).map_err(error::value)?;
    let mut table = vec![
        ("points", inside.len() as f64),
        ("star_discrepancy_at_least", star.lower),
        ("star_discrepancy_at_most", star.upper),
        ("l2_star_discrepancy", discrepancy::l2_star(&unit).map_err(error::value)?),
        ("nearest_least", distances.least()),
        ("nearest_first_percentile", distances.percentile(0.01)),
        ("nearest_mean", distances.mean()),
    ];
    // Short lists and narrow windows have none.
    if inside.len() <= SPECTRUM_LIMIT
        && let Ok(power) = spectrum::low_frequency_power(points, window)
    {
        table.push(("low_frequency_power", power));
    }
    Ok(table)
}

/// How well points follow an importance.
fn fidelity_to((width, _, pixels): &Image, points: &[DVec2]) -> PyResult<Table> {
    let found = fidelity::Raster::new(*width, pixels)
        .and_then(|raster| fidelity::fidelity(points, &raster));
    match found {
        Ok(found) => Ok(vec![
            ("block_variance", found.block_variance),
            ("local_nearest_mean", found.mean_distance),
            ("local_nearest_first_percentile", found.first_percentile),
        ]),
        // A short list, or an image of nothing, has the other measures.
        Err(MeasureError::TooFew { .. } | MeasureError::AllZero) => Ok(Vec::new()),
        Err(reason) => Err(error::value(reason)),
    }
}
