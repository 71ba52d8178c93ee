//! Exact points in 32 bits: what offsets in the tables mean.

use glam::DVec2;

use crate::tiling::numbers::SQRT_3;

/// ((u + v√3)/2, (p + q√3)/2): an exact point, in edges of some level, relative to the placement's
/// reference tile. 32 bits hold it: a domain is at most 2²⁴ edges of level 16 wide (see
/// [`Placement`](crate::Placement)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct ExactPoint {
    pub(crate) u: i32,
    pub(crate) v: i32,
    pub(crate) p: i32,
    pub(crate) q: i32,
}

/// Cosine and sine of 0°, 90°, 180°, 270°.
pub(crate) const QUARTERS: [(i8, i8); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

impl ExactPoint {
    /// The same point in edges one level finer: times λ = 2 + √3.
    #[inline(always)]
    pub(crate) fn finer(self) -> Self {
        let Self { u, v, p, q } = self;
        Self { u: 2 * u + 3 * v, v: u + 2 * v, p: 2 * p + 3 * q, q: p + 2 * q }
    }

    /// Turned by −90°·`quarters`.
    #[inline(always)]
    pub(crate) fn turned_back(self, quarters: u8) -> Self {
        let Self { u, v, p, q } = self;
        // Products, not four cases: a jump is mispredicted three times out of four.
        let (cos, sin) = QUARTERS[usize::from(quarters % 4)];
        let (cos, sin) = (i32::from(cos), i32::from(sin));
        Self {
            u: cos * u + sin * p,
            v: cos * v + sin * q,
            p: cos * p - sin * u,
            q: cos * q - sin * v,
        }
    }

    /// The sum.
    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        Self { u: self.u + other.u, v: self.v + other.v, p: self.p + other.p, q: self.q + other.q }
    }

    /// An integer multiple.
    pub(crate) fn times(self, n: i32) -> Self {
        Self { u: n * self.u, v: n * self.v, p: n * self.p, q: n * self.q }
    }

    /// The difference.
    pub(crate) fn minus(self, other: Self) -> Self {
        self.plus(Self { u: -other.u, v: -other.v, p: -other.p, q: -other.q })
    }

    /// Rounded coordinates, in edges.
    pub(crate) fn to_dvec2(self) -> DVec2 {
        let [u, v, p, q] = [self.u, self.v, self.p, self.q].map(f64::from);
        0.5 * DVec2::new(u + SQRT_3 * v, p + SQRT_3 * q)
    }
}
