//! Several threads: the same points in the same order as one.

use alloc::vec::Vec;

use rayon::prelude::*;

use super::{Filled, Part};
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::position::Position;
use crate::sampling::Sampling;

/// Parts a thread: enough that a thread with more work than expected does not hold up the others.
const PARTS_PER_THREAD: usize = 4;

/// Buffers of the parts of a sampling, kept from frame to frame: memory for the points, which grows to what
/// a sequence of samplings needs and is then only written to.
#[derive(Clone, Debug, Default)]
pub struct Shards<P> {
    buffers: Vec<Buffer<P>>,
}

#[derive(Clone, Debug, Default)]
struct Buffer<P> {
    /// As long as the most points it ever held.
    points: Vec<P>,
    len: usize,
}

impl<P: Position + Send + Sync> Shards<P> {
    /// No buffers yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { buffers: Vec::new() }
    }

    /// Makes all points of a sampling with the threads of rayon's current pool.
    ///
    /// # Errors
    /// As [`Sampling::fill`].
    pub fn sample<I: Importance + Sync>(
        &mut self,
        sampling: &Sampling<'_, I>,
    ) -> Result<(), SamplingError> {
        let of = match rayon::current_num_threads() {
            0 | 1 => 1,
            threads => threads * PARTS_PER_THREAD,
        };
        let division = sampling.divide(of)?;
        self.buffers.resize_with(of, || Buffer { points: Vec::new(), len: 0 });
        let expected = division.expected();
        self.buffers
            .par_iter_mut()
            .enumerate()
            .try_for_each(|(index, buffer)| buffer.fill(&division.part(index)?, expected))
    }

    /// The points: part by part, in the order of the walk.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = &[P]> + Clone {
        self.buffers.iter().map(|buffer| &buffer.points[..buffer.len])
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.buffers.iter().map(|buffer| buffer.len).sum()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<P: Position> Buffer<P> {
    fn fill<I: Importance>(
        &mut self,
        part: &Part<'_, I>,
        expected: usize,
    ) -> Result<(), SamplingError> {
        self.len = 0;
        self.grow(expected)?;
        loop {
            let Filled { written, complete } = part.fill(&mut self.points)?;
            if complete {
                self.len = written;
                return Ok(());
            }
            // Only until the buffer has grown to what this sequence of samplings needs.
            self.grow(self.points.len().max(64).saturating_mul(2))?;
        }
    }

    /// Makes room for `len` points at least.
    fn grow(&mut self, len: usize) -> Result<(), SamplingError> {
        let more = len.saturating_sub(self.points.len());
        if more > 0 {
            let bytes = len.saturating_mul(size_of::<P>());
            self.points.try_reserve_exact(more).map_err(|_| SamplingError::Memory { bytes })?;
            self.points.resize(len, P::default());
        }
        Ok(())
    }
}

impl<I: Importance + Sync> Sampling<'_, I> {
    /// [`fill`](Self::fill) with the threads of rayon's current pool: the same points in the same order.
    ///
    /// The points are made in `shards`' memory and then copied; where they need not be in one piece,
    /// [`Shards::sample`] alone is faster.
    ///
    /// # Errors
    /// As [`fill`](Self::fill).
    pub fn fill_parallel<P: Position + Send + Sync>(
        &self,
        buffer: &mut [P],
        shards: &mut Shards<P>,
    ) -> Result<Filled, SamplingError> {
        shards.sample(self)?;
        let mut rest = buffer;
        let mut written = 0;
        let mut copies = Vec::with_capacity(shards.buffers.len());
        for part in shards.parts() {
            let fitting = part.len().min(rest.len());
            let (to, after) = rest.split_at_mut(fitting);
            copies.push((to, &part[..fitting]));
            rest = after;
            written += fitting;
        }
        copies.into_par_iter().for_each(|(to, from)| to.copy_from_slice(from));
        Ok(Filled { written, complete: written == shards.len() })
    }
}
