//! What a pixel becomes: an importance, radiance, or light with its coverage.

use super::color;
use super::sample::{Colors, Sample};
use super::tone::Toner;

/// What a pixel becomes.
pub(super) trait Pixel: Copy {
    /// What a pixel is that the file does not hold: transparent if it has alpha, black if not.
    const NOTHING: Self;
    /// Whether it has a color, not only a tone.
    const COLORED: bool;
    /// From the samples of a pixel, as for [`Toner::importance`].
    fn of<S: Sample>(toner: &Toner, samples: &[S]) -> Option<Self>;
    /// A weighted mean's next term.
    fn plus(self, other: Self, weight: f32) -> Self;
}

impl Pixel for f32 {
    const NOTHING: Self = 0.0;
    const COLORED: bool = false;

    fn of<S: Sample>(toner: &Toner, samples: &[S]) -> Option<Self> {
        toner.importance(samples)
    }

    fn plus(self, other: Self, weight: f32) -> Self {
        self + other * weight
    }
}

/// Radiance: linear red, green and blue as stored, alpha aside.
impl Pixel for [f32; 3] {
    const NOTHING: Self = [0.0; 3];
    const COLORED: bool = true;

    fn of<S: Sample>(toner: &Toner, samples: &[S]) -> Option<Self> {
        let color = match toner.colors {
            Colors::Gray => [samples[0].fraction(); 3],
            _ => [0, 1, 2].map(|i| samples[i].fraction()),
        };
        let color = toner.space.matrix.map_or(color, |matrix| color::apply(&matrix, color));
        Some(color.map(|value| value as f32))
    }

    fn plus(self, other: Self, weight: f32) -> Self {
        [0, 1, 2].map(|i| self[i] + other[i] * weight)
    }
}

/// Linear sRGB light, at least 0, of the covered part of a pixel; and how much of it is covered.
impl Pixel for [f32; 4] {
    const NOTHING: Self = [0.0; 4];
    const COLORED: bool = true;

    fn of<S: Sample>(toner: &Toner, samples: &[S]) -> Option<Self> {
        let (color, alpha) = toner.straight(samples)?;
        let light = |value: f64| if S::FLOAT { value } else { toner.tone.light(value) };
        let [red, green, blue] = color.map(|value| light(value) as f32);
        Some([red, green, blue, alpha as f32])
    }

    fn plus(self, other: Self, weight: f32) -> Self {
        [0, 1, 2, 3].map(|i| self[i] + other[i] * weight)
    }
}
