//! The nearest place on pixels where a point may be.

use glam::DVec2;

use super::nearest::Lattice;

/// A point that is put on a pixel stays this part of the pixel's side away from its border, so that rounding to
/// single precision leaves it on that pixel.
const BORDER: f64 = 1.0 / 256.0;

impl Lattice {
    /// The place nearest to `moved` on pixels, by column and row, where a point `may_lie`, among the places no farther
    /// from `center` than `moved` is; a little inside its pixel. Border pixels go on beyond the image. Of
    /// places equally near, the one on the pixel nearest to that of `moved`, then on the upper, the left one.
    /// The pixel of `moved` itself is not asked. O(pixels as near as the one found).
    pub(in crate::importance) fn nearest(
        &self,
        center: DVec2,
        moved: DVec2,
        may_lie: impl Fn(usize, usize) -> bool,
    ) -> Option<DVec2> {
        let (column, row) = self.texel(moved);
        let side = DVec2::ONE / self.texels_per_unit;
        let longest = (moved - center).length_squared();
        let (mut nearest, mut least) = (None, longest);
        // Rings of pixels around the first.
        for ring in 1..self.width.max(self.height) {
            // So many whole pixels are between.
            let between = (ring - 1) as f64 * side.min_element();
            if between * between > least {
                break;
            }
            let columns = column.saturating_sub(ring)..=(column + ring).min(self.width - 1);
            for y in row.saturating_sub(ring)..=(row + ring).min(self.height - 1) {
                // The ends alone of the rows in the middle.
                let step = if y.abs_diff(row) < ring { 2 * ring } else { 1 };
                let first = match step {
                    1 => *columns.start(),
                    _ => column.checked_sub(ring).unwrap_or(column + ring),
                };
                for x in (first..=*columns.end()).step_by(step) {
                    let at = self.within([x, y], side, moved);
                    let distance = (at - moved).length_squared();
                    let is_near = distance < least && (at - center).length_squared() <= longest;
                    if is_near && may_lie(x, y) {
                        (nearest, least) = (Some(at), distance);
                    }
                }
            }
        }
        nearest
    }

    /// The place nearest to a point a little inside a pixel of this size.
    #[inline(always)]
    fn within(&self, [x, y]: [usize; 2], side: DVec2, at: DVec2) -> DVec2 {
        let along = |at: f64, i: usize, count: usize, min: f64, side: f64| {
            let (low, high) = (i as f64 + BORDER, (i + 1) as f64 - BORDER);
            let (low, high) = (min + low * side, min + high * side);
            let at = if at < low && i > 0 { low } else { at };
            if at > high && i + 1 < count { high } else { at }
        };
        DVec2::new(
            along(at.x, x, self.width, self.min.x, side.x),
            along(at.y, y, self.height, self.min.y, side.y),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_place_that_is_allowed_is_nearer(
            (width, height) in (1usize..24, 1usize..24),
            min in prop_oneof![Just(DVec2::ZERO), Just(DVec2::new(-3.25, 7.75))],
            scale in prop_oneof![Just(DVec2::ONE), Just(DVec2::new(0.25, 2.0))],
            (center, moved) in ([-0.2f64..1.2, -0.2f64..1.2], [-0.2f64..1.2, -0.2f64..1.2]),
            share in 0u32..10,
            seed: u32,
        ) {
            let lattice = Lattice::new(width, height, min, scale);
            let size = DVec2::new(width as f64, height as f64) / scale;
            let (center, moved) = (min + size * DVec2::from(center), min + size * DVec2::from(moved));
            let allowed = |x: usize, y: usize| {
                let i = (y * width + x) as u32 ^ seed;
                (x, y) != lattice.texel(moved) && i.wrapping_mul(2_654_435_761) >> 16 & 15 > share
            };
            let found = lattice.nearest(center, moved, allowed);
            // The slow way: all pixels, and the place on each by clamping to its corners.
            let side = DVec2::ONE / scale;
            let places: Vec<DVec2> = (0..width * height)
                .map(|i| (i % width, i / width))
                .filter(|(x, y)| allowed(*x, *y))
                .map(|(x, y)| {
                    let low = min + (DVec2::new(x as f64, y as f64) + BORDER) * side;
                    let high = low + (1.0 - 2.0 * BORDER) * side;
                    let ends = |i: usize, count: usize, low: f64, high: f64| {
                        let low = if i == 0 { f64::MIN } else { low };
                        (low, if i + 1 == count { f64::MAX } else { high })
                    };
                    let (left, right) = ends(x, width, low.x, high.x);
                    let (top, bottom) = ends(y, height, low.y, high.y);
                    moved.clamp(DVec2::new(left, top), DVec2::new(right, bottom))
                })
                .collect();
            let reach = moved.distance(center);
            let within = |slack: f64| {
                let near = places.iter().filter(|at| at.distance(center) <= reach * (1.0 + slack));
                near.map(|at| at.distance(moved)).fold(f64::INFINITY, f64::min)
            };
            match found {
                Some(at) => {
                    let (x, y) = lattice.texel(at);
                    prop_assert!(allowed(x, y));
                    prop_assert!(at.distance(center) <= reach * (1.0 + 1e-12));
                    prop_assert!(at.distance(moved) <= within(-1e-12) + 1e-9);
                    prop_assert!(at.distance(moved) >= within(1e-12) - 1e-9);
                }
                None => prop_assert!(within(-1e-12) >= reach * (1.0 - 1e-9)),
            }
        }
    }
}
