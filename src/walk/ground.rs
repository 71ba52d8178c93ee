//! Constant ground, relaxed: every point reads the same phase, so that a vector depends on its class
//! alone. The vectors of whole blocks are looked up once a walk, in the order of their entries, and then
//! added to the fixed centres as fast as these are read.

use super::batch::{Batch, RECIPROCALS, count_below};
use super::kin::{Kin, Lineage};
use super::node::Node;
use super::relaxed::{DELTA, FIRST_RELAXED_LEVEL, StepFrame, Turn, level_of};
use super::scalar::Scalar;
use crate::importance::Importance;
use crate::placement::{FRONTIER_LEVEL, Placement};
use crate::relaxed::{Reading, RelaxationTable};
use crate::sampling::Sampling;
use crate::tiling::TileType;

/// Levels between the tiles whose blocks are emitted and their points.
const LEVELS: u8 = 3;

/// Entries of a block born at most three levels down, at the most.
const ENTRIES: usize = 2716;

/// The same at most two levels down.
const SMALLER: usize = 195;

/// From this many points on, looking up all vectors beforehand, some 3 ns each and up to 10,669 of them,
/// costs less than looking up each point's.
const WORTHWHILE: f64 = 8192.0;

/// The greatest A of a block's entries, and one.
const RANKS: usize = 2745;

/// The vectors of constant ground.
pub(crate) struct Ground<'a> {
    relaxation: &'a RelaxationTable<'a>,
    reading: Reading,
    /// The level of all points.
    level: u8,
    /// Ranks below this are points.
    limit: u64,
    /// By type and entry: the vector in the frame of the block's tile, three levels above the point,
    /// in edges of the point's level.
    vectors: [[[f32; 2]; ENTRIES]; 4],
    /// By type and A: the entry.
    entries: [[u16; RANKS]; 4],
    known: [bool; 4],
    /// The vectors of the entries of a block two levels above the points.
    smaller: [[f32; 2]; SMALLER],
}

impl<'a> Ground<'a> {
    /// `None` where the importance is not constant, or where this is not worth it.
    pub(crate) fn of(sampling: &Sampling<'a, impl Importance>) -> Option<Self> {
        let placement = sampling.placement();
        let relaxation = sampling.relaxation()?;
        let region = placement.domain().region();
        if !sampling.importance().is_constant(&region)
            || placement.tables().depth() < LEVELS
            || sampling.expected_points().is_none_or(|points| points < WORTHWHILE)
        {
            return None;
        }
        let bound = sampling.importance().upper_bound(&region);
        let threshold = sampling.scale().threshold(bound);
        let level = level_of(threshold);
        let tau = threshold * RECIPROCALS[usize::from(level) - 1];
        let reading = relaxation.reading(tau.clamp(1.0, DELTA), 0.0);
        // Classes over more generations are not told by the block alone.
        let in_block = relaxation.generations(&reading) <= LEVELS.into();
        let below = level >= FIRST_RELAXED_LEVEL.max(FRONTIER_LEVEL + LEVELS);
        (in_block && below).then_some(Self {
            relaxation,
            reading,
            level,
            limit: sampling.scale().limit(bound),
            vectors: [[[0.0; 2]; ENTRIES]; 4],
            entries: [[0; RANKS]; 4],
            known: [false; 4],
            smaller: [[0.0; 2]; SMALLER],
        })
    }

    /// The vectors of a batch's entries from its first to its last, and the frame in which they are
    /// given; `None` for a batch of other tiles' centres.
    #[inline(always)]
    pub(crate) fn steps<S: Scalar>(
        &mut self,
        placement: &Placement<'_>,
        batch: &Batch,
        kin: &Kin,
    ) -> Option<(&[[f32; 2]], StepFrame<S>)> {
        let node = &batch.node;
        if batch.start == 0 {
            return None;
        }
        match self.level.checked_sub(node.level)? {
            LEVELS => {
                self.look_up(placement, node.kind);
                let vectors = self.vectors[node.kind.index()].get(batch.start..batch.end)?;
                Some((vectors, StepFrame::new(placement, self.level, node.rotation)))
            }
            2 => {
                // The same tiles' ranks in the parent's block: A = d + 14·A′ − B′ by the recurrence.
                let (parent, digit) = kin.parent()?;
                self.look_up(placement, parent);
                let block = batch.block(placement);
                let (entries, vectors) =
                    (&self.entries[parent.index()], &self.vectors[parent.index()]);
                let ranks = block.rank_coefficients_of(batch.start..batch.end);
                let smaller = self.smaller.get_mut(..batch.end - batch.start)?;
                for (vector, (a, b)) in smaller.iter_mut().zip(ranks) {
                    let rank = usize::from(digit) + 14 * usize::from(a) - usize::from(b);
                    *vector = vectors[usize::from(entries[rank.min(RANKS - 1)]).min(ENTRIES - 1)];
                }
                Some((smaller, StepFrame::new(placement, self.level, kin.parent_rotation())))
            }
            _ => None,
        }
    }

    /// Looks up the vectors of a type's entries that can be points, unless they are known.
    #[inline(always)]
    fn look_up(&mut self, placement: &Placement<'_>, kind: TileType) {
        if !self.known[kind.index()] {
            self.look_up_now(placement, kind);
        }
    }

    #[cold]
    #[inline(never)]
    fn look_up_now(&mut self, placement: &Placement<'_>, kind: TileType) {
        let block = placement.tables().block(kind);
        let lineage = Lineage::of_block(kind.index());
        let turns: [Turn; 12] = core::array::from_fn(|turn| Turn::new(turn as u8));
        // The tile of least rank has the most.
        let first = Node { kind, level: self.level - LEVELS, ..Node::root() };
        let end = count_below(&first, block, LEVELS.into(), self.limit);
        let known = &mut self.vectors[kind.index()];
        for ((i, (turn, class)), vector) in block.thirds().enumerate().take(end).zip(known) {
            let (a, b) = block.rank_coefficients(i);
            let class = |generations: u32| match generations {
                3.. => lineage.class(generations as usize, (a, b)),
                _ => class.into(),
            };
            let in_grandparent = self.relaxation.vector(&self.reading, class);
            *vector = turns[usize::from(turn) % 12].turned(in_grandparent);
            if let Some(entry) = self.entries[kind.index()].get_mut(usize::from(a)) {
                *entry = i as u16;
            }
        }
        self.known[kind.index()] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::Tables;

    #[test]
    fn the_tables_are_as_large_as_the_blocks() {
        let tables = Tables::built_in();
        let mut most = [0; 3];
        for kind in TileType::ALL {
            let block = tables.block(kind);
            let thirds = block.thirds().len();
            most[0] = most[0].max(thirds);
            most[1] = most[1].max(usize::from(block.rank_coefficients(thirds - 1).0) + 1);
            most[2] = most[2].max(block.born_before(3));
        }
        assert_eq!(most, [ENTRIES, RANKS, SMALLER]);
    }
}
