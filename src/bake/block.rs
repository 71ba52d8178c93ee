//! A block: all descendants of a tile down to a fixed depth, in the order of their ranks.
//!
//! With N_m the tile count of the block's own level m, a descendant's rank is
//!
//! rank = r + A·N_m − B·N_{m−1},
//!
//! r the rank of the block's tile, A and B small integers that depend on the descendant's digits alone
//! (by the recurrence of N). The order by A is the order by rank for every m ≥ 1 and every root, so
//! "the points of this subtree below a threshold" are a prefix of the block. It is also the order of
//! birth: the first 1, 13 or 14, 181 or 195, … entries are the tiles born 0, 1, 2, … levels down.

use alloc::vec::Vec;

use super::class::Classes;
use super::error::BakeError;
use crate::tiling::cyclotomic::Surd;
use crate::tiling::{Cyclotomic, Rules, Tile, TileType};

/// One descendant of a block's tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// A in rank = r + A·N_m − B·N_{m−1}.
    pub rank_a: u16,
    /// B.
    pub rank_b: u16,
    /// How many levels below the block's tile it is born, 0..=depth. It stays a tile center, with the
    /// same rank, at every deeper level.
    pub born: u8,
    /// Its offset from the block's center in edges of the level of its birth, in the block's frame.
    pub offset: Cyclotomic,
}

/// An entry three levels below the block's tile, where relaxed points read their vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RelaxKey {
    /// How its ancestor one level below the block's tile is turned, in units of 30°.
    pub turn: u8,
    /// Its class over two generations.
    pub class: u16,
}

/// The entries of one tile type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    entries: Vec<Entry>,
    relax_keys: Vec<RelaxKey>,
}

/// A tile during subdivision, with its rank coefficients and what it remembers of its ancestor one
/// level below the block's tile: its rotation, and the classes counted from there.
#[derive(Clone, Copy)]
struct Growing {
    tile: Tile,
    rank_a: i64,
    rank_b: i64,
    turn: u8,
    classes: Classes,
}

impl Block {
    /// Subdivides a tile of type `kind` `depth` times.
    pub(super) fn subdivide(rules: &Rules, kind: TileType, depth: u8) -> Result<Self, BakeError> {
        let mut entries =
            Vec::from([Entry { rank_a: 0, rank_b: 0, born: 0, offset: Cyclotomic::ZERO }]);
        let (tile, classes) = (Tile::root(kind), Classes::root(kind));
        let mut level = Vec::from([Growing { tile, rank_a: 0, rank_b: 0, turn: 0, classes }]);
        let mut relax_keys = Vec::new();
        // N_{m+j} = a·N_m − b·N_{m−1}: (a, b) of the level above the current one, and of the current.
        let (mut above, mut here) = ((0i64, -1i64), (1i64, 0i64));
        for born in 1..=depth {
            let mut next = Vec::with_capacity(level.len() * 14);
            for &Growing { tile, rank_a, rank_b, turn, classes } in &level {
                for digit in 0..tile.kind.child_count() as u8 {
                    let child = rules.child_of(&tile, digit).map_err(|_| BakeError::Range)?;
                    let child = child.ok_or(BakeError::Range)?;
                    let (d, carry) = (i64::from(digit), i64::from(digit == 13));
                    let rank_a = rank_a + d * here.0 - carry * above.0;
                    let rank_b = rank_b + d * here.1 - carry * above.1;
                    if digit != 0 {
                        entries.push(Entry {
                            rank_a: u16::try_from(rank_a).map_err(|_| BakeError::Range)?,
                            rank_b: u16::try_from(rank_b).map_err(|_| BakeError::Range)?,
                            born,
                            offset: child.center,
                        });
                    }
                    let (turn, classes) = match born {
                        1 => (child.rotation, Classes::root(child.kind)),
                        _ => (turn, classes.child(digit, child.kind)),
                    };
                    if born == 3 {
                        let class = classes.over(2) as u16;
                        relax_keys.push((rank_a, RelaxKey { turn, class }));
                    }
                    next.push(Growing { tile: child, rank_a, rank_b, turn, classes });
                }
            }
            level = next;
            (above, here) = (here, (14 * here.0 - above.0, 14 * here.1 - above.1));
        }
        entries.sort_by_key(|entry| entry.rank_a);
        relax_keys.sort_by_key(|(rank_a, _)| *rank_a);
        let relax_keys = relax_keys.into_iter().map(|(_, third)| third).collect();
        Ok(Self { entries, relax_keys })
    }

    /// The entries born at most three levels down, as they are there, in the order of their ranks;
    /// none at a depth below 3.
    #[must_use]
    pub fn relax_keys(&self) -> &[RelaxKey] {
        &self.relax_keys
    }

    /// The entries in the order of their ranks.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }
}

impl Entry {
    /// The offset turned by `rotation`·30°, as (u, v, p, q) with x = (u + v√3)/2, y = (p + q√3)/2.
    pub(super) fn turned(&self, rotation: u8) -> Result<[i16; 4], BakeError> {
        let turned = self.offset.checked_rotate(rotation).map_err(|_| BakeError::Range)?;
        let [Surd { whole: u, root: v }, Surd { whole: p, root: q }] =
            turned.to_surds().map_err(|_| BakeError::Range)?;
        let narrow = |n: i64| i16::try_from(n).map_err(|_| BakeError::Range);
        Ok([narrow(u)?, narrow(v)?, narrow(p)?, narrow(q)?])
    }

    /// The normalized threshold (A − B/δ)/δ^depth in [0, 1): the entry's place among the points of
    /// the block, for drawing and for approximate work. Ranks decide by A and B.
    #[must_use]
    pub fn threshold(&self, depth: u8) -> f32 {
        let delta = 7.0 + 4.0 * crate::tiling::numbers::SQRT_3;
        let in_block_levels = f64::from(self.rank_a) - f64::from(self.rank_b) / delta;
        (0..depth).fold(in_block_levels, |t, _| t / delta) as f32
    }
}
