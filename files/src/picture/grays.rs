//! Pictures of gray samples in memory, many of one kind.

use image::metadata::Orientation;

use super::color::Space;
use super::plane::{Decoded, Plane};
use super::{Alpha, Colors, Picture, PictureError, Tone, Toner, aspect, importance, limits};

/// Turns frames of gray samples into pictures.
#[derive(Debug)]
pub(crate) struct Grays {
    size: (usize, usize),
    /// Width of a pixel over its height.
    aspect: f64,
    /// The importance of each sample.
    levels: Vec<f32>,
}

impl Grays {
    /// For pictures of this size, whose pixels are `aspect` times as wide as high, of samples below `count`; `encoded`
    /// gives the sRGB-encoded gray of a sample, from 0 to 1, beyond which it is cut off.
    ///
    /// # Errors
    /// [`PictureError::Empty`], [`PictureError::TooLarge`].
    pub(crate) fn new(
        size: (usize, usize),
        aspect: f64,
        tone: Tone,
        count: u32,
        encoded: impl Fn(u32) -> f64,
    ) -> Result<Self, PictureError> {
        // The samples, of up to two bytes, are held as well.
        limits::check(size.0, size.1, 2)?;
        let toner = Toner::new::<u16>(tone, Colors::Gray, Alpha::None, Space::default());
        let level = |sample: u32| {
            let gray = (encoded(sample).clamp(0.0, 1.0) * 65535.0).round() as u16;
            toner.importance(&[gray]).unwrap_or(0.0)
        };
        Ok(Self { size, aspect, levels: (0..count).map(level).collect() })
    }

    /// The picture of these samples, row by row from the top, each row from the left; and
    /// samples beyond the last are as the last.
    ///
    /// # Errors
    /// [`PictureError::TooLarge`] if its pixels become too many as they are made square.
    pub(crate) fn picture(
        &self,
        samples: impl Iterator<Item = usize>,
    ) -> Result<Picture, PictureError> {
        let (width, height) = self.size;
        let last = self.levels.last().copied().unwrap_or(0.0);
        let mut plane = Plane::new(self.size, Orientation::NoTransforms, 1.0)?;
        plane.set_aspect(self.aspect);
        for (i, sample) in samples.take(width * height).enumerate() {
            let level = self.levels.get(sample).copied().unwrap_or(last);
            plane.set(i % width, i / width, Some(level));
        }
        let decoded: Decoded<f32> = aspect::squared(plane.finish(None)?)?;
        Ok(importance(decoded))
    }
}
