//! Bilinear reading of planes of pixels, many points at once.
//!
//! As in the lookup of single pixels, passes over arrays: where to read, the reads, and what is done
//! with them. Each step is one function for one point and for many, so that both agree to the bit.

use glam::DVec2;

use super::RUN;
use super::round::{INTEGERS, clamp, floor_within};

/// Pixels in rows, and where their centers lie.
#[derive(Clone, Copy, Debug)]
pub(in crate::importance) struct Grid {
    pub(in crate::importance) width: usize,
    pub(in crate::importance) height: usize,
    /// The least corner of pixel (0, 0).
    pub(in crate::importance) min: DVec2,
    /// Width and height of a pixel, in units.
    pub(in crate::importance) texel: DVec2,
    /// Whether the pixels beyond the border are those at the opposite one.
    pub(in crate::importance) wraps: bool,
}

/// The four pixels around each of some points, and the weights of the right and the lower ones.
pub(in crate::importance) struct Cells {
    len: usize,
    corners: [[u32; RUN]; 4],
    weights: [[f64; RUN]; 2],
}

/// Along one axis, with the centers of pixels at integers: the pixel before a coordinate, the one
/// after, and the part of the way between them, in 0..=1. Beyond the outermost centers, both are the
/// border's pixel.
#[inline(always)]
fn between(coordinate: f64, last: f64) -> (f64, f64, f64) {
    let before = floor_within(coordinate, last);
    let after = if before < last { before + 1.0 } else { last };
    (before, after, clamp(coordinate - before, 1.0))
}

/// The same where the pixel before the first is the last: beyond half a pixel from the outermost centers,
/// all is as it is there.
#[inline(always)]
fn between_wrapped(coordinate: f64, last: f64) -> (f64, f64, f64) {
    // Counted from the last pixel's center, before the first one's.
    let from_last = clamp(coordinate + 0.5, last + 1.0) + 0.5;
    let passed = floor_within(from_last, last + 1.0);
    let before = if passed > 0.0 { passed - 1.0 } else { last };
    let after = if passed <= last { passed } else { 0.0 };
    (before, after, clamp(from_last - passed, 1.0))
}

/// The value between four pixels: left and right above, left and right below.
#[inline(always)]
fn mix([a, b, c, d]: [f64; 4], [s, t]: [f64; 2]) -> f64 {
    let above = a + s * (b - a);
    let below = c + s * (d - c);
    let mixed = above + t * (below - above);
    // Rounding may carry the sum an ulp past the pixels it lies between.
    let smaller = |a: f64, b: f64| if a < b { a } else { b };
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let least = smaller(smaller(a, b), smaller(c, d));
    smaller(larger(mixed, least), larger(larger(a, b), larger(c, d)))
}

/// Below this part of the greatest of four pixels, the least lies across an edge.
pub(in crate::importance) const SAME_SIDE: f64 = 0.8;

/// The value between four pixels on one side of an edge, and the nearest one's where an edge parts them.
/// Over the square between their centers, the mean is theirs either way.
#[inline(always)]
fn mix_one_side([a, b, c, d]: [f64; 4], [s, t]: [f64; 2]) -> f64 {
    let smaller = |a: f64, b: f64| if a < b { a } else { b };
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let least = smaller(smaller(a, b), smaller(c, d));
    let most = larger(larger(a, b), larger(c, d));
    let (above, below) = (if s < 0.5 { a } else { b }, if s < 0.5 { c } else { d });
    let nearest = if t < 0.5 { above } else { below };
    let mixed = mix([a, b, c, d], [s, t]);
    if least < SAME_SIDE * most { nearest } else { mixed }
}

impl Grid {
    /// Indices of the four pixels around a point, below 2⁵², and its weights.
    #[inline(always)]
    fn cell<const WRAPS: bool>(&self, [x, y]: [f64; 2]) -> ([f64; 4], [f64; 2]) {
        let (last_x, last_y) = ((self.width - 1) as f64, (self.height - 1) as f64);
        let width = self.width as f64;
        let between = if WRAPS { between_wrapped } else { between };
        let (x0, x1, s) = between((x - self.min.x) / self.texel.x - 0.5, last_x);
        let (y0, y1, t) = between((y - self.min.y) / self.texel.y - 0.5, last_y);
        let (above, below) = (y0 * width, y1 * width);
        ([above + x0, above + x1, below + x0, below + x1], [s, t])
    }

    /// The same as this grid goes on over its border.
    #[inline(always)]
    fn cell_at(&self, at: DVec2) -> ([f64; 4], [f64; 2]) {
        if self.wraps {
            self.cell::<true>(at.to_array())
        } else {
            self.cell::<false>(at.to_array())
        }
    }

    /// The value of a plane at a point; the border's beyond it.
    #[inline]
    pub(in crate::importance) fn value<T: Copy + Into<f64>>(&self, plane: &[T], at: DVec2) -> f64 {
        let (corners, weights) = self.cell_at(at);
        mix(corners.map(|i| plane[i as usize].into()), weights)
    }

    /// The same, one side of every edge by itself.
    #[inline]
    pub(in crate::importance) fn value_of_side<T: Copy + Into<f64>>(
        &self,
        plane: &[T],
        at: DVec2,
    ) -> f64 {
        let (corners, weights) = self.cell_at(at);
        mix_one_side(corners.map(|i| plane[i as usize].into()), weights)
    }

    /// Where to read for as many of the points as fit; `None` if indices do not fit in 32 bits.
    #[inline(always)]
    pub(in crate::importance) fn cells(
        &self,
        points: impl Iterator<Item = [f64; 2]>,
    ) -> Option<Cells> {
        if self.wraps { self.cells_of::<true>(points) } else { self.cells_of::<false>(points) }
    }

    #[inline(always)]
    fn cells_of<const WRAPS: bool>(&self, points: impl Iterator<Item = [f64; 2]>) -> Option<Cells> {
        self.width.checked_mul(self.height).filter(|pixels| *pixels < u32::MAX as usize)?;
        let mut cells = Cells { len: 0, corners: [[0; RUN]; 4], weights: [[0.0; RUN]; 2] };
        let Cells { corners: [a, b, c, d], weights: [s, t], .. } = &mut cells;
        let to = a.iter_mut().zip(b).zip(c).zip(d).zip(s.iter_mut().zip(t));
        let mut len = 0;
        for (((((a, b), c), d), (s, t)), point) in to.zip(points) {
            let (corners, weights) = self.cell::<WRAPS>(point);
            [*a, *b, *c, *d] = corners.map(|i| (i + INTEGERS).to_bits() as u32);
            [*s, *t] = weights;
            len += 1;
        }
        cells.len = len;
        Some(cells)
    }
}

impl Cells {
    /// The values of a plane.
    #[inline(always)]
    pub(in crate::importance) fn read<T: Copy + Into<f64>>(&self, plane: &[T], values: &mut [f64]) {
        self.read_with(plane, values, mix);
    }

    /// The same, one side of every edge by itself.
    #[inline(always)]
    pub(in crate::importance) fn read_side<T: Copy + Into<f64>>(
        &self,
        plane: &[T],
        values: &mut [f64],
    ) {
        self.read_with(plane, values, mix_one_side);
    }

    #[inline(always)]
    fn read_with<T: Copy + Into<f64>>(
        &self,
        plane: &[T],
        values: &mut [f64],
        mix: impl Fn([f64; 4], [f64; 2]) -> f64,
    ) {
        let mut read = [[0.0; RUN]; 4];
        for (read, corners) in read.iter_mut().zip(&self.corners) {
            for (read, corner) in read[..self.len].iter_mut().zip(corners) {
                *read = plane[*corner as usize].into();
            }
        }
        let ([a, b, c, d], [s, t]) = (&read, &self.weights);
        let from = a.iter().zip(b).zip(c).zip(d).zip(s.iter().zip(t));
        for (value, ((((a, b), c), d), (s, t))) in values[..self.len].iter_mut().zip(from) {
            *value = mix([*a, *b, *c, *d], [*s, *t]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn many_values_are_the_single_one_and_never_leave_their_pixels(
            (width, height) in (1usize..9, 1usize..9),
            min in prop_oneof![Just(DVec2::ZERO), Just(DVec2::new(-3.25, 7.7))],
            texel in prop_oneof![Just(DVec2::ONE), Just(DVec2::new(0.3, 17.0))],
            points in prop::collection::vec((-3.0f64..12.0, -3.0f64..12.0), RUN),
            wraps: bool,
            seed: u32,
        ) {
            let grid = Grid { width, height, min, texel, wraps };
            let plane: Vec<f32> = (0..width * height)
                .map(|i| (i as u32).wrapping_mul(2_654_435_761).wrapping_add(seed) as f32)
                .collect();
            let mut points: Vec<[f64; 2]> = points.into_iter().map(|(x, y)| [x, y]).collect();
            let [left, right] = [0.5, width as f64 - 0.5].map(|x| min.x + x * texel.x);
            let special = [[left, min.y], [right, 1e30], [f64::NAN, -1e30], [-0.0, f64::INFINITY]];
            points[..4].copy_from_slice(&special);
            let mut values = [f64::NAN; RUN];
            grid.cells(points.iter().copied()).unwrap().read(&plane, &mut values);
            let least = plane.iter().copied().fold(f32::MAX, f32::min);
            let most = plane.iter().copied().fold(0.0, f32::max);
            for (point, value) in points.iter().zip(values) {
                prop_assert_eq!(value, grid.value(&plane, DVec2::from(*point)));
                prop_assert!((f64::from(least)..=f64::from(most)).contains(&value));
            }
        }
    }
}
