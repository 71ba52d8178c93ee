//! The sRGB transfer curve (IEC 61966-2-1), the same bits on every platform.

/// Linear light of an encoded value, both in 0..=1.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Encoded value of a linear light, both in 0..=1.
pub fn encode(light: f64) -> f64 {
    if light <= 0.0031308 { light * 12.92 } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 }
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
}
