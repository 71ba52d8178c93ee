//! Relaxed points: the same tiles, ranks and acceptance, and then a step aside.
//!
//! Every point is accepted or not at its fixed center, with the importance of the nearest place in the
//! domain, and then moved by the vector of its classes and of the local density phase. What lies in
//! the domain is decided by where it ends up; so the walk's regions are widened by [`margin`].

use core::ops::Range;

use glam::DVec2;

use super::ancestry::{Ancestry, ClassFormula};
use super::candidates::Candidates;
use super::chunk::{CHUNK, Chunk};
use super::context::Context;
use super::seam::Seam;
use crate::domain::Disc;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::{FIRST_RELAXED_LEVEL, Placement};
use crate::position::{Position, Scalar};
use crate::sampling::Sampling;
use crate::tables::DisplacementTable;
use crate::tables::displacement::RUN;
use crate::tiling::MAX_LEVEL;
use crate::tiling::numbers::{DELTA, Rotation};
use crate::tree::frame::EdgeFrame;
use crate::tree::node::Node;

/// How far, in units, points born at `level` or later may be moved: a vector is at most
/// [`longest`](DisplacementTable::longest) edges of the point's level long, which is not above the
/// level of its birth.
#[inline(always)]
pub(crate) fn margin(sampling: &Sampling<'_, impl Importance>, level: u8) -> f64 {
    let level = level.clamp(FIRST_RELAXED_LEVEL, MAX_LEVEL as u8);
    let longest = sampling.displacements().map_or(0.0, DisplacementTable::longest);
    2.0 * sampling.placement().half_edge(level).length() * longest
}

/// Whether points of a tile, of this level and deeper ones, may go anywhere: the importance is nowhere 0 where
/// they can.
#[inline(always)]
pub(crate) fn is_free(sampling: &Sampling<'_, impl Importance>, node: &Node, level: u8) -> bool {
    let (placement, importance) = (sampling.placement(), sampling.importance());
    let center = placement.domain().min() + placement.center(node);
    let radius = placement.reach(node.level, usize::MAX) + margin(sampling, level);
    !importance.constrains_everywhere() && importance.lower_bound(&Disc { center, radius }) > 0.0
}

/// The domain's least corner and its greatest place: where a border point that moves in finds its
/// importance.
fn inner_corners(placement: &Placement<'_>) -> (DVec2, DVec2) {
    let domain = placement.domain();
    (domain.min(), DVec2::from(domain.max().to_array().map(f64::next_down)))
}

/// Whether a point that was to go from `center` to `moved` gets as far as `settled`. Always from centers in the
/// domain; from others, which ask as if they were on its border, the walk has to know how far a point goes.
#[inline(always)]
pub(crate) fn reaches(center: DVec2, moved: DVec2, settled: DVec2) -> bool {
    let squared = |step: DVec2| step.x * step.x + step.y * step.y;
    squared(settled - center) <= squared(moved - center)
}

/// A chunk's points on their way.
pub(super) struct Displacer<'w, 'a, I> {
    pub(super) sampling: &'w Sampling<'a, I>,
    pub(super) displacements: &'w DisplacementTable<'a>,
    pub(super) batch: &'w Candidates,
    pub(super) ancestry: &'w Ancestry,
    /// Where importance is read.
    low: DVec2,
    high: DVec2,
    /// Whether points may be across a seam.
    wraps: bool,
}

impl<S: Scalar> Chunk<S> {
    /// As [`select`](Self::select), for relaxed points: takes the batch's entries from `start` on, as
    /// many as fit, and keeps the points among them, where they are moved to.
    //
    // load → values → (keep the accepted) → (drop what is too far from the clip) → pack with values → move
    // → (keep what has landed inside). What is in brackets is for entries that are not sure or not inside.
    #[inline(always)]
    pub(crate) fn select_relaxed<I: Importance, P: Position<Scalar = S>>(
        &mut self,
        walk: &Context<'_, '_, I, S>,
        displacements: &DisplacementTable<'_>,
        batch: &Candidates,
        ancestry: &Ancestry,
        start: usize,
    ) -> Result<usize, SamplingError> {
        let sampling = walk.sampling;
        // Sure ones too read the importance: their phase depends on it.
        let sure = start < batch.sure;
        let next = self.load(sampling.placement(), batch, start..batch.run_end(start));
        let mover = Displacer::new(sampling, displacements, batch, ancestry);
        let wraps = mover.wraps;
        if batch.inside {
            self.read_values(sampling);
        } else if wraps {
            self.read_values_across(sampling);
        } else {
            let (mut x, mut y) = ([0.0; CHUNK], [0.0; CHUNK]);
            let len = self.len.min(CHUNK);
            for i in 0..len {
                [x[i], y[i]] = mover.nearest(self.x[i], self.y[i]).to_array();
            }
            let (x, y) = (&x[..len], &y[..len]);
            sampling.importance().values(DVec2::ZERO, x, y, &mut self.values[..len]);
        }
        if sure {
            self.keep[..self.len].fill(1);
        } else {
            self.mark_accepted(sampling, batch)?;
        }
        // Across a seam, what is far from the clip may be near.
        if !batch.inside && !wraps {
            self.reject_far(walk);
        }
        match sure && batch.inside {
            true => self.list_entries(),
            false => self.pack_with_values(),
        }
        mover.move_all(self);
        if batch.inside {
            self.keep_all();
        } else {
            self.mark_inside::<I, P>(walk);
        }
        Ok(next)
    }

    /// The importance at each candidate, wrapped.
    #[cold]
    #[inline(never)]
    fn read_values_across<I: Importance>(&mut self, sampling: &Sampling<'_, I>) {
        let seam = Seam::around(sampling.placement().domain());
        let columns = self.x[..self.len].iter().zip(&self.y);
        for (value, (x, y)) in self.values.iter_mut().zip(columns) {
            *value = sampling.importance().value(seam.place(*x, *y));
        }
    }

    /// Unmarks those of the marked candidates that are too far from the clip to be moved into it.
    #[inline(always)]
    fn reject_far<I: Importance>(&mut self, walk: &Context<'_, '_, I, S>) {
        let Context { sampling, clip, .. } = *walk;
        let len = self.len.min(CHUNK);
        let mut least = f64::MAX;
        for (value, keep) in self.values[..len].iter().zip(&self.keep) {
            least = if *keep == 1 && *value < least { *value } else { least };
        }
        // The sparser, the longer are the vectors.
        let counts = sampling.placement().numbering().counts();
        let level = counts.level_of(sampling.scale().threshold(least));
        let margin = margin(sampling, level) * (1.0 + 1e-6);
        let corner = sampling.placement().domain().min();
        let (low, high) = clip.widened(margin);
        let (low, high) = (low - corner, high - corner);
        let columns = self.x[..len].iter().zip(&self.y);
        for (keep, (x, y)) in self.keep[..len].iter_mut().zip(columns) {
            let (x, y) = (x.to_f64(), y.to_f64());
            *keep &= u8::from((low.x <= x) & (x <= high.x) & (low.y <= y) & (y <= high.y));
        }
    }
}

impl<'w, 'a, I: Importance> Displacer<'w, 'a, I> {
    #[inline(always)]
    pub(super) fn new(
        sampling: &'w Sampling<'a, I>,
        displacements: &'w DisplacementTable<'a>,
        batch: &'w Candidates,
        ancestry: &'w Ancestry,
    ) -> Self {
        let (low, high) = inner_corners(sampling.placement());
        let wraps = !batch.inside && sampling.placement().is_seamless();
        Self { sampling, displacements, batch, ancestry, low, high, wraps }
    }

    /// Whether the batch's points, if they are of this level and deeper ones, may go anywhere.
    #[inline(always)]
    pub(super) fn may_go_anywhere(&self, level: u8) -> bool {
        self.sampling.unconstrained()
            || (!self.wraps && is_free(self.sampling, &self.batch.node, level))
    }

    /// The place of the domain nearest to a center.
    #[inline(always)]
    fn nearest<S: Scalar>(&self, x: S, y: S) -> DVec2 {
        let corner = self.sampling.placement().domain().min();
        (corner + DVec2::new(x.to_f64(), y.to_f64())).clamp(self.low, self.high)
    }

    /// The phase that a point reads, and the detail. `at` is the place of the domain nearest to its
    /// center, `value` the importance there, and `per_tile` the tiles a rank of the level above its own.
    #[inline(always)]
    fn phase(&self, at: DVec2, value: f64, per_tile: f64) -> (f64, f64) {
        let importance = self.sampling.importance();
        let (mut local, mut detail) = ([value], [0.0]);
        importance.surroundings(&[at.x], &[at.y], &mut local, &mut detail);
        let phase = (self.sampling.scale().threshold(local[0]) * per_tile).clamp(1.0, DELTA);
        (phase, if self.displacements.has_rough() { detail[0] } else { 0.0 })
    }

    /// Moves all points of a packed chunk, a run at a time.
    #[inline(always)]
    fn move_all<S: Scalar>(&self, chunk: &mut Chunk<S>) {
        let node = &self.batch.node;
        let placement = self.sampling.placement();
        // Written out here and below: `map` of an array is not always inlined.
        let formula = |below: usize| ClassFormula::of_entries(self.ancestry, node, below);
        let formulas = [formula(1), formula(2), formula(3)];
        let frame = |deep: u8| {
            let rotation = formulas[usize::from(deep)].rotation;
            EdgeFrame::<S>::new(placement.turned_edge(node.level + 1 + deep, rotation))
        };
        let frames = [frame(0), frame(1), frame(2)];
        let len = chunk.len.min(CHUNK);
        let free = self.may_go_anywhere(self.batch.node.level);
        for start in (0..len).step_by(RUN) {
            self.move_run(chunk, start..len.min(start + RUN), &formulas, &frames, free);
        }
    }

    /// Moves some of a packed chunk's points, [`RUN`] at the most: first the phases of those that are
    /// one to three levels below the batch's tile, then their vectors, then the steps, a loop each; at
    /// last the others.
    #[inline(always)]
    fn move_run<S: Scalar>(
        &self,
        chunk: &mut Chunk<S>,
        run: Range<usize>,
        formulas: &[ClassFormula; 3],
        frames: &[EdgeFrame<S>; 3],
        free: bool,
    ) {
        let Self { sampling, batch, .. } = *self;
        let (placement, scale) = (sampling.placement(), sampling.scale());
        let level = usize::from(batch.node.level);
        let block = batch.block(placement);
        let numbering = placement.numbering();
        let tiles = |below: usize| {
            numbering.counts().all().get(level + below).map_or(f64::INFINITY, |n| *n as f64)
        };
        let (tiles_1, tiles_2) = (tiles(1), tiles(2));
        let most = if placement.tables().depth() < 3 { tiles_2 } else { tiles(3) };
        let per_tile = |below: usize| numbering.reciprocal(level + below);
        let per_tile = [per_tile(0), per_tile(1), per_tile(2)];
        // Past this, a point is moved at all.
        let least = tiles(usize::from(FIRST_RELAXED_LEVEL - 1).saturating_sub(level));
        let least = if level + 1 < usize::from(FIRST_RELAXED_LEVEL) { least } else { 0.0 };
        let len = run.len().min(RUN);
        let (mut phases, mut details) = ([1.0f64; RUN], [0.0f64; RUN]);
        let (mut deep, mut other) = ([0u8; RUN], [0u8; RUN]);
        let mut local = [0.0; RUN];
        local[..len].copy_from_slice(&chunk.values[run.start..run.start + len]);
        let (local, unread) = (&mut local[..len], &mut details[..len]);
        if self.wraps {
            self.surroundings_across(&chunk.x[run.clone()], &chunk.y[run.clone()], local, unread);
        } else {
            let (mut at_x, mut at_y) = ([0.0; RUN], [0.0; RUN]);
            for k in 0..len {
                let i = run.start + k;
                [at_x[k], at_y[k]] = self.nearest(chunk.x[i], chunk.y[i]).to_array();
            }
            sampling.importance().surroundings(&at_x[..len], &at_y[..len], local, unread);
        }
        if !self.displacements.has_rough() {
            details = [0.0; RUN];
        }
        for k in 0..len {
            let i = run.start + k;
            let value = chunk.values[i];
            let threshold = scale.threshold(value);
            let (past_1, past_2) = (threshold > tiles_1, threshold > tiles_2);
            let one_tile = if past_1 { per_tile[1] } else { per_tile[0] };
            let one_tile = if past_2 { per_tile[2] } else { one_tile };
            phases[k] = (scale.threshold(local[k]) * one_tile).clamp(1.0, DELTA);
            deep[k] = u8::from(past_1) + u8::from(past_2);
            other[k] = u8::from((threshold > most) | (threshold <= least) | (chunk.entry[i] == 0));
        }
        let mut coefficients = [(0u16, 0u16); RUN];
        let mut turns = [0u8; RUN];
        let mut classes = [0u16; RUN];
        for k in 0..len {
            let entry = usize::from(chunk.entry[run.start + k]);
            coefficients[k] = block.rank_coefficients(entry);
            (turns[k], classes[k]) = match deep[k] {
                2.. => block.relax_key(entry),
                deep => (formulas[usize::from(deep)].turn, 0),
            };
        }
        let class = |k: usize, generations: u32| match (deep[k], generations) {
            (2.., 2) => classes[k].into(),
            (deep, _) => {
                formulas[usize::from(deep).min(2)].class(generations as usize, coefficients[k])
            }
        };
        let [vx, vy] = self.displacements.vectors(len, &phases, &details, class);
        let (mut dx, mut dy) = ([S::default(); RUN], [S::default(); RUN]);
        for k in 0..len {
            let vector = Rotation::new(turns[k]).rotated([vx[k], vy[k]]);
            [dx[k], dy[k]] = frames[usize::from(deep[k]).min(2)].displacement(vector);
        }
        if other[..len].iter().fold(0, |any, other| any | other) != 0 {
            for k in (0..len).filter(|k| other[*k] != 0) {
                [dx[k], dy[k]] = self.step(chunk, run.start + k);
            }
        }
        self.move_by(chunk, run, &dx, &dy, free);
    }

    /// Moves points by steps, or to where they may go.
    #[inline(always)]
    pub(super) fn move_by<S: Scalar>(
        &self,
        chunk: &mut Chunk<S>,
        run: Range<usize>,
        dx: &[S; RUN],
        dy: &[S; RUN],
        free: bool,
    ) {
        if free {
            let columns = chunk.x[run.clone()].iter_mut().zip(&mut chunk.y[run]);
            for ((x, y), (dx, dy)) in columns.zip(dx.iter().zip(dy)) {
                (*x, *y) = (*x + *dx, *y + *dy);
            }
        } else if self.wraps {
            self.constrain_across(chunk, run, dx, dy);
        } else {
            self.constrain(chunk, run, dx, dy);
        }
    }

    /// Moves points by steps, or to where the importance lets them go.
    #[inline(always)]
    fn constrain<S: Scalar>(
        &self,
        chunk: &mut Chunk<S>,
        run: Range<usize>,
        dx: &[S; RUN],
        dy: &[S; RUN],
    ) {
        let (importance, scale) = (self.sampling.importance(), self.sampling.scale());
        let placement = self.sampling.placement();
        let corner = placement.domain().min();
        let block = self.batch.block(placement);
        let len = run.len().min(RUN);
        // Where the points come from and are moved to, or the nearest place in the domain: those that are
        // moved out of it end out of it.
        let (mut from_x, mut from_y) = ([0.0; RUN], [0.0; RUN]);
        let (mut at_x, mut at_y, mut needed) = ([0.0; RUN], [0.0; RUN], [0.0; RUN]);
        let mut centers = [[S::default(); 2]; RUN];
        for k in 0..len {
            let i = run.start + k;
            let (x, y) = (chunk.x[i], chunk.y[i]);
            centers[k] = [x, y];
            [from_x[k], from_y[k]] = self.nearest(x, y).to_array();
            (chunk.x[i], chunk.y[i]) = (x + dx[k], y + dy[k]);
            [at_x[k], at_y[k]] = self.nearest(chunk.x[i], chunk.y[i]).to_array();
        }
        for (k, needed) in needed[..len].iter_mut().enumerate() {
            let entry = chunk.entry[run.start + k].into();
            *needed = scale.importance_of(self.batch.rank(placement.numbering(), block, entry));
        }
        let (moved_x, moved_y) = (at_x, at_y);
        let to = [&mut at_x[..len], &mut at_y[..len]];
        importance.constrain([&from_x[..len], &from_y[..len]], &needed[..len], to);
        for k in 0..len {
            let i = run.start + k;
            let (moved, settled) =
                (DVec2::new(moved_x[k], moved_y[k]), DVec2::new(at_x[k], at_y[k]));
            if settled != moved {
                let place = |x: S, y: S| corner + DVec2::new(x.to_f64(), y.to_f64());
                if place(chunk.x[i], chunk.y[i]) == moved {
                    let [x, y] = centers[k];
                    [chunk.x[i], chunk.y[i]] = match reaches(place(x, y), moved, settled) {
                        true => (settled - corner).to_array().map(S::from_f64),
                        false => [x, y],
                    };
                }
            }
        }
    }

    /// The surroundings of positions, wrapped.
    #[cold]
    #[inline(never)]
    fn surroundings_across<S: Scalar>(
        &self,
        x: &[S],
        y: &[S],
        local: &mut [f64],
        detail: &mut [f64],
    ) {
        let seam = Seam::around(self.sampling.placement().domain());
        let (mut at_x, mut at_y) = ([0.0; RUN], [0.0; RUN]);
        let places = at_x.iter_mut().zip(&mut at_y);
        for ((at_x, at_y), (x, y)) in places.zip(x.iter().zip(y)) {
            [*at_x, *at_y] = seam.place(*x, *y).to_array();
        }
        let len = x.len().min(RUN);
        self.sampling.importance().surroundings(&at_x[..len], &at_y[..len], local, detail);
    }

    /// Moves points across a seam by steps, a point at a time.
    #[cold]
    #[inline(never)]
    fn constrain_across<S: Scalar>(
        &self,
        chunk: &mut Chunk<S>,
        run: Range<usize>,
        dx: &[S; RUN],
        dy: &[S; RUN],
    ) {
        let (importance, scale) = (self.sampling.importance(), self.sampling.scale());
        let placement = self.sampling.placement();
        let (corner, block) = (placement.domain().min(), self.batch.block(placement));
        let seam = Seam::around(placement.domain());
        for (i, (dx, dy)) in run.zip(dx.iter().zip(dy)) {
            let (x, y) = (chunk.x[i], chunk.y[i]);
            (chunk.x[i], chunk.y[i]) = (x + *dx, y + *dy);
            let place = |x: S, y: S| corner + DVec2::new(x.to_f64(), y.to_f64());
            let (center, moved) = (place(x, y), place(chunk.x[i], chunk.y[i]));
            let (from, to) = (seam.wrapped(center), seam.wrapped(moved));
            let rank = self.batch.rank(placement.numbering(), block, chunk.entry[i].into());
            let needed = scale.importance_of(rank);
            let ([mut to_x], [mut to_y]) = ([to.x], [to.y]);
            let columns = [&mut to_x, &mut to_y].map(core::slice::from_mut);
            importance.constrain([&[from.x], &[from.y]], &[needed], columns);
            let settled = DVec2::new(to_x, to_y);
            if settled == to {
                continue;
            }
            let stays = seam.is_between(center, moved) || !placement.domain().contains(settled);
            (chunk.x[i], chunk.y[i]) = if stays {
                // No way leads over the seam: the point stays at its center.
                (x, y)
            } else {
                (settled - corner).to_array().map(S::from_f64).into()
            };
        }
    }

    /// The step of any point of the chunk: a frontier tile's own center, and centers of an opened tile's
    /// children with points far below them.
    #[inline(never)]
    fn step<S: Scalar>(&self, chunk: &Chunk<S>, i: usize) -> [S; 2] {
        let Self { sampling, batch, ancestry, .. } = *self;
        let (entry, value) = (usize::from(chunk.entry[i]), chunk.values[i]);
        let (placement, node) = (sampling.placement(), &batch.node);
        let tables = placement.tables();
        let numbering = placement.numbering();
        let level = numbering.counts().level_of(sampling.scale().threshold(value));
        if level < FIRST_RELAXED_LEVEL {
            return [S::default(); 2];
        }
        let at = match self.wraps {
            true => Seam::around(placement.domain()).place(chunk.x[i], chunk.y[i]),
            false => self.nearest(chunk.x[i], chunk.y[i]),
        };
        let (phase, detail) = self.phase(at, value, numbering.reciprocal(usize::from(level) - 1));
        let reading = self.displacements.reading(phase, detail);
        let below = usize::from(level.saturating_sub(node.level));
        let block = batch.block(placement);
        let child = match below {
            // A child is one level below the tile; further down its center is followed.
            2.. => node.child(tables, numbering, entry),
            _ => None,
        };
        let (formula, coefficients) = match child {
            _ if entry == 0 => (ClassFormula::of_center(tables, ancestry, node, below), (0, 0)),
            Some(child) => {
                let ancestry = ancestry.child(node, entry, &child);
                (ClassFormula::of_center(tables, &ancestry, &child, below - 1), (0, 0))
            }
            // A bound that need not hold may have hidden that a point is deeper than any here.
            None => (
                ClassFormula::of_entries(ancestry, node, below.min(2)),
                block.rank_coefficients(entry),
            ),
        };
        let class = |generations: u32| formula.class(generations as usize, coefficients);
        let vector =
            Rotation::new(formula.turn).rotated(self.displacements.vector(&reading, class));
        EdgeFrame::new(placement.turned_edge(level, formula.rotation)).displacement(vector)
    }
}
