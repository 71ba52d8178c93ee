//! Points with the weights that make them estimates.

use glam::DVec2;

use crate::emit::Points;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::sampling::Sampling;

/// How points are weighted. See the table of the [module](super).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Weighting {
    /// 1/density: unbiased.
    #[default]
    Density,
    /// 2(1 − z)/density, z = (rank + u)/T: unbiased, and more accurate where f is smooth.
    Smoothed,
}

/// A point of a set that estimates integrals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighted {
    /// Where it is, in the caller's units, inside the half-open domain.
    pub position: DVec2,
    /// Its index in the placement's endless sequence.
    pub rank: u64,
    /// Points expected in a squared unit at the position: above 0, unless rounding carried the position
    /// over an edge of the importance; then density and weight are 0.
    pub density: f64,
    /// The area that the point stands for: Σ f(position)·weight estimates ∫ f. Not negative.
    pub weight: f64,
}

/// Iterator over weighted points, in the order of the walk. After the first error it ends.
#[derive(Clone, Debug)]
pub struct WeightedPoints<'a, I> {
    sampling: Sampling<'a, I>,
    points: Points<'a, I, DVec2>,
    weighting: Weighting,
}

impl<'a, I: Importance> Sampling<'a, I> {
    /// The points with density and weight, one more evaluation of the importance a point.
    ///
    /// ```
    /// use glam::DVec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling, estimate::Weighting};
    ///
    /// let placement = Placement::new(Domain::UNIT, 1);
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(4096.0))?;
    /// let mut integral = 0.0;
    /// for point in sampling.weighted(Weighting::Smoothed)? {
    ///     let point = point?;
    ///     integral += point.position.x * point.position.y * point.weight;
    /// }
    /// assert!((integral - 0.25).abs() < 0.005);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// # Errors
    /// [`SamplingError::Relaxed`] for [`relaxed`](Self::relaxed) points, which are accepted in one place
    /// and lie in another; [`SamplingError::Precision`] if no `f64` lies in the domain.
    pub fn weighted(&self, weighting: Weighting) -> Result<WeightedPoints<'a, I>, SamplingError> {
        if self.displacements().is_some() {
            return Err(SamplingError::Relaxed);
        }
        Ok(WeightedPoints { sampling: *self, points: self.points()?, weighting })
    }

    /// Points expected in a squared unit at a point of the domain: importance × [`density`](Self::density).
    #[must_use]
    pub fn density_at(&self, at: DVec2) -> f64 {
        self.importance().value(at) * self.density()
    }
}

impl<I: Importance> Iterator for WeightedPoints<'_, I> {
    type Item = Result<Weighted, SamplingError>;

    fn next(&mut self) -> Option<Self::Item> {
        let sample = match self.points.next()? {
            Ok(sample) => sample,
            Err(error) => return Some(Err(error)),
        };
        let value = self.sampling.importance().value(sample.position);
        let density = value * self.sampling.density();
        let factor = match self.weighting {
            Weighting::Density => 1.0,
            // Accepted means z < 1, but for rounding.
            Weighting::Smoothed => {
                (2.0 - 2.0 * self.sampling.scale().place(sample.rank, value)).max(0.0)
            }
        };
        let (position, rank) = (sample.position, sample.rank);
        // Far from the origin, rounding may have carried the position to where nothing is expected.
        let weight = if density > 0.0 { factor / density } else { 0.0 };
        Some(Ok(Weighted { position, rank, density, weight }))
    }
}

impl<I: Importance> core::iter::FusedIterator for WeightedPoints<'_, I> {}

/// Divides all weights by what they add up to against `expected`, the number of points expected
/// ([`Sampling::expected_points`]): the self-normalized weights. Importance itself is then integrated
/// without error, and an f that resembles it with little.
///
/// Biased by O(1/n): the count and f vary together. Does nothing without points.
pub fn normalize(points: &mut [Weighted], expected: f64) {
    let total: f64 = points.iter().map(|point| point.weight * point.density).sum();
    if total > 0.0 {
        let factor = expected / total;
        for point in points {
            point.weight *= factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Amount, Constant, Domain, Placement};

    #[test]
    fn relaxed_points_have_no_weights() {
        let placement = Placement::new(Domain::UNIT, 3);
        let fixed = Sampling::new(&placement, &Constant::ONE, Amount::Points(300.0)).unwrap();
        let relaxed = fixed.relaxed().unwrap();
        for weighting in [Weighting::Density, Weighting::Smoothed] {
            assert_eq!(relaxed.weighted(weighting).unwrap_err(), SamplingError::Relaxed);
            assert!(fixed.weighted(weighting).is_ok());
        }
        // However it is cut.
        assert!(relaxed.clipped(Domain::UNIT).weighted(Weighting::Density).is_err());
        assert!(relaxed.clipped(Domain::UNIT).weighted(Weighting::Density).is_err());
    }
}
