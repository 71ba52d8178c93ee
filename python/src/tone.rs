//! From a picture's brightness to importance, as the program reads files of the same numbers: darkness from 0
//! to 1, Rec. 709 weights of colors, transparent parts as paper.

use pyo3::prelude::*;

use crate::arrays::{self, Image, Numbers};
use crate::error;

/// Rec. 709 weights of red, green and blue.
const WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// An array (height, width), (height, width, 3) or (height, width, 4) of brightness as the importance of
/// dark parts; of light ones, if inverted.
pub(crate) fn importance(name: &str, argument: &Bound<'_, PyAny>, invert: bool) -> PyResult<Image> {
    let numbers = Numbers::new(name, argument)?;
    let (height, width, channels) = match *numbers.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels @ (3 | 4)] => (height, width, channels),
        _ => return Err(numbers.of_shape("(height, width), or (…, 3) or (…, 4) of colors")),
    };
    if width == 0 || height == 0 {
        return Err(numbers.of_shape("an image with pixels"));
    }
    let fractions = if let Some(array) = numbers.typed::<u8>() {
        arrays::copied(&array, |level| f64::from(level) / 255.0)?
    } else if let Some(array) = numbers.typed::<u16>() {
        arrays::copied(&array, |level| f64::from(level) / 65535.0)?
    } else if numbers.is_float_or_bool() {
        arrays::copied(&numbers.doubles()?, |fraction| fraction)?
    } else {
        return Err(numbers.of_type("uint8, uint16, floats from 0 to 1 and bool are read"));
    };
    if let Some(i) = fractions.iter().position(|fraction| !(0.0..=1.0).contains(fraction)) {
        let (pixel, channel, value) = (i / channels, i % channels, fractions[i]);
        let (row, column) = (pixel / width, pixel % width);
        let channel = if channels == 1 { String::new() } else { format!(", {channel}") };
        return Err(error::value(format!(
            "{name}[{row}, {column}{channel}] is {value}; brightness is from 0 to 1"
        )));
    }
    let mut pixels = Vec::new();
    let count = width * height;
    pixels.try_reserve_exact(count).map_err(|_| error::memory(count.saturating_mul(4)))?;
    pixels.extend(fractions.chunks_exact(channels).map(|pixel| {
        // Rounded to f32 first, white is exactly 1 and deserves exactly no dots.
        let brightness = brightness(pixel, invert) as f32;
        if invert { brightness.min(1.0) } else { 1.0 - brightness.min(1.0) }
    }));
    Ok((width, height, pixels))
}

/// The brightness of a gray pixel, or of red, green, blue and, perhaps, coverage over paper: white, or black
/// when dots are white.
fn brightness(pixel: &[f64], invert: bool) -> f64 {
    let paper = |alpha: f64| if invert { 0.0 } else { 1.0 - alpha };
    let mean =
        |[red, green, blue]: [f64; 3]| WEIGHTS[0] * red + WEIGHTS[1] * green + WEIGHTS[2] * blue;
    match *pixel {
        [gray] => gray,
        [red, green, blue] => mean([red, green, blue]),
        [red, green, blue, alpha] => {
            mean([red, green, blue].map(|value| value * alpha + paper(alpha)))
        }
        _ => 0.0,
    }
}
