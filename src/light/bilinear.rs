//! Pixels interpolated between their centers, over the seam and the poles, and sampled exactly.
//!
//! Within a pixel, interpolated luminance is one bilinear function in each quarter, and solid angle is
//! uniform (cos θ is linear within a row). So a pixel's share of the light is a weighted sum of nine
//! pixels, and inside it the density can be inverted: first which half, then a linear density, down;
//! then the same across.
//!
//! ```text
//!   a───────b───────c      values at the centers of nine pixels;
//!   │   ┌───┼───┐   │      the middle one has the four quarters
//!   d───┼───e───┼───f      around e, whose corners are e, the mean of
//!   │   └───┼───┘   │      e and b, that of e, a, b and d, …
//!   g───────h───────i
//! ```

use glam::DVec2;

use crate::estimate::sums::BELOW_ONE;
use crate::importance::{EnvironmentMap, luminance};

/// Luminance at the centers of a pixel and its eight neighbors, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch([[f64; 3]; 3]);

/// Columns and rows of a pixel's nine, with what lies beyond the seam and the poles.
fn around((width, height): (usize, usize), column: usize, row: usize) -> [[usize; 3]; 3] {
    // Past a pole the image goes on upside down on the other side of it.
    let opposite = |column: usize| (column + width / 2) % width;
    let columns = [(column + width - 1) % width, column, (column + 1) % width];
    let index = |row: usize, columns: [usize; 3]| columns.map(|column| row * width + column);
    let above = match row {
        0 => index(0, columns.map(opposite)),
        _ => index(row - 1, columns),
    };
    let below =
        if row + 1 == height { index(row, columns.map(opposite)) } else { index(row + 1, columns) };
    [above, index(row, columns), below]
}

/// The share of each of three centers in the interpolated value at `at` from the middle's border, in
/// [0, 1).
fn shares(at: f64) -> [f64; 3] {
    let before = (0.5 - at).max(0.0);
    let after = (at - 0.5).max(0.0);
    [before, 1.0 - before - after, after]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Radiance at a place in a pixel, interpolated.
pub(super) fn radiance(map: &EnvironmentMap, column: usize, row: usize, at: DVec2) -> [f32; 3] {
    let (across, down) = (shares(at.x), shares(at.y));
    let pixels = map.pixels();
    let mut sum = [0.0; 3];
    for (indices, down) in around(map.size(), column, row).into_iter().zip(down) {
        for (index, across) in indices.into_iter().zip(across) {
            for (sum, component) in sum.iter_mut().zip(pixels[index]) {
                *sum += down * across * f64::from(component);
            }
        }
    }
    sum.map(|component| component as f32)
}

impl Patch {
    pub(super) fn new(map: &EnvironmentMap, column: usize, row: usize) -> Self {
        let pixels = map.pixels();
        Self(around(map.size(), column, row).map(|row| row.map(|i| luminance(pixels[i]))))
    }

    /// The mean over the middle pixel.
    pub(super) fn mean(&self) -> f64 {
        // ∫ of the shares over [0, 1).
        let weights = [0.125, 0.75, 0.125];
        dot(weights, self.0.map(|row| dot(row, weights)))
    }

    /// The value at a place in the middle pixel.
    pub(super) fn value(&self, at: DVec2) -> f64 {
        dot(shares(at.y), self.0.map(|row| dot(row, shares(at.x))))
    }

    /// Where in the middle pixel a uniform point of [0, 1)² goes, for the density to follow the value.
    /// The mean must be above 0.
    pub(super) fn find(&self, at: DVec2) -> DVec2 {
        let weights = [0.125, 0.75, 0.125];
        let y = find(self.0.map(|row| dot(row, weights)), at.y);
        let x = find(self.across(y), at.x);
        DVec2::new(x, y)
    }

    /// The inverse of [`find`](Self::find).
    pub(super) fn trace(&self, at: DVec2) -> DVec2 {
        let weights = [0.125, 0.75, 0.125];
        let y = trace(self.0.map(|row| dot(row, weights)), at.y);
        DVec2::new(trace(self.across(at.y), at.x), y)
    }

    /// The three columns' values at a height.
    fn across(&self, y: f64) -> [f64; 3] {
        let [a, b, c] = self.0;
        let shares = shares(y);
        core::array::from_fn(|i| dot(shares, [a[i], b[i], c[i]]))
    }
}

/// The values at the pixel's borders and its center: between them the density is linear.
fn knots([before, middle, after]: [f64; 3]) -> [f64; 3] {
    [0.5 * (before + middle), middle, 0.5 * (middle + after)]
}

/// The place in [0, 1) below which lies the part u of the density that is linear between its knots.
fn find(centers: [f64; 3], u: f64) -> f64 {
    let [start, middle, end] = knots(centers);
    // Twice the areas of the halves, in half pixels.
    let (first, second) = (start + middle, middle + end);
    let along = u * (first + second);
    if along < first {
        0.5 * ramp(start, middle, along / first).min(BELOW_ONE)
    } else {
        (0.5 + 0.5 * ramp(middle, end, (along - first) / second)).min(BELOW_ONE)
    }
}

/// The inverse of [`find`].
fn trace(centers: [f64; 3], at: f64) -> f64 {
    let [start, middle, end] = knots(centers);
    let (first, second) = (start + middle, middle + end);
    // The part of a ramp's area before t: t(2a + t(b − a)) / (a + b).
    let before = |a: f64, b: f64, t: f64| t * (2.0 * a + t * (b - a));
    let area = if at < 0.5 {
        before(start, middle, 2.0 * at)
    } else {
        first + before(middle, end, 2.0 * at - 1.0)
    };
    (area / (first + second)).clamp(0.0, BELOW_ONE)
}

/// Where in [0, 1] the density that rises or falls from a to b has the part u of itself before: the
/// root of t(2a + t(b − a)) = u(a + b), in the form that divides by no small difference.
fn ramp(a: f64, b: f64, u: f64) -> f64 {
    let area = u * (a + b);
    let root = libm::sqrt((a * a + area * (b - a)).max(0.0));
    if area > 0.0 { (area / (a + root)).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn a_patch_is_inverted_and_its_density_is_its_value() {
        let mut random = SplitMix64::new(2);
        for trial in 0..60 {
            // Some with zeros, which the density vanishes towards.
            let mut value = || if random.unit() < 0.4 { 0.0 } else { random.unit() };
            let mut patch = Patch([[0.0; 3]; 3].map(|row: [f64; 3]| row.map(|_| value())));
            if trial == 0 {
                patch = Patch([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
            }
            let mean = patch.mean();
            if mean == 0.0 {
                continue;
            }
            for _ in 0..100 {
                let u = DVec2::new(random.unit(), random.unit()) * 0.998 + 0.001;
                let at = patch.find(u);
                assert!(at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::ONE).all());
                assert!(patch.trace(at).distance(u) < 1e-9, "{patch:?} {u}");
                // A small square's image has the area that the density says.
                let step = 1e-5;
                let dx =
                    patch.find(u + DVec2::new(step, 0.0)) - patch.find(u - DVec2::new(step, 0.0));
                let dy =
                    patch.find(u + DVec2::new(0.0, step)) - patch.find(u - DVec2::new(0.0, step));
                let area = dx.perp_dot(dy).abs() / (4.0 * step * step);
                let density = patch.value(at) / mean;
                let knot = |c: f64| (c - 0.5).abs() < 1e-3;
                if !(knot(at.x) || knot(at.y)) && density > 0.05 {
                    assert!((area * density - 1.0).abs() < 1e-3, "{area} {density} {patch:?} {u}");
                }
            }
        }
    }

    #[test]
    fn neighbors_lie_beyond_the_seam_and_the_poles() {
        assert_eq!(around((8, 4), 0, 0), [[3, 4, 5], [7, 0, 1], [15, 8, 9]]);
        assert_eq!(around((8, 4), 7, 3), [[22, 23, 16], [30, 31, 24], [26, 27, 28]]);
        assert_eq!(around((1, 1), 0, 0), [[0; 3]; 3]);
    }
}
