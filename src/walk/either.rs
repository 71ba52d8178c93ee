//! Both modes of the walk behind one face: fixed centres and relaxed points.

use super::batch::Batch;
use super::chunk::Chunk;
use super::kin::Kin;
use super::scalar::Position;
use super::traverse::Traversal;
use crate::clip::ToCaller;
use crate::importance::Importance;
use crate::sampling::{Sampling, SamplingError};

/// A traversal in the sampling's mode.
#[expect(clippy::large_enum_variant, reason = "one value a walk, and nothing may be allocated")]
#[derive(Clone, Debug)]
pub(crate) enum AnyTraversal {
    Fixed(Traversal<()>),
    Relaxed(Traversal<Kin>),
}

impl AnyTraversal {
    #[inline(always)]
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>) -> Self {
        match sampling.relaxation() {
            None => Self::Fixed(Traversal::new(sampling)),
            Some(_) => Self::Relaxed(Traversal::new(sampling)),
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
    pub(crate) fn batch(&self) -> &Batch {
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
        to_caller: &ToCaller<P::Scalar>,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        match self {
            Self::Fixed(traversal) => traversal.select::<I, P>(sampling, to_caller, start, chunk),
            Self::Relaxed(traversal) => traversal.select::<I, P>(sampling, to_caller, start, chunk),
        }
    }
}
