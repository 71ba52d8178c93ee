//! One tile type's block, read where its bytes lie.

use super::exact::ExactPoint;
use crate::bake::MAX_DEPTH;
use crate::bake::format::BlockBytes;
use crate::tiling::{TileCounts, TileType};

/// Offsets of a block in one orientation: for each entry (u, v, p, q), meaning the point
/// ((u + v√3)/2, (p + q√3)/2) in edges of the level of its birth. Bytes are little-endian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offsets<'a> {
    pub(crate) u: &'a [[u8; 2]],
    pub(crate) v: &'a [[u8; 2]],
    pub(crate) p: &'a [[u8; 2]],
    pub(crate) q: &'a [[u8; 2]],
}

/// The baked descendants of one tile type, in the order of their ranks.
#[derive(Clone, Copy, Debug)]
pub struct BlockTable<'a> {
    pub(super) bytes: BlockBytes<'a>,
    /// `born_before[j]`: how many entries are born fewer than j levels down.
    born_before: [u32; MAX_DEPTH as usize + 2],
    rank_a: &'a [[u8; 2]],
    rank_b: &'a [[u8; 2]],
    thresholds: &'a [[u8; 4]],
    /// Empty below depth 3.
    turns: &'a [u8],
    classes: &'a [[u8; 2]],
    offsets: [Offsets<'a>; 3],
}

impl<'a> BlockTable<'a> {
    pub(super) fn new(bytes: BlockBytes<'a>, kind: TileType, depth: u8) -> Option<Self> {
        let counts = TileCounts::of(kind);
        let mut born_before = [0; MAX_DEPTH as usize + 2];
        for j in 0..=usize::from(depth) {
            born_before[j + 1] = u32::try_from(counts.at(j).ok()?).ok()?;
        }
        let entries = born_before[usize::from(depth) + 1] as usize;
        let pairs = |column: &'a [u8]| {
            let (pairs, rest) = column.as_chunks::<2>();
            (rest.is_empty() && pairs.len() == entries).then_some(pairs)
        };
        let [Some(even), Some(turned_30), Some(turned_60)] = bytes.offsets.map(|[u, v, p, q]| {
            Some(Offsets { u: pairs(u)?, v: pairs(v)?, p: pairs(p)?, q: pairs(q)? })
        }) else {
            return None;
        };
        let (thresholds, rest) = bytes.thresholds.as_chunks::<4>();
        (rest.is_empty() && thresholds.len() == entries).then_some(())?;
        let (classes, rest) = bytes.classes.as_chunks::<2>();
        let relax_keys = if depth < 3 { 0 } else { born_before[4] as usize };
        let fitting =
            bytes.turns.len() == relax_keys && classes.len() == relax_keys && rest.is_empty();
        fitting.then_some(())?;
        Some(Self {
            bytes,
            born_before,
            rank_a: pairs(bytes.rank_a)?,
            rank_b: pairs(bytes.rank_b)?,
            thresholds,
            turns: bytes.turns,
            classes,
            offsets: [even, turned_30, turned_60],
        })
    }

    /// The number of entries: descendants down to the baked depth, the tile itself included.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a block is never empty")]
    pub fn len(&self) -> usize {
        self.rank_a.len()
    }

    /// How many entries are born fewer than `levels` levels down; `levels` ≤ depth + 1.
    #[must_use]
    pub(crate) fn born_before(&self, levels: usize) -> usize {
        self.born_before[levels] as usize
    }

    /// (A, B) of entry `i`: its rank is r + A·N_m − B·N_{m−1}. `i` < [`len`](Self::len).
    pub(crate) fn rank_coefficients(&self, i: usize) -> (u16, u16) {
        (u16::from_le_bytes(self.rank_a[i]), u16::from_le_bytes(self.rank_b[i]))
    }

    /// [`rank_coefficients`](Self::rank_coefficients) of a run of entries.
    #[inline(always)]
    pub(crate) fn rank_coefficients_of(
        &self,
        range: core::ops::Range<usize>,
    ) -> impl Iterator<Item = (u16, u16)> + 'a {
        let number = |bytes: &[u8; 2]| u16::from_le_bytes(*bytes);
        self.rank_a[range.clone()]
            .iter()
            .zip(&self.rank_b[range])
            .map(move |(a, b)| (number(a), number(b)))
    }

    /// Of the entries born at most three levels down, as they are there: the rotation of their ancestor
    /// one level down, relative to the block, and their class over two generations. None below
    /// depth 3.
    pub(crate) fn relax_keys(&self) -> impl ExactSizeIterator<Item = (u8, u16)> + 'a {
        self.relax_keys_of(0..self.turns.len())
    }

    /// [`relax_keys`](Self::relax_keys) of a run of entries, as far as there are any.
    #[inline(always)]
    pub(crate) fn relax_keys_of(
        &self,
        range: core::ops::Range<usize>,
    ) -> impl ExactSizeIterator<Item = (u8, u16)> + 'a {
        let end = range.end.min(self.turns.len()).min(self.classes.len());
        let range = range.start.min(end)..end;
        let columns = self.turns[range.clone()].iter().zip(&self.classes[range]);
        columns.map(|(turn, class)| (*turn, u16::from_le_bytes(*class)))
    }

    /// Of entry `i` among the [`relax_keys`](Self::relax_keys); zeros past them.
    #[inline(always)]
    pub(crate) fn relax_key(&self, i: usize) -> (u8, u16) {
        match (self.turns.get(i), self.classes.get(i)) {
            (Some(turn), Some(class)) => (*turn, u16::from_le_bytes(*class)),
            _ => (0, 0),
        }
    }

    /// The offset of entry `i` < [`len`](Self::len), turned by `turn`·30°, `turn` in 0..3.
    pub(crate) fn offset(&self, turn: usize, i: usize) -> ExactPoint {
        let Offsets { u, v, p, q } = self.offsets[turn];
        let field = |column: &[[u8; 2]]| i32::from(i16::from_le_bytes(column[i]));
        ExactPoint { u: field(u), v: field(v), p: field(p), q: field(q) }
    }

    /// The normalized thresholds of the entries, ascending, in [0, 1): each entry's place among the
    /// points of the block.
    pub fn thresholds(&self) -> impl ExactSizeIterator<Item = f32> + 'a {
        self.thresholds.iter().map(|bytes| f32::from_le_bytes(*bytes))
    }

    /// Offsets turned by `turn`·30°, `turn` in 0..3.
    #[must_use]
    pub(crate) fn offsets(&self, turn: usize) -> &Offsets<'a> {
        &self.offsets[turn]
    }
}
