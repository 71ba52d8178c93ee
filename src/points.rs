//! Points: the iterator on which the other ways to receive points are built.

use glam::DVec2;

use crate::importance::Importance;
use crate::sampling::{Clip, Sampling, SamplingError, representable};
use crate::walk::chunk::Chunk;
use crate::walk::leaf::Leaf;
use crate::walk::scalar::{Position, Scalar};
use crate::walk::traverse::Traversal;

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
    traversal: Traversal,
    leaf: Option<Leaf>,
    /// The next candidate of the leaf.
    candidate: usize,
    chunk: Chunk<P::Scalar>,
    /// The next point of the chunk.
    next: usize,
    x_range: (P::Scalar, P::Scalar),
    y_range: (P::Scalar, P::Scalar),
    failed: bool,
}

impl<'a, I: Importance, P: Position> Points<'a, I, P> {
    pub(crate) fn new(sampling: Sampling<'a, I>) -> Result<Self, SamplingError> {
        let domain = sampling.placement().domain();
        let (min, max) = (domain.min(), domain.max());
        Ok(Self {
            traversal: Traversal::new(&sampling, Clip::domain(&domain)),
            sampling,
            leaf: None,
            candidate: 0,
            chunk: Chunk::new(),
            next: 0,
            x_range: representable(min.x, max.x).ok_or(SamplingError::Precision)?,
            y_range: representable(min.y, max.y).ok_or(SamplingError::Precision)?,
            failed: false,
        })
    }

    /// Fills the chunk with the next accepted candidates; `false` at the end.
    fn next_chunk(&mut self) -> Result<bool, SamplingError> {
        loop {
            let leaf = match self.leaf {
                Some(leaf) if self.candidate < leaf.candidates => leaf,
                _ => match self.traversal.next_leaf(&self.sampling)? {
                    Some(leaf) => {
                        self.candidate = 0;
                        *self.leaf.insert(leaf)
                    }
                    None => return Ok(false),
                },
            };
            let placement = self.sampling.placement();
            self.candidate = leaf.fill_chunk(placement, self.candidate, &mut self.chunk);
            self.accept(&leaf)?;
            if self.chunk.len > 0 {
                self.next = 0;
                return Ok(true);
            }
        }
    }

    /// Keeps the candidates that lie in the domain and whose importance reaches their rank.
    fn accept(&mut self, leaf: &Leaf) -> Result<(), SamplingError> {
        let domain = self.sampling.placement().domain();
        if !leaf.inside {
            let [width, height] = domain.size().to_array().map(P::Scalar::from_f64);
            let zero = P::Scalar::default();
            self.chunk.retain(|x, y, _| {
                Ok::<_, SamplingError>(zero <= x && x < width && zero <= y && y < height)
            })?;
        }
        if !leaf.all_accepted {
            let sampling = &self.sampling;
            self.chunk.retain(|x, y, rank| {
                let at = domain.min() + DVec2::new(x.to_f64(), y.to_f64());
                let value = sampling.importance().value(at);
                if !(value >= 0.0 && value <= leaf.bound) {
                    return Err(SamplingError::InvalidValue { at, value, bound: leaf.bound });
                }
                Ok(rank < sampling.rank_limit(value))
            })?;
        }
        Ok(())
    }

    /// Point `i` of the chunk in the caller's coordinates.
    fn sample(&self, i: usize) -> Sample<P> {
        let min = self.sampling.placement().domain().min();
        // Rounding may carry a coordinate past the border it is inside of.
        let place = |offset: P::Scalar, min: f64, (low, high): (P::Scalar, P::Scalar)| {
            let sum = P::Scalar::from_f64(min) + offset;
            if sum < low {
                low
            } else if sum > high {
                high
            } else {
                sum
            }
        };
        let x = place(self.chunk.x[i], min.x, self.x_range);
        let y = place(self.chunk.y[i], min.y, self.y_range);
        Sample { position: P::from_xy(x, y), rank: self.chunk.ranks[i] }
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
}

impl<I: Importance, P: Position> core::iter::FusedIterator for Points<'_, I, P> {}
