//! NumPy arrays read as importance, light and lists of points; what is wrong with one is said with its
//! name, its place and its value.

use glam::DVec2;
use numpy::{
    PyArrayDescrMethods as _, PyArrayDyn, PyArrayMethods as _, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods as _,
};
use pyo3::prelude::*;
use twelvefold::{Domain, ImageMap, InvalidPixels, Pixels};

use crate::error;

/// Anything that NumPy takes for an array of real numbers.
pub(crate) struct Numbers<'a, 'py> {
    name: &'a str,
    array: Bound<'py, PyUntypedArray>,
}

impl<'a, 'py> Numbers<'a, 'py> {
    /// Of an argument of this name.
    ///
    /// # Errors
    /// `TypeError` unless it is, or makes, an array of floats, integers or bool without a mask.
    pub(crate) fn new(name: &'a str, argument: &Bound<'py, PyAny>) -> PyResult<Self> {
        if argument.get_type().name()?.to_string_lossy() == "MaskedArray" {
            return Err(error::kind(format!(
                "{name} is a masked array; fill it before: .filled(0)"
            )));
        }
        let numpy = argument.py().import("numpy")?;
        let array = numpy.call_method1("asarray", (argument,))?;
        // Aligned and in this machine's byte order, which nearly every array is already.
        let native = array.getattr("dtype")?.call_method1("newbyteorder", ("=",))?;
        let array = numpy.call_method1("require", (array, native, "A"))?;
        let array = array
            .cast_into::<PyUntypedArray>()
            .map_err(|_| error::kind(format!("{name} is no array of numbers")))?;
        let numbers = Self { name, array };
        match numbers.array.dtype().kind() {
            b'f' | b'i' | b'u' | b'b' => Ok(numbers),
            _ => Err(numbers.of_type("floats, integers or bool are read")),
        }
    }

    pub(crate) fn shape(&self) -> &[usize] {
        self.array.shape()
    }

    /// `TypeError` for its dtype.
    pub(crate) fn of_type(&self, wanted: &str) -> PyErr {
        error::kind(format!("{} has dtype {}; {wanted}", self.name, self.array.dtype()))
    }

    /// `ValueError` for its shape.
    pub(crate) fn of_shape(&self, wanted: &str) -> PyErr {
        let shape = self.array.getattr("shape").map_or_else(|_| String::new(), |s| s.to_string());
        error::value(format!("{} has shape {shape}; it should be {wanted}", self.name))
    }

    /// Its numbers, if they are of exactly this type.
    pub(crate) fn typed<T: numpy::Element>(&self) -> Option<PyReadonlyArrayDyn<'py, T>> {
        self.array.cast::<PyArrayDyn<T>>().ok()?.try_readonly().ok()
    }

    pub(crate) fn is_float_or_bool(&self) -> bool {
        matches!(self.array.dtype().kind(), b'f' | b'b')
    }

    /// Its numbers in double precision.
    pub(crate) fn doubles(&self) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
        let array = self.array.call_method1("astype", ("float64",))?;
        array.extract().map_err(|_| error::kind(format!("{} is no array of numbers", self.name)))
    }

    /// Its whole numbers row by row; those past 63 bits as the greatest.
    ///
    /// # Errors
    /// `TypeError` for another dtype.
    pub(crate) fn integers(&self) -> PyResult<Vec<i64>> {
        let broken = |_| error::kind(format!("{} is no array of numbers", self.name));
        let converted = |dtype: &str| self.array.call_method1("astype", (dtype,));
        match self.array.dtype().kind() {
            b'i' => copied(&converted("int64")?.extract().map_err(broken)?, |number| number),
            b'u' => copied(&converted("uint64")?.extract().map_err(broken)?, |number: u64| {
                i64::try_from(number).unwrap_or(i64::MAX)
            }),
            _ => Err(self.of_type("integers are read")),
        }
    }

    /// Its numbers row by row, as `T`, in one copy if they are stored as one of the usual types.
    pub(crate) fn collect<T: From<f32> + Copy + numpy::Element>(
        &self,
        narrow: fn(f64) -> T,
    ) -> PyResult<Vec<T>> {
        if let Some(array) = self.typed::<T>() {
            return copied(&array, |number| number);
        }
        if let Some(array) = self.typed::<f32>() {
            return copied(&array, T::from);
        }
        if let Some(array) = self.typed::<u8>() {
            return copied(&array, |number| T::from(f32::from(number)));
        }
        match self.typed::<f64>() {
            Some(array) => copied(&array, narrow),
            None => copied(&self.doubles()?, narrow),
        }
    }
}

/// The numbers of an array of any layout, row by row.
pub(crate) fn copied<S: numpy::Element + Copy, T>(
    array: &PyReadonlyArrayDyn<'_, S>,
    convert: impl Fn(S) -> T,
) -> PyResult<Vec<T>> {
    let mut copy = Vec::new();
    let bytes = array.len().saturating_mul(size_of::<T>());
    copy.try_reserve_exact(array.len()).map_err(|_| error::memory(bytes))?;
    match array.as_slice() {
        // A slice of an array stored column by column would be in that order.
        Ok(numbers) if array.is_c_contiguous() => {
            copy.extend(numbers.iter().map(|number| convert(*number)));
        }
        _ => copy.extend(array.as_array().iter().map(|number| convert(*number))),
    }
    Ok(copy)
}

/// An image: width, height and values row by row from the top.
pub(crate) type Image = (usize, usize, Vec<f32>);

/// An array (height, width) as importance.
pub(crate) fn importance(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Image> {
    let numbers = Numbers::new(name, argument)?;
    let &[height, width] = numbers.shape() else {
        return Err(numbers.of_shape("(height, width)"));
    };
    if width == 0 || height == 0 {
        return Err(numbers.of_shape("(height, width), neither of them 0"));
    }
    let pixels = numbers.collect(|number| number as f32)?;
    // Where Python counts: row first.
    if let Some(i) = pixels.iter().position(|pixel| !(*pixel >= 0.0 && pixel.is_finite())) {
        let (row, column, value) = (i / width, i % width, pixels[i]);
        return Err(error::value(format!(
            "{name}[{row}, {column}] is {value} in float32; importance is finite and not negative"
        )));
    }
    Ok((width, height, pixels))
}

/// Importance as the library's map, stretched over a domain.
pub(crate) fn map((width, height, pixels): Image, domain: Domain) -> PyResult<ImageMap> {
    let map = Pixels::new(width, height, pixels, InvalidPixels::Reject)
        .and_then(ImageMap::new)
        .map_err(error::map)?;
    // The same numbers, bit for bit, where this is what it covers already.
    Ok(if map.domain() == domain { map } else { map.over(domain) })
}

/// An array (height, width, 3) as light: width, height and pixels, of any value.
pub(crate) fn light(
    name: &str,
    argument: &Bound<'_, PyAny>,
) -> PyResult<(usize, usize, Vec<[f32; 3]>)> {
    let numbers = Numbers::new(name, argument)?;
    let &[height, width, 3] = numbers.shape() else {
        return Err(numbers.of_shape("(height, width, 3)"));
    };
    if width == 0 || height == 0 {
        return Err(numbers.of_shape("(height, width, 3), none of them 0"));
    }
    let components = numbers.collect(|number| number as f32)?;
    let (pixels, _) = components.as_chunks::<3>();
    Ok((width, height, pixels.to_vec()))
}

/// An array (points, 2) as positions.
pub(crate) fn points(name: &str, argument: &Bound<'_, PyAny>) -> PyResult<Vec<DVec2>> {
    let numbers = Numbers::new(name, argument)?;
    let &[_, 2] = numbers.shape() else {
        return Err(numbers.of_shape("(points, 2)"));
    };
    let coordinates = numbers.collect(|number| number)?;
    if let Some(i) = coordinates.iter().position(|coordinate: &f64| !coordinate.is_finite()) {
        let (point, axis, value) = (i / 2, i % 2, coordinates[i]);
        return Err(error::value(format!(
            "{name}[{point}, {axis}] is {value}; coordinates are finite"
        )));
    }
    let (pairs, _) = coordinates.as_chunks::<2>();
    Ok(pairs.iter().map(|pair| DVec2::from_array(*pair)).collect())
}
