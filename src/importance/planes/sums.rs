//! Means over boxes, from the integrals of a part of the image.

use alloc::vec::Vec;

use super::area::Area;
use crate::importance::pixels::MapError;
use crate::importance::pixels::with_room;

/// A box in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Cut {
    /// The box of this half-side about a pixel's center, cut off at the image's border.
    #[inline]
    pub(super) fn about([x, y]: [usize; 2], half: f64, (width, height): (usize, usize)) -> Self {
        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
        Self {
            low: [(x - half).max(0.0), (y - half).max(0.0)],
            high: [(x + half).min(width as f64), (y + half).min(height as f64)],
        }
    }
}

/// Integrals of a part of an image, and of its square, from the part's corner.
#[derive(Debug, Default)]
pub(super) struct Sums {
    sums: Vec<[f64; 2]>,
    /// The image's.
    image: (usize, usize),
    corner: [usize; 2],
    size: [usize; 2],
}

impl Sums {
    /// Of the pixels of `part`, which lies in the area of `pixels`. Keeps its memory from part to part.
    pub(super) fn measure(
        &mut self,
        (pixels, area): (&[f32], &Area),
        part: &Area,
        image: (usize, usize),
    ) -> Result<(), MapError> {
        let (width, height) = part.size();
        let stride = width + 1;
        let len = stride.saturating_mul(height + 1);
        if self.sums.capacity() < len {
            self.sums = with_room(len)?;
        }
        self.sums.clear();
        self.sums.resize(len, [0.0; 2]);
        let mut rows = self.sums.chunks_exact_mut(stride);
        let mut above = rows.next().unwrap_or_default();
        for (y, sums) in part.y.clone().zip(rows) {
            let row = &pixels[area.index(part.x.start, y)..][..width];
            let mut sum = [0.0; 2];
            for ((to, above), pixel) in sums[1..].iter_mut().zip(&above[1..]).zip(row) {
                let value = f64::from(*pixel);
                sum = [sum[0] + value, sum[1] + value * value];
                *to = [above[0] + sum[0], above[1] + sum[1]];
            }
            above = sums;
        }
        self.image = image;
        self.corner = [part.x.start, part.y.start];
        self.size = [width, height];
        Ok(())
    }

    /// The integrals over what lies left of and above a place inside the part.
    #[inline]
    fn integral(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = (x - self.corner[0] as f64, y - self.corner[1] as f64);
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let (next_i, next_j) = ((i + 1).min(self.size[0]), (j + 1).min(self.size[1]));
        let at = |i: usize, j: usize| self.sums[j * (self.size[0] + 1) + i];
        let (a, b, c, d) = (at(i, j), at(next_i, j), at(i, next_j), at(next_i, next_j));
        core::array::from_fn(|k| {
            (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy
        })
    }

    /// The integrals over a box inside the part.
    #[inline]
    pub(super) fn over(&self, Cut { low, high }: &Cut) -> [f64; 2] {
        let (a, b) = (self.integral(high[0], high[1]), self.integral(low[0], high[1]));
        let (c, d) = (self.integral(high[0], low[1]), self.integral(low[0], low[1]));
        core::array::from_fn(|k| (a[k] - b[k] - c[k] + d[k]).max(0.0))
    }

    /// The means of the value and of its square over the box of this half-side about a pixel.
    #[inline]
    pub(super) fn means(&self, at: [usize; 2], half: f64) -> [f64; 2] {
        self.means_over(&Cut::about(at, half, self.image))
    }

    #[inline]
    fn means_over(&self, cut: &Cut) -> [f64; 2] {
        let area = (cut.high[0] - cut.low[0]) * (cut.high[1] - cut.low[1]);
        self.over(cut).map(|sum| sum / area)
    }

    /// The means over the four boxes of which a pixel is the corner, and which reach `half` from its
    /// center.
    pub(super) fn quadrants(&self, at: [usize; 2], half: f64) -> [[f64; 2]; 4] {
        let pixel = Cut::about(at, 0.5, self.image);
        let all = Cut::about(at, half.max(0.5), self.image);
        core::array::from_fn(|k| {
            let pick = |axis: usize| match k >> axis & 1 {
                0 => (all.low[axis], pixel.high[axis]),
                _ => (pixel.low[axis], all.high[axis]),
            };
            let ((left, right), (top, bottom)) = (pick(0), pick(1));
            self.means_over(&Cut { low: [left, top], high: [right, bottom] })
        })
    }
}
