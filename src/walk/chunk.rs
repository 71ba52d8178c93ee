//! Chunks: a few hundred candidates in arrays, one pass each for positions, tests and packing.

use core::ops::Range;

use glam::DVec2;

use super::node::{ExactPoint, Node};
use super::scalar::Scalar;
use crate::placement::Placement;
use crate::tables::Offsets;

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

/// Coordinates of exact points: origin + half edge · (u + v√3, p + q√3), as complex numbers. The two
/// products are added before the origin, so that a quarter turn, which only swaps and negates them,
/// changes no bit of the result: every block in which a point is met gives it the same position.
#[derive(Clone, Copy)]
struct Frame<S> {
    origin: [S; 2],
    x: [S; 2],
    y: [S; 2],
}

impl<S: Scalar> Frame<S> {
    /// For exact points turned back by `quarters`·90°.
    fn new(half_edge: DVec2, origin: DVec2, quarters: u8) -> Self {
        let h = half_edge;
        let (x, y) = match quarters % 4 {
            0 => ([h.x, -h.y], [h.y, h.x]),
            1 => ([-h.y, -h.x], [h.x, -h.y]),
            2 => ([-h.x, h.y], [-h.y, -h.x]),
            _ => ([h.y, h.x], [-h.x, h.y]),
        };
        Self {
            origin: origin.to_array().map(S::from_f64),
            x: x.map(S::from_f64),
            y: y.map(S::from_f64),
        }
    }

    #[inline(always)]
    fn position(&self, at: ExactPoint) -> [S; 2] {
        let x = S::from_i32(at.u) + S::SQRT_3 * S::from_i32(at.v);
        let y = S::from_i32(at.p) + S::SQRT_3 * S::from_i32(at.q);
        [
            self.origin[0] + (self.x[0] * x + self.x[1] * y),
            self.origin[1] + (self.y[0] * x + self.y[1] * y),
        ]
    }
}

impl<S: Scalar> Chunk<S> {
    pub(crate) fn new() -> Self {
        Self { len: 0, x: [S::default(); CHUNK], y: [S::default(); CHUNK], ranks: [0; CHUNK] }
    }

    /// The one candidate that is the node's own centre.
    pub(crate) fn set_single(&mut self, placement: &Placement<'_>, node: &Node) {
        let frame = Frame::new(placement.half_edge(node.born), placement.origin, 0);
        [self.x[0], self.y[0]] = frame.position(node.centre_at_birth);
        self.ranks[0] = node.rank;
        self.len = 1;
    }

    /// The candidates centre + offset for the offsets in `range`, at most [`CHUNK`]; positions only.
    pub(crate) fn set_positions(
        &mut self,
        half_edge: DVec2,
        origin: DVec2,
        quarters: u8,
        centre: ExactPoint,
        offsets: &Offsets<'_>,
        range: Range<usize>,
    ) {
        let frame = Frame::<S>::new(half_edge, origin, quarters);
        self.len = range.len();
        let columns = offsets.u[range.clone()]
            .iter()
            .zip(&offsets.v[range.clone()])
            .zip(&offsets.p[range.clone()])
            .zip(&offsets.q[range]);
        for ((x, y), (((u, v), p), q)) in self.x.iter_mut().zip(&mut self.y).zip(columns) {
            let field = |bytes: &[u8; 2]| i32::from(i16::from_le_bytes(*bytes));
            let at = ExactPoint { u: field(u), v: field(v), p: field(p), q: field(q) };
            [*x, *y] = frame.position(centre.plus(at));
        }
    }

    /// Keeps the candidates for which `keep` holds, in order.
    pub(crate) fn retain<E>(
        &mut self,
        mut keep: impl FnMut(S, S, u64) -> Result<bool, E>,
    ) -> Result<(), E> {
        let mut kept = 0;
        for i in 0..self.len {
            let (x, y, rank) = (self.x[i], self.y[i], self.ranks[i]);
            (self.x[kept], self.y[kept], self.ranks[kept]) = (x, y, rank);
            kept += usize::from(keep(x, y, rank)?);
        }
        self.len = kept;
        Ok(())
    }
}
