//! Other ways to stipple, as rivals: weighted Voronoi relaxation, its linked variant that finds the number
//! of dots by itself, and error diffusion.
//!
//! Written for comparison: to be right, and not to be fast.

mod dithering;
mod linked;
mod sampled;
mod voronoi;

pub use dithering::floyd_steinberg;
pub use linked::linked_voronoi;
pub use voronoi::weighted_voronoi;

use glam::DVec2;

/// A photograph's darkness, 0 to 1, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Darkness<'a> {
    width: usize,
    height: usize,
    values: &'a [f32],
}

impl<'a> Darkness<'a> {
    /// `None` unless values lie in 0..=1, fill at least one row, and are not all 0.
    #[must_use]
    pub fn new(width: usize, values: &'a [f32]) -> Option<Self> {
        let height = values.len().checked_div(width)?;
        let whole = height > 0 && width * height == values.len();
        let sound = values.iter().all(|value| (0.0..=1.0).contains(value));
        (whole && sound && values.iter().any(|value| *value > 0.0)).then_some(Self {
            width,
            height,
            values,
        })
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.width as f64, self.height as f64)
    }

    fn sum(&self) -> f64 {
        self.values.iter().map(|value| f64::from(*value)).sum()
    }
}
