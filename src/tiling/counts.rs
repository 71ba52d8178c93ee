//! How many tiles a root has after m subdivisions: N_{m+1} = 14·N_m − N_{m−1}.

use super::rank::RankError;
use super::tile::TileType;

/// The deepest level whose tile count fits `u64`, for every root (N₁₆ < 2⁶¹, N₁₇ > 2⁶⁴).
pub const MAX_LEVEL: usize = 16;

/// The paper's σ sequences, exact: tile counts N_{−1}, N₀ … N₁₆ under a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileCounts([u64; MAX_LEVEL + 2]);

impl TileCounts {
    const fn from_first_two(before_root: u64, root: u64) -> Self {
        let mut counts = [before_root; MAX_LEVEL + 2];
        counts[1] = root;
        let mut i = 2;
        while i < counts.len() {
            counts[i] = 14 * counts[i - 1] - counts[i - 2];
            i += 1;
        }
        Self(counts)
    }

    /// The paper's σ₁: 1, 13, 181, 2521, … (root `a`), with N_{−1} = 1.
    pub const HEXAGON: Self = Self::from_first_two(1, 1);

    /// The paper's σ₂: 1, 14, 195, 2716, … (roots `b`, `c`, `d`), with N_{−1} = 0.
    pub const PENTAGON: Self = Self::from_first_two(0, 1);

    /// The counts under a root of this type.
    #[must_use]
    pub const fn of(root: TileType) -> &'static Self {
        match root {
            TileType::A => &Self::HEXAGON,
            _ => &Self::PENTAGON,
        }
    }

    /// N_m, the number of tiles `m` levels below the root.
    ///
    /// # Errors
    /// [`RankError::TooDeep`] for m > [`MAX_LEVEL`].
    pub const fn at(&self, level: usize) -> Result<u64, RankError> {
        if level > MAX_LEVEL {
            return Err(RankError::TooDeep { level });
        }
        Ok(self.0[level + 1])
    }

    /// N_{m−1}: as [`at`](Self::at), with the recurrence's own value at m = 0.
    ///
    /// # Errors
    /// [`RankError::TooDeep`] for m > [`MAX_LEVEL`].
    pub const fn before(&self, level: usize) -> Result<u64, RankError> {
        if level > MAX_LEVEL {
            return Err(RankError::TooDeep { level });
        }
        Ok(self.0[level])
    }

    /// N₀ … N₁₆.
    #[must_use]
    pub fn all(&self) -> &[u64] {
        &self.0[1..]
    }
}
