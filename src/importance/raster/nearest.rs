//! From coordinates to pixels, many at once.
//!
//! All of it is + − × and comparisons on arrays, which compilers turn into vector instructions; the
//! results are those of the scalar lookup to the bit.

use glam::DVec2;

use super::RUN;
use super::round::{INTEGERS, INTEGERS_SINGLE, clamp, floor, floor_within, floor_within_single};
use crate::position::Scalar;

/// Where the pixels of an image lie in the caller's plane.
#[derive(Clone, Copy, Debug)]
pub(in crate::importance) struct Lattice {
    pub(in crate::importance) width: usize,
    pub(in crate::importance) height: usize,
    /// The least corner of pixel (0, 0).
    pub(in crate::importance) min: DVec2,
    pub(in crate::importance) texels_per_unit: DVec2,
    /// `texels_per_unit`, if pixel coordinates of positions that are relative to corner 0 are the same
    /// computed in `f32`: powers of two scale without rounding, and every index is exact below 2²².
    single: Option<[f32; 2]>,
}

impl Lattice {
    pub(in crate::importance) fn new(
        width: usize,
        height: usize,
        min: DVec2,
        texels_per_unit: DVec2,
    ) -> Self {
        let scale = [texels_per_unit.x, texels_per_unit.y];
        // Positive normal numbers without mantissa bits, far from the ends of f32's range.
        let is_power = |s: f64| s.to_bits() << 12 == 0 && (1e-30..1e30).contains(&s);
        let small = width.checked_mul(height).is_some_and(|pixels| pixels < 1 << 22);
        let single = small && min == DVec2::ZERO && scale.into_iter().all(is_power);
        let single = single.then(|| scale.map(|s| s as f32));
        Self { width, height, min, texels_per_unit, single }
    }

    /// Column and row of the pixel under a point; the nearest one beyond the image.
    #[inline]
    pub(in crate::importance) fn texel(&self, at: DVec2) -> (usize, usize) {
        let t = (at - self.min) * self.texels_per_unit;
        // `as` takes negative numbers and NaN to 0.
        ((t.x as usize).min(self.width - 1), (t.y as usize).min(self.height - 1))
    }

    /// `values[i]` = the pixel under `origin` + (x[i], y[i]).
    #[inline(always)]
    pub(in crate::importance) fn values<S: Scalar>(
        &self,
        pixels: &[f32],
        origin: DVec2,
        x: &[S],
        y: &[S],
        values: &mut [f64],
    ) {
        let mut indices = [0u32; RUN];
        // Past 2³² pixels an index leaves `u32`.
        if pixels.len() >= u32::MAX as usize {
            for ((value, x), y) in values.iter_mut().zip(x).zip(y) {
                let (column, row) = self.texel(origin + DVec2::new(x.to_f64(), y.to_f64()));
                *value = f64::from(pixels[row * self.width + column]);
            }
            return;
        }
        for ((values, x), y) in values.chunks_mut(RUN).zip(x.chunks(RUN)).zip(y.chunks(RUN)) {
            let indices = &mut indices[..x.len()];
            match (self.single, S::as_singles(x), S::as_singles(y)) {
                (Some(scale), Some(x), Some(y)) if origin == DVec2::ZERO => {
                    self.indices_single(scale, x, y, indices);
                }
                _ => self.indices_double(origin, x, y, indices),
            }
            for (value, index) in values.iter_mut().zip(indices) {
                *value = f64::from(pixels[*index as usize]);
            }
        }
    }

    /// Whether the pixels under the points (x[i], y[i]) are above 0: 1 or 0.
    #[inline(always)]
    pub(in crate::importance) fn are_above(
        &self,
        pixels: &[f32],
        x: &[f64],
        y: &[f64],
        above: &mut [u8],
    ) {
        let mut values = [0.0; RUN];
        for ((above, x), y) in above.chunks_mut(RUN).zip(x.chunks(RUN)).zip(y.chunks(RUN)) {
            let values = &mut values[..x.len()];
            self.values(pixels, DVec2::ZERO, x, y, values);
            for (above, value) in above.iter_mut().zip(values) {
                *above = u8::from(*value > 0.0);
            }
        }
    }

    /// For discs of one radius around `origin` + (x[i], y[i]): first and last column and row, in
    /// texels of 2^shift pixels each way, of their bounding squares. Returns shift, the least at which
    /// no square touches more than three columns or rows.
    #[inline(always)]
    pub(in crate::importance) fn spans(
        &self,
        origin: DVec2,
        x: &[f64],
        y: &[f64],
        radius: f64,
        low: &mut [[u32; 2]],
        high: &mut [[u32; 2]],
    ) -> usize {
        let Self { width, height, min, texels_per_unit: scale, .. } = *self;
        // A square touches three at most if its side is below two texels, a little less for rounding.
        let side = (2.0 + 1e-6) * radius * scale.x.max(scale.y);
        let greatest = usize::BITS - (width.max(height) - 1).leading_zeros();
        let mut shift = 0;
        let mut texels = 2.0;
        // Few steps, the same ones in all tiles of a level.
        while side >= texels && shift < greatest {
            (shift, texels) = (shift + 1, 2.0 * texels);
        }
        let (shrink, last_x, last_y) = (2.0 / texels, (width - 1) as f64, (height - 1) as f64);
        let index = |at: f64, min: f64, scale: f64, last: f64| {
            let t = clamp((at - min) * scale, last) * shrink;
            (floor(t) + INTEGERS).to_bits() as u32
        };
        for (((low, high), x), y) in low.iter_mut().zip(high).zip(x).zip(y) {
            let (x, y) = (origin.x + *x, origin.y + *y);
            *low = [
                index(x - radius, min.x, scale.x, last_x),
                index(y - radius, min.y, scale.y, last_y),
            ];
            *high = [
                index(x + radius, min.x, scale.x, last_x),
                index(y + radius, min.y, scale.y, last_y),
            ];
        }
        shift as usize
    }

    #[inline(always)]
    fn indices_double<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], indices: &mut [u32]) {
        let Self { width, height, min, texels_per_unit: scale, .. } = *self;
        let (last_x, last_y, width) = ((width - 1) as f64, (height - 1) as f64, width as f64);
        for ((index, x), y) in indices.iter_mut().zip(x).zip(y) {
            let column = floor_within((origin.x + x.to_f64() - min.x) * scale.x, last_x);
            let row = floor_within((origin.y + y.to_f64() - min.y) * scale.y, last_y);
            // Integers below 2³², exact.
            *index = (row * width + column + INTEGERS).to_bits() as u32;
        }
    }

    #[inline(always)]
    fn indices_single(&self, scale: [f32; 2], x: &[f32], y: &[f32], indices: &mut [u32]) {
        let (last_x, last_y) = ((self.width - 1) as f32, (self.height - 1) as f32);
        let width = self.width as f32;
        for ((index, x), y) in indices.iter_mut().zip(x).zip(y) {
            let column = floor_within_single(x * scale[0], last_x);
            let row = floor_within_single(y * scale[1], last_y);
            // Integers below 2²², exact.
            *index = (row * width + column + INTEGERS_SINGLE).to_bits() & 0x3f_ffff;
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
        fn many_lookups_are_the_single_one(
            (width, height) in (1usize..70, 1usize..70),
            min in prop_oneof![Just(DVec2::ZERO), Just(DVec2::new(-3.25, 7.7))],
            scale in prop_oneof![
                Just(DVec2::ONE), Just(DVec2::new(0.25, 64.0)), Just(DVec2::new(0.3, 17.0))
            ],
            origin in prop_oneof![Just(DVec2::ZERO), Just(DVec2::new(0.1, -5.0))],
            points in prop::collection::vec((-9.0f64..90.0, -9.0f64..90.0), 0..600),
        ) {
            let lattice = Lattice::new(width, height, min, scale);
            let pixels: Vec<f32> = (0..width * height).map(|i| i as f32).collect();
            // Quarters are exact in both precisions and hit the borders between pixels.
            let mut x: Vec<f64> = points.iter().map(|p| p.0).collect();
            let mut y: Vec<f64> = points.iter().map(|p| p.1).collect();
            x.extend([0.0, -0.0, 1.0, 2.0, 3.0, 0.25, 1e30, -1e30, f64::NAN, 1.0 - 1e-16, 2.5]);
            y.extend([0.0, 1.0, -0.0, 3.0, f64::NAN, 8.0, 1e30, -1e30, 0.5, 2.5, 1.0 - 1e-16]);
            let single = |v: &[f64]| v.iter().map(|v| *v as f32).collect::<Vec<_>>();
            let (sx, sy) = (single(&x), single(&y));
            let mut values = alloc::vec![0.0; x.len()];
            let expected = |x: f64, y: f64| {
                let (column, row) = lattice.texel(origin + DVec2::new(x, y));
                (row * width + column) as f64
            };
            lattice.values(&pixels, origin, &x, &y, &mut values);
            for i in 0..x.len() {
                prop_assert_eq!(values[i], expected(x[i], y[i]));
            }
            lattice.values(&pixels, origin, &sx, &sy, &mut values);
            for i in 0..x.len() {
                prop_assert_eq!(values[i], expected(sx[i].into(), sy[i].into()));
            }
        }
    }
}
