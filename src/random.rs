//! Seeded numbers: the same on every platform, using no transcendental functions.

/// SplitMix64 (Steele, Lea, Flood 2014). Part of the promise that a seed's points never change, which
/// is why it is here and not a dependency.
pub(crate) struct SplitMix64(u64);

impl SplitMix64 {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A point of the open unit disc with density ∝ (1 − r²)^`power`, by rejection.
    pub(crate) fn in_disc(&mut self, power: u32) -> [f64; 2] {
        loop {
            let (x, y, accept) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0, self.unit());
            let depth = 1.0 - (x * x + y * y);
            if depth > 0.0 && accept < (0..power).fold(1.0, |product, _| product * depth) {
                return [x, y];
            }
        }
    }

    /// (cos, sin) of a uniform angle: a point of the disc, normalized.
    pub(crate) fn direction(&mut self) -> [f64; 2] {
        loop {
            let [x, y] = self.in_disc(0);
            let length = libm::sqrt(x * x + y * y);
            if length > 0.01 {
                return [x / length, y / length];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_published_sequence() {
        // The first outputs for seed 1234567, as listed with the reference implementation.
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!(random.next_u64(), 6_457_827_717_110_365_317);
        assert_eq!(random.next_u64(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn directions_are_unit_vectors_and_discs_are_round() {
        let mut random = SplitMix64::new(7);
        let (mut mean, mut squared_radius) = ([0.0; 2], 0.0);
        for _ in 0..20_000 {
            let [x, y] = random.direction();
            assert!((x * x + y * y - 1.0).abs() < 1e-15);
            mean = [mean[0] + x, mean[1] + y];
            let [x, y] = random.in_disc(2);
            squared_radius += x * x + y * y;
        }
        assert!(mean.iter().all(|m| m.abs() < 400.0), "{mean:?}");
        // ∫ r²(1 − r²)²·r / ∫ (1 − r²)²·r = 1/4.
        assert!((squared_radius / 20_000.0 - 0.25).abs() < 0.01);
    }
}
