//! The points of a field on a ground, and where relaxation moves them.

use glam::DVec2;

use super::field::{Field, level_of, spacing};
use super::ground::{Descend, Ground, Region};
use crate::bake::class::Classes;
use crate::bake::relaxation::Relaxation;
use crate::tiling::OutOfRange;
use crate::tiling::cyclotomic::SQRT_3;

/// A point before it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// The tile's centre, in base edges.
    pub centre: DVec2,
    /// Its rank.
    pub rank: u64,
    /// The level L with N_{L−1} < T ≤ N_L.
    pub level: usize,
    /// The edge of that level, in base edges.
    pub edge: f64,
    /// The grandparent's rotation, in units of 30°.
    pub rotation: u8,
    /// Classes at that level.
    pub classes: Classes,
    /// The local phase: the averaged threshold over N_{L−1}, clamped to [1, δ].
    pub tau: f64,
    /// The rough layer's share.
    pub detail: f64,
    /// 1/√ρ for the averaged threshold, in base edges.
    pub spacing: f64,
}

/// All points of `field` whose tile centres lie in `region`, in the order of the walk.
///
/// # Errors
/// [`OutOfRange`] when the field needs more than 5 levels below the base level.
pub fn sites(
    ground: &Ground<'_>,
    field: &impl Field,
    region: Region,
) -> Result<Vec<Site>, OutOfRange> {
    let mut sites = Vec::new();
    ground.walk(region, &mut |node| {
        let edge = super::ground::edge(node.level);
        let bound = field.bound(node.centre, edge * core::f64::consts::FRAC_1_SQRT_2);
        let tiles = crate::tiling::TileCounts::HEXAGON.all()[node.level] as f64;
        if region.touches(node.centre, 0.0) {
            let threshold = field.threshold(node.centre);
            let (level, _, above) = level_of(threshold);
            if level == node.level && (node.rank as f64) < threshold {
                let local = field.local(node.centre);
                sites.push(Site {
                    centre: node.centre,
                    rank: node.rank,
                    level,
                    edge,
                    rotation: node.rotations[1],
                    classes: node.classes,
                    tau: (local / above).clamp(1.0, crate::bake::relaxation::DELTA.into()),
                    detail: field.detail(node.centre),
                    spacing: spacing(local),
                });
            }
        }
        Descend { ranks_below: bound, centre: bound > tiles }
    })?;
    Ok(sites)
}

impl Site {
    /// Where the table moves the point, in base edges.
    #[must_use]
    pub fn relaxed(&self, table: &Relaxation) -> DVec2 {
        let vector = table.vector(&self.classes, self.tau, self.detail);
        self.centre + turned(vector.into(), self.rotation) * self.edge
    }
}

impl Site {
    /// Where the point goes: [`relaxed`](Self::relaxed), held back by the field's edges.
    #[must_use]
    pub fn settled(&self, table: &Relaxation, field: &impl Field) -> DVec2 {
        field.settle(self.centre, self.rank, self.relaxed(table))
    }
}

/// `v` turned by `rotation`·30°, with √3/2 as the only irrational factor.
#[must_use]
pub fn turned(v: DVec2, rotation: u8) -> DVec2 {
    let [c, s] = cosine_and_sine(rotation);
    DVec2::new(c * v.x - s * v.y, s * v.x + c * v.y)
}

/// cos and sin of `rotation`·30°.
#[must_use]
pub fn cosine_and_sine(rotation: u8) -> [f64; 2] {
    const H: f64 = 0.5 * SQRT_3;
    const COSINES: [f64; 12] = [1.0, H, 0.5, 0.0, -0.5, -H, -1.0, -H, -0.5, 0.0, 0.5, H];
    let k = usize::from(rotation % 12);
    [COSINES[k], COSINES[(k + 9) % 12]]
}
