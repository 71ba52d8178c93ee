//! NumPy arrays read as importance, light and lists of points; what is wrong with one is said with its
//! name, its place and its value.

use glam::DVec2;
use numpy::{
    PyArrayDescrMethods as _, PyReadonlyArrayDyn, PyUntypedArray, PyUntypedArrayMethods as _,
};
use pyo3::prelude::*;
use twelvefold::{Domain, ImageMap, InvalidPixels};

use crate::error;

/// The numbers of an array of any layout in row-major order, as `f32`, and its shape. Integers are taken
/// as they are; `bool` as 0 and 1.
fn numbers<T>(name: &str, array: &Bound<'_, PyAny>) -> PyResult<(Vec<T>, Vec<usize>)>
where
    T: numpy::Element + Copy,
    for<'a, 'py> PyReadonlyArrayDyn<'py, T>: FromPyObject<'a, 'py>,
{
    let numpy = array.py().import("numpy")?;
    let untyped = numpy.call_method1("asarray", (array,))?;
    let untyped = untyped
        .cast::<PyUntypedArray>()
        .map_err(|_| error::kind(format!("{name} is no array of numbers")))?;
    let sort = untyped.dtype().kind();
    if !matches!(sort, b'f' | b'i' | b'u' | b'b') {
        let dtype = untyped.dtype().to_string();
        return Err(error::kind(format!(
            "{name} has dtype {dtype}; floats, integers or bool are read"
        )));
    }
    let shape = untyped.shape().to_vec();
    let wanted = T::get_dtype(array.py());
    // A copy only where type or layout differ.
    let array = numpy.call_method1("ascontiguousarray", (untyped, wanted))?;
    let array: PyReadonlyArrayDyn<'_, T> =
        array.extract().map_err(|_| error::kind(format!("{name} is no array of numbers")))?;
    let slice = array.as_slice().map_err(error::value)?;
    let mut copy = Vec::new();
    copy.try_reserve_exact(slice.len()).map_err(|_| error::memory(size_of_val(slice)))?;
    copy.extend_from_slice(slice);
    Ok((copy, shape))
}

/// A two-dimensional array [rows, columns] as an image: width, height and pixels row by row from the top.
pub(crate) fn image(name: &str, array: &Bound<'_, PyAny>) -> PyResult<(usize, usize, Vec<f32>)> {
    let (pixels, shape) = numbers::<f32>(name, array)?;
    let [height, width] = shape[..] else {
        return Err(error::value(format!(
            "{name} has shape {shape:?}; it should be (height, width)"
        )));
    };
    if width == 0 || height == 0 {
        return Err(error::value(format!("{name} has shape {shape:?}, and so no pixels")));
    }
    // Where Python counts: row first.
    if let Some(i) = pixels.iter().position(|pixel| !(*pixel >= 0.0 && pixel.is_finite())) {
        let (row, column) = (i / width, i % width);
        return Err(error::value(format!(
            "{name}[{row}, {column}] is {}; importance is finite and not negative",
            pixels[i]
        )));
    }
    Ok((width, height, pixels))
}

/// The same as the library's map, over the image's own pixels or a domain.
pub(crate) fn map(
    name: &str,
    array: &Bound<'_, PyAny>,
    domain: Option<Domain>,
) -> PyResult<ImageMap> {
    let (width, height, pixels) = image(name, array)?;
    let map = ImageMap::new(width, height, pixels, InvalidPixels::Reject).map_err(error::value)?;
    Ok(match domain {
        Some(domain) => map.over(domain),
        None => map,
    })
}

/// A three-dimensional array [rows, columns, 3] as light: width, height and pixels.
pub(crate) fn light(
    name: &str,
    array: &Bound<'_, PyAny>,
) -> PyResult<(usize, usize, Vec<[f32; 3]>)> {
    let (components, shape) = numbers::<f32>(name, array)?;
    let [height, width, 3] = shape[..] else {
        return Err(error::value(format!(
            "{name} has shape {shape:?}; it should be (height, width, 3)"
        )));
    };
    let (pixels, _) = components.as_chunks::<3>();
    Ok((width, height, pixels.to_vec()))
}

/// An array [points, 2] as positions.
pub(crate) fn points(name: &str, array: &Bound<'_, PyAny>) -> PyResult<Vec<DVec2>> {
    let (coordinates, shape) = numbers::<f64>(name, array)?;
    let [_, 2] = shape[..] else {
        return Err(error::value(format!("{name} has shape {shape:?}; it should be (points, 2)")));
    };
    let (pairs, _) = coordinates.as_chunks::<2>();
    if let Some(i) = pairs.iter().position(|pair| !pair.iter().all(|c| c.is_finite())) {
        return Err(error::value(format!("{name}[{i}] is {:?}, which is no place", pairs[i])));
    }
    Ok(pairs.iter().map(|pair| DVec2::from_array(*pair)).collect())
}

/// (x, y, width, height) as a domain.
pub(crate) fn domain((x, y, width, height): (f64, f64, f64, f64)) -> PyResult<Domain> {
    Domain::new(DVec2::new(x, y), DVec2::new(width, height)).map_err(error::value)
}
