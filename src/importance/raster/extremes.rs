//! Extremess of extremes: the largest and the smallest pixel of any square block, from a few reads.

use alloc::vec::Vec;
use core::ops::Range;

use crate::importance::pixels::{MapError, filled};

/// Texels reduced in one pass.
const RUN: usize = 256;

/// Levels 1, 2, … of maxima and minima over 2×2, 4×4, … pixels, down to one texel. Level 0, the
/// pixels, stays with its owner. Odd sizes round up: the last texel of a level covers what is left.
#[derive(Clone, Debug)]
pub(in crate::importance) struct Extremes {
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

impl Extremes {
    /// Reduces `pixels`, `width` × `height` of them, row by row. O(pixels), two thirds more memory.
    pub(in crate::importance) fn new(
        pixels: &[f32],
        width: usize,
        height: usize,
    ) -> Result<Self, MapError> {
        let mut levels = Vec::new();
        let (mut w, mut h, mut total) = (width, height, 0);
        while w > 1 || h > 1 {
            (w, h) = (w.div_ceil(2), h.div_ceil(2));
            levels.push(Level { start: total, width: w, height: h });
            total += w * h;
        }
        let (greatest, least) = (filled(0.0, total)?, filled(0.0, total)?);
        let mut pyramid = Self { greatest, least, levels };
        for y in 0..height.div_ceil(2) {
            pyramid.reduce_pixels(pixels, (width, height), y, &(0..width));
        }
        pyramid.reduce_above(&(0..width), &(0..height));
        Ok(pyramid)
    }

    /// Recomputes row `y` of level 1 where it depends on the pixels in `columns`, from two rows of
    /// pixels at the most.
    #[inline(always)]
    pub(in crate::importance) fn reduce_pixels(
        &mut self,
        pixels: &[f32],
        size: (usize, usize),
        y: usize,
        columns: &Range<usize>,
    ) {
        let Some(level) = self.levels.first() else { return };
        let columns = columns.start / 2..(columns.end - 1) / 2 + 1;
        level.reduce_row(pixels, size, y, &columns, &mut self.greatest, larger);
        level.reduce_row(pixels, size, y, &columns, &mut self.least, smaller);
    }

    /// Recomputes what depends on the pixels in these columns and rows from level 2 on, when level 1 is
    /// as it should be: a third of that level, and a few texels a level.
    #[inline(always)]
    pub(in crate::importance) fn reduce_above(
        &mut self,
        columns: &Range<usize>,
        rows: &Range<usize>,
    ) {
        for i in 1..self.levels.len() {
            let (source, level) = (self.levels[i - 1], self.levels[i]);
            let covered =
                |pixels: &Range<usize>| pixels.start >> (i + 1)..((pixels.end - 1) >> (i + 1)) + 1;
            let (columns, rows) = (covered(columns), covered(rows));
            let size = (source.width, source.height);
            let (greatest, to_greatest) = self.greatest.split_at_mut(level.start);
            let (least, to_least) = self.least.split_at_mut(level.start);
            for y in rows {
                let greatest = &greatest[source.start..];
                level.reduce_row(greatest, size, y, &columns, to_greatest, larger);
                level.reduce_row(&least[source.start..], size, y, &columns, to_least, smaller);
            }
        }
    }

    /// The level whose texels are 2^shift pixels wide; the last one if there are fewer.
    #[inline(always)]
    pub(in crate::importance) fn level<'a>(
        &'a self,
        pixels: &'a [f32],
        width: usize,
        shift: usize,
    ) -> Texels<'a> {
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

impl Level {
    /// Reduces two rows of the level below, `size`, to row `y` of this one, `texels` from its start on,
    /// in some columns.
    #[inline(always)]
    fn reduce_row(
        &self,
        source: &[f32],
        (width, height): (usize, usize),
        y: usize,
        columns: &Range<usize>,
        texels: &mut [f32],
        further: impl Fn(f32, f32) -> f32 + Copy,
    ) {
        let source_columns = 2 * columns.start..(2 * columns.end).min(width);
        let above = &row(source, width, 2 * y)[source_columns.clone()];
        let below = &row(source, width, (2 * y + 1).min(height - 1))[source_columns];
        let target = &mut texels[y * self.width..][columns.clone()];
        // First two rows to one, then two columns: half as many texels are moved between lanes.
        let mut run = [0.0f32; RUN];
        let runs = above.chunks(RUN).zip(below.chunks(RUN)).zip(target.chunks_mut(RUN / 2));
        for ((above, below), target) in runs {
            let run = &mut run[..above.len()];
            for ((extreme, a), b) in run.iter_mut().zip(above).zip(below) {
                *extreme = further(*a, *b);
            }
            let (pairs, odd) = run.as_chunks::<2>();
            let (of_pairs, of_odd) = target.split_at_mut(pairs.len());
            for (extreme, [a, b]) in of_pairs.iter_mut().zip(pairs) {
                *extreme = further(*a, *b);
            }
            // The last block of an odd row is 1 wide.
            of_odd.copy_from_slice(odd);
        }
    }
}

/// One level of a pyramid.
#[derive(Clone, Copy, Debug)]
pub(in crate::importance) struct Texels<'a> {
    greatest: &'a [f32],
    least: &'a [f32],
    width: usize,
}

impl Texels<'_> {
    /// The largest pixel of the columns and rows from `low` to `high`, three texels each way at most.
    #[inline(always)]
    pub(in crate::importance) fn max(&self, low: [u32; 2], high: [u32; 2]) -> f32 {
        extreme(self.greatest, self.width, low, high, larger)
    }

    /// The smallest.
    #[inline(always)]
    pub(in crate::importance) fn min(&self, low: [u32; 2], high: [u32; 2]) -> f32 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_has_the_extremes_of_its_pixels() {
        for (width, height) in [(1, 1), (1, 9), (17, 1), (2, 2), (7, 5), (33, 64)] {
            let pixels: Vec<f32> = (0..width * height).map(|i| (i * 7919 % 1009) as f32).collect();
            let pyramid = Extremes::new(&pixels, width, height).unwrap();
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
