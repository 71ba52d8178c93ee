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
    #[inline(always)]
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

/// A coordinate between two integrals, or at the last: the part of the way from one to the other.
struct Between {
    before: usize,
    after: usize,
    share: f64,
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
        // Coordinates are converted through `u32`.
        if width.max(height) >= u32::MAX as usize {
            return Err(MapError::Memory { bytes: len.saturating_mul(size_of::<[f64; 2]>()) });
        }
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

    /// Where a coordinate inside the part lies between the integrals.
    #[inline(always)]
    fn between(&self, axis: usize, at: f64) -> Between {
        let at = at - self.corner[axis] as f64;
        // The cheapest conversion, and parts are smaller than that.
        let before = at as u32 as usize;
        let after = (before + 1).min(self.size[axis]);
        Between { before, after, share: at - before as f64 }
    }

    /// The integral over what lies left of and above a place inside the part: of the value, or of its square.
    #[inline(always)]
    fn integral(&self, x: &Between, y: &Between, of: usize) -> f64 {
        let stride = self.size[0] + 1;
        let (above, below) = (&self.sums[y.before * stride..], &self.sums[y.after * stride..]);
        let (a, b) = (above[x.before][of], above[x.after][of]);
        let (c, d) = (below[x.before][of], below[x.after][of]);
        let (fx, fy) = (x.share, y.share);
        (a * (1.0 - fx) + b * fx) * (1.0 - fy) + (c * (1.0 - fx) + d * fx) * fy
    }

    #[inline(always)]
    fn over_between(
        &self,
        [left, right]: [&Between; 2],
        [top, bottom]: [&Between; 2],
        of: usize,
    ) -> f64 {
        let (a, b) = (self.integral(right, bottom, of), self.integral(left, bottom, of));
        let (c, d) = (self.integral(right, top, of), self.integral(left, top, of));
        (a - b - c + d).max(0.0)
    }

    /// The integral of the value over a box inside the part.
    #[inline(always)]
    pub(super) fn over(&self, Cut { low, high }: &Cut) -> f64 {
        let (left, right) = (self.between(0, low[0]), self.between(0, high[0]));
        let (top, bottom) = (self.between(1, low[1]), self.between(1, high[1]));
        self.over_between([&left, &right], [&top, &bottom], 0)
    }

    /// The mean of the value over the box of this half-side about a pixel.
    #[inline(always)]
    pub(super) fn mean(&self, at: [usize; 2], half: f64) -> f64 {
        let cut = Cut::about(at, half, self.image);
        self.over(&cut) / ((cut.high[0] - cut.low[0]) * (cut.high[1] - cut.low[1]))
    }

    /// The same, and the mean of its square.
    #[inline(always)]
    pub(super) fn means(&self, at: [usize; 2], half: f64) -> [f64; 2] {
        let Cut { low, high } = Cut::about(at, half, self.image);
        let (left, right) = (self.between(0, low[0]), self.between(0, high[0]));
        let (top, bottom) = (self.between(1, low[1]), self.between(1, high[1]));
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        let mean = |of: usize| self.over_between([&left, &right], [&top, &bottom], of) / area;
        [mean(0), mean(1)]
    }

    /// The means over the four boxes of which a pixel is the corner, and which reach `half` from its
    /// center.
    pub(super) fn quadrants(&self, at: [usize; 2], half: f64) -> [[f64; 2]; 4] {
        let pixel = Cut::about(at, 0.5, self.image);
        let all = Cut::about(at, half.max(0.5), self.image);
        // Along each axis, the lower box and the upper one: where they begin and end, and their lengths.
        let boxes = |axis: usize| {
            let ends = |low: f64, high: f64| {
                ([self.between(axis, low), self.between(axis, high)], high - low)
            };
            [ends(all.low[axis], pixel.high[axis]), ends(pixel.low[axis], all.high[axis])]
        };
        let (x, y) = (boxes(0), boxes(1));
        let means = |i: usize, j: usize| {
            let (([left, right], width), ([top, bottom], height)) = (&x[i], &y[j]);
            let mean =
                |of: usize| self.over_between([left, right], [top, bottom], of) / (width * height);
            [mean(0), mean(1)]
        };
        [means(0, 0), means(1, 0), means(0, 1), means(1, 1)]
    }
}
