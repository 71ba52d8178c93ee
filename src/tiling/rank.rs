//! The exact rank: a numbering of the tiles without gaps, refined from level to level.
//!
//! The paper's own value of an F-code (its equations 4 and 5) numbers the tiles with gaps and
//! collisions (`paper` in twelvefold-lab). With the new digit d most significant, what does number them is
//!
//! rank(child) = d·N_m + rank(parent)                  for d = 0 … C,
//! rank(child) = 13·N_m + rank(parent) − N_{m−1}       for d = D,
//!
//! because an `a` tile has no D child and the `a` tiles of level m are exactly the first N_{m−1} ranks.
//! A tile's center child keeps its rank, so a rank is a fixed index into one endless sequence.

use super::counts::{MAX_LEVEL, RankError, TileCounts};
use super::cyclotomic::OutOfRange;
use super::fcode::FCode;
use super::rules::Rules;
use super::tile::{Tile, TileType};

/// The rank of the child with `digit` (0..14) of a level-`level` tile with rank `parent`.
///
/// # Errors
/// [`RankError::TooDeep`] when the child's level is past [`MAX_LEVEL`]; [`RankError::NoSuchRank`] when
/// the parent's level has no such rank; [`RankError::NoSuchChild`] when the parent has no such digit.
pub fn child_rank(
    counts: &TileCounts,
    level: usize,
    parent: u64,
    digit: u8,
) -> Result<u64, RankError> {
    counts.at(level.saturating_add(1))?;
    let tiles = counts.at(level)?;
    let hexagons = counts.before(level)?;
    if parent >= tiles {
        return Err(RankError::NoSuchRank { rank: parent, tiles });
    }
    match digit {
        // Below 14·N_m, which fits: N₁₆ does, and N₁₆ ≥ 13·N₁₅.
        0..=12 => Ok(u64::from(digit) * tiles + parent),
        13 if parent >= hexagons => Ok(13 * tiles + (parent - hexagons)),
        _ => Err(RankError::NoSuchChild { rank: parent, digit }),
    }
}

/// The digit and the parent's rank of the level-`level` tile with this rank, `level` ≥ 1.
fn split(counts: &TileCounts, level: usize, rank: u64) -> Result<(u8, u64), RankError> {
    let tiles = counts.at(level - 1)?;
    Ok(if rank / tiles < 13 {
        ((rank / tiles) as u8, rank % tiles)
    } else {
        (13, rank - 13 * tiles + counts.before(level - 1)?)
    })
}

impl FCode {
    /// The exact rank of the tile with this code, below N_K for a code of K digits. O(K).
    #[must_use]
    pub fn rank(&self) -> u64 {
        let counts = TileCounts::of(self.root());
        self.oldest_first().enumerate().fold(0, |parent, (level, digit)| {
            // Never an error: an `FCode` has at most MAX_LEVEL digits and no impossible word.
            child_rank(counts, level, parent, digit).unwrap_or(parent)
        })
    }

    /// The code of the level-`level` tile with this rank under `root`. O(level).
    ///
    /// # Errors
    /// [`RankError`] when the level is too deep or has no such rank.
    pub fn from_rank(root: TileType, level: usize, rank: u64) -> Result<Self, RankError> {
        let counts = TileCounts::of(root);
        let tiles = counts.at(level)?;
        if rank >= tiles {
            return Err(RankError::NoSuchRank { rank, tiles });
        }
        let mut newest_first = [0; MAX_LEVEL];
        let mut rest = rank;
        for (i, digit) in newest_first[..level].iter_mut().enumerate() {
            (*digit, rest) = split(counts, level - i, rest)?;
        }
        Ok(Self::from_valid_newest_first(root, &newest_first[..level]))
    }

    /// The tile with this code: type, rotation, exact center. O(levels).
    ///
    /// # Errors
    /// [`OutOfRange`] cannot happen for the at most [`MAX_LEVEL`] levels of a code; it is passed on
    /// rather than hidden.
    pub fn tile(&self, rules: &Rules) -> Result<Tile, OutOfRange> {
        let mut tile = Tile::root(self.root());
        for digit in self.oldest_first() {
            tile = rules.child_of(&tile, digit)?.ok_or(OutOfRange)?;
        }
        Ok(tile)
    }
}
