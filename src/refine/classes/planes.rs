//! What is wanted: a plane of pixels for each class.

use alloc::vec::Vec;

use super::super::error::{MOST_CLASSES, RefineError, filled};
use super::super::ink::Ink;

/// How much of each class every pixel wants, and their sum.
#[derive(Clone, Debug)]
pub struct Classes {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) planes: Vec<Vec<f32>>,
    pub(super) total: Vec<f32>,
}

impl Classes {
    /// The most classes.
    pub const MOST: usize = MOST_CLASSES;

    /// Pictures of `width` × `height` pixels, one a class, row by row: importance, 0 where no dot of
    /// the class may be. One unit is the same density of dots in all of them. O(pixels × classes).
    ///
    /// # Errors
    /// No class or more than [`MOST`](Self::MOST); a picture of another size; a pixel that is NaN, infinite or
    /// negative, or whose sum over the classes is infinite; too little memory.
    pub fn new(width: usize, height: usize, planes: Vec<Vec<f32>>) -> Result<Self, RefineError> {
        if planes.is_empty() || planes.len() > Self::MOST {
            return Err(RefineError::Classes { count: planes.len() });
        }
        let mut total = filled(width.saturating_mul(height), 0.0_f32)?;
        for plane in &planes {
            Ink::new(width, height, plane)?;
            for (sum, value) in total.iter_mut().zip(plane) {
                *sum += value;
            }
        }
        Ink::new(width, height, &total)?;
        Ok(Self { width, height, planes, total })
    }

    /// The sum of all classes, row by row: what all dots together should draw, and what points to
    /// begin with should be sampled from.
    #[must_use]
    pub fn total(&self) -> &[f32] {
        &self.total
    }

    /// What every class wants, row by row.
    #[must_use]
    pub fn planes(&self) -> &[Vec<f32>] {
        &self.planes
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }
}
