//! A max pyramid: the largest pixel of any square block, from a few reads.

use alloc::vec::Vec;

/// Levels 1, 2, … of maxima over 2×2, 4×4, … pixels, down to one texel. Level 0, the pixels, stays
/// with its owner. Odd sizes round up: the last texel of a level covers what is left.
#[derive(Clone, Debug)]
pub(super) struct MaxPyramid {
    texels: Vec<f32>,
    levels: Vec<Level>,
}

#[derive(Clone, Copy, Debug)]
struct Level {
    start: usize,
    width: usize,
    height: usize,
}

impl MaxPyramid {
    /// Reduces `pixels`, `width` × `height` of them, row by row. O(pixels), a third more memory.
    pub(super) fn new(pixels: &[f32], width: usize, height: usize) -> Self {
        let mut levels = Vec::new();
        let (mut w, mut h, mut total) = (width, height, 0);
        while w > 1 || h > 1 {
            (w, h) = (w.div_ceil(2), h.div_ceil(2));
            levels.push(Level { start: total, width: w, height: h });
            total += w * h;
        }
        let mut pyramid = Self { texels: alloc::vec![0.0; total], levels };
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
            let (done, rest) = self.texels.split_at_mut(level.start);
            let source = if i == 0 { pixels } else { &done[self.levels[i - 1].start..] };
            let columns = low[0]..high[0] + 1;
            let source_columns = 2 * columns.start..(2 * columns.end).min(source_width);
            for y in low[1]..=high[1] {
                let row = &source[2 * y * source_width..][source_columns.clone()];
                let below = (2 * y + 1).min(source_height - 1);
                let below = &source[below * source_width..][source_columns.clone()];
                let target = &mut rest[y * level.width..][columns.clone()];
                reduce_rows(row, below, target);
            }
            (source_width, source_height) = (level.width, level.height);
        }
    }

    /// The level whose texels are 2^shift pixels wide; the last one if there are fewer.
    #[inline(always)]
    pub(super) fn level<'a>(&'a self, pixels: &'a [f32], width: usize, shift: usize) -> Texels<'a> {
        match shift.min(self.levels.len()).checked_sub(1) {
            None => Texels { texels: pixels, width },
            Some(i) => {
                let Level { start, width, height } = self.levels[i];
                Texels { texels: &self.texels[start..start + width * height], width }
            }
        }
    }
}

/// One level of a pyramid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Texels<'a> {
    texels: &'a [f32],
    width: usize,
}

impl Texels<'_> {
    /// The largest texel of the columns and rows from `low` to `high`, three each way at most.
    #[inline(always)]
    pub(super) fn max(&self, [x0, y0]: [u32; 2], [x1, y1]: [u32; 2]) -> f32 {
        // Always nine reads, some of them twice: no branch depends on where the span begins.
        let (middle_x, middle_y) = ((x0 + 1).min(x1) as usize, (y0 + 1).min(y1) as usize);
        let [x0, x1, y0, y1] = [x0, x1, y0, y1].map(|i| i as usize);
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let row = |y: usize| {
            let row = &self.texels[y * self.width..][..self.width];
            larger(larger(row[x0], row[middle_x]), row[x1])
        };
        larger(larger(row(y0), row(middle_y)), row(y1))
    }
}

/// Maxima of 2×2 blocks of two rows; the last block of an odd row is 1 wide.
#[inline(always)]
fn reduce_rows(row: &[f32], below: &[f32], target: &mut [f32]) {
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let (pairs, odd) = row.as_chunks::<2>();
    let (pairs_below, odd_below) = below.as_chunks::<2>();
    let (target_pairs, target_odd) = target.split_at_mut(pairs.len());
    for ((t, [a, b]), [c, d]) in target_pairs.iter_mut().zip(pairs).zip(pairs_below) {
        *t = larger(larger(*a, *b), larger(*c, *d));
    }
    if let ([t], [a], [b]) = (target_odd, odd, odd_below) {
        *t = larger(*a, *b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_is_the_largest_of_its_pixels() {
        for (width, height) in [(1, 1), (1, 9), (17, 1), (2, 2), (7, 5), (33, 64)] {
            let pixels: Vec<f32> = (0..width * height).map(|i| (i * 7919 % 1009) as f32).collect();
            let pyramid = MaxPyramid::new(&pixels, width, height);
            for shift in 0..8 {
                let shift = shift.min(pyramid.levels.len());
                let level = pyramid.level(&pixels, width, shift);
                let (columns, rows) = (width.div_ceil(1 << shift), height.div_ceil(1 << shift));
                for (x, y) in (0..columns * rows).map(|i| (i % columns, i / columns)) {
                    let end = |i: usize, size: usize| ((i + 1) << shift).min(size);
                    let expected = (y << shift..end(y, height))
                        .flat_map(|y| {
                            pixels[y * width..][x << shift..end(x, width)].iter().copied()
                        })
                        .fold(0.0, f32::max);
                    let at = [x as u32, y as u32];
                    assert_eq!(level.max(at, at), expected);
                }
            }
        }
    }
}
