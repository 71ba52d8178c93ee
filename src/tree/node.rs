//! A tile on the way: exact coordinates relative to the placement, and its rank.

use crate::tables::{ExactPoint, Tables};
use crate::tiling::{TileCounts, TileType};

/// A tile of the walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) kind: TileType,
    /// 0..12, in units of 30°.
    pub(crate) rotation: u8,
    /// Levels below the root.
    pub(crate) level: u8,
    /// The center in edges of `level`.
    pub(crate) center: ExactPoint,
    pub(crate) rank: u64,
}

impl Node {
    /// The root `a`, unrotated at the origin.
    pub(crate) const fn root() -> Self {
        let center = ExactPoint { u: 0, v: 0, p: 0, q: 0 };
        Self { kind: TileType::A, rotation: 0, level: 0, center, rank: 0 }
    }

    /// The rank of a descendant from its coefficients (A, B): rank + A·N_m − B·N_{m−1}, m the node's level.
    #[inline(always)]
    pub(crate) fn rank_of(&self, (a, b): (u16, u16)) -> u64 {
        let (tiles, before) = TileCounts::HEXAGON.pair(self.level);
        self.rank + u64::from(a) * tiles - u64::from(b) * before
    }

    /// The child with this digit, or `None` if there is none.
    #[inline(always)]
    pub(crate) fn child(&self, tables: &Tables<'_>, digit: usize) -> Option<Self> {
        let (kind, turn) = *tables.child_kinds(self.kind).get(digit)?;
        let turned = self.rotation + turn;
        let rotation = if turned < 12 { turned } else { turned - 12 };
        let block = tables.block(self.kind);
        // Entry 0 of a block is its own center, with offset 0 and the tile's own rank.
        let offset = block.offset(usize::from(self.rotation % 3), digit);
        // Three quarter turns back are one forward, and so on.
        let offset = offset.turned_back(4 - self.rotation / 3);
        Some(Self {
            kind,
            rotation,
            level: self.level + 1,
            center: self.center.finer().plus(offset),
            rank: self.rank_of(block.rank_coefficients(digit)),
        })
    }
}
