//! Points: the iterator on which the other ways to receive points are built.

use glam::DVec2;

use crate::clip::{Clip, ToCaller};
use crate::importance::Importance;
use crate::sampling::{Sampling, SamplingError};
use crate::walk::chunk::{CHUNK, Chunk};
use crate::walk::leaf::Leaf;
use crate::walk::scalar::{Position, Scalar};
use crate::walk::traverse::Traversal;

/// A point of the set. [`Sampling::weighted`] adds what estimates need: density and weight.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    to_caller: ToCaller<P::Scalar>,
    failed: bool,
}

impl<'a, I: Importance, P: Position> Points<'a, I, P> {
    pub(crate) fn new(sampling: Sampling<'a, I>) -> Result<Self, SamplingError> {
        let domain = sampling.placement().domain();
        Ok(Self {
            traversal: Traversal::new(&sampling, Clip::domain(&domain)),
            sampling,
            leaf: None,
            candidate: 0,
            chunk: Chunk::new(),
            next: 0,
            to_caller: ToCaller::new(&domain)?,
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
            accept(&self.sampling, &leaf, &mut self.chunk)?;
            if self.chunk.len > 0 {
                self.next = 0;
                return Ok(true);
            }
        }
    }

    /// Point `i` of the chunk in the caller's coordinates.
    fn sample(&self, i: usize) -> Sample<P> {
        let position = self.to_caller.place(self.chunk.x[i], self.chunk.y[i]);
        Sample { position, rank: self.chunk.ranks[i] }
    }
}

/// Keeps the candidates that lie in the domain and whose importance reaches their rank.
pub(crate) fn accept<I: Importance, S: Scalar>(
    sampling: &Sampling<'_, I>,
    leaf: &Leaf,
    chunk: &mut Chunk<S>,
) -> Result<(), SamplingError> {
    let domain = sampling.placement().domain();
    if !leaf.inside {
        let [width, height] = domain.size().to_array().map(S::from_f64);
        chunk.retain_inside(width, height);
    }
    if leaf.all_accepted {
        return Ok(());
    }
    let len = chunk.len;
    let mut values = [0.0; CHUNK];
    let values_here = &mut values[..len];
    sampling.importance().values(domain.min(), &chunk.x[..len], &chunk.y[..len], values_here);
    // One comparison that is false for NaN, so that no broken promise passes.
    let broken = |value: &f64| !(*value >= 0.0 && *value <= leaf.bound);
    if values_here.iter().any(broken) {
        let i = values_here.iter().position(broken).unwrap_or(0);
        let at = domain.min() + DVec2::new(chunk.x[i].to_f64(), chunk.y[i].to_f64());
        return Err(SamplingError::InvalidValue { at, value: values[i], bound: leaf.bound });
    }
    chunk.retain_accepted(&values, sampling.scale());
    Ok(())
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
