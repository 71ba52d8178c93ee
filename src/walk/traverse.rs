//! The paper's ADAPTIVESAMP, with exact pruning: depth first, digit 0 first.
//!
//! In the subtree of a level-m tile with rank r, the smallest rank is r, and the smallest rank that is
//! not the centre's own is N_m + r. So a subtree whose bound in rank units is at most r holds no point,
//! and one whose bound is at most N_m + r holds its centre at most. This is sharper than the paper's κ
//! (its equation 8) and takes no logarithm.

use super::leaf::{Leaf, count_below, levels_below, tile_counts};
use super::node::Node;
use crate::clip::Clip;
use crate::importance::Importance;
use crate::placement::FRONTIER_LEVEL;
use crate::sampling::{Sampling, SamplingError};
use crate::tiling::MAX_LEVEL;

/// Waiting nodes: at most 13 siblings on each level below the frontier, and the frontier.
const STACK: usize = 13 * (MAX_LEVEL - FRONTIER_LEVEL as usize) + 14;

/// A traversal in progress. Holds everything it needs; nothing is allocated.
#[derive(Clone, Debug)]
pub(crate) struct Traversal {
    stack: [Option<Node>; STACK],
    waiting: usize,
    clip: Clip,
    tiles_left: u64,
}

impl Traversal {
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>, clip: Clip) -> Self {
        let mut traversal =
            Self { stack: [None; STACK], waiting: 0, clip, tiles_left: sampling.limits().tiles };
        for node in sampling.placement().frontier().rev() {
            traversal.push(*node);
        }
        traversal
    }

    fn push(&mut self, node: Node) {
        // Never full: see STACK.
        if let Some(slot) = self.stack.get_mut(self.waiting) {
            *slot = Some(node);
            self.waiting += 1;
        }
    }

    fn pop(&mut self) -> Option<Node> {
        self.waiting = self.waiting.checked_sub(1)?;
        self.stack[self.waiting]
    }

    /// The next block with candidates, or `None` at the end.
    pub(crate) fn next_leaf<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<Option<Leaf>, SamplingError> {
        let placement = sampling.placement();
        let tables = placement.tables();
        while let Some(node) = self.pop() {
            self.tiles_left = self
                .tiles_left
                .checked_sub(1)
                .ok_or(SamplingError::TilesLimit { limit: sampling.limits().tiles })?;
            let region = placement.region(&node);
            if !self.clip.touches(&region) {
                continue;
            }
            let bound = sampling.importance().upper_bound(&region);
            let limit = sampling.rank_limit_of_bound(bound, &region)?;
            if limit <= node.rank {
                continue;
            }
            if let Some(levels) = levels_below(&node, tables, limit) {
                let constant = sampling.importance().is_constant(&region);
                if levels <= 2 || constant {
                    let block = tables.block(node.kind);
                    return Ok(Some(Leaf {
                        candidates: count_below(&node, block, levels, limit),
                        inside: self.clip.holds(&region),
                        all_accepted: constant,
                        node,
                        bound,
                    }));
                }
            }
            let (tiles, before) = tile_counts(node.level);
            for digit in (0..tables.child_kinds(node.kind).len()).rev() {
                if let Some(child) = node.child(tables, digit, tiles, before) {
                    self.push(child);
                }
            }
        }
        Ok(None)
    }
}
