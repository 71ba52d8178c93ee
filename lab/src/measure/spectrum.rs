//! The power spectrum of a finite window of points.
//!
//! The window's sharp border would leak the mean density into every frequency, so the points are
//! weighted by a smooth taper, w(u, v) = sin²(πu)·sin²(πv) on the unit square (Hann), whose own
//! transform vanishes beyond two cycles a window. With F(k) = Σ w_j·exp(−2πi k·x_j) the power is
//! |F(k)|² / Σ w_j², which has the mean 1 for white noise.

use glam::DVec2;

use super::{MeasureError, Window};

/// Least |k| used, in cycles a window: below it the taper leaks the mean density.
const LEAST_FREQUENCY: f64 = 3.0;

/// Half the principal frequency of 64 points is 4 cycles: the least that leaves any.
const LEAST_POINTS: usize = 64;

/// Mean power at frequencies of at most half the principal one, white noise = 1.
///
/// The principal frequency is √n cycles a window of n points (for a window that is not square, per
/// axis in proportion). Frequencies below 3 cycles a window are left out. Time O(n²), exact: no grid, no
/// aliasing.
///
/// # Errors
/// [`MeasureError::TooFew`] for fewer than 64 points in the window, where no frequency is left;
/// [`MeasureError::TooElongated`] for a window about n times as long as wide;
/// [`MeasureError::OnBorder`].
pub fn low_frequency_power(points: &[DVec2], window: Window) -> Result<f64, MeasureError> {
    let inside = window.scaled(points);
    if inside.len() < LEAST_POINTS {
        return Err(MeasureError::TooFew { found: inside.len(), needed: LEAST_POINTS });
    }
    // In the unit square the axes count cycles a window; a frequency's length is physical.
    let principal = libm::sqrt(inside.len() as f64 / window.area());
    let limit = 0.5 * principal;
    let limits = [limit * window.size.x, limit * window.size.y].map(|k| k as usize);
    // The product of both limits is n/4, so this bounds the frequencies by about n as well.
    if limits.iter().any(|k| *k > inside.len()) {
        return Err(MeasureError::TooElongated { size: window.size });
    }
    let power = tapered_power(&inside, limits).ok_or(MeasureError::OnBorder)?;
    let (mut sum, mut count) = (0.0, 0u32);
    for (k, p) in power {
        let cycles = DVec2::new(f64::from(k[0]), f64::from(k[1]));
        if cycles.length() >= LEAST_FREQUENCY && (cycles / window.size).length() <= limit {
            sum += p;
            count += 1;
        }
    }
    if count == 0 {
        return Err(MeasureError::TooElongated { size: window.size });
    }
    Ok(sum / f64::from(count))
}

/// Power at every integer frequency of the half plane 0 ≤ k₀ ≤ `limit[0]`, |k₁| ≤ `limit[1]`, of
/// points in the unit square. `None` if none of them has a weight.
fn tapered_power(points: &[DVec2], limit: [usize; 2]) -> Option<Vec<([i32; 2], f64)>> {
    let width = 2 * limit[1] + 1;
    let mut sums = vec![[0.0f64; 2]; (limit[0] + 1) * width];
    let mut normalization = 0.0;
    let mut columns = vec![[0.0f64; 2]; width];
    for p in points {
        let taper = |u: f64| {
            let s = libm::sin(core::f64::consts::PI * u);
            s * s
        };
        let weight = taper(p.x) * taper(p.y);
        normalization += weight * weight;
        for (k, column) in (-(limit[1] as i32)..).zip(&mut columns) {
            *column = unit(f64::from(k) * p.y);
        }
        for (k, row) in sums.chunks_exact_mut(width).enumerate() {
            let [c, s] = unit(k as f64 * p.x).map(|z| z * weight);
            for (sum, column) in row.iter_mut().zip(&columns) {
                sum[0] += c * column[0] - s * column[1];
                sum[1] += c * column[1] + s * column[0];
            }
        }
    }
    let power = sums.iter().enumerate().map(|(i, [re, im])| {
        let k = [(i / width) as i32, (i % width) as i32 - limit[1] as i32];
        (k, (re * re + im * im) / normalization)
    });
    (normalization > 0.0).then(|| power.collect())
}

/// exp(−2πi·turns).
fn unit(turns: f64) -> [f64; 2] {
    let (s, c) = libm::sincos(-core::f64::consts::TAU * (turns - libm::floor(turns)));
    [c, s]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_lattice_has_no_low_frequencies_and_white_noise_has_power_one() {
        let lattice: Vec<DVec2> = (0..4096)
            .map(|i| DVec2::new(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5) / 64.0)
            .collect();
        assert!(low_frequency_power(&lattice, Window::UNIT).unwrap() < 1e-4);

        let mut state = 1u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let white: Vec<DVec2> = (0..4096).map(|_| DVec2::new(uniform(), uniform())).collect();
        let power = low_frequency_power(&white, Window::UNIT).unwrap();
        assert!((power - 1.0).abs() < 0.1, "{power}");
        assert_eq!(
            low_frequency_power(&white[..63], Window::UNIT),
            Err(MeasureError::TooFew { found: 63, needed: 64 })
        );
        // A window of another shape and place sees the same points the same way.
        let moved = white
            .iter()
            .map(|p| *p * DVec2::splat(3.0) + DVec2::new(7.0, -2.0))
            .collect::<Vec<_>>();
        let window = Window::new(DVec2::new(7.0, -2.0), DVec2::splat(3.0)).unwrap();
        assert!((low_frequency_power(&moved, window).unwrap() - power).abs() < 1e-3);
    }
}
