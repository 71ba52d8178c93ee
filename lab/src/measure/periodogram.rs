//! The periodogram: power at every frequency up to twice the principal one, and its radial mean.
//!
//! Points are weighted by the taper of [`spectrum`](super::spectrum), so that the window's border leaves
//! no cross, and spread over the nearest cells of a fine grid (linearly, undone after the transform),
//! whose fast Fourier transform is the sum over the points to a fraction of a percent.

use std::sync::Arc;

use glam::DVec2;
use rustfft::{Fft, FftPlanner, num_complex::Complex};

use super::{MeasureError, Window};

/// The largest grid: 128 MiB of complex numbers.
const MAX_GRID: usize = 4096;

/// Power over frequencies (k₀, k₁), |k| ≤ [`limit`](Self::limit) cycles a window on each axis. White
/// noise has mean power 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodogram {
    limit: usize,
    /// Row by row from k₁ = −limit, each from k₀ = −limit.
    power: Vec<f64>,
    principal: f64,
}

/// A ring of the periodogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// |k| in units of the principal frequency √n, at the middle of a ring one cycle wide.
    pub frequency: f64,
    /// Mean power, white noise = 1.
    pub power: f64,
    /// Variance of the power over its mean squared: 1 for an isotropic set.
    pub anisotropy: f64,
}

impl Periodogram {
    /// Of the points in `window`, whose axes are scaled to the unit square: for a window that is not
    /// square, frequencies count cycles a window on each axis.
    ///
    /// O(n + g² log g), g = the power of two from 16√n on, at most 4096; the limit is 2√n, at most
    /// 512.
    ///
    /// # Errors
    /// [`MeasureError::TooFew`] for fewer than 2 points in the window, [`MeasureError::OnBorder`].
    pub fn new(points: &[DVec2], window: Window) -> Result<Self, MeasureError> {
        let inside = window.scaled(points);
        if inside.len() < 2 {
            return Err(MeasureError::TooFew { found: inside.len(), needed: 2 });
        }
        let principal = libm::sqrt(inside.len() as f64);
        let grid = ((16.0 * principal) as usize).next_power_of_two().clamp(64, MAX_GRID);
        let limit = ((2.0 * principal) as usize).clamp(4, grid / 8);

        let mut cells = vec![Complex::new(0.0f32, 0.0); grid * grid];
        let mut squares = 0.0;
        for p in &inside {
            let weight = taper(p.x) * taper(p.y);
            squares += weight * weight;
            let at = *p * grid as f64;
            let (x, y) = (at.x as usize, at.y as usize);
            let (s, t) = (at.x - x as f64, at.y - y as f64);
            for (j, wy) in [(y, 1.0 - t), (y + 1, t)] {
                for (i, wx) in [(x, 1.0 - s), (x + 1, s)] {
                    cells[(j % grid) * grid + i % grid].re += (weight * wx * wy) as f32;
                }
            }
        }
        if squares == 0.0 {
            return Err(MeasureError::OnBorder);
        }
        transform(&mut cells, grid);
        // What linear spreading does to a frequency, along one axis.
        let spread = |k: i64| {
            let u = core::f64::consts::PI * k as f64 / grid as f64;
            if k == 0 { 1.0 } else { (libm::sin(u) / u) * (libm::sin(u) / u) }
        };
        let wrap = |k: i64| k.rem_euclid(grid as i64) as usize;
        let range = -(limit as i64)..=limit as i64;
        let mut power = Vec::with_capacity((2 * limit + 1) * (2 * limit + 1));
        for k1 in range.clone() {
            for k0 in range.clone() {
                // Two transforms along rows leave the result transposed.
                let value = cells[wrap(k0) * grid + wrap(k1)];
                let attenuation = spread(k0) * spread(k1);
                let norm = f64::from(value.re).powi(2) + f64::from(value.im).powi(2);
                power.push(norm / (attenuation * attenuation * squares));
            }
        }
        Ok(Self { limit, power, principal })
    }

    /// The greatest |k₀| and |k₁|, in cycles a window.
    #[must_use]
    pub fn limit(&self) -> usize {
        self.limit
    }

    /// Power at every frequency, row by row from k₁ = −limit, each row from k₀ = −limit: (2·limit + 1)²
    /// numbers. Those below 3 cycles hold the taper's own shape.
    #[must_use]
    pub fn power(&self) -> &[f64] {
        &self.power
    }

    /// Rings one cycle wide around |k| = 3, 4, …, limit; below lies the taper's shape.
    #[must_use]
    pub fn rings(&self) -> Vec<Ring> {
        let mut sums = vec![[0.0f64; 3]; self.limit + 1];
        let side = 2 * self.limit + 1;
        for (i, power) in self.power.iter().enumerate() {
            let k = DVec2::new((i % side) as f64, (i / side) as f64) - self.limit as f64;
            let ring = libm::round(k.length()) as usize;
            if let Some([count, sum, square]) = sums.get_mut(ring) {
                *count += 1.0;
                *sum += power;
                *square += power * power;
            }
        }
        let rings = sums.iter().enumerate().skip(3);
        rings
            .map(|(radius, [count, sum, square])| {
                let mean = sum / count;
                Ring {
                    frequency: radius as f64 / self.principal,
                    power: mean,
                    anisotropy: (square / count - mean * mean) / (mean * mean),
                }
            })
            .collect()
    }
}

/// Hann's window.
fn taper(u: f64) -> f64 {
    let s = libm::sin(core::f64::consts::PI * u);
    s * s
}

/// The two-dimensional transform, transposed.
fn transform(cells: &mut [Complex<f32>], side: usize) {
    let fft: Arc<dyn Fft<f32>> = FftPlanner::new().plan_fft_forward(side);
    fft.process(cells);
    for y in 0..side {
        for x in y + 1..side {
            cells.swap(y * side + x, x * side + y);
        }
    }
    fft.process(cells);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn random(n: usize) -> Vec<DVec2> {
        let mut random = Random::new(8, &[]);
        (0..n).map(|_| DVec2::new(random.unit(), random.unit())).collect()
    }

    #[test]
    fn power_is_the_sum_over_points() {
        let points = random(300);
        let periodogram = Periodogram::new(&points, Window::UNIT).unwrap();
        let limit = periodogram.limit() as i64;
        assert_eq!(limit, 34);
        for (k0, k1) in [(0, 0), (5, 0), (0, -7), (20, 13), (-34, 34), (-3, -30)] {
            let (mut re, mut im, mut squares) = (0.0, 0.0, 0.0);
            for p in &points {
                let weight = taper(p.x) * taper(p.y);
                let angle = core::f64::consts::TAU * (k0 as f64 * p.x + k1 as f64 * p.y);
                re += weight * angle.cos();
                im -= weight * angle.sin();
                squares += weight * weight;
            }
            let expected = (re * re + im * im) / squares;
            let at = (k1 + limit) * (2 * limit + 1) + k0 + limit;
            let found = periodogram.power()[at as usize];
            assert!((found - expected).abs() < 0.01 * (1.0 + expected), "{found} {expected}");
        }
    }

    #[test]
    fn white_noise_is_flat_and_a_lattice_has_one_ring() {
        let rings = Periodogram::new(&random(20_000), Window::UNIT).unwrap().rings();
        assert!(rings.iter().skip(20).all(|ring| (ring.power - 1.0).abs() < 0.5));
        let mean = rings.iter().map(|ring| ring.power).sum::<f64>() / rings.len() as f64;
        assert!((mean - 1.0).abs() < 0.02, "{mean}");

        let side = 64usize;
        let lattice: Vec<DVec2> = (0..side * side)
            .map(|i| (DVec2::new((i % side) as f64, (i / side) as f64) + 0.5) / side as f64)
            .collect();
        let rings = Periodogram::new(&lattice, Window::UNIT).unwrap().rings();
        let loudest = rings.iter().max_by(|a, b| a.power.total_cmp(&b.power)).unwrap();
        assert_eq!(loudest.frequency, 1.0);
        assert!(rings.iter().all(|ring| ring.frequency > 0.9 || ring.power < 1e-6));
        assert_eq!(
            Periodogram::new(&lattice[..1], Window::UNIT),
            Err(MeasureError::TooFew { found: 1, needed: 2 })
        );
    }
}
