//! A pyramid of sums: how much of a map's importance lies in each square block of 2×2, 4×4, … pixels.

use alloc::vec::Vec;

use crate::importance::ImageMap;

/// Sums over blocks of 2^level pixels a side, in pixel units; level 0 are the pixels. Blocks at the
/// right and lower border hold what is left. `f64` throughout: 2.7 times the memory of the pixels.
#[derive(Clone, Debug)]
pub(crate) struct SumPyramid {
    sums: Vec<f64>,
    levels: Vec<Level>,
}

#[derive(Clone, Copy, Debug)]
struct Level {
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
        let quarter = |i, j| Self { level: self.level - 1, x: 2 * self.x + i, y: 2 * self.y + j };
        [quarter(0, 0), quarter(1, 0), quarter(0, 1), quarter(1, 1)]
    }
}

impl SumPyramid {
    /// O(pixels).
    pub(crate) fn new(map: &ImageMap) -> Self {
        let (width, height) = map.size();
        let mut levels = alloc::vec![Level { start: 0, width, height }];
        let mut total = width * height;
        let (mut w, mut h) = (width, height);
        while w > 1 || h > 1 {
            (w, h) = (w.div_ceil(2), h.div_ceil(2));
            levels.push(Level { start: total, width: w, height: h });
            total += w * h;
        }
        let mut sums = Vec::with_capacity(total);
        sums.extend(map.pixels().iter().map(|pixel| f64::from(*pixel)));
        for pair in levels.windows(2) {
            let [fine, coarse] = [pair[0], pair[1]];
            for y in 0..coarse.height {
                for x in 0..coarse.width {
                    let mut sum = 0.0;
                    for j in 2 * y..(2 * y + 2).min(fine.height) {
                        for i in 2 * x..(2 * x + 2).min(fine.width) {
                            sum += sums[fine.start + j * fine.width + i];
                        }
                    }
                    sums.push(sum);
                }
            }
        }
        Self { sums, levels }
    }

    /// The cell of the whole map.
    pub(crate) fn top(&self) -> Cell {
        Cell { level: self.levels.len() - 1, x: 0, y: 0 }
    }

    /// The sum over a cell's pixels; 0 past the border.
    pub(crate) fn sum(&self, cell: Cell) -> f64 {
        let level = self.levels[cell.level];
        if cell.x >= level.width || cell.y >= level.height {
            return 0.0;
        }
        self.sums[level.start + cell.y * level.width + cell.x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::InvalidPixels;

    #[test]
    fn every_cell_is_the_sum_of_its_pixels() {
        for (width, height) in [(1, 1), (1, 9), (17, 1), (7, 5), (32, 64), (33, 6)] {
            let pixels: Vec<f32> = (0..width * height).map(|i| (i * i % 97) as f32).collect();
            let map = ImageMap::new(width, height, pixels.clone(), InvalidPixels::Reject).unwrap();
            let pyramid = SumPyramid::new(&map);
            let top = pyramid.top();
            assert_eq!(pyramid.sum(top), pixels.iter().map(|p| f64::from(*p)).sum::<f64>());
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
                        assert_eq!(pyramid.sum(Cell { level, x, y }), sum);
                    }
                }
            }
        }
    }
}
