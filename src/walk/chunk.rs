//! Chunks: up to a few hundred candidates in arrays, one pass each for positions, ranks, tests and
//! packing.

use super::scalar::Scalar;
use crate::sampling::RankScale;

/// Candidates a chunk. A block of depth 2 fits, and the arrays stay in the first-level cache.
pub(crate) const CHUNK: usize = 256;

/// Positions relative to the domain's least corner, and ranks.
#[derive(Clone, Debug)]
pub(crate) struct Chunk<S> {
    pub(crate) len: usize,
    pub(crate) x: [S; CHUNK],
    pub(crate) y: [S; CHUNK],
    pub(crate) ranks: [u64; CHUNK],
}

impl<S: Scalar> Chunk<S> {
    pub(crate) fn new() -> Self {
        Self { len: 0, x: [S::default(); CHUNK], y: [S::default(); CHUNK], ranks: [0; CHUNK] }
    }

    /// Keeps the candidates with 0 ≤ x < width and 0 ≤ y < height, in order. Branch-free.
    pub(crate) fn retain_inside(&mut self, width: S, height: S) {
        let zero = S::default();
        let mut kept = 0;
        for i in 0..self.len {
            let (x, y, rank) = (self.x[i], self.y[i], self.ranks[i]);
            (self.x[kept], self.y[kept], self.ranks[kept]) = (x, y, rank);
            kept += usize::from((zero <= x) & (x < width) & (zero <= y) & (y < height));
        }
        self.len = kept;
    }

    /// Keeps candidate i if its rank is accepted where the importance is `values[i]`, in order.
    /// Branch-free.
    pub(crate) fn retain_accepted(&mut self, values: &[f64; CHUNK], scale: RankScale) {
        let mut kept = 0;
        for (i, value) in values.iter().enumerate().take(self.len) {
            let (x, y, rank) = (self.x[i], self.y[i], self.ranks[i]);
            (self.x[kept], self.y[kept], self.ranks[kept]) = (x, y, rank);
            kept += usize::from(scale.accepts(rank, *value));
        }
        self.len = kept;
    }
}
