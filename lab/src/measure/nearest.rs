//! Nearest-neighbour distances.

use glam::DVec2;
use rstar::RTree;

/// The distance from each of `queries`, which are among `points`, to the nearest other of `points`;
/// infinite if there is no other. Coincident points are at distance 0. O(n log n).
#[must_use]
pub fn distances(points: &[DVec2], queries: &[DVec2]) -> Vec<f64> {
    let tree = RTree::bulk_load(points.iter().map(|p| p.to_array()).collect());
    queries
        .iter()
        .map(|query| {
            // The first hit is the query itself, or a point that coincides with it.
            tree.nearest_neighbor_iter_with_distance_2(&query.to_array())
                .nth(1)
                .map_or(f64::INFINITY, |(_, squared)| libm::sqrt(squared))
        })
        .collect()
}

/// Sorted values, for means and percentiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary(Vec<f64>);

impl Summary {
    /// Of at least one value, none of them NaN; otherwise `None`.
    #[must_use]
    pub fn new(mut values: Vec<f64>) -> Option<Self> {
        if values.is_empty() || values.iter().any(|v| v.is_nan()) {
            return None;
        }
        values.sort_by(f64::total_cmp);
        Some(Self(values))
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
        assert!(distances(&points, &points).iter().all(|d| *d == 1.0));
        let twice = [points.clone(), points[..1].to_vec()].concat();
        assert_eq!(distances(&twice, &twice)[0], 0.0);
        assert_eq!(distances(&points[..1], &points[..1]), [f64::INFINITY]);
    }

    #[test]
    fn summaries() {
        assert_eq!(Summary::new(vec![]), None);
        assert_eq!(Summary::new(vec![1.0, f64::NAN]), None);
        let summary = Summary::new((0..100).rev().map(f64::from).collect()).unwrap();
        assert_eq!((summary.least(), summary.mean(), summary.greatest()), (0.0, 49.5, 99.0));
        assert_eq!((summary.percentile(0.01), summary.percentile(1.0)), (1.0, 99.0));
    }
}
