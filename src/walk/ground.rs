//! Constant ground, tile by tile: all points of a batch read the same phase, nothing is left to test, and what is
//! looked up are two bytes of a class.
//!
//! Apart from what other points go through, and called: inlined, it would cost these some 5 %.

use core::ops::Range;

use super::ancestry::{Ancestry, ClassFormula};
use super::candidates::Candidates;
use super::chunk::{CHUNK, Chunk};
use super::context::Context;
use super::relaxed::Displacer;
use crate::importance::Importance;
use crate::placement::{FIRST_RELAXED_LEVEL, Placement};
use crate::position::{Position, Scalar};
use crate::sampling::Sampling;
use crate::simd::Simd;
use crate::tables::DisplacementTable;
use crate::tables::displacement::{RUN, Reading};
use crate::tiling::numbers::{DELTA, Rotation};
use crate::tree::frame::EdgeFrame;

/// What all points read where the importance is the same.
#[derive(Clone, Copy)]
pub(super) struct Ground {
    /// That of all points.
    pub(super) level: u8,
    pub(super) reading: Reading,
}

impl Ground {
    /// Where the importance is `value`; `None` where that is so low that points are not moved.
    #[inline(never)]
    pub(super) fn of(
        sampling: &Sampling<'_, impl Importance>,
        displacements: &DisplacementTable<'_>,
        value: f64,
    ) -> Option<Self> {
        let numbering = sampling.placement().numbering();
        let threshold = sampling.scale().threshold(value);
        let level = numbering.counts().level_of(threshold);
        if level < FIRST_RELAXED_LEVEL {
            return None;
        }
        let phase = threshold * numbering.reciprocal(usize::from(level) - 1);
        Some(Self { level, reading: displacements.reading(phase.clamp(1.0, DELTA), 0.0) })
    }

    /// How many levels the points of a batch are below its tile, one to three; `None` if they are not, or if the
    /// tables do not reach so deep.
    pub(super) fn below(&self, placement: &Placement<'_>, batch: &Candidates) -> Option<u8> {
        let below = self.level.checked_sub(batch.node.level)?;
        let known = below < 3 || placement.tables().depth() >= 3;
        ((1..=3).contains(&below) && known && batch.start > 0).then_some(below)
    }
}

impl<S: Scalar> Chunk<S> {
    /// As [`select_relaxed`](Self::select_relaxed), for a batch on constant ground. Returns the next entry.
    #[inline(never)]
    pub(super) fn select_constant<I: Importance, P: Position<Scalar = S>>(
        &mut self,
        walk: &Context<'_, '_, I, S>,
        displacements: &DisplacementTable<'_>,
        (ground, below): (&Ground, u8),
        batch: &Candidates,
        ancestry: &Ancestry,
        start: usize,
    ) -> usize {
        let sampling = walk.sampling;
        Simd::detect().run(
            #[inline(always)]
            || {
                let next = self.load(sampling.placement(), batch, start..batch.end);
                self.list_entries();
                Displacer::new(sampling, displacements, batch, ancestry)
                    .move_constant(self, ground, below);
                if batch.inside {
                    self.keep_all();
                } else {
                    self.mark_inside::<I, P>(walk);
                }
                next
            },
        )
    }
}

impl<I: Importance> Displacer<'_, '_, I> {
    /// Moves all points of a chunk of entries in a row.
    #[inline(always)]
    fn move_constant<S: Scalar>(&self, chunk: &mut Chunk<S>, ground: &Ground, below: u8) {
        let node = &self.batch.node;
        let placement = self.sampling.placement();
        let formula = ClassFormula::of_entries(self.ancestry, node, below.into());
        let frame = EdgeFrame::new(placement.turned_edge(ground.level, formula.rotation));
        let free = self.may_go_anywhere(ground.level);
        let block = self.batch.block(placement);
        let len = chunk.len.min(CHUNK);
        for start in (0..len).step_by(RUN) {
            let run: Range<usize> = start..len.min(start + RUN);
            let len = run.len().min(RUN);
            let first = chunk.entry(start);
            let (mut a, mut b, mut classes) = ([0u16; RUN], [0u16; RUN], [0u32; RUN]);
            let mut turns = [formula.turn; RUN];
            let columns = a.iter_mut().zip(&mut b);
            for ((a, b), of) in columns.zip(block.rank_coefficients_of(first..first + len)) {
                (*a, *b) = of;
            }
            if below == 3 {
                let keys = block.relax_keys_of(first..first + len);
                for ((turn, class), of) in turns.iter_mut().zip(&mut classes).zip(keys) {
                    (*turn, *class) = (of.0, of.1.into());
                }
            }
            let classes = |generations: u32| match (below, generations) {
                (3, 2) => classes,
                _ => {
                    let mut classes = [0; RUN];
                    for (class, of) in classes.iter_mut().zip(a.iter().zip(&b)) {
                        *class = formula.class(generations as usize, (*of.0, *of.1));
                    }
                    classes
                }
            };
            let [vx, vy] = self.displacements.vectors_at(len, &ground.reading, classes);
            let (mut dx, mut dy) = ([S::default(); RUN], [S::default(); RUN]);
            for k in 0..len {
                let vector = Rotation::new(turns[k]).rotated([vx[k], vy[k]]);
                [dx[k], dy[k]] = frame.displacement(vector);
            }
            self.move_by(chunk, run, &dx, &dy, free);
        }
    }
}
