//! Constant ground, relaxed: every point reads the same phase, so that a vector depends on its class
//! alone. The vectors of whole blocks are looked up once a walk, in the order of their entries, and then
//! added to the fixed centers as fast as these are read.

use super::ancestry::ClassFormula;
use super::candidates::Candidates;
use super::count::count_below;
use super::displaced::Displaced;
use crate::importance::Importance;
use crate::placement::{FIRST_RELAXED_LEVEL, FRONTIER_LEVEL, Placement};
use crate::position::Scalar;
use crate::sampling::Sampling;
use crate::tables::DisplacementTable;
use crate::tables::displacement::Reading;
use crate::tiling::counts::RECIPROCALS;
use crate::tiling::numbers::{DELTA, Rotation};
use crate::tiling::{TileCounts, TileType};
use crate::tree::frame::EdgeFrame;
use crate::tree::node::Node;

/// Levels between the tiles whose blocks are emitted and their points.
const LEVELS: u8 = 3;

/// Entries of a block born at most three levels down, at the most.
const ENTRIES: usize = 2716;

/// From this many points on, looking up all vectors beforehand, some 3 ns each and up to 10,669 of them,
/// costs less than looking up each point's.
const WORTHWHILE: f64 = 8192.0;

/// The vectors of constant ground.
pub(crate) struct UniformDisplacements<'a> {
    displacements: &'a DisplacementTable<'a>,
    reading: Reading,
    /// The level of all points.
    level: u8,
    /// Ranks below this are points.
    limit: u64,
    /// By type, coordinate and entry: the vector in the frame of the block's tile, three levels above
    /// the point, in edges of the point's level.
    vectors: [[[f32; ENTRIES]; 2]; 4],
    known: [bool; 4],
}

impl<'a> UniformDisplacements<'a> {
    /// `None` where the importance is not constant, or where this is not worth it.
    pub(crate) fn of(sampling: &Sampling<'a, impl Importance>) -> Option<Self> {
        let placement = sampling.placement();
        let displacements = sampling.displacements()?;
        let region = placement.domain().disc();
        if !sampling.importance().is_constant(&region)
            || placement.tables().depth() < LEVELS
            || sampling.expected_points().is_none_or(|points| points < WORTHWHILE)
        {
            return None;
        }
        let bound = sampling.importance().upper_bound(&region);
        let threshold = sampling.scale().threshold(bound);
        let level = TileCounts::HEXAGON.level_of(threshold);
        let tau = threshold * RECIPROCALS[usize::from(level) - 1];
        let reading = displacements.reading(tau.clamp(1.0, DELTA), 0.0);
        // Classes over more generations are not told by the block alone.
        let in_block = displacements.generations(&reading) <= u32::from(LEVELS);
        let below = level >= FIRST_RELAXED_LEVEL.max(FRONTIER_LEVEL + LEVELS);
        (in_block && below).then_some(Self {
            displacements,
            reading,
            level,
            limit: sampling.scale().limit(bound),
            vectors: [[[0.0; ENTRIES]; 2]; 4],
            known: [false; 4],
        })
    }

    /// The steps of a batch's entries; `None` for a batch of other tiles' centers.
    #[inline(always)]
    pub(crate) fn steps<S: Scalar>(
        &mut self,
        placement: &Placement<'_>,
        batch: &Candidates,
    ) -> Option<Displaced<'_, S>> {
        let node = &batch.node;
        let is_block = node.level + LEVELS == self.level && batch.start > 0;
        if !is_block || batch.end > ENTRIES {
            return None;
        }
        if !self.known[node.kind.index()] {
            self.look_up(placement, node.kind);
        }
        let [x, y] = &self.vectors[node.kind.index()];
        let frame = EdgeFrame::new(placement.turned_edge(self.level, node.rotation));
        Some(Displaced { x: &x[..batch.end], y: &y[..batch.end], frame })
    }

    /// Looks up the vectors of a type's entries that can be points.
    #[cold]
    #[inline(never)]
    fn look_up(&mut self, placement: &Placement<'_>, kind: TileType) {
        let block = placement.tables().block(kind);
        let formula = ClassFormula::of_block(kind.index());
        let turns: [Rotation; 12] = core::array::from_fn(|turn| Rotation::new(turn as u8));
        // The tile of least rank has the most.
        let first = Node { kind, level: self.level - LEVELS, ..Node::root() };
        let end = count_below(&first, block, LEVELS.into(), self.limit);
        let [x, y] = &mut self.vectors[kind.index()];
        let columns = x.iter_mut().zip(y);
        for ((i, (turn, class)), (x, y)) in block.relax_keys().enumerate().take(end).zip(columns) {
            let coefficients = block.rank_coefficients(i);
            let class = |generations: u32| match generations {
                3.. => formula.class(generations as usize, coefficients),
                _ => class.into(),
            };
            let in_grandparent = self.displacements.vector(&self.reading, class);
            [*x, *y] = turns[usize::from(turn) % 12].rotated(in_grandparent);
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
        let most =
            TileType::ALL.map(|kind| tables.block(kind).relax_keys().len()).into_iter().max();
        assert_eq!(most, Some(ENTRIES));
    }
}
