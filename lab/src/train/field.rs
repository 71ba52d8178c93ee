//! Thresholds over the plane, in rank units: a tile center p is a point if its rank < T(p).

use glam::DVec2;

use super::place::{BASE_LEVEL, density, edge};
use twelvefold::tiling::TileCounts;

/// A threshold at every place. Lengths are in edges of the ground's base level.
pub trait Field: Sync {
    /// T(p), finite and ≥ 0.
    fn threshold(&self, p: DVec2) -> f64;

    /// An upper bound of T within `radius` of `p`.
    fn bound(&self, p: DVec2, radius: f64) -> f64;

    /// T averaged at the scale of the spacing: what the phase is read from.
    fn local(&self, p: DVec2) -> f64 {
        self.threshold(p)
    }

    /// How much detail there is at the scale of the spacing, 0 … 1: the share of the rough layer.
    fn detail(&self, p: DVec2) -> f64 {
        let _ = p;
        0.0
    }

    /// Where a point of this rank and tile center goes that displacements moves to `moved`: a field with
    /// edges may hold it back.
    fn settle(&self, center: DVec2, rank: u64, moved: DVec2) -> DVec2 {
        let _ = (center, rank);
        moved
    }
}

/// T relative to the tile count of the level above the base level: the phase τ of a field in the base
/// level's range.
#[must_use]
pub fn threshold_of_phase(tau: f64) -> f64 {
    tau * TileCounts::HEXAGON.all()[BASE_LEVEL - 1] as f64
}

/// The same T everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

impl Field for Constant {
    fn threshold(&self, _: DVec2) -> f64 {
        self.0
    }

    fn bound(&self, _: DVec2, _: f64) -> f64 {
        self.0
    }
}

/// The spacing 1/√ρ of a threshold, in base edges.
#[must_use]
pub fn spacing(threshold: f64) -> f64 {
    1.0 / libm::sqrt(density(threshold))
}

/// The level whose range (N_{L−1}, N_L] holds `threshold`, its edge in base edges, and N_{L−1}.
/// Thresholds up to 1 are of level 1.
#[must_use]
pub fn level_of(threshold: f64) -> (usize, f64, f64) {
    let counts = TileCounts::HEXAGON.all();
    let level = counts.partition_point(|n| (*n as f64) < threshold).max(1);
    (level, edge(level), counts[level - 1] as f64)
}
