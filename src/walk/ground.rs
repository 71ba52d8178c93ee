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
use crate::placement::FIRST_RELAXED_LEVEL;
use crate::position::{Position, Scalar};
use crate::sampling::Sampling;
use crate::simd::Simd;
use crate::tables::DisplacementTable;
use crate::tables::displacement::{RUN, Reading};
use crate::tiling::numbers::{DELTA, Rotation};
use crate::tree::frame::EdgeFrame;

/// What all points of a batch read.
pub(super) struct Ground {
    /// Theirs, and so many levels below the batch's tile.
    level: u8,
    below: u8,
    reading: Reading,
}

impl Ground {
    /// Of a batch on constant ground; `None` unless its points are one to three levels below its tile.
    #[inline(never)]
    pub(super) fn of(
        sampling: &Sampling<'_, impl Importance>,
        displacements: &DisplacementTable<'_>,
        batch: &Candidates,
    ) -> Option<Self> {
        let placement = sampling.placement();
        let numbering = placement.numbering();
        let threshold = sampling.scale().threshold(batch.bound);
        let level = numbering.counts().level_of(threshold);
        let below = level.checked_sub(batch.node.level).filter(|below| (1..=3).contains(below))?;
        let known = below < 3 || placement.tables().depth() >= 3;
        if level < FIRST_RELAXED_LEVEL || !known || batch.start == 0 {
            return None;
        }
        let phase = threshold * numbering.reciprocal(usize::from(level) - 1);
        Some(Self { level, below, reading: displacements.reading(phase.clamp(1.0, DELTA), 0.0) })
    }
}

impl<S: Scalar> Chunk<S> {
    /// As [`select_relaxed`](Self::select_relaxed), for a batch on constant ground. Returns the next entry.
    #[inline(never)]
    pub(super) fn select_constant<I: Importance, P: Position<Scalar = S>>(
        &mut self,
        walk: &Context<'_, '_, I, S>,
        (ground, displacements): (&Ground, &DisplacementTable<'_>),
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
                    .move_constant(self, ground, sampling);
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
    fn move_constant<S: Scalar>(
        &self,
        chunk: &mut Chunk<S>,
        ground: &Ground,
        sampling: &Sampling<'_, I>,
    ) {
        let node = &self.batch.node;
        let placement = sampling.placement();
        let formula = ClassFormula::of_entries(self.ancestry, node, ground.below.into());
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
            if ground.below == 3 {
                let keys = block.relax_keys_of(first..first + len);
                for ((turn, class), of) in turns.iter_mut().zip(&mut classes).zip(keys) {
                    (*turn, *class) = (of.0, of.1.into());
                }
            }
            let classes = |generations: u32| match (ground.below, generations) {
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
