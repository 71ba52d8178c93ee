//! What a sampler written elsewhere must know: a placement and the tables as plain numbers.
//!
//! A GPU, or another language, makes the same points from these numbers, the public
//! [`tiling`](crate::tiling) and two rules.
//!
//! *Acceptance.* Rank k is a point where the importance is v if and only if k is less than
//! fl(fl(v·M) − u), M being density × [`Export::ranks_per_density`], u [`Export::rank_shift`] and fl
//! rounding to `f64`. A descendant of a level-m tile of rank r has the rank r + A·N_m − B·N_{m−1}, A and B
//! being its [`Entry`]'s and N the [`TileCounts`](crate::tiling::TileCounts) of the hexagon.
//!
//! *Position.* That of [`position`], to the bit, from the exact center of the tile in edges of the level of
//! its birth; then [`ToCaller::place`].

use alloc::vec::Vec;

use glam::{DVec2, Vec2};

use crate::domain::Domain;
use crate::error::SamplingError;
use crate::placement::{FRONTIER_LEVEL, Placement};
use crate::sampling::ToWorld;
use crate::tables::{ExactPoint, Tables};
use crate::tiling::{MAX_LEVEL, TileType};
use crate::tree::frame::Frame;

/// Relaxed points of coarser levels than this stay at their centers.
pub const FIRST_RELAXED_LEVEL: u8 = crate::placement::FIRST_RELAXED_LEVEL;

/// A placement as numbers. Everything is relative to the domain's least corner.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Export {
    /// The point that exact coordinates are relative to, in units.
    pub origin: DVec2,
    /// For each level: the vector of half an edge along the tiling's x axis, in units.
    pub half_edges: [DVec2; MAX_LEVEL + 1],
    /// For each level: no descendant of a tile lies farther than this from its center, in units, however
    /// positions are rounded.
    pub reach: [f64; MAX_LEVEL + 1],
    /// u, in [0, 1).
    pub rank_shift: f64,
    /// M for one point a squared unit where the importance is 1.
    pub ranks_per_density: f64,
    /// The level of the tiles of `frontier`.
    pub frontier_level: u8,
    /// All tiles of that level from which points come, relaxed ones included.
    pub frontier: Vec<FrontierTile>,
}

/// A tile at which walks start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrontierTile {
    /// The type.
    pub kind: TileType,
    /// 0..12, in units of 30°.
    pub rotation: u8,
    /// The center ((u + v√3)/2, (p + q√3)/2) as [u, v, p, q], in edges of its level.
    pub center: [i32; 4],
    /// The rank, which tells the path from the root.
    pub rank: u64,
}

/// A baked descendant of a tile of some type, or the tile itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// A of its rank.
    pub a: u16,
    /// B of its rank.
    pub b: u16,
    /// From the tile's center to its own: [u, v, p, q] as in [`FrontierTile::center`], in the frame of an
    /// unrotated tile and in edges of the level of its birth.
    pub offset: [i32; 4],
    /// Relaxed points three levels below the tile: the rotation of its ancestor one level below the
    /// tile, relative to the tile.
    pub turn: u8,
    /// The same: its class over two generations.
    pub class: u16,
}

impl Export {
    /// The numbers of a placement.
    #[must_use]
    pub fn of(placement: &Placement<'_>) -> Self {
        let level = |i: usize| i as u8;
        let tile = |i| {
            let node = placement.frontier_node(i)?;
            let ExactPoint { u, v, p, q } = node.center;
            let (kind, rotation) = (node.kind, node.rotation);
            Some(FrontierTile { kind, rotation, center: [u, v, p, q], rank: node.rank })
        };
        Self {
            origin: placement.origin(),
            half_edges: core::array::from_fn(|i| placement.half_edge(level(i))),
            reach: core::array::from_fn(|i| placement.reach(level(i), usize::MAX)),
            rank_shift: placement.rank_shift(),
            ranks_per_density: placement.ranks_per_density(),
            frontier_level: FRONTIER_LEVEL,
            frontier: (0..).map_while(tile).collect(),
        }
    }
}

/// The edge of `level` (at most [`MAX_LEVEL`]) at `rotation`·30° from the tiling's x axis, in units: rounded
/// to `f32`, it is what a relaxed point's vector is multiplied by as complex numbers, in `f32`.
#[must_use]
pub fn turned_edge(placement: &Placement<'_>, level: u8, rotation: u8) -> DVec2 {
    placement.turned_edge(level.min(MAX_LEVEL as u8), rotation)
}

/// The entries of a type that are born at most `levels` levels below the tile, in the order of their
/// ranks, which is also that of their births: first the tile, then N_1 − 1 a level below it, and so on.
/// Those of the baked depth if that is less.
#[must_use]
pub fn entries(tables: &Tables<'_>, kind: TileType, levels: u8) -> Vec<Entry> {
    let block = tables.block(kind);
    let levels = levels.min(tables.depth());
    (0..block.born_before(usize::from(levels) + 1))
        .map(|i| {
            let (a, b) = block.rank_coefficients(i);
            let ExactPoint { u, v, p, q } = block.offset(0, i);
            let (turn, class) = block.relax_key(i);
            Entry { a, b, offset: [u, v, p, q], turn, class }
        })
        .collect()
}

/// The position of an exact point [u, v, p, q] of a level, relative to the domain's least corner: with
/// `origin` and `half_edge` = (a, b) rounded to `f32`, integers rounded to `f32`, and each operation rounded
/// to nearest even,
///
/// x = u + √3·v,  y = p + √3·q,  (origin.x + (a·x + (−b)·y), origin.y + (b·x + a·y)).
///
/// A promise: these operations in this order, without fused ones, give the library's bits for ever.
///
/// ```
/// use glam::DVec2;
/// use twelvefold::export::position;
/// let at = position(DVec2::new(0.5, 0.25), DVec2::new(0.125, 0.0), [1, 0, 0, 1]);
/// assert_eq!(at.to_array().map(f32::to_bits), [0x3f20_0000, 0x3eee_d9ec]);
/// ```
#[must_use]
pub fn position(origin: DVec2, half_edge: DVec2, [u, v, p, q]: [i32; 4]) -> Vec2 {
    let frame = Frame::<f32>::new(half_edge, origin, 0);
    Vec2::from_array(frame.position(ExactPoint { u, v, p, q }))
}

/// From `f32` positions relative to a domain's least corner to the caller's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToCaller {
    /// What is added: the least corner, rounded.
    pub corner: Vec2,
    /// The least number of the domain.
    pub least: Vec2,
    /// The greatest.
    pub greatest: Vec2,
}

impl ToCaller {
    /// Of a domain.
    ///
    /// # Errors
    /// [`SamplingError::Precision`] where `f32` cannot tell the domain's points apart.
    pub fn of(domain: &Domain) -> Result<Self, SamplingError> {
        let to_caller = ToWorld::<f32>::new(domain)?;
        let [corner, least, greatest] = to_caller.numbers().map(Vec2::from_array);
        Ok(Self { corner, least, greatest })
    }

    /// `corner` + `at`, rounded, and then not less than `least` nor more than `greatest`.
    #[must_use]
    pub fn place(&self, at: Vec2) -> Vec2 {
        (self.corner + at).max(self.least).min(self.greatest)
    }
}
