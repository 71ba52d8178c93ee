//! Points: the iterator on which the other ways to receive points are built.

use crate::clip::{Clip, ToCaller};
use crate::importance::Importance;
use crate::sampling::{Sampling, SamplingError};
use crate::walk::chunk::Chunk;
use crate::walk::either::{AnyBatch, AnyTraversal};
use crate::walk::scalar::Position;

/// A point of the set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<P> {
    /// Where it is, in the caller's units, inside the half-open domain.
    pub position: P,
    /// Its index in the placement's endless sequence. Unique in a placement, and the same at every
    /// density at which the point is present.
    pub rank: u64,
}

/// How far a buffer was filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Filled {
    /// The number of positions written, from the buffer's start.
    pub written: usize,
    /// Whether these are all points; otherwise the buffer was too small.
    pub complete: bool,
}

/// Iterator over the points of a [`Sampling`], in the order of the walk.
///
/// After the first error it ends.
#[derive(Clone, Debug)]
pub struct Points<'a, I, P: Position> {
    sampling: Sampling<'a, I>,
    clip: Clip,
    traversal: AnyTraversal,
    batch: Option<AnyBatch>,
    /// The next entry of the batch.
    entry: usize,
    chunk: Chunk<P::Scalar>,
    /// The next point of the chunk.
    next: usize,
    to_caller: ToCaller<P::Scalar>,
    failed: bool,
}

impl<'a, I: Importance, P: Position> Points<'a, I, P> {
    pub(crate) fn new(sampling: Sampling<'a, I>, clip: Clip) -> Result<Self, SamplingError> {
        Ok(Self {
            to_caller: ToCaller::new(&sampling.placement().domain())?,
            traversal: AnyTraversal::new(&sampling, clip),
            sampling,
            clip,
            batch: None,
            entry: 0,
            chunk: Chunk::new(),
            next: 0,
            failed: false,
        })
    }

    /// Fills the chunk with the next points; `false` at the end.
    fn next_chunk(&mut self) -> Result<bool, SamplingError> {
        loop {
            let batch = match self.batch {
                Some(batch) if self.entry < batch.entries().end => batch,
                _ => match self.traversal.next_batch(&self.sampling)? {
                    Some(batch) => {
                        self.entry = batch.entries().start;
                        *self.batch.insert(batch)
                    }
                    None => return Ok(false),
                },
            };
            self.entry = batch.select::<I, P>(
                &self.sampling,
                &self.clip,
                &self.to_caller,
                self.entry,
                &mut self.chunk,
            )?;
            self.chunk.pack();
            if self.chunk.len > 0 {
                self.next = 0;
                return Ok(true);
            }
        }
    }

    /// Point `i` of the chunk.
    fn sample(&self, i: usize) -> Option<Sample<P>> {
        let batch = self.batch.as_ref()?.entries();
        let block = batch.block(self.sampling.placement());
        Some(Sample {
            position: self.to_caller.place(self.chunk.x[i], self.chunk.y[i]),
            rank: batch.rank(block, self.chunk.entry[i].into()),
        })
    }
}

impl<I: Importance, P: Position> Iterator for Points<'_, I, P> {
    type Item = Result<Sample<P>, SamplingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next >= self.chunk.len {
            if self.failed {
                return None;
            }
            match self.next_chunk() {
                Ok(true) => {}
                Ok(false) => return None,
                Err(error) => {
                    (self.failed, self.chunk.len) = (true, 0);
                    return Some(Err(error));
                }
            }
        }
        self.next += 1;
        self.sample(self.next - 1).map(Ok)
    }
}

impl<I: Importance, P: Position> core::iter::FusedIterator for Points<'_, I, P> {}
