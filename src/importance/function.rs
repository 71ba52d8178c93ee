//! Importance from closures.

use glam::DVec2;

use super::Importance;
use crate::domain::{Disc, Domain};

/// An importance given by two closures: its value at a point, and an upper bound over a region.
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
