//! Points one after the other, with their ranks.

use crate::error::SamplingError;
use crate::importance::Importance;
use crate::position::Position;
use crate::sampling::{Sampling, ToWorld};
use crate::walk::Walk;
use crate::walk::chunk::Chunk;
use crate::walk::shard::Shard;

/// A point of the set. [`Sampling::weighted`] adds what estimates need: density and weight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sample<P> {
    /// Where it is, in the caller's units, inside the half-open domain.
    ///
    /// Relative to the domain's least corner, each coordinate is within 3 units in the last place of
    /// the domain's diagonal (3ε · 2^⌊log₂ diagonal⌋, ε = 2⁻²³ for `Vec2` and 2⁻⁵² for `DVec2`) of exact
    /// arithmetic, at every level; the largest error met in the tests is 2.5. A corner other than the
    /// origin adds the rounding of that sum.
    pub position: P,
    /// Its index in the placement's endless sequence. Unique in a placement, and the same at every
    /// density at which the point is present.
    pub rank: u64,
}

/// Iterator over the points of a [`Sampling`], in the order of the walk.
///
/// After the first error it ends.
#[derive(Clone, Debug)]
pub struct Points<'a, I, P: Position> {
    sampling: Sampling<'a, I>,
    walk: Walk,
    /// The next entry of the batch.
    entry: usize,
    chunk: Chunk<P::Scalar>,
    /// The next point of the chunk.
    next: usize,
    to_world: ToWorld<P::Scalar>,
    failed: bool,
}

impl<'a, I: Importance, P: Position> Points<'a, I, P> {
    pub(super) fn new(
        sampling: Sampling<'a, I>,
        shard: Option<Shard>,
    ) -> Result<Self, SamplingError> {
        Ok(Self {
            to_world: ToWorld::new(&sampling.placement().domain())?,
            walk: Walk::new(&sampling, shard),
            sampling,
            entry: 0,
            chunk: Chunk::new(),
            next: 0,
            failed: false,
        })
    }

    /// Fills the chunk with the next points; `false` at the end.
    fn next_chunk(&mut self) -> Result<bool, SamplingError> {
        loop {
            if self.entry >= self.walk.batch().end {
                if !self.walk.advance(&self.sampling)? {
                    return Ok(false);
                }
                self.entry = self.walk.batch().start;
            }
            let Self { sampling, walk, chunk, to_world, .. } = self;
            self.entry = walk.select::<I, P>(sampling, to_world, self.entry, chunk)?;
            self.chunk.pack();
            if self.chunk.len > 0 {
                self.next = 0;
                return Ok(true);
            }
        }
    }

    /// Calls `take` for each point, for as long as it succeeds: the same as the iterator, with less
    /// between one point and the next.
    #[inline]
    pub(crate) fn for_each_sample<E: From<SamplingError>>(
        mut self,
        mut take: impl FnMut(Sample<P>) -> Result<(), E>,
    ) -> Result<(), E> {
        while self.next_chunk()? {
            for i in 0..self.chunk.len {
                take(self.sample(i))?;
            }
        }
        Ok(())
    }

    /// Point `i` of the chunk.
    #[inline(always)]
    fn sample(&self, i: usize) -> Sample<P> {
        let batch = self.walk.batch();
        let placement = self.sampling.placement();
        let block = batch.block(placement);
        Sample {
            position: self.to_world.place(self.chunk.x[i], self.chunk.y[i]),
            rank: batch.rank(placement.numbering(), block, self.chunk.entry(i)),
        }
    }
}

impl<'a, I: Importance> Sampling<'a, I> {
    /// An iterator over the points. It holds its state (some 10 KiB) itself and allocates nothing.
    ///
    /// Each item is a result, since an importance may break its promises at any point of the walk.
    ///
    /// ```
    /// use glam::Vec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(100.0))?;
    /// for sample in sampling.points::<Vec2>()? {
    ///     let sample = sample?;
    ///     assert!(sample.position.x < 1.0 && sample.position.y < 1.0);
    /// }
    /// // Plain arrays for those whose vectors are not glam's; the same numbers.
    /// let arrays = sampling.points::<[f32; 2]>()?;
    /// assert!(arrays.zip(sampling.points::<Vec2>()?).all(|(a, b)| {
    ///     matches!((a, b), (Ok(a), Ok(b)) if a.position == b.position.to_array())
    /// }));
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// # Errors
    /// [`SamplingError::Precision`] if the position type cannot represent any point of the domain.
    pub fn points<P: Position>(&self) -> Result<Points<'a, I, P>, SamplingError> {
        Points::new(*self, None)
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
        Some(Ok(self.sample(self.next - 1)))
    }

    /// Chunk by chunk: less between one point and the next.
    fn fold<B, F: FnMut(B, Self::Item) -> B>(mut self, init: B, mut f: F) -> B {
        let mut folded = init;
        loop {
            for i in self.next..self.chunk.len {
                folded = f(folded, Ok(self.sample(i)));
            }
            if self.failed {
                return folded;
            }
            match self.next_chunk() {
                Ok(true) => {}
                Ok(false) => return folded,
                Err(error) => return f(folded, Err(error)),
            }
        }
    }
}

impl<I: Importance, P: Position> core::iter::FusedIterator for Points<'_, I, P> {}
