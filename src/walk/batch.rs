//! Batches of the walk: runs of candidates read from the baked tables.

use super::frame::{Frame, Segment};
use super::node::Node;
use super::scalar::Scalar;
use crate::placement::Placement;
use crate::tables::BlockTable;
use crate::tiling::{MAX_LEVEL, TileCounts};

/// Entries `start..end` of a node's block: descendants that may be accepted, in the order of rank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch {
    pub(crate) node: Node,
    /// 1, or 0 with `end` 1 for the centre of a tile of the frontier.
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// Every candidate lies in the clip.
    pub(crate) inside: bool,
    /// Entries before this one are accepted wherever they lie in the clip: their ranks are below what
    /// the lower bound of the importance admits. `end` or more: all of them.
    pub(crate) certain: usize,
    /// The upper bound of the importance over the candidates.
    pub(crate) bound: f64,
}

impl Batch {
    /// No candidates.
    pub(crate) const EMPTY: Self =
        Self { node: Node::root(), start: 0, end: 0, inside: false, certain: 0, bound: 0.0 };
}

/// N_m of a level, under the root `a`.
#[inline(always)]
pub(crate) fn tiles_at(level: u8) -> u64 {
    TileCounts::HEXAGON.all()[usize::from(level)]
}

/// N_m and N_{m−1} of a level, under the root `a`.
#[inline(always)]
pub(crate) fn tile_counts(level: u8) -> (u64, u64) {
    (tiles_at(level), if level == 0 { 1 } else { tiles_at(level - 1) })
}

/// 1/N_m.
pub(crate) static RECIPROCALS: [f64; MAX_LEVEL + 1] = {
    let mut reciprocals = [1.0; MAX_LEVEL + 1];
    let mut level = 0;
    while level <= MAX_LEVEL {
        if let Ok(tiles) = TileCounts::HEXAGON.at(level) {
            reciprocals[level] = 1.0 / tiles as f64;
        }
        level += 1;
    }
    reciprocals
};

/// The smallest number of levels j such that no tile born deeper than j levels below the node has a
/// rank under `limit`: the smallest rank born in level m + j + 1 is N_{m+j} + r.
#[inline(always)]
pub(crate) fn levels_below(node: &Node, limit: u64) -> usize {
    let counts = &TileCounts::HEXAGON.all()[usize::from(node.level)..];
    let more = |tiles: &u64| limit > tiles.saturating_add(node.rank);
    // Counted, not searched: the number is small and no branch predicts it. Past the last level there
    // are no ranks, and no limit reaches there.
    let near = counts.iter().take(4).filter(|tiles| more(tiles)).count();
    if near < 4 { near } else { counts.iter().filter(|tiles| more(tiles)).count() }
}

/// About how many candidates a subtree has: a tile has one descendant in each N_m ranks.
pub(crate) fn work_below(node: &Node, limit: u64) -> u64 {
    let ranks = limit.saturating_sub(node.rank) as i64 as f64;
    (ranks * RECIPROCALS[usize::from(node.level)]) as i64 as u64 + 1
}

/// A number of entries, born at most `levels` levels down, after which none has a rank below `limit`:
/// [`count_below`] or a few more.
///
/// A rank is r + A·N_m − B·N_{m−1}, B is less than A/13 + 1, N_{m−1} is less than N_m/12.9, and the A
/// ascend without repeating; so the entry with index i has A ≥ i, and a rank of at least
/// r + (i·(1 − 1/167) − 1/12)·N_m.
#[inline(always)]
pub(crate) fn count_below_at_most(
    node: &Node,
    block: &BlockTable<'_>,
    levels: usize,
    limit: u64,
) -> usize {
    let blocks =
        limit.saturating_sub(node.rank) as i64 as f64 * RECIPROCALS[usize::from(node.level)];
    let count = (blocks + 0.1) * (1.0 + 1.0 / 160.0) + 1.0;
    (count as i64 as usize).min(block.born_before(levels + 1))
}

/// How many of the entries born at most `levels` levels down have a rank below `limit`.
#[inline(always)]
pub(crate) fn count_below(node: &Node, block: &BlockTable<'_>, levels: usize, limit: u64) -> usize {
    let (tiles, before) = tile_counts(node.level);
    let mut low = 0;
    let mut size = block.born_before(levels + 1);
    // Halving without a branch to mispredict; entry 0 is the node itself.
    while size > 0 {
        let half = size.div_ceil(2);
        let (a, b) = block.rank_coefficients(low + half - 1);
        let below = node.rank + u64::from(a) * tiles - u64::from(b) * before < limit;
        low += if below { half } else { 0 };
        size = if below { size - half } else { half - 1 };
    }
    low
}

impl Batch {
    /// Where the run ends of which entry `start` is: the certain ones, or the others.
    #[inline(always)]
    pub(crate) fn run_end(&self, start: usize) -> usize {
        if start < self.certain { self.certain.min(self.end) } else { self.end }
    }

    /// The rank of entry `i`.
    #[inline(always)]
    pub(crate) fn rank(&self, block: &BlockTable<'_>, i: usize) -> u64 {
        let (tiles, before) = tile_counts(self.node.level);
        let (a, b) = block.rank_coefficients(i);
        self.node.rank + u64::from(a) * tiles - u64::from(b) * before
    }

    /// The block that the entries are of.
    pub(crate) fn block<'t, 'p>(&self, placement: &'p Placement<'t>) -> &'p BlockTable<'t> {
        placement.tables().block(self.node.kind)
    }

    /// The entries from `start` on that share its level of birth, `most` at the most, and the first
    /// that is not among them.
    #[inline(always)]
    pub(crate) fn segment<'t, S: Scalar>(
        &self,
        placement: &Placement<'t>,
        start: usize,
        most: usize,
    ) -> (Segment<'t, S>, usize) {
        let node = &self.node;
        let block = placement.tables().block(node.kind);
        let depth = usize::from(placement.tables().depth());
        let levels = (0..depth).find(|j| start < block.born_before(j + 1)).unwrap_or(depth);
        let end = self.end.min(block.born_before(levels + 1)).min(start.saturating_add(most));
        let quarters = node.rotation / 3;
        let centre = (0..levels).fold(node.centre, |centre, _| centre.finer());
        let half_edge = placement.half_edge(node.level + levels as u8);
        let segment = Segment::new(
            Frame::new(half_edge, placement.origin(), quarters),
            centre.turned_back(quarters),
            block.offsets(usize::from(node.rotation % 3)),
            start..end,
        );
        (segment, end)
    }
}
