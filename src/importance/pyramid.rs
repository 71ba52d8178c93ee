//! Pyramids of extremes: the largest and the smallest pixel of any square block, from a few reads.

use alloc::vec::Vec;

/// Levels 1, 2, … of maxima and minima over 2×2, 4×4, … pixels, down to one texel. Level 0, the
/// pixels, stays with its owner. Odd sizes round up: the last texel of a level covers what is left.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    greatest: Vec<f32>,
    least: Vec<f32>,
    levels: Vec<Level>,
}

#[derive(Clone, Copy, Debug)]
struct Level {
    start: usize,
    width: usize,
    height: usize,
}

impl Pyramid {
    /// Reduces `pixels`, `width` × `height` of them, row by row. O(pixels), two thirds more memory.
    pub(super) fn new(pixels: &[f32], width: usize, height: usize) -> Self {
        let mut levels = Vec::new();
        let (mut w, mut h, mut total) = (width, height, 0);
        while w > 1 || h > 1 {
            (w, h) = (w.div_ceil(2), h.div_ceil(2));
            levels.push(Level { start: total, width: w, height: h });
            total += w * h;
        }
        let texels = alloc::vec![0.0; total];
        let mut pyramid = Self { greatest: texels.clone(), least: texels, levels };
        pyramid.update(pixels, (width, height), [0, 0], [width - 1, height - 1]);
        pyramid
    }

    /// Recomputes what depends on the pixels in columns `low[0]`..=`high[0]` and rows
    /// `low[1]`..=`high[1]`: their number and a third, and a few texels a level.
    #[inline(always)]
    pub(super) fn update(
        &mut self,
        pixels: &[f32],
        (mut source_width, mut source_height): (usize, usize),
        mut low: [usize; 2],
        mut high: [usize; 2],
    ) {
        for i in 0..self.levels.len() {
            (low, high) = (low.map(|i| i / 2), high.map(|i| i / 2));
            let level = self.levels[i];
            let (greatest, to_greatest) = self.greatest.split_at_mut(level.start);
            let (least, to_least) = self.least.split_at_mut(level.start);
            let (greatest, least) = match i.checked_sub(1) {
                None => (pixels, pixels),
                Some(i) => (&greatest[self.levels[i].start..], &least[self.levels[i].start..]),
            };
            let columns = low[0]..high[0] + 1;
            let source_columns = 2 * columns.start..(2 * columns.end).min(source_width);
            for y in low[1]..=high[1] {
                let rows = [2 * y, (2 * y + 1).min(source_height - 1)];
                let of = |source| rows.map(|y| &row(source, source_width, y)[source_columns.clone()]);
                let target = y * level.width..(y + 1) * level.width;
                let to_greatest = &mut to_greatest[target.clone()][columns.clone()];
                let to_least = &mut to_least[target][columns.clone()];
                reduce_rows(of(greatest), to_greatest, larger);
                reduce_rows(of(least), to_least, smaller);
            }
            (source_width, source_height) = (level.width, level.height);
        }
    }

    /// The level whose texels are 2^shift pixels wide; the last one if there are fewer.
    #[inline(always)]
    pub(super) fn level<'a>(&'a self, pixels: &'a [f32], width: usize, shift: usize) -> Texels<'a> {
        match shift.min(self.levels.len()).checked_sub(1) {
            None => Texels { greatest: pixels, least: pixels, width },
            Some(i) => {
                let Level { start, width, height } = self.levels[i];
                let texels = start..start + width * height;
                let (greatest, least) = (&self.greatest[texels.clone()], &self.least[texels]);
                Texels { greatest, least, width }
            }
        }
    }
}

/// One level of a pyramid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texels<'a> {
    greatest: &'a [f32],
    least: &'a [f32],
    width: usize,
}

impl Texels<'_> {
    /// The largest pixel of the columns and rows from `low` to `high`, three texels each way at most.
    #[inline(always)]
    pub(super) fn max(&self, low: [u32; 2], high: [u32; 2]) -> f32 {
        extreme(self.greatest, self.width, low, high, larger)
    }

    /// The smallest.
    #[inline(always)]
    pub(super) fn min(&self, low: [u32; 2], high: [u32; 2]) -> f32 {
        extreme(self.least, self.width, low, high, smaller)
    }
}

#[inline(always)]
fn extreme(
    texels: &[f32],
    width: usize,
    [x0, y0]: [u32; 2],
    [x1, y1]: [u32; 2],
    further: impl Fn(f32, f32) -> f32,
) -> f32 {
    // Always nine reads, some of them twice: no branch depends on where the span begins.
    let (middle_x, middle_y) = ((x0 + 1).min(x1) as usize, (y0 + 1).min(y1) as usize);
    let [x0, x1, y0, y1] = [x0, x1, y0, y1].map(|i| i as usize);
    let in_row = |y: usize| {
        let row = row(texels, width, y);
        further(further(row[x0], row[middle_x]), row[x1])
    };
    further(further(in_row(y0), in_row(middle_y)), in_row(y1))
}

#[inline(always)]
fn row(texels: &[f32], width: usize, y: usize) -> &[f32] {
    &texels[y * width..][..width]
}

#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Extremes of 2×2 blocks of two rows; the last block of an odd row is 1 wide.
#[inline(always)]
fn reduce_rows([row, below]: [&[f32]; 2], target: &mut [f32], further: impl Fn(f32, f32) -> f32) {
    let (pairs, odd) = row.as_chunks::<2>();
    let (pairs_below, odd_below) = below.as_chunks::<2>();
    let (target_pairs, target_odd) = target.split_at_mut(pairs.len());
    for ((t, [a, b]), [c, d]) in target_pairs.iter_mut().zip(pairs).zip(pairs_below) {
        *t = further(further(*a, *b), further(*c, *d));
    }
    if let ([t], [a], [b]) = (target_odd, odd, odd_below) {
        *t = further(*a, *b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_has_the_extremes_of_its_pixels() {
        for (width, height) in [(1, 1), (1, 9), (17, 1), (2, 2), (7, 5), (33, 64)] {
            let pixels: Vec<f32> = (0..width * height).map(|i| (i * 7919 % 1009) as f32).collect();
            let pyramid = Pyramid::new(&pixels, width, height);
            for shift in 0..8 {
                let shift = shift.min(pyramid.levels.len());
                let level = pyramid.level(&pixels, width, shift);
                let (columns, rows) = (width.div_ceil(1 << shift), height.div_ceil(1 << shift));
                for (x, y) in (0..columns * rows).map(|i| (i % columns, i / columns)) {
                    let end = |i: usize, size: usize| ((i + 1) << shift).min(size);
                    let covered: Vec<f32> = (y << shift..end(y, height))
                        .flat_map(|y| &pixels[y * width..][x << shift..end(x, width)])
                        .copied()
                        .collect();
                    let at = [x as u32, y as u32];
                    assert_eq!(level.max(at, at), covered.iter().copied().fold(0.0, f32::max));
                    assert_eq!(level.min(at, at), covered.into_iter().fold(1e9, f32::min));
                }
            }
        }
    }
}
