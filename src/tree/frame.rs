//! From exact points to coordinates: the only place where positions become floating-point numbers.

use core::ops::Range;

use glam::DVec2;

use crate::position::Scalar;
use crate::tables::{ExactPoint, Offsets, QUARTERS};

/// Coordinates of exact points of one level: origin + half edge · (u + v√3, p + q√3), as complex
/// numbers. The two products are added before the origin, so that a quarter turn, which only swaps and
/// negates them, changes no bit of the result: every block in which a point is met gives it the same
/// position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<S> {
    origin: [S; 2],
    x: [S; 2],
    y: [S; 2],
}

impl<S: Scalar> Frame<S> {
    /// For exact points turned back by `quarters`·90°.
    #[inline(always)]
    pub(crate) fn new(half_edge: DVec2, origin: DVec2, quarters: u8) -> Self {
        let (cos, sin) = QUARTERS[usize::from(quarters % 4)];
        let (cos, sin) = (f64::from(cos), f64::from(sin));
        // One product is 0 and the other ± a component: exact.
        let a = cos * half_edge.x - sin * half_edge.y;
        let b = sin * half_edge.x + cos * half_edge.y;
        let (x, y) = ([a, -b], [b, a]);
        Self {
            origin: origin.to_array().map(S::from_f64),
            x: x.map(S::from_f64),
            y: y.map(S::from_f64),
        }
    }

    /// The coordinates, relative to the domain's least corner.
    #[inline(always)]
    pub(crate) fn position(&self, at: ExactPoint) -> [S; 2] {
        let x = S::from_i32(at.u) + S::SQRT_3 * S::from_i32(at.v);
        let y = S::from_i32(at.p) + S::SQRT_3 * S::from_i32(at.q);
        [
            self.origin[0] + (self.x[0] * x + self.x[1] * y),
            self.origin[1] + (self.y[0] * x + self.y[1] * y),
        ]
    }
}

/// Candidates of one block that are born at the same level: one frame, one center, a run of offsets.
pub(crate) struct Segment<'t, S> {
    pub(crate) frame: Frame<S>,
    pub(crate) center: ExactPoint,
    pub(crate) offsets: Offsets<'t>,
}

impl<'t, S: Scalar> Segment<'t, S> {
    /// The run `range` of a block's offsets.
    #[inline(always)]
    pub(crate) fn new(
        frame: Frame<S>,
        center: ExactPoint,
        offsets: &Offsets<'t>,
        range: Range<usize>,
    ) -> Self {
        let Offsets { u, v, p, q } = *offsets;
        let offsets = Offsets {
            u: &u[range.clone()],
            v: &v[range.clone()],
            p: &p[range.clone()],
            q: &q[range],
        };
        Self { frame, center, offsets }
    }

    /// The positions, relative to the domain's least corner. A plain loop over four arrays of one
    /// length, which compilers turn into vector instructions.
    #[inline(always)]
    pub(crate) fn positions(&self) -> impl Iterator<Item = [S; 2]> {
        let Self { frame, center, offsets: Offsets { u, v, p, q } } = *self;
        let field = |bytes: [u8; 2]| i32::from(i16::from_le_bytes(bytes));
        u.iter().zip(v).zip(p).zip(q).map(move |(((u, v), p), q)| {
            let offset = ExactPoint { u: field(*u), v: field(*v), p: field(*p), q: field(*q) };
            frame.position(center.plus(offset))
        })
    }

    /// Writes the positions, one array a coordinate.
    #[inline(always)]
    pub(crate) fn write_columns(&self, xs: &mut [S], ys: &mut [S]) {
        for ((to_x, to_y), [x, y]) in xs.iter_mut().zip(ys).zip(self.positions()) {
            (*to_x, *to_y) = (x, y);
        }
    }
}

/// The frame in which displacements are given: an edge of the point's level, turned as its
/// great-grandparent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFrame<S>([S; 3]);

impl<S: Scalar> EdgeFrame<S> {
    /// The frame of this edge, in units.
    #[inline(always)]
    pub(crate) fn new(edge: DVec2) -> Self {
        Self([edge.x, edge.y, -edge.y].map(S::from_f64))
    }

    /// A displacement in units, from one in edges.
    #[inline(always)]
    pub(crate) fn displacement(&self, [x, y]: [f32; 2]) -> [S; 2] {
        let [c, s, minus_s] = self.0;
        let [x, y] = [x, y].map(|v| S::from_f64(f64::from(v)));
        [c * x + minus_s * y, s * x + c * y]
    }
}
