//! The paper's short cut: importance "tested only at a few points within the tile".

use glam::DVec2;

use super::Importance;
use crate::domain::{Disc, Domain};
use crate::position::Scalar;

/// An importance whose upper bounds are not proven but probed: the largest value at seven points of a
/// region, its center and six around it.
///
/// For functions without a known bound. A peak between the probes is missed: the points on it that
/// rank after what the probes promised are lost, without an error. Measured on maps of 1024 × 1024
/// pixels at 65,536 points (`cargo bench --bench image -- probed`), with headroom 1 and 2: smooth
/// 0.05 % and none missed, noise 2.6 % and 0.02 %, hard edges 0.7 % and 0.6 %, a sun of ten pixels 23 %
/// of all points either way. Use a true bound wherever there is one.
#[derive(Clone, Copy, Debug)]
pub struct Probed<I> {
    importance: I,
    domain: Domain,
    headroom: f64,
}

impl<I: Importance> Probed<I> {
    /// Probes `importance` in a domain. Bounds are `headroom` times the largest value found: 1 as in
    /// the paper, more to lose less; not below 1.
    pub fn new(importance: I, domain: Domain, headroom: f64) -> Self {
        Self { importance, domain, headroom: headroom.max(1.0) }
    }
}

/// The center, and a hexagon at two thirds of the radius: (cos, sin) of 15° + k·60°, times 2/3.
const PROBES: [DVec2; 7] = [
    DVec2::new(0.0, 0.0),
    DVec2::new(0.643_950_551, 0.172_546_030),
    DVec2::new(0.172_546_030, 0.643_950_551),
    DVec2::new(-0.471_404_521, 0.471_404_521),
    DVec2::new(-0.643_950_551, -0.172_546_030),
    DVec2::new(-0.172_546_030, -0.643_950_551),
    DVec2::new(0.471_404_521, -0.471_404_521),
];

impl<I: Importance> Importance for Probed<I> {
    fn value(&self, at: DVec2) -> f64 {
        self.importance.value(at)
    }

    fn upper_bound(&self, region: &Disc) -> f64 {
        let (min, max) = (self.domain.min(), self.domain.max());
        let value = |probe: &DVec2| {
            self.importance.value((region.center + region.radius * *probe).max(min).min(max))
        };
        self.headroom * PROBES.iter().map(value).fold(0.0, f64::max)
    }

    #[inline(always)]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64]) {
        self.importance.values(origin, x, y, values);
    }

    fn integral(&self, domain: &Domain) -> Option<f64> {
        self.importance.integral(domain)
    }

    #[inline(always)]
    fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
        self.importance.surroundings(x, y, local, detail);
    }

    #[inline(always)]
    fn constrain(&self, centers: [&[f64]; 2], needed: &[f64], moved: [&mut [f64]; 2]) {
        self.importance.constrain(centers, needed, moved);
    }

    fn constrains_everywhere(&self) -> bool {
        self.importance.constrains_everywhere()
    }

    fn bounds_hold(&self) -> bool {
        false
    }
}
