//! How faithfully points follow an importance image.

use glam::DVec2;

use super::nearest::{self, Summary};
use super::{MeasureError, Window, hexagonal_distance};

/// An importance image as the measures see it: `values[y·width + x]` is the importance on the pixel
/// [x, x + 1) × [y, y + 1).
#[derive(Clone, Copy, Debug)]
pub struct Raster<'a> {
    values: &'a [f32],
    width: usize,
}

/// How faithfully points follow an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fidelity {
    /// Points in the image.
    pub count: usize,
    /// Variance of the counts in blocks of 64 expected points, Poisson = 1.
    pub block_variance: f64,
    /// Mean distance to the nearest point in local hexagonal units.
    pub mean_distance: f64,
    /// The distance, in local hexagonal units, that 1 % of the points fall short of.
    pub first_percentile: f64,
}

impl<'a> Raster<'a> {
    /// Of `width` pixels a row.
    ///
    /// # Errors
    /// [`MeasureError::NotRows`] unless the values fill whole rows, at least one;
    /// [`MeasureError::Pixel`] for the first that is not finite or below 0.
    pub fn new(width: usize, values: &'a [f32]) -> Result<Self, MeasureError> {
        if values.is_empty() || values.len().checked_rem(width) != Some(0) {
            return Err(MeasureError::NotRows { width, pixels: values.len() });
        }
        match values.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
            Some(i) => Err(MeasureError::Pixel { x: i % width, y: i / width }),
            None => Ok(Self { values, width }),
        }
    }

    fn height(&self) -> usize {
        self.values.len() / self.width
    }

    fn window(&self) -> Window {
        let size = DVec2::new(self.width as f64, self.height() as f64);
        Window { min: DVec2::ZERO, size }
    }

    /// The importance of the pixel that holds `p`, of the nearest one for a point outside.
    #[must_use]
    pub fn at(&self, p: DVec2) -> f64 {
        // Casting saturates at 0.
        let x = (p.x as usize).min(self.width - 1);
        let y = (p.y as usize).min(self.height() - 1);
        f64::from(self.values[y * self.width + x])
    }
}

/// Cuts the image by halves, always across the longer side and where the importance on both sides is
/// equal, until a block expects about `points_per_block` points; the variance of (count − expected),
/// relative to the expected count, over the blocks: 1 for independent points.
///
/// Counts are compared with the importance of the block, scaled so that the whole image expects
/// exactly the points that lie in it.
///
/// # Errors
/// [`MeasureError::AllZero`] for an image of nothing, [`MeasureError::TooFew`] if it holds fewer than
/// two blocks' points, [`MeasureError::PointsPerBlock`] unless that is at least 1.
pub fn block_variance(
    points: &[DVec2],
    image: &Raster<'_>,
    points_per_block: f64,
) -> Result<f64, MeasureError> {
    if points_per_block.is_nan() || points_per_block < 1.0 {
        return Err(MeasureError::PointsPerBlock(points_per_block));
    }
    let mut inside: Vec<DVec2> =
        points.iter().copied().filter(|p| image.window().contains(*p)).collect();
    let sums = Sums::new(image);
    let total = sums.rectangle(DVec2::ZERO, image.window().size);
    if total <= 0.0 {
        return Err(MeasureError::AllZero);
    }
    if (inside.len() as f64) < 2.0 * points_per_block {
        let needed = libm::ceil(2.0 * points_per_block) as usize;
        return Err(MeasureError::TooFew { found: inside.len(), needed });
    }
    let depth = libm::round(libm::log2(inside.len() as f64 / points_per_block)) as u32;
    let mut result = (0.0, 0u32);
    let scale = inside.len() as f64 / total;
    sums.split(&mut inside, image.window(), depth, scale, &mut result);
    // Rounding may leave no block with importance if one pixel outweighs the others by 10¹⁶.
    if result.1 == 0 { Err(MeasureError::AllZero) } else { Ok(result.0 / f64::from(result.1)) }
}

/// Integrals of the image from the corner: `sums[y][x]` over [0, x) × [0, y).
struct Sums {
    sums: Vec<f64>,
    stride: usize,
}

impl Sums {
    fn new(image: &Raster<'_>) -> Self {
        let stride = image.width + 1;
        let mut sums = vec![0.0; stride * (image.height() + 1)];
        for y in 0..image.height() {
            let mut row = 0.0;
            for x in 0..image.width {
                row += f64::from(image.values[y * image.width + x]);
                sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
            }
        }
        Self { sums, stride }
    }

    /// The integral over [0, p.x) × [0, p.y): bilinear between pixel corners, which is exact.
    fn corner(&self, p: DVec2) -> f64 {
        let (x, y) = (p.x as usize, p.y as usize);
        let (fx, fy) = (p.x - x as f64, p.y - y as f64);
        let rows = self.sums.len() / self.stride;
        let at =
            |x: usize, y: usize| self.sums[y.min(rows - 1) * self.stride + x.min(self.stride - 1)];
        (at(x, y) * (1.0 - fx) + at(x + 1, y) * fx) * (1.0 - fy)
            + (at(x, y + 1) * (1.0 - fx) + at(x + 1, y + 1) * fx) * fy
    }

    fn rectangle(&self, min: DVec2, max: DVec2) -> f64 {
        self.corner(max)
            - self.corner(DVec2::new(min.x, max.y))
            - self.corner(DVec2::new(max.x, min.y))
            + self.corner(min)
    }

    fn split(
        &self,
        points: &mut [DVec2],
        window: Window,
        depth: u32,
        scale: f64,
        result: &mut (f64, u32),
    ) {
        let max = window.min + window.size;
        let mass = self.rectangle(window.min, max);
        if depth == 0 {
            let expected = mass * scale;
            if expected > 0.0 {
                let excess = points.len() as f64 - expected;
                result.0 += excess * excess / expected;
                result.1 += 1;
            }
            return;
        }
        let axis = usize::from(window.size.y > window.size.x);
        let (mut low, mut high) = (window.min[axis], max[axis]);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let mut corner = max;
            corner[axis] = middle;
            let below = self.rectangle(window.min, corner) < 0.5 * mass;
            *(if below { &mut low } else { &mut high }) = middle;
        }
        let mut first = Window { min: window.min, size: window.size };
        first.size[axis] = low - window.min[axis];
        let mut second = Window { min: window.min, size: window.size };
        second.min[axis] = low;
        second.size[axis] = max[axis] - low;
        let half = partition(points, |p| p[axis] < low);
        let (left, right) = points.split_at_mut(half);
        self.split(left, first, depth - 1, scale, result);
        self.split(right, second, depth - 1, scale, result);
    }
}

/// Moves the points that satisfy `first` to the front and returns how many they are.
fn partition(points: &mut [DVec2], first: impl Fn(&DVec2) -> bool) -> usize {
    let mut count = 0;
    for i in 0..points.len() {
        if first(&points[i]) {
            points.swap(i, count);
            count += 1;
        }
    }
    count
}

/// The distance of each point to its nearest neighbor in units of the hexagonal lattice of the
/// density that the image asks for at the point: importance at its pixel × `density_per_importance`.
/// Points on pixels of importance 0 are left out, as they have no unit.
///
/// # Errors
/// As [`nearest::distances`].
pub fn local_distances(
    points: &[DVec2],
    image: &Raster<'_>,
    density_per_importance: f64,
) -> Result<Vec<f64>, MeasureError> {
    let inside: Vec<DVec2> =
        points.iter().copied().filter(|p| image.window().contains(*p)).collect();
    Ok(nearest::distances(points, &inside)?
        .iter()
        .zip(&inside)
        .map(|(distance, p)| (distance, image.at(*p)))
        .filter(|(_, importance)| *importance > 0.0)
        .map(|(distance, importance)| {
            distance / hexagonal_distance(importance * density_per_importance)
        })
        .collect())
}

/// The share of the points in the image that lie on pixels of importance 0: the wrong side of edges.
/// 0 if no point lies in the image.
#[must_use]
pub fn share_on_zero(points: &[DVec2], image: &Raster<'_>) -> f64 {
    let window = image.window();
    let (mut inside, mut wrong) = (0u64, 0u64);
    for p in points.iter().filter(|p| window.contains(**p)) {
        inside += 1;
        wrong += u64::from(image.at(*p) <= 0.0);
    }
    wrong as f64 / inside.max(1) as f64
}

/// Measures points against the image: variance in blocks of 64 and local nearest distances. Points
/// outside the image serve as neighbors only.
///
/// # Errors
/// As [`block_variance`] and [`local_distances`]; [`MeasureError::TooFew`] if all points lie on pixels
/// of importance 0.
pub fn fidelity(points: &[DVec2], image: &Raster<'_>) -> Result<Fidelity, MeasureError> {
    let count = points.iter().filter(|p| image.window().contains(**p)).count();
    let total: f64 = image.values.iter().map(|v| f64::from(*v)).sum();
    let block_variance = block_variance(points, image, 64.0)?;
    let distances = Summary::new(local_distances(points, image, count as f64 / total)?)?;
    Ok(Fidelity {
        count,
        block_variance,
        mean_distance: distances.mean(),
        first_percentile: distances.percentile(0.01),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    #[test]
    fn independent_points_have_variance_one_and_lattices_almost_none() {
        let (width, height) = (96, 64);
        // Importance rising to the right: u = (x/width)² has the density 2x, so x = width·√u.
        let values: Vec<f32> = (0..width * height).map(|i| (i % width) as f32 + 0.5).collect();
        let image = Raster::new(width, &values).unwrap();
        let mut state = 2;
        let points: Vec<DVec2> = (0..60_000)
            .map(|_| {
                let x = width as f64 * uniform(&mut state).sqrt();
                DVec2::new(x, height as f64 * uniform(&mut state))
            })
            .collect();
        let measured = fidelity(&points, &image).unwrap();
        assert!((measured.block_variance - 1.0).abs() < 0.12, "{measured:?}");
        // The mean nearest distance of a Poisson process, 1/(2√ρ), over the hexagonal one.
        assert!((measured.mean_distance - 0.465).abs() < 0.01, "{measured:?}");
        // 1 % lie nearer than r with ρπr² = −ln 0.99.
        assert!((measured.first_percentile - 0.0526).abs() < 0.005, "{measured:?}");

        let flat = vec![1.0; width * height];
        let image = Raster::new(width, &flat).unwrap();
        let lattice: Vec<DVec2> = (0..256 * 384)
            .map(|i| DVec2::new(f64::from(i % 384) + 0.5, f64::from(i / 384) + 0.5) * 0.25)
            .collect();
        let measured = fidelity(&lattice, &image).unwrap();
        assert!(measured.block_variance < 0.2, "{measured:?}");
        // A square lattice: √(√3/2) of the hexagonal distance.
        assert!((measured.first_percentile - 0.9306).abs() < 1e-3, "{measured:?}");
    }

    #[test]
    fn points_on_nothing_are_counted_as_wrong() {
        let values = [0.0, 1.0];
        let image = Raster::new(2, &values).unwrap();
        let at = |x: f64| DVec2::new(x, 0.5);
        assert_eq!(share_on_zero(&[at(0.99), at(1.0), at(1.5), at(1.9), at(2.0)], &image), 0.25);
        assert_eq!(share_on_zero(&[], &image), 0.0);
        assert_eq!(
            block_variance(&[at(1.5); 127], &image, 64.0),
            Err(MeasureError::TooFew { found: 127, needed: 128 })
        );
        let nothing = Raster::new(1, &[0.0]).unwrap();
        assert_eq!(block_variance(&[at(0.5); 200], &nothing, 64.0), Err(MeasureError::AllZero));
    }
}
