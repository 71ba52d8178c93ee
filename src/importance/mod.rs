//! Importance: how many points are wanted where.
//!
//! The number of points in a small area is the importance there times the area times a magnification,
//! which a [`Sampling`](crate::Sampling) derives from the wanted [`Amount`](crate::Amount). Units of
//! importance are the caller's; only ratios matter when a count is asked for.

mod bilinear;
mod constant;
mod environment;
pub(crate) mod frame;
mod function;
mod image;
mod pixels;
mod planes;
pub(crate) mod policy;
mod probed;
mod raster;
mod stipple;

pub use bilinear::BilinearMap;
pub use constant::{Constant, ConstantError};
pub use environment::{EnvironmentError, EnvironmentMap, EnvironmentSample};
pub(crate) use environment::{importance_of, luminance};
pub use function::Function;
pub use image::ImageMap;
pub use pixels::{InvalidPixels, MapError, PixelData, PixelView};
pub use probed::Probed;
pub use stipple::StippleMap;

use glam::DVec2;

use crate::domain::{Disc, Domain};
use crate::position::Scalar;

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
    fn upper_bound(&self, region: &Disc) -> f64;

    /// A number that [`value`](Self::value) is not below anywhere in the part of `region` that lies in the
    /// domain; as much of a promise as the upper bound, but not checked. Candidates that it admits need
    /// no look at the importance. 0, not negative, where nothing better is known.
    fn lower_bound(&self, region: &Disc) -> f64 {
        let _ = region;
        0.0
    }

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

    /// [`upper_bound`](Self::upper_bound) of each disc of one radius around the points
    /// `origin + (x[i], y[i])`, all of one length. Worth overriding where many at once are cheaper.
    #[inline]
    fn upper_bounds(&self, origin: DVec2, x: &[f64], y: &[f64], radius: f64, bounds: &mut [f64]) {
        for ((bound, x), y) in bounds.iter_mut().zip(x).zip(y) {
            *bound = self.upper_bound(&Disc { center: origin + DVec2::new(*x, *y), radius });
        }
    }

    /// The integral over the domain, in importance × squared units, if it is known.
    fn integral(&self, domain: &Domain) -> Option<f64> {
        let _ = domain;
        None
    }

    /// Relaxed points only: the importance that the density phase is read from: averaged at the scale
    /// of the points' spacing around a place where it is `value`. The same if it is smooth.
    #[inline]
    fn local(&self, at: DVec2, value: f64) -> f64 {
        let _ = at;
        value
    }

    /// Relaxed points only: how much the importance varies at the scale of the spacing, from 0, smooth,
    /// to 1.
    fn detail(&self, at: DVec2) -> f64 {
        let _ = at;
        0.0
    }

    /// [`local`](Self::local) and [`detail`](Self::detail) at each point `(x[i], y[i])`, all of one length;
    /// `local` holds the importance at each when it is called. Worth overriding where many at once are
    /// cheaper; the numbers must be the same.
    #[inline]
    fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
        for (((x, y), local), detail) in x.iter().zip(y).zip(local).zip(detail) {
            let at = DVec2::new(*x, *y);
            (*local, *detail) = (self.local(at, *local), self.detail(at));
        }
    }

    /// Relaxed points only: where a point ends up. Its tile's center is `center`, its rank is accepted
    /// where the importance is above `needed`, and relaxation would move it to `moved`; both are places
    /// of the domain. Never where the
    /// importance is 0: by default, back towards the center until it is not. Importance with hard edges
    /// keeps points on their side. Not farther from `moved` than
    /// [`longest_constraint`](Self::longest_constraint), unless between `moved` and `center`.
    fn constrain(&self, center: DVec2, moved: DVec2, needed: f64) -> DVec2 {
        let _ = needed;
        retreat(center, moved, |at| self.value(at) > 0.0)
    }

    /// Which moved points may stay: 1 for each place `(x[i], y[i])` at which
    /// [`constrain`](Self::constrain) is sure to leave a point of importance `needed[i]`, and 0 for each
    /// about which it has to be asked. Worth overriding where many at once
    /// are cheaper.
    #[inline]
    fn unconstrained(&self, x: &[f64], y: &[f64], needed: &[f64], unconstrained: &mut [u8]) {
        let _ = needed;
        for ((x, y), unconstrained) in x.iter().zip(y).zip(unconstrained) {
            *unconstrained = u8::from(self.value(DVec2::new(*x, *y)) > 0.0);
        }
    }

    /// The farthest that [`constrain`](Self::constrain) takes a point away from where relaxation moved it, in
    /// units, other than towards its center. 0: it is asked only where
    /// [`lower_bound`](Self::lower_bound) is 0.
    fn longest_constraint(&self) -> f64 {
        0.0
    }

    /// Whether [`upper_bound`](Self::upper_bound) is a promise, as it must be unless the importance says
    /// otherwise: then a value above it is an error. Without a promise, points can be missing.
    fn bounds_hold(&self) -> bool {
        true
    }

    /// Whether `value` equals `upper_bound(region)` everywhere in the region, so that points need no
    /// test of their own. Where it does, [`local`](Self::local) equals it too, there is no
    /// [`detail`](Self::detail), and nothing [constrains](Self::constrain).
    fn is_constant(&self, region: &Disc) -> bool {
        let _ = region;
        false
    }
}

/// Parts of the way from its center that a point goes that may not go all of it.
const WAYS: [f64; 3] = [0.75, 0.5, 0.25];

/// The farthest of some places on the way from `center` to `moved` where a point may lie; the center if
/// there is no other.
fn retreat(center: DVec2, moved: DVec2, may_lie: impl Fn(DVec2) -> bool) -> DVec2 {
    if may_lie(moved) {
        return moved;
    }
    let places = WAYS.iter().map(|way| center + (moved - center) * *way);
    places.into_iter().find(|at| may_lie(*at)).unwrap_or(center)
}

/// What a reference does: everything that it refers to.
macro_rules! forward {
    () => {
        fn value(&self, at: DVec2) -> f64 {
            (**self).value(at)
        }

        fn upper_bound(&self, region: &Disc) -> f64 {
            (**self).upper_bound(region)
        }

        fn lower_bound(&self, region: &Disc) -> f64 {
            (**self).lower_bound(region)
        }

        #[inline(always)]
        fn upper_bounds(
            &self,
            origin: DVec2,
            x: &[f64],
            y: &[f64],
            radius: f64,
            bounds: &mut [f64],
        ) {
            (**self).upper_bounds(origin, x, y, radius, bounds);
        }

        fn integral(&self, domain: &Domain) -> Option<f64> {
            (**self).integral(domain)
        }

        #[inline]
        fn local(&self, at: DVec2, value: f64) -> f64 {
            (**self).local(at, value)
        }

        #[inline]
        fn detail(&self, at: DVec2) -> f64 {
            (**self).detail(at)
        }

        #[inline(always)]
        fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
            (**self).surroundings(x, y, local, detail);
        }

        #[inline]
        fn constrain(&self, center: DVec2, moved: DVec2, needed: f64) -> DVec2 {
            (**self).constrain(center, moved, needed)
        }

        #[inline(always)]
        fn unconstrained(&self, x: &[f64], y: &[f64], needed: &[f64], unconstrained: &mut [u8]) {
            (**self).unconstrained(x, y, needed, unconstrained);
        }

        #[inline]
        fn longest_constraint(&self) -> f64 {
            (**self).longest_constraint()
        }

        fn bounds_hold(&self) -> bool {
            (**self).bounds_hold()
        }

        fn is_constant(&self, region: &Disc) -> bool {
            (**self).is_constant(region)
        }
    };
}

impl<I: Importance> Importance for &I {
    forward!();

    // Always, here and above: what is not inlined into the walk is not compiled for its vectors.
    #[inline(always)]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64]) {
        (**self).values(origin, x, y, values);
    }
}

// Looks up one value at a time: a method for many, generic in their precision, is not in a vtable.
impl Importance for &dyn Importance {
    forward!();
}
