//! The same importance everywhere.

use core::fmt;

use glam::DVec2;

use super::Importance;
use crate::domain::{Disc, Domain};

/// A constant importance, finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(f64);

/// A constant that is NaN, infinite or negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantError {
    /// The value.
    pub value: f64,
}

impl fmt::Display for ConstantError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is no importance: it must be finite and not negative", self.value)
    }
}

impl core::error::Error for ConstantError {}

impl Constant {
    /// Importance 1 everywhere.
    pub const ONE: Self = Self(1.0);

    /// Importance `value` everywhere.
    ///
    /// # Errors
    /// [`ConstantError`] for NaN, infinities and negative numbers.
    pub fn new(value: f64) -> Result<Self, ConstantError> {
        if value >= 0.0 && value.is_finite() {
            Ok(Self(value))
        } else {
            Err(ConstantError { value })
        }
    }
}

impl Importance for Constant {
    fn value(&self, _at: DVec2) -> f64 {
        self.0
    }

    fn upper_bound(&self, _region: &Disc) -> f64 {
        self.0
    }

    fn integral(&self, domain: &Domain) -> Option<f64> {
        Some(self.0 * domain.area())
    }

    fn lower_bound(&self, _region: &Disc) -> f64 {
        self.0
    }

    fn is_constant(&self, _region: &Disc) -> bool {
        true
    }
}
