//! Coding-independent code points (ITU-T H.273): primaries and transfer curves by number.

use std::sync::Arc;

use super::color::{Curve, Primaries, SRGB, Space};
use super::srgb;

const C: [f64; 2] = [0.310, 0.316];
const D65: [f64; 2] = [0.3127, 0.3290];

/// The space that these numbers name.
///
/// # Errors
/// What is not known, as the end of a sentence.
pub(super) fn space(primaries: u8, transfer: u8, full_range: bool) -> Result<Space, String> {
    let primaries = chromaticities(primaries)
        .ok_or_else(|| format!("color primaries {primaries} are unknown"))?;
    if transfer == 13 && full_range {
        return Ok(Space::default().with_primaries(&primaries).curved_if_mixed());
    }
    let curve = curve(transfer).ok_or_else(|| format!("transfer curve {transfer} is unknown"))?;
    let curve: Curve = if full_range {
        curve
    } else {
        // Black at 16 and white at 235 of 255.
        Arc::new(move |value| curve(((value * 255.0 - 16.0) / 219.0).clamp(0.0, 1.0)))
    };
    Ok(Space::of_curve(curve).with_primaries(&primaries))
}

impl Space {
    /// Colors that a matrix mixes need their curve said.
    pub(super) fn curved_if_mixed(self) -> Self {
        match self.matrix {
            Some(_) if self.curves.is_none() => {
                Self { matrix: self.matrix, ..Self::of_curve(Arc::new(srgb::decode)) }
            }
            _ => self,
        }
    }
}

fn chromaticities(number: u8) -> Option<Primaries> {
    Some(match number {
        1 | 2 => SRGB,
        4 => [C, [0.67, 0.33], [0.21, 0.71], [0.14, 0.08]],
        5 => [D65, [0.64, 0.33], [0.29, 0.60], [0.15, 0.06]],
        6 | 7 => [D65, [0.630, 0.340], [0.310, 0.595], [0.155, 0.070]],
        8 => [C, [0.681, 0.319], [0.243, 0.692], [0.145, 0.049]],
        9 => [D65, [0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
        10 => [[1.0 / 3.0; 2], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]],
        11 => [[0.314, 0.351], [0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
        12 => [D65, [0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
        22 => [D65, [0.630, 0.340], [0.295, 0.605], [0.155, 0.077]],
        _ => return None,
    })
}

fn curve(number: u8) -> Option<Curve> {
    Some(match number {
        // Of cameras, inverted: BT.709, 601 and 2020.
        1 | 6 | 14 | 15 => Arc::new(|v| {
            if v < 0.081_242_86 {
                v / 4.5
            } else {
                libm::pow((v + 0.099_296_83) / 1.099_296_83, 1.0 / 0.45)
            }
        }),
        2 | 13 => Arc::new(srgb::decode),
        4 => Arc::new(|v| libm::pow(v, 2.2)),
        5 => Arc::new(|v| libm::pow(v, 2.8)),
        7 => Arc::new(|v| {
            if v < 0.0913 { v / 4.0 } else { libm::pow((v + 0.1115) / 1.1115, 1.0 / 0.45) }
        }),
        8 => Arc::new(|v| v),
        16 => Arc::new(perceptual_quantizer),
        17 => Arc::new(|v| 52.37 / 48.0 * libm::pow(v, 2.6)),
        18 => Arc::new(hybrid_log_gamma),
        _ => return None,
    })
}

/// SMPTE ST 2084, with white at the 203 cd/m² that ITU-R BT.2408 gives diffuse white.
fn perceptual_quantizer(value: f64) -> f64 {
    const M1: f64 = 2610.0 / 16384.0;
    const M2: f64 = 2523.0 / 32.0;
    const C1: f64 = 3424.0 / 4096.0;
    const C2: f64 = 2413.0 / 128.0;
    const C3: f64 = 2392.0 / 128.0;
    let root = libm::pow(value, 1.0 / M2);
    libm::pow((root - C1).max(0.0) / (C2 - C3 * root), 1.0 / M1) * (10_000.0 / 203.0)
}

/// ARIB STD-B67, with white at the 75 % that ITU-R BT.2408 gives diffuse white.
fn hybrid_log_gamma(value: f64) -> f64 {
    const A: f64 = 0.178_832_77;
    const B: f64 = 1.0 - 4.0 * A;
    const C: f64 = 0.559_910_73;
    let scene = |v: f64| if v <= 0.5 { v * v / 3.0 } else { (libm::exp((v - C) / A) + B) / 12.0 };
    scene(value) / scene(0.75)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_rise_from_black_and_reach_white() {
        for number in [1, 4, 5, 6, 7, 8, 13, 14, 15, 16, 17, 18] {
            let curve = curve(number).unwrap();
            assert!(curve(0.0).abs() < 1e-6, "{number}");
            assert!((1..=64).all(|i| curve(f64::from(i) / 64.0) > curve(f64::from(i - 1) / 64.0)));
            assert!(curve(1.0) > 0.999, "{number}: {}", curve(1.0));
        }
        // Diffuse white.
        assert!((curve(18).unwrap()(0.75) - 1.0).abs() < 1e-12);
        assert!((curve(16).unwrap()(0.5807) - 1.0).abs() < 0.01);
        assert!(curve(3).is_none() && chromaticities(3).is_none());
        assert!(space(1, 13, true).unwrap().curves.is_none());
        assert!(space(12, 13, true).unwrap().matrix.is_some());
    }
}
