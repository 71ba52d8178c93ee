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
        let mut texels = alloc::vec![0.0; total];
        let (mut source_width, mut source_height) = (width, height);
        for i in 0..levels.len() {
            let level = levels[i];
            let (done, rest) = texels.split_at_mut(level.start);
            let source = if i == 0 { pixels } else { &done[levels[i - 1].start..] };
            for y in 0..level.height {
                let row = &source[2 * y * source_width..][..source_width];
                let below = (2 * y + 1).min(source_height - 1);
                let below = &source[below * source_width..][..source_width];
                let target = &mut rest[y * level.width..][..level.width];
                reduce_rows(row, below, target);
            }
            (source_width, source_height) = (level.width, level.height);
        }
        Self { texels, levels }
    }

    /// The largest pixel in columns x0..=x1 and rows y0..=y1, or a little more than those: the range
    /// is widened to whole texels of the first level where it spans at most three each way.
    pub(super) fn max(
        &self,
        pixels: &[f32],
        width: usize,
        [x0, x1]: [usize; 2],
        [y0, y1]: [usize; 2],
    ) -> f32 {
        let span = (x1 - x0).max(y1 - y0);
        let mut shift = 0;
        while span >> shift > 2 {
            shift += 1;
        }
        let (texels, width) = match shift {
            0 => (pixels, width),
            _ => {
                let level = self.levels[shift - 1];
                (&self.texels[level.start..], level.width)
            }
        };
        let mut max = 0.0f32;
        for y in y0 >> shift..=y1 >> shift {
            for texel in &texels[y * width..][x0 >> shift..=x1 >> shift] {
                max = max.max(*texel);
            }
        }
        max
    }
}

/// Maxima of 2×2 blocks of two rows; the last block of an odd row is 1 wide.
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
    fn a_query_never_misses_a_pixel_and_widens_by_less_than_its_span() {
        for (width, height) in [(1, 1), (1, 9), (17, 1), (2, 2), (7, 5), (33, 64)] {
            for hot in 0..width * height {
                let mut pixels = alloc::vec![0.0f32; width * height];
                pixels[hot] = 1.0;
                let pyramid = MaxPyramid::new(&pixels, width, height);
                assert_eq!(pyramid.max(&pixels, width, [0, width - 1], [0, height - 1]), 1.0);
                let (x, y) = (hot % width, hot / width);
                for x0 in 0..width {
                    for x1 in [x0, (x0 + 3).min(width - 1), width - 1] {
                        for (y0, y1) in
                            [(0, height - 1), (y, y), (y / 2, (y / 2 + 2).min(height - 1))]
                        {
                            let max = pyramid.max(&pixels, width, [x0, x1], [y0, y1]);
                            let inside = (x0..=x1).contains(&x) && (y0..=y1).contains(&y);
                            assert!(!inside || max == 1.0);
                            let span = (x1 - x0).max(y1 - y0);
                            let far =
                                x + span < x0 || x > x1 + span || y + span < y0 || y > y1 + span;
                            assert!(!far || max == 0.0);
                        }
                    }
                }
            }
        }
    }
}
