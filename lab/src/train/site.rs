//! The points of a field on a ground, and where displacements moves them.

use glam::{DVec2, Vec2};

use super::field::{Field, level_of, spacing};
use super::place::{Descend, Place, Region};
use twelvefold::bake::class::Classes;
use twelvefold::bake::displacement::Displacements;
use twelvefold::tiling::OutOfRange;
use twelvefold::tiling::numbers::SQRT_3;

/// A point before it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// The tile's center, in base edges.
    pub center: DVec2,
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

/// All points of `field` whose tile centers lie in `region`, in the order of the walk.
///
/// # Errors
/// [`OutOfRange`] when the field needs more than 5 levels below the base level.
pub fn sites(
    ground: &Place<'_>,
    field: &impl Field,
    region: Region,
) -> Result<Vec<Site>, OutOfRange> {
    let mut sites = Vec::new();
    ground.walk(region, &mut |node| {
        let edge = super::place::edge(node.level);
        let bound = field.bound(node.center, edge * core::f64::consts::FRAC_1_SQRT_2);
        let tiles = twelvefold::tiling::TileCounts::HEXAGON.all()[node.level] as f64;
        if region.touches(node.center, 0.0) {
            let threshold = field.threshold(node.center);
            let (level, _, above) = level_of(threshold);
            if level == node.level && (node.rank as f64) < threshold {
                let local = field.local(node.center);
                sites.push(Site {
                    center: node.center,
                    rank: node.rank,
                    level,
                    edge,
                    rotation: node.rotations[1],
                    classes: node.classes,
                    tau: (local / above).clamp(1.0, twelvefold::bake::displacement::DELTA.into()),
                    detail: field.detail(node.center),
                    spacing: spacing(local),
                });
            }
        }
        Descend { ranks_below: bound, center: bound > tiles }
    })?;
    Ok(sites)
}

impl Site {
    /// Where the table moves the point, in base edges.
    #[must_use]
    pub fn relaxed(&self, table: &Displacements) -> DVec2 {
        let vector = table.vector(&self.classes, self.tau, self.detail);
        self.center + turned(Vec2::from(vector).as_dvec2(), self.rotation) * self.edge
    }
}

impl Site {
    /// Where the point goes: [`relaxed`](Self::relaxed), held back by the field's edges.
    #[must_use]
    pub fn settled(&self, table: &Displacements, field: &impl Field) -> DVec2 {
        field.settle(self.center, self.rank, self.relaxed(table))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::train::field::{Constant, threshold_of_phase};
    use crate::train::place::{BASE_LEVEL, density};
    use twelvefold::tiling::{Digits, FCode, Rules, Tile, TileType};

    fn rules() -> Rules {
        Rules::new(&Digits::parse(include_str!("../../../tables/digits.txt")).unwrap()).unwrap()
    }

    #[test]
    fn sites_are_the_tiles_that_their_ranks_name() {
        let rules = rules();
        // Phases of the base level, of the level above and of the level below.
        for (tau, level) in [(3.3, BASE_LEVEL), (0.4, BASE_LEVEL - 1), (20.0, BASE_LEVEL + 1)] {
            let field = Constant(threshold_of_phase(tau));
            let radius = 20.0 * spacing(field.0);
            let ground = Place::random(&rules, radius, &mut Random::new(5, &[])).unwrap();
            let sites = sites(&ground, &field, Region::Disc(radius)).unwrap();
            let expected = density(field.0) * core::f64::consts::PI * radius * radius;
            assert!(
                (sites.len() as f64 / expected - 1.0).abs() < 0.03,
                "{} {expected}",
                sites.len()
            );
            let mut origin = None;
            for site in &sites {
                assert_eq!(site.level, level);
                assert!((site.rank as f64) < field.0);
                let code = FCode::from_rank(TileType::A, level, site.rank).unwrap();
                let tile = code.tile(&rules).unwrap();
                // Where the center must lie, up to the ground's place, the same for all sites.
                let place = DVec2::from(tile.center.to_f64()) * site.edge - site.center;
                assert!((*origin.get_or_insert(place) - place).length() < 1e-6);
                let digits: Vec<u8> = code.oldest_first().collect();
                let (older, newest) = digits.split_at(level - 2);
                let mut ancestor = Tile::root(TileType::A);
                for digit in older {
                    ancestor = rules.child_of(&ancestor, *digit).unwrap().unwrap();
                }
                assert_eq!(site.rotation, ancestor.rotation);
                let mut classes = Classes::root(ancestor.kind);
                let mut kind = ancestor.kind;
                for digit in newest {
                    kind = rules.children(kind)[usize::from(*digit)].kind;
                    classes = classes.child(*digit, kind);
                }
                assert_eq!(site.classes.over(2), classes.over(2));
                let levels = level as f64 - BASE_LEVEL as f64;
                assert!((site.tau * 13.928_203f64.powf(levels) / tau - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn turning_by_thirty_degrees() {
        for k in 0..12u8 {
            let [c, s] = cosine_and_sine(k);
            let (sin, cos) = (f64::from(k) * core::f64::consts::PI / 6.0).sin_cos();
            assert!((c - cos).abs() < 1e-15 && (s - sin).abs() < 1e-15);
        }
        assert_eq!(turned(DVec2::new(1.0, 2.0), 3), DVec2::new(-2.0, 1.0));
    }
}
