//! Both modes of the walk behind one face: fixed centres and relaxed points.

use super::batch::Batch;
use super::chunk::Chunk;
use super::relaxed::{RelaxedBatch, RelaxedTraversal};
use super::scalar::Position;
use super::traverse::Traversal;
use crate::clip::{Clip, ToCaller};
use crate::importance::Importance;
use crate::sampling::{Sampling, SamplingError};

/// A traversal in the sampling's mode.
#[expect(clippy::large_enum_variant, reason = "one value a walk, and nothing may be allocated")]
#[derive(Clone, Debug)]
pub(crate) enum AnyTraversal {
    Fixed(Traversal),
    Relaxed(RelaxedTraversal),
}

/// A batch in the sampling's mode.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AnyBatch {
    Fixed(Batch),
    Relaxed(RelaxedBatch),
}

impl AnyTraversal {
    pub(crate) fn new<I: Importance>(sampling: &Sampling<'_, I>, clip: Clip) -> Self {
        match sampling.relaxation() {
            None => Self::Fixed(Traversal::new(sampling, clip)),
            Some(_) => Self::Relaxed(RelaxedTraversal::new(sampling, clip)),
        }
    }

    /// The next batch of candidates, or `None` at the end.
    pub(crate) fn next_batch<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<Option<AnyBatch>, SamplingError> {
        Ok(match (self, sampling.relaxation()) {
            (Self::Relaxed(traversal), Some(relaxation)) => {
                traversal.next_batch(sampling, relaxation)?.map(AnyBatch::Relaxed)
            }
            (Self::Relaxed(_), None) => None,
            (Self::Fixed(traversal), _) => traversal.next_batch(sampling)?.map(AnyBatch::Fixed),
        })
    }
}

impl AnyBatch {
    /// The candidates, fixed or not.
    pub(crate) fn entries(&self) -> &Batch {
        match self {
            Self::Fixed(batch) | Self::Relaxed(RelaxedBatch { batch, .. }) => batch,
        }
    }

    /// Takes the entries from `start` on into `chunk`, as many as fit, and marks the points among
    /// them. Returns the next entry.
    #[inline(always)]
    pub(crate) fn select<I: Importance, P: Position>(
        &self,
        sampling: &Sampling<'_, I>,
        clip: &Clip,
        to_caller: &ToCaller<P::Scalar>,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        match (self, sampling.relaxation()) {
            (Self::Relaxed(batch), Some(relaxation)) => {
                batch.select::<I, P>(sampling, relaxation, clip, to_caller, start, chunk)
            }
            (Self::Fixed(batch) | Self::Relaxed(RelaxedBatch { batch, .. }), _) => {
                chunk.select::<I, P>(sampling, clip, to_caller, batch, start)
            }
        }
    }
}
