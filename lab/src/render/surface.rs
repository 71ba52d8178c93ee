//! Surfaces: a diffuse part and a glossy lobe around the mirrored view.

use glam::DVec3;
use std::f64::consts::PI;

/// Reflects `diffuse` in all directions alike and `glossy` in a lobe of cosines to the power of
/// `exponent` (E. Lafortune and Y. Willems, *Using the modified Phong reflectance model for physically
/// based rendering*, 1994).
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) diffuse: DVec3,
    pub(super) glossy: f64,
    pub(super) exponent: f64,
}

impl Surface {
    /// The chance of a sample of the lobe.
    fn share(&self) -> f64 {
        self.glossy / (self.glossy + self.diffuse.element_sum() / 3.0)
    }

    /// f·cos θ from `direction`, seen along the mirrored view `mirror`, and the density of
    /// [`sample`](Self::sample) there.
    pub(super) fn reflect(&self, normal: DVec3, mirror: DVec3, direction: DVec3) -> (DVec3, f64) {
        let cosine = direction.dot(normal);
        let lobe = direction.dot(mirror).max(0.0).powf(self.exponent);
        let share = self.share();
        // The lobe reaches below the horizon, where nothing is reflected but samples fall.
        let density = share * lobe * (self.exponent + 1.0) / (2.0 * PI)
            + (1.0 - share) * cosine.max(0.0) / PI;
        let glossy = self.glossy * lobe * (self.exponent + 2.0) / (2.0 * PI);
        ((self.diffuse / PI + glossy) * cosine.max(0.0), density)
    }

    /// A direction with that density, from two uniform numbers.
    pub(super) fn sample(&self, normal: DVec3, mirror: DVec3, [u, v]: [f64; 2]) -> DVec3 {
        let share = self.share();
        // The first number chooses the part and is stretched to serve again.
        if u < share {
            around(mirror, v, (u / share).powf(1.0 / (self.exponent + 1.0)))
        } else {
            around(normal, v, ((u - share) / (1.0 - share)).sqrt())
        }
    }
}

/// The direction at this cosine from the axis, `turn` of a whole turn around it.
fn around(axis: DVec3, turn: f64, cosine: f64) -> DVec3 {
    let (side, other) = axis.any_orthonormal_pair();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (y, x) = (2.0 * PI * turn).sin_cos();
    sine * (x * side + y * other) + cosine * axis
}
