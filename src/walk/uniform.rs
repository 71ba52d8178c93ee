//! Constant ground, relaxed: every point reads the same phase, so that a vector depends on its class
//! alone. The vectors of whole blocks are looked up once, in the order of their entries, and then
//! added to the fixed centers as fast as these are read: for a constant importance, and for one that has many
//! points of the same in a row.

use super::ancestry::ClassFormula;
use super::candidates::Candidates;
use super::count::count_below;
use super::displaced::Displaced;
use super::ground::Ground;
use super::relaxed::is_free;
use crate::importance::Importance;
use crate::placement::FRONTIER_LEVEL;
use crate::position::Scalar;
use crate::sampling::Sampling;
use crate::tables::DisplacementTable;
use crate::tiling::TileType;
use crate::tiling::numbers::Rotation;
use crate::tree::frame::EdgeFrame;
use crate::tree::node::Node;

/// Levels between the tiles whose blocks are emitted and their points.
const LEVELS: u8 = 3;

/// Entries of a block born at most three levels down, at the most.
const ENTRIES: usize = 2716;

/// From this many points on, looking up all vectors beforehand, some 3 ns each and up to 10,669 of them,
/// costs less than looking up each point's.
const WORTHWHILE: f64 = 8192.0;

/// The same where only parts of the ground may be constant: asking for each tile costs a few percent of 10,000 points
/// of noise, and nothing that can be measured of 65,536.
const WORTHWHILE_IN_PARTS: f64 = 65_536.0;

/// By type, coordinate and entry: the vector in the frame of the block's tile, three levels above the
/// point, in edges of the point's level.
pub(crate) type BlockVectors = [[[f32; ENTRIES]; 2]; 4];

/// The vectors of the constant ground that the walk is on.
pub(crate) struct UniformDisplacements<'v, 'a> {
    displacements: &'a DisplacementTable<'a>,
    /// The importance there, and what is read there if blocks tell the vectors.
    value: f64,
    ground: Option<Ground>,
    /// Another one, and how many points in a row were on it.
    next: (f64, usize),
    vectors: &'v mut Option<BlockVectors>,
    known: [bool; 4],
}

impl<'v, 'a> UniformDisplacements<'v, 'a> {
    /// With room for the vectors, which is written to once they are needed. `None` where this is not worth it.
    pub(crate) fn of(
        sampling: &Sampling<'a, impl Importance>,
        vectors: &'v mut Option<BlockVectors>,
    ) -> Option<Self> {
        let placement = sampling.placement();
        let displacements = sampling.displacements()?;
        let region = placement.domain().disc();
        let importance = sampling.importance();
        let constant = importance.is_constant(&region);
        let least = if constant { WORTHWHILE } else { WORTHWHILE_IN_PARTS };
        let worthwhile = sampling.expected_points().is_some_and(|points| points >= least);
        if placement.tables().depth() < LEVELS || !worthwhile {
            return None;
        }
        let (ground, next) = (None, (0.0, 0));
        let mut ground =
            Self { displacements, value: 0.0, ground, next, vectors, known: [false; 4] };
        if constant {
            ground.turn_to(sampling, importance.upper_bound(&region));
        }
        Some(ground)
    }

    #[cold]
    #[inline(never)]
    fn turn_to(&mut self, sampling: &Sampling<'_, impl Importance>, value: f64) {
        let displacements = self.displacements;
        // What blocks tell: classes over no more generations than they have levels.
        let told = |ground: &Ground| {
            ground.level >= FRONTIER_LEVEL + LEVELS
                && displacements.generations(&ground.reading) <= u32::from(LEVELS)
        };
        self.value = value;
        self.ground = Ground::of(sampling, displacements, value).filter(told);
        self.known = [false; 4];
    }

    /// The steps of a batch's entries; `None` for a batch of other tiles' centers, where the ground is not
    /// constant or not known well enough, and where points may not go anywhere.
    #[inline(always)]
    pub(crate) fn steps<S: Scalar>(
        &mut self,
        sampling: &Sampling<'_, impl Importance>,
        batch: &Candidates,
    ) -> Option<Displaced<'_, S>> {
        let node = &batch.node;
        if !batch.constant || batch.start == 0 {
            return None;
        }
        if batch.bound != self.value {
            let passed = if self.next.0 == batch.bound { self.next.1 } else { 0 };
            self.next = (batch.bound, passed + batch.end);
            if (self.next.1 as f64) < WORTHWHILE {
                return None;
            }
            self.turn_to(sampling, batch.bound);
        }
        let level = self.ground?.level;
        if node.level + LEVELS != level || batch.end > ENTRIES {
            return None;
        }
        let placement = sampling.placement();
        if !sampling.unconstrained() && !is_free(sampling, node, level) {
            return None;
        }
        if !self.known[node.kind.index()] {
            self.look_up(sampling, node.kind);
        }
        let [x, y] = &self.vectors.as_ref()?[node.kind.index()];
        let frame = EdgeFrame::new(placement.turned_edge(level, node.rotation));
        Some(Displaced { x: &x[..batch.end], y: &y[..batch.end], frame })
    }

    /// Looks up the vectors of a type's entries that can be points.
    #[cold]
    #[inline(never)]
    fn look_up(&mut self, sampling: &Sampling<'_, impl Importance>, kind: TileType) {
        let Some(Ground { reading, level }) = self.ground else { return };
        let placement = sampling.placement();
        let block = placement.tables().block(kind);
        let formula = ClassFormula::of_block(kind.index());
        let turns: [Rotation; 12] = core::array::from_fn(|turn| Rotation::new(turn as u8));
        // The tile of least rank has the most.
        let first = Node { kind, level: level - LEVELS, ..Node::root() };
        let limit = sampling.scale().limit(self.value);
        let end = count_below(placement.numbering(), &first, block, LEVELS.into(), limit);
        let vectors = self.vectors.get_or_insert_with(|| [[[0.0; ENTRIES]; 2]; 4]);
        let [x, y] = &mut vectors[kind.index()];
        let columns = x.iter_mut().zip(y);
        for ((i, (turn, class)), (x, y)) in block.relax_keys().enumerate().take(end).zip(columns) {
            let coefficients = block.rank_coefficients(i);
            let class = |generations: u32| match generations {
                3.. => formula.class(generations as usize, coefficients),
                _ => class.into(),
            };
            let in_grandparent = self.displacements.vector(&reading, class);
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
