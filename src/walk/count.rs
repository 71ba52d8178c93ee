//! Counting ahead: how many levels, entries and candidates a limit on ranks leaves below a tile.

use crate::tables::BlockTable;
use crate::tiling::counts::Numbering;
use crate::tree::node::Node;

/// The smallest number of levels j such that no tile born deeper than j levels below the node has a
/// rank under `limit`: the smallest rank born in level m + j + 1 is N_{m+j} + r.
#[inline(always)]
pub(crate) fn levels_below(numbering: &Numbering, node: &Node, limit: u64) -> usize {
    let counts = &numbering.counts().all()[usize::from(node.level)..];
    let more = |tiles: &u64| limit > tiles.saturating_add(node.rank);
    // Counted, not searched: the number is small and no branch predicts it. Past the last level there
    // are no ranks, and no limit reaches there.
    let near = counts.iter().take(4).filter(|tiles| more(tiles)).count();
    if near < 4 { near } else { counts.iter().filter(|tiles| more(tiles)).count() }
}

/// About how many candidates a subtree has: a tile has one descendant in each N_m ranks.
pub(crate) fn work_below(numbering: &Numbering, node: &Node, limit: u64) -> u64 {
    let ranks = limit.saturating_sub(node.rank) as i64 as f64;
    (ranks * numbering.reciprocal(node.level.into())) as i64 as u64 + 1
}

/// A number of entries, born at most `levels` levels down, after which none has a rank below `limit`:
/// [`count_below`] or a few more.
///
/// A rank is r + A·N_m − B·N_{m−1}, B is less than A/13 + 1, N_{m−1} is less than N_m/12.9, and the A
/// ascend without repeating; so the entry with index i has A ≥ i, and a rank of at least
/// r + (i·(1 − 1/167) − 1/12)·N_m.
#[inline(always)]
pub(crate) fn count_below_at_most(
    numbering: &Numbering,
    node: &Node,
    block: &BlockTable<'_>,
    levels: usize,
    limit: u64,
) -> usize {
    let ranks = limit.saturating_sub(node.rank) as i64 as f64;
    let blocks = ranks * numbering.reciprocal(node.level.into());
    let count = (blocks + 0.1) * (1.0 + 1.0 / 160.0) + 1.0;
    (count as i64 as usize).min(block.born_before(levels + 1))
}

/// How many of the entries born at most `levels` levels down have a rank below `limit`.
#[inline(always)]
pub(crate) fn count_below(
    numbering: &Numbering,
    node: &Node,
    block: &BlockTable<'_>,
    levels: usize,
    limit: u64,
) -> usize {
    let mut low = 0;
    let mut size = block.born_before(levels + 1);
    // Halving without a branch to mispredict; entry 0 is the node itself.
    while size > 0 {
        let half = size.div_ceil(2);
        let below = node.rank_of(numbering, block.rank_coefficients(low + half - 1)) < limit;
        low += if below { half } else { 0 };
        size = if below { size - half } else { half - 1 };
    }
    low
}
