//! The walk down the hierarchy of tiles: from the few that touch the domain to blocks of points.

pub(crate) mod ancestry;
pub(crate) mod candidates;
pub(crate) mod chunk;
pub(crate) mod context;
mod count;
pub(crate) mod displaced;
mod frontier;
mod ground;
pub(crate) mod mode;
mod open;
mod relaxed;
mod seam;
pub(crate) mod shard;
pub(crate) mod traverse;
pub(crate) mod uniform;

use ancestry::Ancestry;
use candidates::Candidates;
use chunk::Chunk;
use mode::Fixed;
use shard::Shard;
use traverse::Traversal;

use crate::error::SamplingError;
use crate::importance::Importance;
use crate::position::Position;
use crate::sampling::{Sampling, ToWorld};

/// A traversal in the sampling's mode.
#[expect(clippy::large_enum_variant, reason = "one value a walk, and nothing may be allocated")]
#[derive(Clone, Debug)]
pub(crate) enum Walk {
    Fixed(Traversal<Fixed>),
    Relaxed(Traversal<Ancestry>),
}

impl Walk {
    #[inline(always)]
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>, shard: Option<Shard>) -> Self {
        match sampling.displacements() {
            None => Self::Fixed(Traversal::new(sampling, shard)),
            Some(_) => Self::Relaxed(Traversal::new(sampling, shard)),
        }
    }

    /// Moves to the next batch of candidates; `false` at the end.
    #[inline(always)]
    pub(crate) fn advance<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<bool, SamplingError> {
        match self {
            Self::Fixed(traversal) => traversal.advance(sampling),
            Self::Relaxed(traversal) => traversal.advance(sampling),
        }
    }

    /// The work that a walk by parts has passed.
    pub(crate) fn passed(&self) -> u64 {
        match self {
            Self::Fixed(traversal) => traversal.passed(),
            Self::Relaxed(traversal) => traversal.passed(),
        }
    }

    /// How many more tiles the walk may visit.
    pub(crate) fn tiles_left(&self) -> u64 {
        match self {
            Self::Fixed(traversal) => traversal.tiles_left(),
            Self::Relaxed(traversal) => traversal.tiles_left(),
        }
    }

    /// The current batch of candidates.
    #[inline(always)]
    pub(crate) fn batch(&self) -> &Candidates {
        match self {
            Self::Fixed(traversal) => traversal.batch(),
            Self::Relaxed(traversal) => traversal.batch(),
        }
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
        match self {
            Self::Fixed(traversal) => traversal.select::<I, P>(sampling, to_world, start, chunk),
            Self::Relaxed(traversal) => traversal.select::<I, P>(sampling, to_world, start, chunk),
        }
    }
}
