//! A place in a deep root, and the walk over its tiles.

use glam::DVec2;

use crate::random::Random;
use twelvefold::bake::class::Classes;
use twelvefold::tiling::numbers::SQRT_3;
use twelvefold::tiling::{Cyclotomic, FCode, OutOfRange, Rules, Tile, TileCounts, TileType};

/// λ = 2 + √3.
pub const LAMBDA: f64 = 2.0 + SQRT_3;

/// The deepest level that is walked to, from a [`BASE_LEVEL`] below it by up to 4 levels.
const LEVELS: usize = 14;

/// The level whose edge is the unit of length. The root's edge is λ⁹ = 140,000 units; patches of some
/// 600 units see ancestors as random as those of an infinite tiling.
pub const BASE_LEVEL: usize = 9;

/// A place under a root `a`, at the center of one of its tiles of level [`BASE_LEVEL`]. Positions are
/// relative to it, in edges of that level.
#[derive(Clone, Debug)]
pub struct Place<'a> {
    rules: &'a Rules,
    /// The place in edges of each level: exact, because λ is a unit of the ring.
    origins: Vec<Cyclotomic>,
}

/// The part of the plane that is walked, about the ground's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// A disc of this radius.
    Disc(f64),
    /// The rectangle [−half, half].
    Rectangle(DVec2),
}

impl Region {
    /// Whether a disc reaches into the region; may err towards yes at corners.
    #[must_use]
    pub fn touches(&self, center: DVec2, radius: f64) -> bool {
        match self {
            Self::Disc(own) => center.length_squared() <= (own + radius) * (own + radius),
            Self::Rectangle(half) => (center.abs() - *half).max_element() <= radius,
        }
    }
}

/// A tile as the walk meets it.
#[derive(Clone, Debug)]
pub struct Node {
    /// The tile, in edges of its level.
    pub tile: Tile,
    /// Its level.
    pub level: usize,
    /// Its rank.
    pub rank: u64,
    /// Its classes.
    pub classes: Classes,
    /// The rotations of its parent and grandparent (the root's, above the root).
    pub rotations: [u8; 2],
    /// Its center relative to the ground's place, in edges of [`BASE_LEVEL`].
    pub center: DVec2,
}

/// What the walk does below a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descend {
    /// Children are visited whose rank is below this.
    pub ranks_below: f64,
    /// The center child is visited, whatever its rank.
    pub center: bool,
}

impl<'a> Place<'a> {
    /// A random place, such that everything within `reach` of it lies under the root.
    ///
    /// # Errors
    /// [`OutOfRange`] cannot happen at these levels; it is passed on.
    pub fn random(rules: &'a Rules, reach: f64, random: &mut Random) -> Result<Self, OutOfRange> {
        let tiles = TileCounts::HEXAGON.all()[BASE_LEVEL];
        // Every point within 0.2929 root edges of the root's center is its descendant.
        let radius = (0.2928 * edge(0) - reach).max(0.0);
        loop {
            let rank = random.below(tiles);
            let Ok(code) = FCode::from_rank(TileType::A, BASE_LEVEL, rank) else {
                return Err(OutOfRange);
            };
            let origin = code.tile(rules)?.center;
            if DVec2::from(origin.to_f64()).length() <= radius {
                return Self::at(rules, origin);
            }
        }
    }

    /// The place with these coordinates in edges of [`BASE_LEVEL`] under a root `a` at 0.
    ///
    /// # Errors
    /// [`OutOfRange`] for a place far outside the root.
    pub fn at(rules: &'a Rules, origin: Cyclotomic) -> Result<Self, OutOfRange> {
        let mut origins = vec![origin; LEVELS + 1];
        for level in (0..BASE_LEVEL).rev() {
            origins[level] = origins[level + 1].checked_div_lambda()?;
        }
        for level in BASE_LEVEL + 1..=LEVELS {
            origins[level] = origins[level - 1].checked_mul_lambda()?;
        }
        Ok(Self { rules, origins })
    }

    /// Visits tiles that reach into `region`, parents before children in the order of their digits.
    /// `visit` is given each tile and says which of its children to go to.
    ///
    /// # Errors
    /// [`OutOfRange`] when asked to go below level 14.
    pub fn walk(
        &self,
        region: Region,
        visit: &mut impl FnMut(&Node) -> Descend,
    ) -> Result<(), OutOfRange> {
        let root = Node {
            tile: Tile::root(TileType::A),
            level: 0,
            rank: 0,
            classes: Classes::root(TileType::A),
            rotations: [0; 2],
            center: -self.origins[0].to_f64_vec() * edge(0),
        };
        self.walk_below(&root, region, visit)
    }

    fn walk_below(
        &self,
        node: &Node,
        region: Region,
        visit: &mut impl FnMut(&Node) -> Descend,
    ) -> Result<(), OutOfRange> {
        let descend = visit(node);
        let tiles = TileCounts::HEXAGON.all()[node.level];
        let level = node.level + 1;
        for digit in 0..node.tile.kind.child_count() as u8 {
            let rank = twelvefold::tiling::rank::child_rank(
                &TileCounts::HEXAGON,
                node.level,
                node.rank,
                digit,
            )
            .map_err(|_| OutOfRange)?;
            debug_assert!(digit > 0 || rank < tiles);
            let wanted =
                if digit == 0 { descend.center } else { (rank as f64) < descend.ranks_below };
            if !wanted {
                continue;
            }
            let Some(tile) = self.rules.child_of(&node.tile, digit)? else { continue };
            let origin = self.origins.get(level).ok_or(OutOfRange)?;
            let center = tile.center.checked_sub(*origin)?.to_f64_vec() * edge(level);
            // A tile's descendants lie within 1/√2 of its edge.
            if region.touches(center, edge(level) * core::f64::consts::FRAC_1_SQRT_2) {
                let child = Node {
                    classes: node.classes.child(digit, tile.kind),
                    tile,
                    level,
                    rank,
                    rotations: [node.tile.rotation, node.rotations[0]],
                    center,
                };
                self.walk_below(&child, region, visit)?;
            }
        }
        Ok(())
    }
}

/// The edge of a level, in edges of [`BASE_LEVEL`].
#[must_use]
pub fn edge(level: usize) -> f64 {
    let power = |n: usize| (0..n).fold(1.0, |p, _| p * LAMBDA);
    if level < BASE_LEVEL { power(BASE_LEVEL - level) } else { 1.0 / power(level - BASE_LEVEL) }
}

/// Points a unit of area (squared edges of [`BASE_LEVEL`]) of rank below `threshold`.
#[must_use]
pub fn density(threshold: f64) -> f64 {
    threshold / (0.5 * SQRT_3 * edge(0) * edge(0))
}

trait ToVec {
    fn to_f64_vec(self) -> DVec2;
}

impl ToVec for Cyclotomic {
    fn to_f64_vec(self) -> DVec2 {
        DVec2::from(self.to_f64())
    }
}
