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
mod view;

pub use bilinear::BilinearMap;
pub use constant::{Constant, ConstantError};
pub use environment::{EnvironmentError, EnvironmentMap, EnvironmentSample};
pub(crate) use environment::{importance_of, luminance};
pub use function::Function;
pub use image::ImageMap;
pub use pixels::{InvalidPixels, MapError, Pixels};
pub(crate) use planes::Area;
pub use probed::Probed;
pub use stipple::StippleMap;
pub(crate) use stipple::Whole;
pub use view::{PixelData, PixelView};

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

    /// Relaxed points only: what surrounds each point `(x[i], y[i])`, all of one length. `local` holds the
    /// importance at each when it is called, and is left with the importance that the density phase is
    /// read from: averaged at the scale of the points' spacing, the same if it is smooth. `detail`, 0
    /// before, is left with how much the importance varies at that scale, from 0, smooth, to 1.
    #[inline]
    fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
        let _ = (x, y, local, detail);
    }

    /// Relaxed points only: where points end up, columns of one length. Each comes from its tile's center
    /// `centers`, is accepted where the importance is above `needed`, and would be moved to `moved`; both are
    /// places of the domain. `moved` is left with where it goes: never where the importance is 0; by default,
    /// back towards the center until it is not. Importance with hard edges keeps points on their side.
    /// No farther from the center than `moved` was. The result for a point depends on that point alone.
    #[inline]
    fn constrain(&self, centers: [&[f64]; 2], needed: &[f64], moved: [&mut [f64]; 2]) {
        let _ = needed;
        constrain_each(centers, moved, |center, moved, _| {
            retreat(center, moved, |at| self.value(at) > 0.0)
        });
    }

    /// Whether [`constrain`](Self::constrain) has to be asked of every point; if not, it is asked only where
    /// [`lower_bound`](Self::lower_bound) is 0.
    fn constrains_everywhere(&self) -> bool {
        false
    }

    /// Whether [`upper_bound`](Self::upper_bound) is a promise, as it must be unless the importance says
    /// otherwise: then a value above it is an error. Without a promise, points can be missing.
    fn bounds_hold(&self) -> bool {
        true
    }

    /// Whether `value` equals `upper_bound(region)` everywhere in the region, so that points need no
    /// test of their own. Where it does, the [surroundings](Self::surroundings) are the same, without
    /// detail. Worth telling of large regions: relaxed points there come many times as fast.
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

/// Each moved point replaced by what becomes of it: of its center, of itself, of its number.
#[inline(always)]
fn constrain_each(
    [center_x, center_y]: [&[f64]; 2],
    [x, y]: [&mut [f64]; 2],
    settled: impl Fn(DVec2, DVec2, usize) -> DVec2,
) {
    let centers = center_x.iter().zip(center_y);
    for (i, ((x, y), (center_x, center_y))) in x.iter_mut().zip(y).zip(centers).enumerate() {
        [*x, *y] = settled(DVec2::new(*center_x, *center_y), DVec2::new(*x, *y), i).to_array();
    }
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

        #[inline(always)]
        fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
            (**self).surroundings(x, y, local, detail);
        }

        #[inline(always)]
        fn constrain(&self, centers: [&[f64]; 2], needed: &[f64], moved: [&mut [f64]; 2]) {
            (**self).constrain(centers, needed, moved);
        }

        #[inline]
        fn constrains_everywhere(&self) -> bool {
            (**self).constrains_everywhere()
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
