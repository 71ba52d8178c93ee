//! The sRGB transfer curve (IEC 61966-2-1), the same bits on every platform.

/// Linear light of an encoded value, both in 0..=1.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Encoded value of a linear light, both in 0..=1.
pub fn encode(light: f64) -> f64 {
    if light <= 0.0031308 { light * 12.92 } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 }
}

/// [`encode`] by a table: within 1e-6 of it, and sooner.
pub(crate) struct Encoder(Vec<f64>);

impl Encoder {
    /// Steps of the table. Where the curve bends most, just above its straight part, its second
    /// derivative is 2400: an eighth of that by the squared step is 7e-8.
    const STEPS: u32 = 1 << 16;

    pub(crate) fn new() -> Self {
        Self((0..=Self::STEPS).map(|i| encode(f64::from(i) / f64::from(Self::STEPS))).collect())
    }

    /// Encoded value of a light, which is cut to 0..=1.
    pub(crate) fn encode(&self, light: f64) -> f64 {
        let place = light.clamp(0.0, 1.0) * f64::from(Self::STEPS);
        let step = place as usize;
        match (self.0.get(step), self.0.get(step + 1)) {
            (Some(&low), Some(&high)) => low + (high - low) * (place - step as f64),
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_undo_each_other_and_keep_their_ends() {
        for level in 0..=1000 {
            let value = f64::from(level) / 1000.0;
            assert!((encode(decode(value)) - value).abs() < 1e-6, "{value}");
        }
        assert_eq!((decode(0.0), decode(1.0)), (0.0, 1.0));
        assert_eq!(encode(0.0), 0.0);
        assert!((encode(1.0) - 1.0).abs() < 1e-15);
        assert!((decode(0.5) - 0.21404).abs() < 1e-5);
    }

    #[test]
    fn the_table_is_the_curve() {
        let encoder = Encoder::new();
        for i in 0..=5000 {
            let light = libm::pow(f64::from(i) / 5000.0, 3.0);
            assert!((encoder.encode(light) - encode(light)).abs() < 1e-6, "{light}");
        }
        assert_eq!((encoder.encode(0.0), encoder.encode(9.0)), (0.0, 1.0));
    }
}
