//! Pixels that are not square, made square: the longer side of each is divided.

use std::ops::Range;

use super::area::Area;
use super::plane::Decoded;
use super::{PictureError, Pixel, limits};

/// The most that a pixel's sides may differ and count as equal: printers' and scanners' rounding.
const TOLERANCE: f64 = 0.01;

/// The picture with square pixels, each the mean of what it covers.
///
/// # Errors
/// [`PictureError::TooLarge`].
pub(super) fn squared<P: Pixel>(picture: Decoded<P>) -> Result<Decoded<P>, PictureError> {
    let Decoded { width, height, pixels, aspect, range, mut warnings } = picture;
    let squares = Squares::of((width, height), aspect);
    let Some(warning) = squares.warning() else {
        return Ok(Decoded { width, height, pixels, aspect: 1.0, range, warnings });
    };
    let whole = Area::whole(squares.size);
    let pixels = squares.drawn(&whole, &squares.stored(&whole), &pixels)?;
    warnings.push(warning);
    let (width, height) = squares.size;
    Ok(Decoded { width, height, pixels, aspect: 1.0, range, warnings })
}

/// Square pixels and those that they are made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Squares {
    aspect: f64,
    stored: (usize, usize),
    /// How many there are across and down.
    pub(super) size: (usize, usize),
}

impl Squares {
    /// Those of a picture with this many pixels, each `aspect` times as wide as high.
    pub(super) fn of(stored: (usize, usize), aspect: f64) -> Self {
        let (width, height) = stored;
        let stretched =
            |length: usize, factor: f64| ((length as f64 * factor).round() as usize).max(1);
        let size = if (aspect - 1.0).abs() <= TOLERANCE {
            stored
        } else if aspect > 1.0 {
            (stretched(width, aspect), height)
        } else {
            (width, stretched(height, 1.0 / aspect))
        };
        Self { aspect, stored, size }
    }

    fn are_as_stored(&self) -> bool {
        (self.aspect - 1.0).abs() <= TOLERANCE
    }

    /// What is said of pixels that were not square.
    pub(super) fn warning(&self) -> Option<String> {
        let Self { aspect, size: (across, down), .. } = self;
        (!self.are_as_stored()).then(|| {
            format!(
                "its pixels are {aspect:.3} times as wide as high; it is drawn as {across} x {down} square ones"
            )
        })
    }

    /// The stored pixels that a window of square ones is made of.
    pub(super) fn stored(&self, window: &Area) -> Area {
        let stretched = |range: &Range<usize>, length: usize, new: usize| {
            range.start * length / new..(range.end * length).div_ceil(new)
        };
        let (columns, rows) = (window.columns.clone(), window.rows.clone());
        if self.are_as_stored() {
            window.clone()
        } else if self.aspect > 1.0 {
            Area { columns: stretched(&columns, self.stored.0, self.size.0), rows }
        } else {
            Area { columns, rows: stretched(&rows, self.stored.1, self.size.1) }
        }
    }

    /// A window of square pixels, from `pixels`, which are those of [`Self::stored`].
    ///
    /// # Errors
    /// [`PictureError::TooLarge`].
    pub(super) fn drawn<P: Pixel>(
        &self,
        window: &Area,
        stored: &Area,
        pixels: &[P],
    ) -> Result<Vec<P>, PictureError> {
        let (across, down) = window.size();
        let bytes = 2 * size_of::<P>() - size_of::<f32>();
        let count = limits::check(across, down, bytes)?;
        let mut square = Vec::new();
        square.try_reserve_exact(count).map_err(|_| limits::too_large(across, down, bytes))?;
        let wide = self.aspect > 1.0;
        let width = stored.columns.len();
        for y in window.rows.clone() {
            for x in window.columns.clone() {
                let (line, place, first, length, new) = if wide {
                    let row = &pixels[(y - window.rows.start) * width..][..width];
                    (row, x, stored.columns.start, self.stored.0, self.size.0)
                } else {
                    let column = &pixels[x - window.columns.start..];
                    (column, y, stored.rows.start, self.stored.1, self.size.1)
                };
                let stride = if wide { 1 } else { width };
                // The new pixel reaches from place/new to (place + 1)/new of the line; in units of
                // 1/(length · new) all borders are integers.
                let (start, end) = (place * length, (place + 1) * length);
                let mut mean = P::NOTHING;
                for old in start / new..end.div_ceil(new) {
                    let covered = end.min((old + 1) * new) - start.max(old * new);
                    mean = mean.plus(line[(old - first) * stride], covered as f32 / length as f32);
                }
                square.push(mean);
            }
        }
        Ok(square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, aspect: f64) -> Decoded<f32> {
        let pixels = (0..width * height).map(|i| (i * 7 % 5) as f32).collect();
        Decoded { width, height, pixels, aspect, range: None, warnings: Vec::new() }
    }

    #[test]
    fn the_mean_is_kept_and_the_shape_mended() {
        for (aspect, size) in [(2.0, (12, 4)), (0.5, (6, 8)), (1.5, (9, 4)), (0.4, (6, 10))] {
            let stored = picture(6, 4, aspect);
            let mean = |p: &Decoded<f32>| p.pixels.iter().sum::<f32>() / p.pixels.len() as f32;
            let before = mean(&stored);
            let square = squared(stored).unwrap();
            assert_eq!((square.width, square.height), size);
            assert!((mean(&square) - before).abs() < 1e-5);
            assert_eq!(square.warnings.len(), 1);
        }
        assert!(squared(picture(6, 4, 1.005)).unwrap().warnings.is_empty());
    }
}
