//! Warps: a uniform set bent into the density of a map.

use alloc::vec::Vec;

use glam::DVec2;

use super::exact::ExactError;
use super::seamless::SeamlessSet;
use super::sums::SumPyramid;
use super::weighted::Weighted;
use crate::importance::ImageMap;
use crate::sampling::Limits;

/// The hierarchical warp from the unit square to a map's domain that turns the uniform density into
/// the map's (P. Clarberg et al., *Wavelet Importance Sampling*, 2005).
///
/// From the whole map down to a pixel, the square is divided into upper and lower half in the ratio of
/// their sums, then left and right, and each part is stretched to a half square. Neighbors stay
/// neighbors but for the stretching, so that a set of low discrepancy keeps most of its merit: the
/// least error per sample known for environment maps, with a seamless level of the tiling as well as
/// with Owen-scrambled [Sobol](crate::light::Sobol) points. Pixels of importance 0 get no point.
///
/// O(pixels) to make; 3 to 4 numbers read a level and point.
#[derive(Clone, Debug)]
pub struct Warp<'m> {
    map: &'m ImageMap,
    sums: SumPyramid,
}

impl<'m> Warp<'m> {
    /// The warp to a map's density; `None` if the map is 0 everywhere.
    #[must_use]
    pub fn new(map: &'m ImageMap) -> Option<Self> {
        let sums = SumPyramid::new(map.pixels(), map.size());
        let sum = sums.total();
        (sum > 0.0 && sum.is_finite()).then_some(Self { map, sums })
    }

    /// Where a point of [0, 1)² goes: to a point of the domain inside a pixel above 0, unless the domain
    /// is so far from the origin that `f64` cannot tell its pixels apart. Coordinates outside of [0, 1),
    /// NaN included, count as the nearest inside.
    #[must_use]
    pub fn position(&self, at: DVec2) -> DVec2 {
        let (column, row, at) = self.pixel(at);
        self.inside(column, row, at)
    }

    /// The point at `at` in [0, 1)² of a pixel, in the map's domain.
    fn inside(&self, column: usize, row: usize, at: DVec2) -> DVec2 {
        let domain = self.map.domain();
        let (width, height) = self.map.size();
        let size = domain.size() / DVec2::new(width as f64, height as f64);
        let position = domain.min() + size * (DVec2::new(column as f64, row as f64) + at);
        // Rounding may carry a point to the next pixel, which may be 0, or out of the domain.
        let fits = |p: DVec2| self.map.texel(p) == (column, row) && domain.contains(p);
        let center = domain.min() + size * DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
        if fits(position) {
            position
        } else if domain.contains(center) {
            center
        } else {
            domain.min()
        }
    }

    /// The pixel to which a point goes, and where in it.
    fn pixel(&self, at: DVec2) -> (usize, usize, DVec2) {
        self.sums.find(self.map.pixels(), self.sums.top(), at)
    }

    /// The weighted point to which a point of [0, 1)² goes, as one of `n`. The estimate from n points
    /// that are each uniform in the square is unbiased.
    #[must_use]
    pub fn weighted(&self, at: DVec2, n: usize, rank: u64) -> Weighted {
        let (x, y, at) = self.pixel(at);
        let position = self.inside(x, y, at);
        let value = f64::from(self.map.pixels()[y * self.map.size().0 + x]);
        let integral = self.map.mean() * self.map.domain().area();
        let density = n as f64 * (value / integral);
        Weighted { position, rank, density, weight: 1.0 / density }
    }

    /// [`post_stratify`](super::post_stratify) without summing the pixels again: O(points·log points).
    pub fn post_stratify(&self, points: &mut [Weighted], per_cell: f64) {
        super::stratified::weigh(points, self.map, &self.sums, per_cell);
    }

    /// Exactly `n` points that follow the map: a [`SeamlessSet`] of the tiling, warped, in no useful
    /// order; ranks are the order. Best where n is a multiple of 4.
    ///
    /// To make many sets of one number, keep the set and warp its [points](SeamlessSet::points).
    ///
    /// # Errors
    /// Those of [`SeamlessSet::new`], with `limits`.
    pub fn level(&self, n: usize, seed: u64, limits: Limits) -> Result<Vec<Weighted>, ExactError> {
        let set = SeamlessSet::new(n, limits)?;
        Ok((0..).zip(set.points(seed)).map(|(rank, at)| self.weighted(at, n, rank)).collect())
    }
}
