//! Importance from closures.

use glam::DVec2;

use super::Importance;
use crate::domain::{Disc, Domain};

/// An importance given by two closures: its value at a point, and an upper bound over a region.
///
/// ```
/// use glam::{DVec2, Vec2};
/// use twelvefold::{Amount, Disc, Domain, Function, Placement, Sampling};
/// // A lens that sees best in the middle of a 4 × 3 screen: 1/(1 + r²).
/// let middle = DVec2::new(2.0, 1.5);
/// let acuity = Function::new(
///     |p: DVec2| 1.0 / (1.0 + p.distance_squared(middle)),
///     |r: &Disc| 1.0 / (1.0 + (r.center.distance(middle) - r.radius).max(0.0).powi(2)),
/// );
/// let placement = Placement::new(Domain::new(DVec2::ZERO, DVec2::new(4.0, 3.0))?, 3);
/// // 50 a unit of area where the acuity is 1.
/// let sampling = Sampling::new(&placement, &acuity, Amount::Density(50.0))?;
/// let mut rays = [Vec2::ZERO; 512];
/// let filled = sampling.fill(&mut rays)?;
/// assert!(filled.complete && filled.written > 100);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Function<V, B> {
    value: V,
    bound: B,
    integral: Option<f64>,
}

impl<V: Fn(DVec2) -> f64, B: Fn(&Disc) -> f64> Function<V, B> {
    /// `value(p)` is the importance at p, in the caller's units; `bound(r)` must not be exceeded by it
    /// anywhere in r. A bound that ignores its region (`|_| 1.0`) is allowed and slow where the
    /// function is far below it.
    pub const fn new(value: V, bound: B) -> Self {
        Self { value, bound, integral: None }
    }

    /// Tells the integral over the domain that will be sampled, which a count of points needs.
    #[must_use]
    pub fn with_integral(self, integral: f64) -> Self {
        Self { integral: Some(integral), ..self }
    }
}

impl<V: Fn(DVec2) -> f64, B: Fn(&Disc) -> f64> Importance for Function<V, B> {
    fn value(&self, at: DVec2) -> f64 {
        (self.value)(at)
    }

    fn upper_bound(&self, region: &Disc) -> f64 {
        (self.bound)(region)
    }

    fn integral(&self, _domain: &Domain) -> Option<f64> {
        self.integral
    }
}
