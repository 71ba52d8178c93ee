//! A small generator with fixed output on every platform.

/// SplitMix64 (Steele, Lea, Flood 2014), one stream a key.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of `seed` and a path of keys, such as (pass, patch): streams of different paths are
    /// unrelated.
    #[must_use]
    pub fn new(seed: u64, keys: &[u64]) -> Self {
        let mut random = Self(seed);
        for key in keys {
            random.0 = random.bits() ^ key.wrapping_mul(0xd134_2543_de82_ef95);
        }
        random
    }

    /// 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [0, 1)².
    pub fn point(&mut self) -> glam::DVec2 {
        glam::DVec2::new(self.unit(), self.unit())
    }

    /// Uniform in [0, n) for n > 0, with a bias below n/2⁶⁴.
    pub fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(n)) >> 64) as u64
    }
}
