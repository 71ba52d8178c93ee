//! Batches of the walk: runs of candidates read from the baked tables.

use crate::placement::Placement;
use crate::position::Scalar;
use crate::tables::BlockTable;
use crate::tree::frame::{Frame, Segment};
use crate::tree::node::Node;

/// Entries `start..end` of a node's block: descendants that may be accepted, in the order of rank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidates {
    pub(crate) node: Node,
    /// 1, or 0 with `end` 1 for the center of a tile of the frontier.
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// Every candidate lies in the clip.
    pub(crate) inside: bool,
    /// Whether the importance is constant where the node's points are.
    pub(crate) constant: bool,
    /// Entries before this one are accepted wherever they lie in the clip: their ranks are below what
    /// the lower bound of the importance admits. At most `end`.
    pub(crate) sure: usize,
    /// The upper bound of the importance over the candidates.
    pub(crate) bound: f64,
}

impl Candidates {
    /// No candidates.
    pub(crate) const EMPTY: Self = Self {
        node: Node::root(),
        start: 0,
        end: 0,
        inside: false,
        constant: false,
        sure: 0,
        bound: 0.0,
    };
}

impl Candidates {
    /// The end of the run that entry `start` is in: that of the sure entries, or that of the others.
    #[inline(always)]
    pub(crate) fn run_end(&self, start: usize) -> usize {
        if start < self.sure { self.sure } else { self.end }
    }

    /// The rank of entry `i`.
    #[inline(always)]
    pub(crate) fn rank(&self, block: &BlockTable<'_>, i: usize) -> u64 {
        self.node.rank_of(block.rank_coefficients(i))
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
        let center = (0..levels).fold(node.center, |center, _| center.finer());
        let half_edge = placement.half_edge(node.level + levels as u8);
        let segment = Segment::new(
            Frame::new(half_edge, placement.origin(), quarters),
            center.turned_back(quarters),
            block.offsets(usize::from(node.rotation % 3)),
            start..end,
        );
        (segment, end)
    }
}
