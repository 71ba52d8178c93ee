//! A tile on the way: exact coordinates relative to the placement, and its rank.

use glam::DVec2;

use crate::tables::Tables;
use crate::tiling::TileType;
use crate::tiling::cyclotomic::SQRT_3;

/// ((u + v√3)/2, (p + q√3)/2): an exact point, in edges of some level, relative to the placement's
/// reference tile. 32 bits hold it: a domain is at most 2²⁴ edges of level 16 wide (see
/// [`Placement`](crate::Placement)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct ExactPoint {
    pub(crate) u: i32,
    pub(crate) v: i32,
    pub(crate) p: i32,
    pub(crate) q: i32,
}

/// Cosine and sine of 0°, 90°, 180°, 270°.
pub(crate) const QUARTERS: [(i8, i8); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

impl ExactPoint {
    /// The same point in edges one level finer: times λ = 2 + √3.
    #[inline(always)]
    pub(crate) fn finer(self) -> Self {
        let Self { u, v, p, q } = self;
        Self { u: 2 * u + 3 * v, v: u + 2 * v, p: 2 * p + 3 * q, q: p + 2 * q }
    }

    /// Turned by −90°·`quarters`.
    #[inline(always)]
    pub(crate) fn turned_back(self, quarters: u8) -> Self {
        let Self { u, v, p, q } = self;
        // Products, not four cases: a jump is mispredicted three times out of four.
        let (cos, sin) = QUARTERS[usize::from(quarters % 4)];
        let (cos, sin) = (i32::from(cos), i32::from(sin));
        Self {
            u: cos * u + sin * p,
            v: cos * v + sin * q,
            p: cos * p - sin * u,
            q: cos * q - sin * v,
        }
    }

    /// The sum.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self { u: self.u + other.u, v: self.v + other.v, p: self.p + other.p, q: self.q + other.q }
    }

    /// The difference.
    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(Self { u: -other.u, v: -other.v, p: -other.p, q: -other.q })
    }

    /// Rounded coordinates, in edges.
    pub(crate) fn to_dvec2(self) -> DVec2 {
        let [u, v, p, q] = [self.u, self.v, self.p, self.q].map(f64::from);
        0.5 * DVec2::new(u + SQRT_3 * v, p + SQRT_3 * q)
    }
}

/// A tile of the walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) kind: TileType,
    /// 0..12, in units of 30°.
    pub(crate) rotation: u8,
    /// Levels below the root.
    pub(crate) level: u8,
    /// The centre in edges of `level`.
    pub(crate) centre: ExactPoint,
    pub(crate) rank: u64,
}

impl Node {
    /// The root `a`, unrotated at the origin.
    pub(crate) const fn root() -> Self {
        let centre = ExactPoint { u: 0, v: 0, p: 0, q: 0 };
        Self { kind: TileType::A, rotation: 0, level: 0, centre, rank: 0 }
    }

    /// The child with this digit, or `None` if there is none. `tiles` and `tiles_before` are N_m and
    /// N_{m−1} of this node's level.
    #[inline(always)]
    pub(crate) fn child(
        &self,
        tables: &Tables<'_>,
        digit: usize,
        tiles: u64,
        tiles_before: u64,
    ) -> Option<Self> {
        let (kind, turn) = *tables.child_kinds(self.kind).get(digit)?;
        let turned = self.rotation + turn;
        let rotation = if turned < 12 { turned } else { turned - 12 };
        let block = tables.block(self.kind);
        // Entry 0 of a block is its own centre, with offset 0 and the tile's own rank.
        let offset = block.offset(usize::from(self.rotation % 3), digit);
        // Three quarter turns back are one forward, and so on.
        let offset = offset.turned_back(4 - self.rotation / 3);
        let (a, b) = block.rank_coefficients(digit);
        Some(Self {
            kind,
            rotation,
            level: self.level + 1,
            centre: self.centre.finer().plus(offset),
            rank: self.rank + u64::from(a) * tiles - u64::from(b) * tiles_before,
        })
    }
}
