//! Leaves of the walk: blocks of candidates read from the baked tables.

use super::chunk::{CHUNK, Chunk};
use super::frame::{Frame, Segment};
use super::node::Node;
use super::scalar::{Position, Scalar};
use crate::placement::Placement;
use crate::tables::{BlockTable, Tables};
use crate::tiling::TileCounts;

/// The first `candidates` entries of a node's block: all of its descendants that can be accepted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub(crate) node: Node,
    /// At least 1.
    pub(crate) candidates: usize,
    /// Every candidate lies in the domain.
    pub(crate) inside: bool,
    /// Every candidate that lies in the domain is accepted.
    pub(crate) all_accepted: bool,
    /// The upper bound of the importance over the block.
    pub(crate) bound: f64,
}

/// N_m and N_{m−1} of a level, under the root `a`.
pub(crate) fn tile_counts(level: u8) -> (u64, u64) {
    let counts = TileCounts::HEXAGON.all();
    let level = usize::from(level);
    (counts[level], if level == 0 { 1 } else { counts[level - 1] })
}

/// The smallest number of levels j ≤ the baked depth such that no tile born deeper than j levels below
/// the node has a rank under `limit`: the smallest rank born in level m + j + 1 is N_{m+j} + r.
pub(crate) fn levels_below(node: &Node, tables: &Tables<'_>, limit: u64) -> Option<usize> {
    let counts = &TileCounts::HEXAGON.all()[usize::from(node.level)..];
    let enough = |tiles: &u64| limit <= tiles.saturating_add(node.rank);
    // Past the last level there are no ranks, and no limit reaches there.
    let levels = counts.iter().position(enough).unwrap_or(counts.len());
    (levels <= usize::from(tables.depth())).then_some(levels)
}

/// How many of the entries born at most `levels` levels down have a rank below `limit`.
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
    /// The candidates from `start` ≥ 1 on that share its birth level, and the first that does not.
    fn segment<'t, S: Scalar>(
        &self,
        placement: &Placement<'t>,
        start: usize,
        most: usize,
    ) -> (Segment<'t, S>, usize) {
        let node = &self.node;
        let block = placement.tables().block(node.kind);
        let depth = usize::from(placement.tables().depth());
        let levels = (1..depth).find(|j| start < block.born_before(j + 1)).unwrap_or(depth);
        let end = self.candidates.min(block.born_before(levels + 1)).min(start + most);
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

    /// The position of candidate 0, the node's own centre.
    fn own_centre<S: Scalar>(&self, placement: &Placement<'_>) -> [S; 2] {
        let half_edge = placement.half_edge(self.node.born);
        Frame::new(half_edge, placement.origin(), 0).position(self.node.centre_at_birth)
    }

    /// Fills `chunk` with candidates from `start` on, as many as fit. Returns the next candidate.
    pub(crate) fn fill_chunk<S: Scalar>(
        &self,
        placement: &Placement<'_>,
        start: usize,
        chunk: &mut Chunk<S>,
    ) -> usize {
        let mut next = start;
        chunk.len = 0;
        if start == 0 {
            [chunk.x[0], chunk.y[0]] = self.own_centre(placement);
            (chunk.len, next) = (1, 1);
        }
        while chunk.len < CHUNK && next < self.candidates {
            let (segment, end) = self.segment::<S>(placement, next, CHUNK - chunk.len);
            let filled = chunk.len..chunk.len + (end - next);
            let (xs, ys) = (&mut chunk.x[filled.clone()], &mut chunk.y[filled.clone()]);
            segment.for_each(|i, x, y| (xs[i], ys[i]) = (x, y));
            (chunk.len, next) = (filled.end, end);
        }
        let (tiles, before) = tile_counts(self.node.level);
        let block = placement.tables().block(self.node.kind);
        let coefficients = block.rank_coefficients_of(start..next);
        for (slot, (a, b)) in chunk.ranks.iter_mut().zip(coefficients) {
            *slot = self.node.rank + u64::from(a) * tiles - u64::from(b) * before;
        }
        next
    }

    /// Writes the positions of all candidates, relative to the domain's least corner, to the start of
    /// `buffer`, which has room for them.
    pub(crate) fn write_positions<P: Position>(&self, placement: &Placement<'_>, buffer: &mut [P]) {
        let [x, y] = self.own_centre(placement);
        buffer[0] = P::from_xy(x, y);
        let mut next = 1;
        while next < self.candidates {
            let (segment, end) = self.segment::<P::Scalar>(placement, next, self.candidates);
            let slots = &mut buffer[next..end];
            segment.for_each(|i, x, y| slots[i] = P::from_xy(x, y));
            next = end;
        }
    }
}
