//! Several threads: the same points in the same order as one.

use alloc::vec::Vec;

use rayon::prelude::*;

use crate::importance::Importance;
use crate::points::Filled;
use crate::sampling::{Sampling, SamplingError};
use crate::walk::scalar::Position;

/// Parts a thread: enough that a thread with more work than expected is no hold-up.
const PARTS_PER_THREAD: usize = 4;

/// Buffers of the parts of a sampling, kept from frame to frame: memory for the points, and nothing is
/// allocated once they have grown.
#[derive(Clone, Debug, Default)]
pub struct Shards<P> {
    parts: Vec<Part<P>>,
}

#[derive(Clone, Debug, Default)]
struct Part<P> {
    /// As long as the most points it ever held.
    buffer: Vec<P>,
    len: usize,
}

impl<P: Position + Send + Sync> Shards<P> {
    /// No buffers yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { parts: Vec::new() }
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
        let (grain, total) = sampling.measure(of)?;
        self.parts.resize_with(of, || Part { buffer: Vec::new(), len: 0 });
        let expected = (total / of as u64) as usize;
        self.parts.par_iter_mut().enumerate().try_for_each(|(index, part)| {
            part.fill(&sampling.part(grain, total, index, of), expected)
        })
    }

    /// The points: part by part, in the order of the walk.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = &[P]> + Clone {
        self.parts.iter().map(|part| &part.buffer[..part.len])
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parts.iter().map(|part| part.len).sum()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<P: Position> Part<P> {
    fn fill<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        expected: usize,
    ) -> Result<(), SamplingError> {
        self.len = 0;
        if self.buffer.len() < expected {
            self.buffer.resize(expected, P::default());
        }
        loop {
            let Filled { written, complete } = sampling.fill(&mut self.buffer)?;
            if complete {
                self.len = written;
                return Ok(());
            }
            // Only until the buffer has grown to what this sequence of samplings needs.
            self.buffer.resize(2 * self.buffer.len().max(64), P::default());
        }
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
        let mut copies = Vec::with_capacity(shards.parts.len());
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
