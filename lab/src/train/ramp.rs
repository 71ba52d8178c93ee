//! Training grounds: discs of a deep root under a field of varying density.

use glam::DVec2;

use super::field::{Field, threshold_of_phase};

/// A ramp of the phase across the patch, times a wave of the density in another direction:
/// τ(p) = (from + (to − from)·(½ + p·along/(2·radius)))·exp(amplitude·sin(2π·p·across/length)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// The phases at either end.
    pub phases: [f64; 2],
    /// Half the length over which the phase runs, in base edges.
    pub radius: f64,
    /// The unit vector along which it runs.
    pub along: DVec2,
    /// The wave vector: direction, in turns a base edge.
    pub wave: DVec2,
    /// The wave's amplitude in ln τ.
    pub amplitude: f64,
    /// The wave's start, in turns.
    pub start: f64,
}

/// No ramp goes below this phase: far outside a patch a ramp would reach 0.
const LEAST_PHASE: f64 = 0.2;

impl Ramp {
    fn phase(&self, p: DVec2) -> f64 {
        let [from, to] = self.phases;
        let ramp = from + (to - from) * (0.5 + 0.5 * p.dot(self.along) / self.radius);
        let turns = p.dot(self.wave) + self.start;
        let wave = self.amplitude * libm::sin(core::f64::consts::TAU * turns);
        ramp.max(LEAST_PHASE) * libm::exp(wave)
    }
}

impl Field for Ramp {
    fn threshold(&self, p: DVec2) -> f64 {
        threshold_of_phase(self.phase(p))
    }

    fn bound(&self, p: DVec2, radius: f64) -> f64 {
        // The ramp is linear; ln of the wave changes by at most its slope times the radius.
        let [from, to] = self.phases;
        let ramp = |p: DVec2| from + (to - from) * (0.5 + 0.5 * p.dot(self.along) / self.radius);
        let rise = (to - from).abs() * 0.5 * radius / self.radius;
        let slope = core::f64::consts::TAU * self.wave.length() * radius;
        let wave = (self.amplitude
            * libm::sin(core::f64::consts::TAU * (p.dot(self.wave) + self.start))
            + self.amplitude.abs() * slope)
            .min(self.amplitude.abs());
        let phase = (ramp(p) + rise).max(LEAST_PHASE) * libm::exp(wave);
        threshold_of_phase(phase) * (1.0 + 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn bounds_hold() {
        let mut random = Random::new(1, &[]);
        for i in 0..200 {
            let mut vector =
                |scale: f64| DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * scale;
            let (along, wave) = (vector(1.0).normalize(), vector(0.3));
            let (p, offset) = (vector(300.0), vector(1.0));
            let ramp = Ramp {
                phases: [1.0 + random.unit(), 1.0 + 12.0 * random.unit()],
                radius: 100.0,
                along,
                wave,
                amplitude: if i % 2 == 0 { 0.9 } else { 0.15 },
                start: random.unit(),
            };
            let radius = 40.0 * random.unit();
            let q = p + offset * (2.0 * radius * 0.70);
            assert!((q - p).length() <= radius);
            assert!(ramp.threshold(q) <= ramp.bound(p, radius));
        }
    }
}
