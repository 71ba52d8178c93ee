//! The paper's ADAPTIVESAMP, with exact pruning: depth first, digit 0 first.
//!
//! In the subtree of a level-m tile with rank r, the smallest rank is r, and the smallest rank that is
//! not the center's own is N_m + r. A tile's center is tested with its parent's batch; so a subtree
//! whose bound in rank units is at most N_m + r needs no visit. This is sharper than the paper's κ
//! (its equation 8) and takes no logarithm.
//!
//! ```text
//! level m      tile: limit = ranks that its bound admits
//!                │ limit ≤ N_m + r                      nothing below it: passed over
//!                │ few entries left to test             one batch: the block's entries below limit
//!                │ otherwise: opened                    one batch: the children's centers
//! level m + 1    ├─ child 0 ─ …                         then each child, digit 0 first
//!                ├─ child 1 ─ …
//! ```
//!
//! `advance` goes to the next tile (a child of the deepest open tile, or a tile of the frontier, whose own
//! center is a batch by itself) and visits it, until there is a batch to hand out.

use super::candidates::Candidates;
use super::chunk::Chunk;
use super::context::Context;
use super::count::{count_below, count_below_at_most, levels_below, work_below};
use super::displaced::Displaced;
use super::frontier::Frontier;
use super::mode::Mode;
use super::open::OpenTile;
use super::seam::Seam;
use super::shard::Shard;
use crate::domain::Disc;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::FRONTIER_LEVEL;
use crate::position::Position;
use crate::sampling::{Clip, Sampling, ToWorld};
use crate::tiling::MAX_LEVEL;
use crate::tree::node::Node;

/// Open tiles: one a level from the frontier on; the deepest tiles have no children.
const MAX_OPEN: usize = MAX_LEVEL - FRONTIER_LEVEL as usize;

/// From this many candidates on, it is found out which of them need no test. On a smooth map, 128 costs
/// a sixth more at 64k points and a tenth less at 64; 8 costs up to half as much again.
const WORTH_A_BOUND: usize = 32;

/// Where the walk stops and tests the candidates that are left: below this many, testing them costs
/// less than the bounds of the tiles among them save. Those that need no test do not count. Measured at 64
/// to 16 million points over smooth, textured, hard-edged and high-dynamic-range maps: from 100 to 400
/// the time of a million points falls by a quarter to a half, from 400 to 800 by up to a sixth.
const FEW: usize = 800;

/// How far above the mean bound of a tile and its siblings its own is where importance has a peak.
const PEAK: f64 = 2.0;

/// The same at a peak, where the bounds of tiles below differ and save more.
const FEW_AT_PEAK: usize = 130;

/// The same for a tile across the clip's border, where a candidate may lie outside, and costs more. From
/// 200 to 400 a thousand uniform points cost two thirds; from 400 to 800 other small counts rise.
const FEW_AT_BORDER: usize = 400;

/// Relaxed points know their ancestry by the tile at most so many levels above them.
const KIN_LEVELS: u8 = 3;

/// A traversal in progress. Holds everything it needs; nothing is allocated.
#[derive(Clone, Debug)]
pub(crate) struct Traversal<K> {
    open: [OpenTile<K>; MAX_OPEN],
    depth: usize,
    frontier: Frontier,
    /// How many ranks the bound of the frontier tile begun last admits, while only that tile's center
    /// has been tested.
    begun: Option<u64>,
    clip: Clip,
    /// The part of the walk that is taken; `None` for all of it.
    shard: Option<Shard>,
    tiles_left: u64,
    /// The tile being visited and its candidates, built in place.
    batch: Candidates,
    ancestry: K,
    /// Whether the tile's bound is well above its siblings'.
    peak: bool,
    /// Whether blocks are read where that is sooner; otherwise every tile that may hold points is opened.
    blocks: bool,
}

impl<K: Mode> Traversal<K> {
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>, shard: Option<Shard>) -> Self {
        Self {
            open: [OpenTile::CLOSED; MAX_OPEN],
            depth: 0,
            frontier: Frontier::new(sampling),
            begun: None,
            clip: sampling.clip(),
            shard,
            tiles_left: sampling.limits().tiles,
            batch: Candidates::EMPTY,
            ancestry: K::NONE,
            peak: false,
            blocks: true,
        }
    }

    /// The same, tile by tile to the end, as without tables.
    pub(crate) fn without_blocks(self) -> Self {
        Self { blocks: false, ..self }
    }

    /// Takes the batch's entries from `start` on into `chunk`, as many as fit, and marks the points
    /// among them. Returns the next entry.
    #[inline(always)]
    pub(crate) fn select<I: Importance, P: Position>(
        &self,
        sampling: &Sampling<'_, I>,
        to_world: &ToWorld<P::Scalar>,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        let walk = Context { sampling, clip: &self.clip, to_world };
        self.ancestry.select::<I, P>(&walk, &self.batch, start, chunk)
    }

    /// The current batch of candidates.
    #[inline(always)]
    pub(crate) fn batch(&self) -> &Candidates {
        &self.batch
    }

    /// The same on constant ground: the entries from `start` on, moved by steps.
    #[inline(always)]
    pub(crate) fn select_moved<I: Importance, P: Position>(
        &self,
        sampling: &Sampling<'_, I>,
        to_world: &ToWorld<P::Scalar>,
        start: usize,
        steps: &Displaced<'_, P::Scalar>,
        chunk: &mut Chunk<P::Scalar>,
    ) -> usize {
        let entries = start..self.batch.end;
        let next = chunk.load_moved(sampling.placement(), &self.batch, entries, steps);
        chunk.mark_inside::<I, P>(&Context { sampling, clip: &self.clip, to_world });
        next
    }

    /// The work that a walk by parts has passed.
    pub(crate) fn passed(&self) -> u64 {
        self.shard.map_or(0, |shard| shard.passed())
    }

    /// How many more tiles the walk may visit.
    pub(crate) fn tiles_left(&self) -> u64 {
        self.tiles_left
    }

    /// Moves to the next batch of candidates; `false` at the end.
    #[inline(always)]
    pub(crate) fn advance<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<bool, SamplingError> {
        loop {
            let limit = if let Some(limit) = self.next_child(sampling) {
                limit
            } else if let Some(limit) = self.begun.take() {
                limit
            } else {
                let Some(node) = self.frontier.next::<K>(sampling, &self.clip) else {
                    return Ok(false);
                };
                self.begun = self.enter_frontier(sampling, &node)?;
                if self.begun.is_some() {
                    (self.batch.start, self.batch.end) = (0, 1);
                    self.batch.sure = usize::from(self.batch.constant);
                    if self.shard.as_mut().is_none_or(|shard| shard.take(1, 0)) {
                        return Ok(true);
                    }
                }
                continue;
            };
            if self.visit(sampling, limit)? {
                return Ok(true);
            }
        }
    }

    /// Moves to the next child of the deepest open tile: how many ranks its bound admits.
    #[inline(always)]
    fn next_child<I: Importance>(&mut self, sampling: &Sampling<'_, I>) -> Option<u64> {
        let placement = sampling.placement();
        let (tables, numbering) = (placement.tables(), placement.numbering());
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
            self.batch.node = open.node.child(tables, numbering, digit)?;
            self.ancestry = open.ancestry.child(&open.node, digit, &self.batch.node);
            self.batch.bound = open.bounds[digit];
            self.peak = open.bounds[digit] > PEAK * open.mean_bound;
            self.batch.inside = open.inside & bit != 0;
            self.batch.constant = open.constant & bit != 0;
            return Some(open.limits[digit]);
        }
    }

    /// Moves to a tile of the frontier, unless nothing of it can be accepted.
    fn enter_frontier<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        node: &Node,
    ) -> Result<Option<u64>, SamplingError> {
        let placement = sampling.placement();
        let center = placement.domain().min() + placement.center(node);
        let region = Disc { center, radius: placement.reach(node.level, usize::MAX) };
        let radius = region.radius + K::margin(sampling, node.level);
        let region_of_points = Disc { radius, ..region };
        let seam = Seam::of(placement);
        let touches = match &seam {
            None => self.clip.touches(&region_of_points),
            Some(seam) => seam.touches(&self.clip, &region_of_points),
        };
        if !touches {
            return Ok(None);
        }
        let region = match K::RELAXED && seam.is_none() {
            // Importance is read at the nearest place of the domain.
            true => {
                let domain = placement.domain();
                Disc { center: center.clamp(domain.min(), domain.max()), ..region }
            }
            false => region,
        };
        let importance = sampling.importance();
        let (bound, constant) = match seam.filter(|seam| !seam.is_clear_of(&region)) {
            None => (importance.upper_bound(&region), importance.is_constant(&region)),
            Some(seam) => (seam.upper_bound(importance, &region), seam.is_constant(importance)),
        };
        let limit = sampling.rank_limit_of_bound(bound, &region)?;
        self.batch.node = *node;
        self.ancestry = K::frontier(placement, node);
        self.batch.bound = bound;
        // No siblings to compare with.
        self.peak = true;
        self.batch.inside = self.clip.holds(&region_of_points);
        self.batch.constant = constant;
        Ok((limit > node.rank).then_some(limit))
    }

    /// Visits a tile whose own center has had its turn: either all that can be accepted in it becomes
    /// one batch, or it is opened and the batch is its children's centers. `false` if nothing can be.
    #[inline(always)]
    fn visit<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        limit: u64,
    ) -> Result<bool, SamplingError> {
        self.tiles_left = self
            .tiles_left
            .checked_sub(1)
            .ok_or(SamplingError::TilesLimit { limit: sampling.limits().tiles })?;
        self.batch.start = 1;
        let mut shard = self.shard.as_mut().filter(|shard| !shard.is_in_piece(self.depth));
        let Candidates { node, inside, constant, bound, .. } = &self.batch;
        let constant = *constant;
        let placement = sampling.placement();
        let numbering = placement.numbering();
        if limit <= numbering.counts().pair(node.level).0.saturating_add(node.rank) {
            return Ok(false);
        }
        let tables = placement.tables();
        let block = tables.block(node.kind);
        let levels = levels_below(numbering, node, limit);
        if let Some(part) = &mut shard {
            let work = work_below(numbering, node, limit);
            if part.is_piece(work) {
                if !part.take(work, self.depth) {
                    return Ok(false);
                }
                shard = None;
            }
        }
        // The ancestry of relaxed points reaches only so many levels down.
        let near = !K::RELAXED
            || numbering.counts().is_within(
                node.level,
                KIN_LEVELS.min(tables.depth().max(2)),
                sampling.scale().threshold(*bound),
            );
        if self.blocks && near && levels <= usize::from(tables.depth()) {
            let end = if constant {
                count_below(numbering, node, block, levels, limit)
            } else {
                count_below_at_most(numbering, node, block, levels, limit)
            };
            let (mut end, mut constant) = (end, constant);
            let sure = if constant {
                end
            } else if end < WORTH_A_BOUND || (!inside && (K::RELAXED || placement.is_seamless())) {
                0
            } else {
                let (lower, region) = lower_bound(sampling, node, levels);
                constant =
                    K::RELAXED && lower >= *bound && sampling.importance().is_constant(&region);
                // A broken promise admits no more than the upper bound; NaN, nothing.
                let lower = if lower > *bound { *bound } else { lower };
                let sure = sure_below(sampling, node, lower, levels).min(end);
                end = if constant { sure } else { end };
                sure
            };
            let few = match (constant, inside) {
                // Whole blocks, whose vectors are looked up together.
                (true, false) if K::RELAXED => true,
                (_, false) => end <= FEW_AT_BORDER,
                (_, true) => end - sure <= if self.peak { FEW_AT_PEAK } else { FEW },
            };
            if levels == 1 || few {
                let taken = shard.is_none_or(|shard| shard.take(end as u64, self.depth));
                (self.batch.end, self.batch.sure) = (end, sure);
                self.batch.constant = constant;
                return Ok(taken);
            }
        }
        // Never full: each open tile is one level below the one before.
        let Some(open) = self.open.get_mut(self.depth) else { return Ok(false) };
        let value = constant.then_some(*bound);
        open.expand(sampling, &self.clip, (node, &self.ancestry), limit, *inside, value)?;
        // Deeper levels are wanted, so that all children's centers are.
        let end = block.born_before(2);
        let taken = shard.is_none_or(|shard| shard.take(end as u64, self.depth + 1));
        self.depth += 1;
        (self.batch.end, self.batch.sure) = (end, if constant { end } else { 0 });
        Ok(taken)
    }
}

/// A lower bound of the importance where the descendants of a tile are that are born at most `levels` levels
/// below it, and where that is.
#[inline(always)]
fn lower_bound(
    sampling: &Sampling<'_, impl Importance>,
    node: &Node,
    levels: usize,
) -> (f64, Disc) {
    let placement = sampling.placement();
    let center = placement.domain().min() + placement.center(node);
    let region = Disc { center, radius: placement.reach(node.level, levels) };
    (sampling.importance().lower_bound(&region), region)
}

/// How many of those are accepted whatever the importance is there, from `lower` on.
fn sure_below<I: Importance>(
    sampling: &Sampling<'_, I>,
    node: &Node,
    lower: f64,
    levels: usize,
) -> usize {
    let placement = sampling.placement();
    let limit = sampling.scale().limit(lower);
    if limit <= node.rank {
        return 0;
    }
    let block = placement.tables().block(node.kind);
    count_below(placement.numbering(), node, block, levels, limit)
}
