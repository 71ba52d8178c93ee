//! Importance: how many points are wanted where.
//!
//! The number of points in a small area is the importance there times the area times a magnification,
//! which a [`Sampling`](crate::Sampling) derives from the wanted [`Amount`](crate::Amount). Units of
//! importance are the caller's; only ratios matter when a count is asked for.

mod bilinear;
mod constant;
mod function;
mod map;
mod pyramid;
pub(crate) mod sums;

pub use bilinear::BilinearMap;
pub use constant::{Constant, ConstantError};
pub use function::Function;
pub use map::{ImageMap, InvalidPixels, MapError};

use glam::DVec2;

use crate::domain::{Domain, Region};
use crate::walk::scalar::Scalar;

/// A density of points to follow, known at each point and bounded over each disc.
///
/// Implementations must be pure: the same arguments, the same results. The walk relies on
/// `0 ≤ value(p) ≤ upper_bound(r)` for every p in r; it reports a value that is NaN, negative or above
/// the bound it was given as an error instead of losing points silently.
pub trait Importance {
    /// The importance at a point of the domain, in the caller's units: finite, not negative.
    fn value(&self, at: DVec2) -> f64;

    /// A number that [`value`](Self::value) does not exceed anywhere in the part of `region` that lies
    /// in the domain. The closer, the less work; it may not be below.
    fn upper_bound(&self, region: &Region) -> f64;

    /// [`value`](Self::value) at each point `origin + (x[i], y[i])`, all of one length. Worth overriding
    /// where many at once are cheaper; the numbers must be the same.
    #[inline]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64])
    where
        Self: Sized,
    {
        for ((value, x), y) in values.iter_mut().zip(x).zip(y) {
            *value = self.value(origin + DVec2::new(x.to_f64(), y.to_f64()));
        }
    }

    /// The integral over the domain, in importance × squared units, if it is known.
    fn integral(&self, domain: &Domain) -> Option<f64> {
        let _ = domain;
        None
    }

    /// Whether `value` equals `upper_bound(region)` everywhere in the region, so that points need no
    /// test of their own.
    fn is_constant(&self, region: &Region) -> bool {
        let _ = region;
        false
    }
}

impl<I: Importance + ?Sized> Importance for &I {
    fn value(&self, at: DVec2) -> f64 {
        (**self).value(at)
    }

    fn upper_bound(&self, region: &Region) -> f64 {
        (**self).upper_bound(region)
    }

    fn integral(&self, domain: &Domain) -> Option<f64> {
        (**self).integral(domain)
    }

    fn is_constant(&self, region: &Region) -> bool {
        (**self).is_constant(region)
    }
}
