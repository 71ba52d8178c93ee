//! The walk in relaxed mode: the same tiles, ranks and acceptance, and then a step aside.
//!
//! Every point is accepted or not at its fixed centre, with the importance of the nearest place in the
//! domain, and then moved by the vector of its classes and of the local density phase. What lies in
//! the domain is decided by where it ends up. So subtrees are visited whose points can move in: a
//! vector is at most [`longest`](crate::RelaxationTable) edges of the point's level long, which is at
//! least one level below the subtree's tile, but for the tile's own centre, whose level can be as
//! early as its birth.

use glam::DVec2;

use super::batch::{Batch, count_below, levels_below, tile_counts, work_below};
use super::chunk::{CHUNK, Chunk};
use super::kin::{Kin, Relation};
use super::scalar::{Position, Scalar};
use super::share::Share;
use crate::clip::{Clip, ToCaller};
use crate::domain::Region;
use crate::importance::Importance;
use crate::placement::{FRONTIER_LEVEL, Placement};
use crate::relaxed::RelaxationTable;
use crate::sampling::{Sampling, SamplingError};
use crate::tiling::cyclotomic::SQRT_3;
use crate::tiling::{MAX_LEVEL, TileCounts};

/// Points of earlier levels stay where they are: they occur where fewer than some four points are
/// expected in a domain, and the tiles from which they could move in would be very many.
pub(crate) const FIRST_RELAXED_LEVEL: u8 = FRONTIER_LEVEL + 2;

/// Waiting nodes, as for the fixed walk.
const STACK: usize = 13 * (MAX_LEVEL - FRONTIER_LEVEL as usize) + 24;

/// δ = 7 + 4√3.
const DELTA: f64 = 7.0 + 4.0 * SQRT_3;

/// A traversal in progress.
#[derive(Clone, Debug)]
pub(crate) struct RelaxedTraversal {
    stack: [Option<Kin>; STACK],
    waiting: usize,
    clip: Clip,
    /// The part of the walk that is taken; `None` for all of it.
    share: Option<Share>,
    tiles_left: u64,
    /// The tile being visited; its own centre is entry 0 of the batch.
    kin: Option<Kin>,
    batch: Batch,
}

/// The level L with N_{L−1} < T ≤ N_L, at least 1, and N_{L−1}.
fn level_of(threshold: f64) -> (u8, f64) {
    let counts = TileCounts::HEXAGON.all();
    let level = counts.partition_point(|tiles| (*tiles as f64) < threshold).max(1);
    (level as u8, counts[level - 1] as f64)
}

impl RelaxedTraversal {
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>) -> Self {
        let placement = sampling.placement();
        let mut traversal = Self {
            stack: [None; STACK],
            waiting: 0,
            clip: sampling.clip(),
            share: sampling.share(),
            tiles_left: sampling.limits().tiles,
            kin: None,
            batch: Batch::EMPTY,
        };
        for node in placement.frontier().rev() {
            traversal.push(Kin::frontier(placement.tables(), node));
        }
        traversal
    }

    fn push(&mut self, kin: Kin) {
        // Never full: see STACK.
        if let Some(slot) = self.stack.get_mut(self.waiting) {
            *slot = Some(kin);
            self.waiting += 1;
        }
    }

    fn pop(&mut self) -> Option<Kin> {
        self.waiting = self.waiting.checked_sub(1)?;
        self.stack[self.waiting]
    }

    /// The work that a walk by parts has passed.
    pub(crate) fn passed(&self) -> u64 {
        self.share.map_or(0, |share| share.passed())
    }

    /// The current batch of candidates.
    pub(crate) fn batch(&self) -> &Batch {
        &self.batch
    }

    /// Moves to the next batch of candidates; `false` at the end.
    pub(crate) fn advance<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        relaxation: &RelaxationTable<'_>,
    ) -> Result<bool, SamplingError> {
        let placement = sampling.placement();
        let domain = placement.domain();
        let tables = placement.tables();
        while let Some(kin) = self.pop() {
            self.tiles_left = self
                .tiles_left
                .checked_sub(1)
                .ok_or(SamplingError::TilesLimit { limit: sampling.limits().tiles })?;
            let node = kin.node;
            let centre = domain.min() + placement.centre(&node);
            let region = Region { centre, radius: placement.reach(node.level, usize::MAX) };
            // How far points born in the subtree move, and the node's own centre.
            let step = |level: u8| {
                let level = level.max(FIRST_RELAXED_LEVEL).min(MAX_LEVEL as u8);
                2.0 * placement.half_edge(level).length() * relaxation.longest()
                    + sampling.importance().longest_settling()
            };
            let wide = Region { radius: region.radius + step(node.level + 1), ..region };
            let own =
                Region { radius: placement.reach(node.level, 0) + step(kin.born()), ..region };
            let subtree_reaches = self.clip.touches(&wide);
            if !subtree_reaches && !self.clip.touches(&own) {
                continue;
            }
            // The nearest place of the domain is never farther from the clamped centre than the point
            // itself from the centre.
            let nearest = region.centre.clamp(domain.min(), domain.max());
            let here = Region { centre: nearest, ..region };
            let bound = sampling.importance().upper_bound(&here);
            let limit = sampling.rank_limit_of_bound(bound, &here)?;
            if limit <= node.rank {
                continue;
            }
            let (level, _) = level_of(sampling.scale().threshold(bound));
            let block = tables.block(node.kind);
            self.kin = Some(kin);
            self.batch =
                Batch { node, start: 0, end: 1, inside: false, all_accepted: false, bound };
            // Tiles that wait below this one on the stack tell a piece's depth: all of its own
            // descendants are stacked above them.
            let depth = self.waiting;
            let mut share = self.share.as_mut().filter(|share| !share.is_in_piece(depth + 1));
            if !subtree_reaches {
                if share.is_none_or(|share| share.take(1, depth)) {
                    return Ok(true);
                }
                continue;
            }
            if let Some(part) = &mut share {
                part.leave_piece();
                let work = work_below(&node, limit);
                if part.is_piece(work) {
                    if !part.take(work, depth) {
                        continue;
                    }
                    share = None;
                }
            }
            let levels = levels_below(&node, limit);
            if level <= node.level + 2 && levels <= usize::from(tables.depth()) {
                self.batch.inside = self.clip.holds(&wide) && self.clip.holds(&own);
                self.batch.end = count_below(&node, block, levels, limit);
                let work = self.batch.end as u64;
                if share.is_none_or(|share| share.take(work, depth)) {
                    return Ok(true);
                }
                continue;
            }
            let (tiles, before) = tile_counts(node.level);
            for digit in (0..tables.child_kinds(node.kind).len()).rev() {
                if let Some(child) = kin.child(tables, digit, tiles, before) {
                    self.push(child);
                }
            }
        }
        Ok(false)
    }

    /// Fills `chunk` with the points among the entries from `start` on, where they are moved to, as
    /// many as fit. Returns the next entry.
    pub(crate) fn select<I: Importance, P: Position>(
        &self,
        sampling: &Sampling<'_, I>,
        relaxation: &RelaxationTable<'_>,
        to_caller: &ToCaller<P::Scalar>,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        let placement = sampling.placement();
        let domain = placement.domain();
        // Where a border point that moves in finds its importance.
        let (low, high) = (domain.min(), DVec2::from(domain.max().to_array().map(f64::next_down)));
        let Some(kin) = &self.kin else { return Ok(self.batch.end) };
        let next = self.fill_chunk(kin, placement, start, chunk);
        let mut kept = 0;
        for k in 0..chunk.len {
            let (x, y, entry) = (chunk.x[k], chunk.y[k], start + k);
            let centre = domain.min() + DVec2::new(x.to_f64(), y.to_f64());
            let at = centre.clamp(low, high);
            let value = sampling.importance().value(at);
            if !(value >= 0.0 && value <= self.batch.bound) {
                return Err(SamplingError::InvalidValue { at, value, bound: self.batch.bound });
            }
            let rank = self.batch.rank(self.batch.block(placement), entry);
            if !sampling.scale().accepts(rank, value) {
                continue;
            }
            let [dx, dy] = self.step::<P::Scalar, I>(kin, sampling, relaxation, entry, at, value);
            let (moved_x, moved_y) = (x + dx, y + dy);
            let moved = domain.min() + DVec2::new(moved_x.to_f64(), moved_y.to_f64());
            let needed = sampling.scale().importance_of(rank);
            let settled = sampling.importance().settle(centre, moved, needed);
            let [moved_x, moved_y] = if settled == moved {
                [moved_x, moved_y]
            } else {
                (settled - domain.min()).to_array().map(P::Scalar::from_f64)
            };
            chunk.set(kept, [moved_x, moved_y], entry);
            kept += 1;
        }
        chunk.len = kept;
        if !self.batch.inside {
            chunk.mark_inside::<P>(sampling, &self.clip, to_caller);
        }
        Ok(next)
    }

    /// The fixed centres of the entries from `start` on, as many as fit. Returns the next entry.
    fn fill_chunk<S: Scalar>(
        &self,
        kin: &Kin,
        placement: &Placement<'_>,
        start: usize,
        chunk: &mut Chunk<S>,
    ) -> usize {
        chunk.len = 0;
        let mut next = start;
        if start == 0 {
            [chunk.x[0], chunk.y[0]] = kin.own_centre(placement);
            (chunk.len, next) = (1, 1);
        }
        while chunk.len < CHUNK && next < self.batch.end {
            let (segment, end) = self.batch.segment::<S>(placement, next, CHUNK - chunk.len);
            let filled = chunk.len..chunk.len + (end - next);
            segment.write_columns(&mut chunk.x[filled.clone()], &mut chunk.y[filled.clone()]);
            (chunk.len, next) = (filled.end, end);
        }
        next
    }

    /// How far candidate `i`, accepted at `at` where the importance is `value`, is moved.
    fn step<S: Scalar, I: Importance>(
        &self,
        kin: &Kin,
        sampling: &Sampling<'_, I>,
        relaxation: &RelaxationTable<'_>,
        i: usize,
        at: DVec2,
        value: f64,
    ) -> [S; 2] {
        let placement = sampling.placement();
        let threshold = sampling.scale().threshold(value);
        let (level, tiles_above) = level_of(threshold);
        if level < FIRST_RELAXED_LEVEL {
            return [S::default(); 2];
        }
        let importance = sampling.importance();
        let local = sampling.scale().threshold(importance.local(at));
        let phase = (local / tiles_above).clamp(1.0, DELTA);
        let detail = if relaxation.has_rough() { importance.detail(at) } else { 0.0 };
        let tables = placement.tables();
        let (vector, rotation) = if i == 0 {
            let Relation { class, rotation } = kin.of_own_centre(tables, level);
            (relaxation.vector(class, phase, detail), rotation)
        } else {
            let coefficients = tables.block(self.batch.node.kind).rank_coefficients(i);
            let Relation { class, rotation } = kin.of_entry(coefficients, level);
            (relaxation.vector(class, phase, detail), rotation)
        };
        let [vx, vy] = vector.map(S::from_f64);
        let frame = placement.turned_edge(level, rotation);
        let [c, s, minus_s] = [frame.x, frame.y, -frame.y].map(S::from_f64);
        [c * vx + minus_s * vy, s * vx + c * vy]
    }
}
