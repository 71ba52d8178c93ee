//! A pyramid of sums: how much of a map's importance lies in each square block of 2×2, 4×4, … pixels,
//! and the hierarchical warp that they make.

use alloc::vec::Vec;

use glam::DVec2;

/// Sums over blocks of 2^level pixels a side, in pixel units; level 0 are the pixels, which the caller
/// keeps and hands in. Blocks at the right and lower border hold what is left.
///
/// `f64` throughout: two thirds of the memory of the pixels. The four quarters of a cell lie together,
/// so that a descent reads one cache line a level.
#[derive(Clone, Debug)]
pub(crate) struct SumPyramid {
    /// The quarters' sums, cell by cell, of all cells from level 2 on.
    quads: Vec<[f64; 4]>,
    /// Of each level, from 0.
    levels: Vec<Level>,
    total: f64,
}

#[derive(Clone, Copy, Debug)]
struct Level {
    /// Where its cells' quads begin; of no meaning below level 2.
    start: usize,
    width: usize,
    height: usize,
}

/// A block: 2^level pixels a side, at column x and row y of its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cell {
    pub(crate) level: usize,
    pub(crate) x: usize,
    pub(crate) y: usize,
}

impl Cell {
    /// Its four quarters, row by row; those past the border have no importance.
    pub(crate) fn quarters(self) -> [Self; 4] {
        core::array::from_fn(|slot| self.quarter(slot))
    }

    fn quarter(self, slot: usize) -> Self {
        Self { level: self.level - 1, x: 2 * self.x + slot % 2, y: 2 * self.y + slot / 2 }
    }

    /// The cell of which it is a quarter, and which.
    fn parent(self) -> (Self, usize) {
        let parent = Self { level: self.level + 1, x: self.x / 2, y: self.y / 2 };
        (parent, 2 * (self.y % 2) + self.x % 2)
    }
}

/// The greatest number below 1.
pub(crate) const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

impl SumPyramid {
    /// O(pixels).
    pub(crate) fn new(pixels: &[f32], (width, height): (usize, usize)) -> Self {
        let mut levels = alloc::vec![Level { start: 0, width, height }];
        let (mut w, mut h, mut count) = (width, height, 0);
        while w > 1 || h > 1 {
            (w, h) = (w.div_ceil(2), h.div_ceil(2));
            let start = count;
            if levels.len() > 1 {
                count += w * h;
            }
            levels.push(Level { start, width: w, height: h });
        }
        let mut pyramid = Self { quads: alloc::vec![[0.0; 4]; count], levels, total: 0.0 };
        pyramid.add_up(pixels);
        pyramid
    }

    /// Sums the pixels again, as many as before. Allocates nothing.
    pub(crate) fn add_up(&mut self, pixels: &[f32]) {
        for level in 2..self.levels.len() {
            let Level { start, width, height } = self.levels[level];
            for y in 0..height {
                for x in 0..width {
                    let quarters = Cell { level, x, y }.quarters();
                    self.quads[start + y * width + x] =
                        quarters.map(|quarter| self.quarter_sums(pixels, quarter).iter().sum());
                }
            }
        }
        self.total = self.quarter_sums(pixels, self.top()).iter().sum();
    }

    /// The cell of the whole map.
    pub(crate) fn top(&self) -> Cell {
        Cell { level: self.levels.len() - 1, x: 0, y: 0 }
    }

    /// The sum of all pixels.
    pub(crate) fn total(&self) -> f64 {
        self.total
    }

    /// The cells of a level, across and down.
    pub(crate) fn cells(&self, level: usize) -> (usize, usize) {
        let Level { width, height, .. } = self.levels[level];
        (width, height)
    }

    /// The sums over a cell's quarters; for a pixel itself and nothing, for a cell past the border 0.
    fn quarter_sums(&self, pixels: &[f32], Cell { level, x, y }: Cell) -> [f64; 4] {
        let Level { start, width, height } = self.levels[level];
        if x >= width || y >= height {
            return [0.0; 4];
        }
        match level {
            0 => [f64::from(pixels[y * width + x]), 0.0, 0.0, 0.0],
            1 => {
                let Level { width, height, .. } = self.levels[0];
                let pixel = |x: usize, y: usize| {
                    if x < width && y < height { f64::from(pixels[y * width + x]) } else { 0.0 }
                };
                let (x, y) = (2 * x, 2 * y);
                [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)]
            }
            _ => self.quads[start + y * width + x],
        }
    }

    /// The sum over a cell's pixels; 0 past the border.
    pub(crate) fn sum(&self, pixels: &[f32], cell: Cell) -> f64 {
        if cell.level == 0 || cell.level + 1 == self.levels.len() {
            return self.quarter_sums(pixels, cell).iter().sum();
        }
        let (parent, slot) = cell.parent();
        self.quarter_sums(pixels, parent)[slot]
    }

    /// The hierarchical warp (P. Clarberg et al., *Wavelet Importance Sampling*, 2005): the pixel of
    /// `cell` to which a point of its square [0, 1)² goes, column and row, and where in the pixel. From
    /// the cell down to a pixel the square is divided into upper and lower half in the ratio of their
    /// sums, then left and right. Coordinates outside of [0, 1), NaN included, count as the nearest
    /// inside. A pixel of 0 is never found, if the cell's sum is above 0.
    pub(crate) fn find(&self, pixels: &[f32], cell: Cell, at: DVec2) -> (usize, usize, DVec2) {
        let inside = |c: f64| if c > 0.0 { c.min(BELOW_ONE) } else { 0.0 };
        let (mut cell, mut x, mut y) = (cell, inside(at.x), inside(at.y));
        while cell.level > 0 {
            let [a, b, c, d] = self.quarter_sums(pixels, cell);
            let (row, below) = split(y, a + b, c + d);
            let [left, right] = if row == 0 { [a, b] } else { [c, d] };
            let (column, beyond) = split(x, left, right);
            (x, y) = (beyond, below);
            cell = cell.quarter(2 * row + column);
        }
        (cell.x, cell.y, DVec2::new(x, y))
    }

    /// The inverse of [`find`](Self::find): from a place in a pixel to the place in the ancestor `cell`'s
    /// square that goes there, to rounding. Of no meaning in a pixel of 0.
    pub(crate) fn trace(
        &self,
        pixels: &[f32],
        cell: Cell,
        (column, row, at): (usize, usize, DVec2),
    ) -> DVec2 {
        let (mut part, mut x, mut y) = (Cell { level: 0, x: column, y: row }, at.x, at.y);
        while part.level < cell.level {
            let (parent, slot) = part.parent();
            let [a, b, c, d] = self.quarter_sums(pixels, parent);
            let [left, right] = if slot < 2 { [a, b] } else { [c, d] };
            x = joined(x, slot % 2, left, right);
            y = joined(y, slot / 2, a + b, c + d);
            part = parent;
        }
        DVec2::new(x.min(BELOW_ONE), y.min(BELOW_ONE))
    }
}

/// Which of two parts, side by side in [0, 1) in the ratio first : second, holds c, and where in it, in
/// [0, 1).
///
/// A part of 0 holds nothing: c ≤ 1 − 2⁻⁵³ times the sum rounds below the sum.
#[inline]
fn split(c: f64, first: f64, second: f64) -> (usize, f64) {
    let along = c * (first + second);
    if along < first {
        (0, (along / first).min(BELOW_ONE))
    } else {
        // Where rounding left a second part of 0, nothing is beyond the first.
        (1, ((along - first) / second).min(BELOW_ONE))
    }
}

/// The inverse of [`split`].
fn joined(c: f64, part: usize, first: f64, second: f64) -> f64 {
    let sum = first + second;
    if part == 0 { c * first / sum } else { (first + c * second) / sum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn every_cell_is_the_sum_of_its_pixels() {
        for (width, height) in [(1, 1), (1, 2), (1, 9), (17, 1), (7, 5), (32, 64), (33, 6)] {
            let pixels: Vec<f32> = (0..width * height).map(|i| (i * i % 97) as f32).collect();
            let pyramid = SumPyramid::new(&pixels, (width, height));
            let top = pyramid.top();
            let total = pixels.iter().map(|p| f64::from(*p)).sum::<f64>();
            assert_eq!((pyramid.total(), pyramid.sum(&pixels, top)), (total, total));
            for level in 0..=top.level {
                let side = 1 << level;
                for y in 0..=height / side {
                    for x in 0..=width / side {
                        let mut sum = 0.0;
                        for j in (y * side..(y + 1) * side).filter(|j| *j < height) {
                            for i in (x * side..(x + 1) * side).filter(|i| *i < width) {
                                sum += f64::from(pixels[j * width + i]);
                            }
                        }
                        assert_eq!(pyramid.sum(&pixels, Cell { level, x, y }), sum);
                    }
                }
            }
        }
    }

    #[test]
    fn a_place_is_found_and_traced_back() {
        let mut random = SplitMix64::new(5);
        for (width, height) in [(1, 1), (1, 9), (7, 5), (33, 6)] {
            let pixels: Vec<f32> = (0..width * height)
                .map(|i| if i % 3 == 1 { 0.0 } else { random.unit() as f32 * 1e4f32.powi(i % 2) })
                .collect();
            let (width, height) = (width as usize, height as usize);
            let pyramid = SumPyramid::new(&pixels, (width, height));
            for _ in 0..500 {
                let at = DVec2::new(random.unit(), random.unit());
                let (x, y, inside) = pyramid.find(&pixels, pyramid.top(), at);
                assert!(pixels[y * width + x] > 0.0);
                assert!(inside.cmpge(DVec2::ZERO).all() && inside.cmplt(DVec2::ONE).all());
                let back = pyramid.trace(&pixels, pyramid.top(), (x, y, inside));
                assert!(back.distance(at) < 1e-14, "{at} {back}");
            }
            for edge in [DVec2::ZERO, DVec2::ONE, DVec2::NAN, DVec2::splat(BELOW_ONE)] {
                let (x, y, inside) = pyramid.find(&pixels, pyramid.top(), edge);
                assert!(pixels[y * width + x] > 0.0 && inside.cmplt(DVec2::ONE).all());
            }
        }
    }
}
