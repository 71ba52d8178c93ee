//! How many tiles a root has after m subdivisions: N_{m+1} = 14·N_m − N_{m−1}.

use core::fmt;

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

    /// (N_m, N_{m−1}) of a level that exists: the two numbers of which ranks are made.
    #[inline(always)]
    pub(crate) fn pair(&self, level: u8) -> (u64, u64) {
        let level = usize::from(level);
        (self.0[level + 1], self.0[level])
    }

    /// The level L with N_{L−1} < T ≤ N_L, at least 1: where points of threshold T read their
    /// displacements. Past the deepest level, one more than that.
    pub(crate) fn level_of(&self, threshold: f64) -> u8 {
        self.all().partition_point(|tiles| (*tiles as f64) < threshold).max(1) as u8
    }

    /// Whether points with thresholds up to `threshold` are at most `below` levels below a tile of
    /// `level`.
    #[inline(always)]
    pub(crate) fn is_within(&self, level: u8, below: u8, threshold: f64) -> bool {
        let tiles = self.all().get(usize::from(level + below));
        tiles.is_none_or(|tiles| threshold <= *tiles as f64)
    }
}

/// How the tiles of an endless sequence are numbered: the counts of which ranks are made, and 1/N_m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Numbering {
    counts: TileCounts,
    reciprocals: [f64; MAX_LEVEL + 1],
}

impl Numbering {
    /// Under one root `a`.
    pub(crate) const HEXAGON: Self = Self::of(TileCounts::HEXAGON);

    /// Under several roots, all pentagons of this level, whose ranks interleave: rank · roots + the
    /// root's place among them. `None` where the last level's ranks leave 2⁶¹, or without roots.
    pub(crate) fn of_pentagons(roots: u64, level: u8) -> Option<Self> {
        let mut counts = [0; MAX_LEVEL + 2];
        let pentagon = TileCounts::PENTAGON.0;
        for (count, tiles) in counts.iter_mut().skip(level.into()).zip(pentagon) {
            *count = tiles.checked_mul(roots).filter(|count| *count < 1 << 61)?;
        }
        (roots > 0).then_some(Self::of(TileCounts(counts)))
    }

    const fn of(counts: TileCounts) -> Self {
        let mut reciprocals = [1.0; MAX_LEVEL + 1];
        let mut level = 0;
        while level <= MAX_LEVEL {
            // Above several roots there are no tiles.
            if counts.0[level + 1] > 0 {
                reciprocals[level] = 1.0 / counts.0[level + 1] as f64;
            }
            level += 1;
        }
        Self { counts, reciprocals }
    }

    /// N₀ … N₁₆.
    #[inline(always)]
    pub(crate) fn counts(&self) -> &TileCounts {
        &self.counts
    }

    /// 1/N_m of a level that exists; 1 if there are no tiles, 0 past the last level.
    #[inline(always)]
    pub(crate) fn reciprocal(&self, level: usize) -> f64 {
        self.reciprocals.get(level).copied().unwrap_or(0.0)
    }
}

/// Why a rank could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RankError {
    /// The level is past [`MAX_LEVEL`], where ranks leave `u64`.
    TooDeep {
        /// The level asked for.
        level: usize,
    },
    /// The rank is not below the number of tiles of its level.
    NoSuchRank {
        /// The rank.
        rank: u64,
        /// The number of tiles.
        tiles: u64,
    },
    /// The tile with this rank has no child with this digit.
    NoSuchChild {
        /// The rank.
        rank: u64,
        /// The digit; 13 (D) when the tile is of type `a`.
        digit: u8,
    },
}

impl fmt::Display for RankError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooDeep { level } => {
                write!(f, "level {level} is past {MAX_LEVEL}, the last whose ranks fit 64 bits")
            }
            Self::NoSuchRank { rank, tiles } => {
                write!(f, "rank {rank} is not below {tiles}, the number of tiles of its level")
            }
            Self::NoSuchChild { rank, digit } => {
                write!(f, "the tile of rank {rank} has no child with digit {digit}")
            }
        }
    }
}

impl core::error::Error for RankError {}
