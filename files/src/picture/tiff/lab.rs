//! CIE L*a*b* with a white of D50, as TIFF files hold it.

use super::super::color::{self, Matrix};

/// How numbers hold colors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lab {
    /// Whether a* and b* are signed; if not, zero is half of full scale.
    signed: bool,
    /// From XYZ to linear sRGB.
    matrix: Matrix,
}

impl Lab {
    pub(super) fn new(signed: bool) -> Self {
        // Never missing: the primaries of sRGB make a space.
        Self { signed, matrix: color::of_d50().unwrap_or([[0.0, 1.0, 0.0]; 3]) }
    }

    /// Linear sRGB light, at least 0, of a pixel of samples of so many bits.
    pub(super) fn light(self, [lightness, a, b]: [usize; 3], bits: u32) -> [f32; 3] {
        const D50: [f64; 3] = [0.9642, 1.0, 0.8249];
        let half = 1i64 << (bits - 1);
        let unit = (1i64 << (bits - 8)) as f64;
        let difference = |value: usize| {
            let value = value as i64;
            let value = match self.signed {
                true if value >= half => value - 2 * half,
                true => value,
                false => value - half,
            };
            value as f64 / unit
        };
        let (a, b) = (difference(a), difference(b));
        let lightness = lightness as f64 / (2 * half - 1) as f64 * 100.0;
        let middle = (lightness + 16.0) / 116.0;
        let luminance = color::of_root(middle);
        if (a, b) == (0.0, 0.0) {
            // White is exactly white.
            return [luminance as f32; 3];
        }
        let xyz = [
            D50[0] * color::of_root(middle + a / 500.0),
            luminance,
            D50[2] * color::of_root(middle - b / 200.0),
        ];
        color::apply(&self.matrix, xyz).map(|value| value.max(0.0) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grays_are_gray_and_red_is_red_in_both_encodings() {
        for (signed, zero) in [(true, 0usize), (false, 128)] {
            let lab = Lab::new(signed);
            assert_eq!(lab.light([255, zero, zero], 8), [1.0; 3]);
            assert_eq!(lab.light([65535, zero << 8, zero << 8], 16), [1.0; 3]);
            assert_eq!(lab.light([0, zero, zero], 8), [0.0; 3]);
            // L* = 50 is .184 of the light.
            let gray = lab.light([32768, zero << 8, zero << 8], 16)[0];
            assert!((gray - 0.1842).abs() < 1e-3, "{gray}");
            // sRGB's red in D50: 54.3, 80.8, 69.9.
            let red = lab.light([138, (zero + 81) & 255, (zero + 70) & 255], 8);
            assert!((red[0] - 1.0).abs() < 0.03 && red[1] < 0.01 && red[2] < 0.01, "{red:?}");
            let green = lab.light([224, (zero + 256 - 79) & 255, (zero + 81) & 255], 8);
            assert!(green[0] < 0.02 && (green[1] - 1.0).abs() < 0.03, "{green:?}");
        }
    }
}
