//! Leaves of the walk: blocks of candidates read from the baked tables.

use super::chunk::{CHUNK, Chunk};
use super::node::Node;
use super::scalar::Scalar;
use crate::placement::Placement;
use crate::tables::{BlockTable, Tables};
use crate::tiling::TileCounts;

/// The first `candidates` entries of a node's block: all of its descendants that can be accepted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub(crate) node: Node,
    /// At least 1.
    pub(crate) candidates: usize,
    /// Every candidate lies in the domain and in the clip rectangle.
    pub(crate) inside: bool,
    /// Every candidate's importance is the one from which `candidates` was derived.
    pub(crate) all_accepted: bool,
    /// The upper bound of the importance over the block.
    pub(crate) bound: f64,
}

/// N_m and N_{m−1} of a node's level, under the root `a`.
pub(crate) fn tile_counts(level: u8) -> (u64, u64) {
    let counts = TileCounts::HEXAGON.all();
    let level = usize::from(level);
    (counts[level], if level == 0 { 1 } else { counts[level - 1] })
}

/// How many entries of a block, the first `born_before(levels + 1)` of it, have a rank below `limit`.
pub(crate) fn count_below(node: &Node, block: &BlockTable<'_>, levels: usize, limit: u64) -> usize {
    let (tiles, before) = tile_counts(node.level);
    let (mut low, mut high) = (0, block.born_before(levels + 1));
    while low < high {
        let middle = low + (high - low) / 2;
        let (a, b) = block.rank_coefficients(middle);
        if node.rank + u64::from(a) * tiles - u64::from(b) * before < limit {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

impl Leaf {
    /// Writes positions (relative to the domain's corner) and ranks of candidates from `start` on into
    /// `chunk`, as many as fit and are of one birth level. Returns the next candidate.
    pub(crate) fn fill_chunk<S: Scalar>(
        &self,
        placement: &Placement<'_>,
        start: usize,
        chunk: &mut Chunk<S>,
    ) -> usize {
        let node = &self.node;
        let block = placement.tables().block(node.kind);
        if start == 0 {
            chunk.set_single(placement, node);
            return 1;
        }
        let levels = (1..).find(|j| start < block.born_before(j + 1)).unwrap_or(1);
        let end = self.candidates.min(block.born_before(levels + 1)).min(start + CHUNK);
        let quarters = node.rotation / 3;
        let centre = (0..levels).fold(node.centre, |centre, _| centre.finer());
        chunk.set_positions(
            placement.half_edge(node.level + levels as u8),
            placement.origin,
            quarters,
            centre.turned_back(quarters),
            block.offsets(usize::from(node.rotation % 3)),
            start..end,
        );
        let (tiles, before) = tile_counts(node.level);
        for (rank, i) in chunk.ranks.iter_mut().zip(start..end) {
            let (a, b) = block.rank_coefficients(i);
            *rank = node.rank + u64::from(a) * tiles - u64::from(b) * before;
        }
        end
    }
}

/// The smallest number of levels j ≤ `depth` such that no tile born deeper than j levels below the
/// node has a rank under `limit`: the smallest rank born in level m + j + 1 is N_{m+j} + r.
pub(crate) fn levels_below(node: &Node, tables: &Tables<'_>, limit: u64) -> Option<usize> {
    let counts = TileCounts::HEXAGON.all();
    (0..=usize::from(tables.depth())).find(|j| {
        counts
            .get(usize::from(node.level) + j)
            .is_none_or(|tiles| limit <= tiles.saturating_add(node.rank))
    })
}
