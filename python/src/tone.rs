//! From a picture's brightness to importance, as the program reads files of the same numbers: darkness from 0
//! to 1, Rec. 709 weights of colors, transparent parts as paper.

use pyo3::prelude::*;

use crate::arrays::{self, Image, Numbers};
use crate::error;

/// Rec. 709 weights of red, green and blue.
const WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// What is made of brightness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tone {
    /// Dots follow light, of which the numbers are the sRGB code, and not the numbers.
    pub(crate) linear: bool,
    /// Dots where it is light.
    pub(crate) invert: bool,
    /// What counts as black and as white, in the array's own numbers; white is the largest unless it is
    /// said.
    pub(crate) black: f64,
    pub(crate) white: Option<f64>,
    /// Brightness is raised to one over this.
    pub(crate) gamma: f64,
}

/// Brightness stretched from between two fractions of full brightness, and its middle moved.
#[derive(Clone, Copy, Debug)]
struct Levels {
    black: f64,
    white: f64,
    gamma: f64,
}

impl Tone {
    /// The levels for an array of which `full` is the largest number; none if they change nothing.
    fn levels(&self, full: f64) -> PyResult<Option<Levels>> {
        let white = self.white.unwrap_or(full);
        for (name, level) in [("black", self.black), ("white", white)] {
            if !(0.0..=full).contains(&level) {
                return Err(error::value(format!(
                    "{name} is {level}; brightness in this image is from 0 to {full}"
                )));
            }
        }
        let (black, gamma) = (self.black, self.gamma);
        if black >= white {
            return Err(error::value(format!("black is {black}, not below white, {white}")));
        }
        if !(gamma > 0.0 && gamma.is_finite()) {
            return Err(error::value(format!("gamma is {gamma}; it should be above 0 and finite")));
        }
        let plain = black == 0.0 && white == full && gamma == 1.0;
        Ok((!plain).then_some(Levels { black: black / full, white: white / full, gamma }))
    }
}

/// An array (height, width), or (height, width, channels) of gray and coverage, of colors, or of colors and
/// coverage, as the importance of dark parts; of light ones, if inverted.
pub(crate) fn importance(name: &str, argument: &Bound<'_, PyAny>, tone: Tone) -> PyResult<Image> {
    let numbers = Numbers::new(name, argument)?;
    let (height, width, channels) = match *numbers.shape() {
        [height, width] => (height, width, 1),
        [height, width, channels @ 2..=4] => (height, width, channels),
        _ => return Err(numbers.of_shape("(height, width), or (…, 2), (…, 3) or (…, 4)")),
    };
    if width == 0 || height == 0 {
        return Err(numbers.of_shape("an image with pixels"));
    }
    let (fractions, full) = if let Some(array) = numbers.typed::<u8>() {
        (arrays::copied(&array, |level| f64::from(level) / 255.0)?, Some(255))
    } else if let Some(array) = numbers.typed::<u16>() {
        (arrays::copied(&array, |level| f64::from(level) / 65535.0)?, Some(65535))
    } else if numbers.is_float_or_bool() {
        (arrays::copied(&numbers.doubles()?, |fraction| fraction)?, None)
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
    let toner = Toner {
        invert: tone.invert,
        levels: tone.levels(full.map_or(1.0, f64::from))?,
        light: if tone.linear { Some(Light::of(full)) } else { None },
    };
    let mut pixels = Vec::new();
    let count = width * height;
    pixels.try_reserve_exact(count).map_err(|_| error::memory(count.saturating_mul(4)))?;
    pixels.extend(fractions.chunks_exact(channels).map(|pixel| toner.importance(pixel)));
    Ok((width, height, pixels))
}

/// Turns pixels into importance.
struct Toner {
    invert: bool,
    levels: Option<Levels>,
    light: Option<Light>,
}

impl Toner {
    /// Of a gray pixel or of red, green and blue, and perhaps of coverage over paper: white, or black when
    /// dots are white.
    fn importance(&self, pixel: &[f64]) -> f32 {
        let (colors, alpha) = match *pixel {
            [_, alpha] | [_, _, _, alpha] => (&pixel[..pixel.len() - 1], Some(alpha)),
            _ => (pixel, None),
        };
        let mean = |shown: &dyn Fn(f64) -> f64| match *colors {
            [gray] => shown(gray),
            [red, green, blue] => {
                WEIGHTS[0] * shown(red) + WEIGHTS[1] * shown(green) + WEIGHTS[2] * shown(blue)
            }
            _ => 0.0,
        };
        // Rounded to f32 first, white is exactly 1 and deserves exactly no dots.
        let importance = |brightness: f64| {
            let brightness = (brightness as f32).min(1.0);
            if self.invert { brightness } else { 1.0 - brightness }
        };
        if let Some(levels) = self.levels {
            let brightness = mean(&|value| self.working(value));
            let [black, white] = [levels.black, levels.white].map(|level| self.exact(level));
            let stretched = ((brightness - black) / (white - black)).clamp(0.0, 1.0);
            let gamma = levels.gamma;
            let leveled = if gamma == 1.0 { stretched } else { libm::pow(stretched, 1.0 / gamma) };
            return importance(leveled) * alpha.unwrap_or(1.0) as f32;
        }
        let Some(alpha) = alpha else { return importance(mean(&|value| self.working(value))) };
        let paper = if self.invert { 0.0 } else { 1.0 - alpha };
        importance(mean(&|value| (self.working(value) * alpha + paper).min(1.0)))
    }

    /// A number of the image in the space that is followed.
    fn working(&self, value: f64) -> f64 {
        self.light.as_ref().map_or(value, |light| light.of_pixel(value))
    }

    /// Any other number in that space.
    fn exact(&self, value: f64) -> f64 {
        if self.light.is_some() { decode(value) } else { value }
    }
}

/// The light of encoded numbers: looked up where there are few of them.
enum Light {
    Levels { top: f64, table: Vec<f64> },
    Fractions,
}

impl Light {
    /// Of an image of whole numbers up to `full`, or of fractions.
    fn of(full: Option<u16>) -> Self {
        match full {
            None => Self::Fractions,
            Some(full) => {
                let top = f64::from(full);
                let table = (0..=full).map(|level| decode(f64::from(level) / top)).collect();
                Self::Levels { top, table }
            }
        }
    }

    fn of_pixel(&self, fraction: f64) -> f64 {
        match self {
            Self::Fractions => decode(fraction),
            Self::Levels { top, table } => {
                let level = (fraction * top + 0.5) as usize;
                table.get(level).copied().unwrap_or(1.0)
            }
        }
    }
}

/// The light of a number encoded as in sRGB (IEC 61966-2-1).
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}
