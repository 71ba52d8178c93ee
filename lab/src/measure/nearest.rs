//! Nearest-neighbor distances.

use glam::DVec2;
use rstar::RTree;

use super::MeasureError;

/// The distance from each of `queries`, which are among `points`, to the nearest other of `points`;
/// infinite if there is no other, or none nearer than 10¹⁵⁴, whose square would be. Points that coincide,
/// or are nearer than 10⁻¹⁶², are at distance 0. O(n log n).
///
/// # Errors
/// [`MeasureError::NotFinite`] for the first point, or else query, that is not finite.
pub fn distances(points: &[DVec2], queries: &[DVec2]) -> Result<Vec<f64>, MeasureError> {
    let unfit = |points: &[DVec2]| points.iter().position(|p| !p.is_finite());
    if let Some(point) = unfit(points).or_else(|| unfit(queries)) {
        return Err(MeasureError::NotFinite { point });
    }
    let tree = RTree::bulk_load(points.iter().map(|p| p.to_array()).collect());
    Ok(queries
        .iter()
        .map(|query| {
            // The first hit is the query itself, or a point that coincides with it.
            tree.nearest_neighbor_iter_with_distance_2(&query.to_array())
                .nth(1)
                .map_or(f64::INFINITY, |(_, squared)| libm::sqrt(squared))
        })
        .collect())
}

/// Sorted values, for means and percentiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary(Vec<f64>);

impl Summary {
    /// Of values that may be infinite.
    ///
    /// # Errors
    /// [`MeasureError::TooFew`] without a value, [`MeasureError::NotANumber`] with a NaN among them.
    pub fn new(mut values: Vec<f64>) -> Result<Self, MeasureError> {
        if values.is_empty() {
            return Err(MeasureError::TooFew { found: 0, needed: 1 });
        }
        if let Some(value) = values.iter().position(|v| v.is_nan()) {
            return Err(MeasureError::NotANumber { value });
        }
        values.sort_by(f64::total_cmp);
        Ok(Self(values))
    }

    /// The arithmetic mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    /// The least value.
    #[must_use]
    pub fn least(&self) -> f64 {
        self.0[0]
    }

    /// The greatest value.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        self.0[self.0.len() - 1]
    }

    /// The value below which a `fraction` in [0, 1] of the values lie (nearest rank; 0.5: the upper
    /// median). A fraction outside is taken as the nearer end.
    #[must_use]
    pub fn percentile(&self, fraction: f64) -> f64 {
        let last = self.0.len() - 1;
        // Casting saturates, and NaN becomes 0.
        self.0[((fraction * self.0.len() as f64) as usize).min(last)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_has_one_distance() {
        let points: Vec<DVec2> =
            (0..100).map(|i| DVec2::new(f64::from(i % 10), f64::from(i / 10))).collect();
        assert!(distances(&points, &points).unwrap().iter().all(|d| *d == 1.0));
        let twice = [points.clone(), points[..1].to_vec()].concat();
        assert_eq!(distances(&twice, &twice).unwrap()[0], 0.0);
        assert_eq!(distances(&points[..1], &points[..1]), Ok(vec![f64::INFINITY]));
    }

    #[test]
    fn summaries() {
        assert_eq!(Summary::new(vec![]), Err(MeasureError::TooFew { found: 0, needed: 1 }));
        assert_eq!(Summary::new(vec![1.0, f64::NAN]), Err(MeasureError::NotANumber { value: 1 }));
        let summary = Summary::new((0..100).rev().map(f64::from).collect()).unwrap();
        assert_eq!((summary.least(), summary.mean(), summary.greatest()), (0.0, 49.5, 99.0));
        assert_eq!((summary.percentile(0.01), summary.percentile(1.0)), (1.0, 99.0));
    }
}
