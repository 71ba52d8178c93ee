//! The paper's ADAPTIVESAMP, with exact pruning: depth first, digit 0 first.
//!
//! In the subtree of a level-m tile with rank r, the smallest rank is r, and the smallest rank that is
//! not the centre's own is N_m + r. A tile's centre is tested with its parent's batch; so a subtree
//! whose bound in rank units is at most N_m + r needs no visit. This is sharper than the paper's κ
//! (its equation 8) and takes no logarithm.

use super::batch::{Batch, count_below, levels_below, tiles_at};
use super::expand::Open;
use super::node::Node;
use crate::clip::Clip;
use crate::domain::Region;
use crate::importance::Importance;
use crate::placement::FRONTIER_LEVEL;
use crate::sampling::{Sampling, SamplingError};
use crate::tiling::MAX_LEVEL;

/// Open tiles: one a level from the frontier on; the deepest tiles have no children.
const OPEN: usize = MAX_LEVEL - FRONTIER_LEVEL as usize;

/// Where the walk stops and tests the candidates that are left: below this many, testing them costs
/// less than asking for the bounds of 14 children. Chosen by measurement, see benches/image.rs.
const FEW: usize = 96;

/// The same on constant ground, for a tile across the clip's border: candidates cost little there.
const FEW_AT_BORDER: usize = 200;

/// A traversal in progress. Holds everything it needs; nothing is allocated.
#[derive(Clone, Debug)]
pub(crate) struct Traversal {
    open: [Open; OPEN],
    depth: usize,
    /// Twice the number of frontier tiles begun, less one if only its centre was.
    frontier: usize,
    clip: Clip,
    tiles_left: u64,
}

/// A tile to visit and what its opened parent knows about it.
struct Visit {
    node: Node,
    limit: u64,
    bound: f64,
    inside: bool,
    constant: bool,
}

impl Traversal {
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>, clip: Clip) -> Self {
        let tiles_left = sampling.limits().tiles;
        Self { open: [Open::CLOSED; OPEN], depth: 0, frontier: 0, clip, tiles_left }
    }

    /// The next batch of candidates, or `None` at the end.
    pub(crate) fn next_batch<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<Option<Batch>, SamplingError> {
        loop {
            let visit = if let Some(visit) = self.next_child(sampling) {
                visit
            } else {
                let Some(node) = sampling.placement().frontier_node(self.frontier / 2) else {
                    return Ok(None);
                };
                self.frontier += 1;
                let Some(visit) = self.frontier_visit(sampling, node)? else { continue };
                if self.frontier % 2 == 1 {
                    return Ok(Some(visit.centre()));
                }
                visit
            };
            if let Some(batch) = self.visit(sampling, &visit)? {
                return Ok(Some(batch));
            }
        }
    }

    /// The next child of the deepest open tile.
    fn next_child<I: Importance>(&mut self, sampling: &Sampling<'_, I>) -> Option<Visit> {
        let tables = sampling.placement().tables();
        loop {
            let top = self.depth.checked_sub(1)?;
            let open = &mut self.open[top];
            if open.pending == 0 {
                self.depth = top;
                continue;
            }
            let digit = open.pending.trailing_zeros() as usize;
            let bit = 1 << digit;
            open.pending &= !bit;
            let (tiles, before) = super::batch::tile_counts(open.node.level);
            return Some(Visit {
                node: open.node.child(tables, digit, tiles, before)?,
                limit: open.limits[digit],
                bound: open.bounds[digit],
                inside: open.inside & bit != 0,
                constant: open.constant & bit != 0,
            });
        }
    }

    /// A tile of the frontier, unless nothing of it can be accepted.
    fn frontier_visit<I: Importance>(
        &self,
        sampling: &Sampling<'_, I>,
        node: &Node,
    ) -> Result<Option<Visit>, SamplingError> {
        let placement = sampling.placement();
        let centre = placement.domain().min() + placement.centre(node);
        let region = Region { centre, radius: placement.reach(node.level, usize::MAX) };
        if !self.clip.touches(&region) {
            return Ok(None);
        }
        let bound = sampling.importance().upper_bound(&region);
        let limit = sampling.rank_limit_of_bound(bound, &region)?;
        let constant = sampling.importance().is_constant(&region);
        let inside = self.clip.holds(&region);
        Ok((limit > node.rank).then_some(Visit { node: *node, limit, bound, inside, constant }))
    }

    /// Visits a tile whose own centre has had its turn: either all that can be accepted in it becomes
    /// one batch, or it is opened and the batch is its children's centres.
    fn visit<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        visit: &Visit,
    ) -> Result<Option<Batch>, SamplingError> {
        self.tiles_left = self
            .tiles_left
            .checked_sub(1)
            .ok_or(SamplingError::TilesLimit { limit: sampling.limits().tiles })?;
        let Visit { node, limit, .. } = visit;
        if *limit <= tiles_at(node.level).saturating_add(node.rank) {
            return Ok(None);
        }
        let tables = sampling.placement().tables();
        let block = tables.block(node.kind);
        let levels = levels_below(node, *limit);
        let depth = usize::from(tables.depth());
        if levels <= depth {
            let end = count_below(node, block, levels, *limit);
            let few = match (visit.constant, visit.inside) {
                (true, true) => usize::MAX,
                (true, false) => FEW_AT_BORDER,
                (false, _) => FEW,
            };
            if levels == 1 || end <= few {
                return Ok(Some(visit.batch(end)));
            }
        }
        // Never full: each open tile is one level below the one before.
        let Some(open) = self.open.get_mut(self.depth) else { return Ok(None) };
        open.expand(sampling, &self.clip, node, levels, visit.inside)?;
        self.depth += 1;
        Ok(Some(visit.batch(count_below(node, block, 1, *limit))))
    }
}

impl Visit {
    /// Entries 1..end of the tile's block.
    fn batch(&self, end: usize) -> Batch {
        let Self { node, bound, inside, constant: all_accepted, .. } = *self;
        Batch { node, start: 1, end, inside, all_accepted, bound }
    }

    /// The tile's own centre.
    fn centre(&self) -> Batch {
        Batch { start: 0, ..self.batch(1) }
    }
}
