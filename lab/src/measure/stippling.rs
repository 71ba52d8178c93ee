//! How well dots draw a photograph: tone at several distances of the viewer, structure, spacing.
//!
//! | measure | what |
//! |---|---|
//! | tone error t₁, t₂, t₄ | RMS of dots − darkness, both blurred by a Gaussian of 1, 2, 4 mean spacings, over the mean |
//! | `ink_error` | the same of ink (the union of all discs), absolute, 1 spacing |
//! | `psnr`, `ssim` | ink blurred by 1 spacing (ssim also by 0.7) against the photograph as it is |
//! | `nearest_mean`, `nearest_low` | nearest distance over the local hexagonal one; mean and 1st percentile |
//! | `touching` | share of dots nearer to another than 0.8 of a dot's diameter |
//! | `on_white` | share of dots on pixels of darkness 0 |
//!
//! The mean spacing is √(area / dots), a dot's area that at which all dots together would cover what is
//! black. SSIM is Wang et al. 2004 with a uniform window of 7 pixels and sample covariance.

use glam::DVec2;

use super::{MeasureError, nearest};

/// Supersampling of the ink: pixels of the rendering a pixel of the photograph, and samples in each.
const RENDERED: usize = 2;
const SAMPLES: usize = 4;

/// Side of the window of structural similarity.
const WINDOW: usize = 7;

/// A gray image of numbers in 0..=1, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Gray {
    width: usize,
    height: usize,
    values: Vec<f64>,
}

/// The figures of one drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stippling {
    /// Dots.
    pub dots: usize,
    /// Relative tone error at 1, 2 and 4 spacings.
    pub tone: [f64; 3],
    /// Absolute error of ink at 1 spacing.
    pub ink_error: f64,
    /// Peak signal-to-noise ratio in dB at 1 spacing.
    pub psnr: f64,
    /// Structural similarity at 1 and at 0.7 spacings.
    pub ssim: [f64; 2],
    /// Mean nearest distance, local hexagonal distance = 1.
    pub nearest_mean: f64,
    /// Its first percentile.
    pub nearest_low: f64,
    /// Share of dots that touch another well.
    pub touching: f64,
    /// Share of dots where the photograph is white.
    pub on_white: f64,
}

impl Gray {
    /// An image of `width` pixels a row, each in 0..=1.
    ///
    /// # Errors
    /// [`MeasureError::NotRows`] unless the values fill whole rows, at least one;
    /// [`MeasureError::Pixel`] for the first outside of 0..=1.
    pub fn new(width: usize, values: Vec<f64>) -> Result<Self, MeasureError> {
        if values.is_empty() || values.len().checked_rem(width) != Some(0) {
            return Err(MeasureError::NotRows { width, pixels: values.len() });
        }
        if let Some(i) = values.iter().position(|value| !(0.0..=1.0).contains(value)) {
            return Err(MeasureError::Pixel { x: i % width, y: i / width });
        }
        Ok(Self { width, height: values.len() / width, values })
    }

    /// Each pixel as `by` × `by` pixels.
    fn enlarged(&self, by: usize) -> Self {
        let (width, height) = (self.width * by, self.height * by);
        let values = (0..width * height)
            .map(|i| self.values[i / width / by * self.width + i % width / by])
            .collect();
        Self { width, height, values }
    }

    /// Root mean square of the difference.
    fn distance(&self, other: &Self) -> f64 {
        let squares = self.values.iter().zip(&other.values).map(|(a, b)| (a - b) * (a - b));
        (squares.sum::<f64>() / self.values.len() as f64).sqrt()
    }

    /// Blurred by a Gaussian of this standard deviation, cut at 4 of them, mirrored at borders.
    fn blurred(&self, deviation: f64) -> Self {
        let reach = (4.0 * deviation + 0.5) as usize;
        let mut kernel: Vec<f64> =
            (0..=reach).map(|i| (-0.5 * (i as f64 / deviation).powi(2)).exp()).collect();
        let sum = kernel[0] + 2.0 * kernel[1..].iter().sum::<f64>();
        kernel.iter_mut().for_each(|weight| *weight /= sum);
        let (width, height) = (self.width, self.height);
        let mut across = Vec::with_capacity(self.values.len());
        let mut padded = Vec::new();
        for row in self.values.chunks_exact(width) {
            padded.clear();
            padded.extend((0..width + 2 * reach).map(|i| row[mirrored(i, reach, width)]));
            for x in 0..width {
                let side = |i: usize| padded[x + reach - i] + padded[x + reach + i];
                let sides: f64 = (1..=reach).map(|i| kernel[i] * side(i)).sum();
                across.push(kernel[0] * padded[x + reach] + sides);
            }
        }
        let mut values = vec![0.0; self.values.len()];
        for (y, row) in values.chunks_exact_mut(width).enumerate() {
            for i in 0..=2 * reach {
                let from = mirrored(y + i, reach, height) * width;
                let weight = kernel[i.abs_diff(reach)];
                for (to, value) in row.iter_mut().zip(&across[from..from + width]) {
                    *to += weight * value;
                }
            }
        }
        Self { width, height, values }
    }
}

/// The place in 0..size that place i − before is, mirrored at the ends, the end pixels twice.
fn mirrored(i: usize, before: usize, size: usize) -> usize {
    let period = 2 * size as i64;
    let place = (i as i64 - before as i64).rem_euclid(period) as usize;
    place.min(2 * size - 1 - place)
}

/// Measures dots (pixels of the photograph, x right, y down) against the darkness, 0 to 1, of a
/// photograph. The tone of a dot outside the photograph counts at its border. O(dots + pixels × spacing).
///
/// # Errors
/// [`MeasureError::TooFew`] for fewer than two dots, [`MeasureError::NotFinite`] for a dot,
/// [`MeasureError::AllZero`] for a white photograph.
pub fn stippling(darkness: &Gray, dots: &[DVec2]) -> Result<Stippling, MeasureError> {
    let black: f64 = darkness.values.iter().sum();
    if dots.len() < 2 {
        return Err(MeasureError::TooFew { found: dots.len(), needed: 2 });
    }
    if black <= 0.0 {
        return Err(MeasureError::AllZero);
    }
    let distances = nearest::distances(dots, dots)?;
    // A dot farther off than this draws as one here: no disc is as large as the photograph.
    let far_off = DVec2::splat((darkness.width + darkness.height) as f64);
    let drawn: Vec<DVec2> = dots.iter().map(|dot| dot.clamp(-far_off, 2.0 * far_off)).collect();
    let dots = drawn.as_slice();
    let count = dots.len() as f64;
    let spacing = ((darkness.width * darkness.height) as f64 / count).sqrt();

    let finer = (2.5 / spacing).ceil().max(1.0) as usize;
    let mut difference = splat(darkness, dots, finer);
    let wanted = darkness.enlarged(finer);
    for (value, wanted) in difference.values.iter_mut().zip(&wanted.values) {
        *value = *value * (finer * finer) as f64 - wanted * (count / black);
    }
    let mean = black / (darkness.width * darkness.height) as f64 * (count / black);
    let zero = Gray { values: vec![0.0; difference.values.len()], ..difference.clone() };
    let tone = [1.0, 2.0, 4.0].map(|spacings| {
        difference.blurred(spacings * spacing * finer as f64).distance(&zero) / mean
    });

    let radius = (black / count / std::f64::consts::PI).sqrt();
    let ink = rendered(darkness, dots, radius);
    let photograph = darkness.enlarged(RENDERED);
    let viewed = |spacings: f64| ink.blurred(spacings * spacing * RENDERED as f64);
    let (far, near) = (viewed(1.0), viewed(0.7));
    let ink_error = far.distance(&photograph.blurred(spacing * RENDERED as f64));

    let smooth = darkness.blurred(spacing);
    let pixel = |dot: DVec2| {
        let index = |c: f64, size: usize| (c.max(0.0) as usize).min(size - 1);
        index(dot.y, darkness.height) * darkness.width + index(dot.x, darkness.width)
    };
    let hexagonal = |dot: DVec2| {
        let density = (smooth.values[pixel(dot)] * count / black).max(1e-12);
        super::hexagonal_distance(density)
    };
    let relative = dots.iter().zip(&distances).map(|(dot, d)| d / hexagonal(*dot)).collect();
    let relative = nearest::Summary::new(relative)?;
    let share = |number: usize| number as f64 / count;
    Ok(Stippling {
        dots: dots.len(),
        tone,
        ink_error,
        psnr: -20.0 * far.distance(&photograph).log10(),
        ssim: [similarity(&far, &photograph), similarity(&near, &photograph)],
        nearest_mean: relative.mean(),
        nearest_low: relative.percentile(0.01),
        touching: share(distances.iter().filter(|d| **d < 1.6 * radius).count()),
        on_white: share(dots.iter().filter(|dot| darkness.values[pixel(**dot)] <= 1e-9).count()),
    })
}

/// Each dot's mass on the four nearest pixels of a grid `finer` times as fine.
fn splat(like: &Gray, dots: &[DVec2], finer: usize) -> Gray {
    let (width, height) = (like.width * finer, like.height * finer);
    let mut values = vec![0.0; width * height];
    for dot in dots {
        let at = *dot * finer as f64 - 0.5;
        let (low, part) = (at.floor(), at - at.floor());
        let place = |c: f64, size: usize| (c.max(0.0) as usize).min(size - 1);
        for (dy, wy) in [(0.0, 1.0 - part.y), (1.0, part.y)] {
            for (dx, wx) in [(0.0, 1.0 - part.x), (1.0, part.x)] {
                values[place(low.y + dy, height) * width + place(low.x + dx, width)] += wx * wy;
            }
        }
    }
    Gray { width, height, values }
}

/// Coverage of the union of discs.
fn rendered(like: &Gray, dots: &[DVec2], radius: f64) -> Gray {
    let fine = RENDERED * SAMPLES;
    let (wide, high) = (like.width * fine, like.height * fine);
    let mut bits = vec![false; wide * high];
    let reach = radius * fine as f64;
    for dot in dots {
        let center = *dot * fine as f64;
        let first = (center.y - reach).floor().max(0.0) as usize;
        let last = ((center.y + reach).ceil().max(0.0) as usize).min(high - 1);
        for y in first..=last {
            let up = y as f64 + 0.5 - center.y;
            let half = (reach * reach - up * up).max(0.0).sqrt();
            let from = (center.x - half - 0.5).ceil().max(0.0) as usize;
            let to = (center.x + half - 0.5).floor();
            if half > 0.0 && to >= 0.0 {
                let to = (to as usize + 1).min(wide);
                bits[y * wide..][from.min(to)..to].fill(true);
            }
        }
    }
    let (width, height) = (like.width * RENDERED, like.height * RENDERED);
    let mut values = vec![0.0; width * height];
    for (i, bit) in bits.iter().enumerate() {
        if *bit {
            values[i / wide / SAMPLES * width + i % wide / SAMPLES] += 1.0;
        }
    }
    values.iter_mut().for_each(|value| *value /= (SAMPLES * SAMPLES) as f64);
    Gray { width, height, values }
}

/// Mean structural similarity of two images of range 1; 1 for images smaller than the window.
fn similarity(a: &Gray, b: &Gray) -> f64 {
    let (width, height) = (a.width, a.height);
    if width < WINDOW || height < WINDOW {
        return 1.0;
    }
    // Sums over windows, by running sums over rows and then columns.
    let windowed = |value: &dyn Fn(usize) -> f64| {
        let mut rows = vec![0.0; width * height];
        for y in 0..height {
            let mut sum = 0.0;
            for x in 0..width {
                sum += value(y * width + x);
                if x >= WINDOW {
                    sum -= value(y * width + x - WINDOW);
                }
                rows[y * width + x] = sum;
            }
        }
        let mut sums = Vec::new();
        let mut column = vec![0.0; width];
        for y in 0..height {
            for x in 0..width {
                column[x] += rows[y * width + x];
                if y >= WINDOW {
                    column[x] -= rows[(y - WINDOW) * width + x];
                }
            }
            if y + 1 >= WINDOW {
                sums.extend_from_slice(&column[WINDOW - 1..]);
            }
        }
        sums
    };
    // Of light, as published figures are: 1 − ink.
    let (u, v) = (|i: usize| 1.0 - a.values[i], |i: usize| 1.0 - b.values[i]);
    let sums = [
        windowed(&u),
        windowed(&v),
        windowed(&|i| u(i) * u(i)),
        windowed(&|i| v(i) * v(i)),
        windowed(&|i| u(i) * v(i)),
    ];
    let area = (WINDOW * WINDOW) as f64;
    let (c1, c2) = (0.01 * 0.01, 0.03 * 0.03);
    let count = sums[0].len();
    let total: f64 = (0..count)
        .map(|i| {
            let [mu, mv, uu, vv, uv] = [0, 1, 2, 3, 4].map(|k| sums[k][i] / area);
            let sample = area / (area - 1.0);
            let (uu, vv, uv) =
                (sample * (uu - mu * mu), sample * (vv - mv * mv), sample * (uv - mu * mv));
            ((2.0 * mu * mv + c1) * (2.0 * uv + c2)) / ((mu * mu + mv * mv + c1) * (uu + vv + c2))
        })
        .sum();
    total / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blur_keeps_the_mean_and_a_constant() {
        let gray = Gray::new(17, (0..17 * 9).map(|i| f64::from(i * 7919 % 101) / 101.0).collect())
            .unwrap();
        for deviation in [0.3, 1.0, 4.0, 20.0] {
            let mean = |gray: &Gray| gray.values.iter().sum::<f64>() / gray.values.len() as f64;
            assert!((mean(&gray.blurred(deviation)) - mean(&gray)).abs() < 1e-9 * mean(&gray));
        }
    }

    #[test]
    fn dots_on_a_lattice_draw_an_even_gray_and_a_clump_does_not() {
        let even = Gray::new(64, vec![0.5; 64 * 64]).unwrap();
        let lattice: Vec<DVec2> = (0..16 * 16)
            .map(|i| DVec2::new(f64::from(i % 16) * 4.0 + 2.0, f64::from(i / 16) * 4.0 + 2.0))
            .collect();
        let found = stippling(&even, &lattice).unwrap();
        assert!(
            found.tone[1] < 1e-4 && found.ink_error < 0.02 && found.on_white == 0.0,
            "{found:?}"
        );
        let clump: Vec<DVec2> = lattice.iter().map(|dot| 0.3 * *dot).collect();
        let worse = stippling(&even, &clump).unwrap();
        assert!(worse.tone.iter().zip(found.tone).all(|(w, f)| *w > 1.0 + f));
        assert!(worse.psnr < found.psnr && worse.ssim[0] < found.ssim[0]);
    }

    #[test]
    fn what_cannot_be_measured_is_no_panic() {
        assert_eq!(Gray::new(0, vec![]), Err(MeasureError::NotRows { width: 0, pixels: 0 }));
        assert_eq!(Gray::new(3, vec![0.0; 4]), Err(MeasureError::NotRows { width: 3, pixels: 4 }));
        assert_eq!(Gray::new(1, vec![1.0, f64::NAN]), Err(MeasureError::Pixel { x: 0, y: 1 }));
        let white = Gray::new(8, vec![0.0; 64]).unwrap();
        let black = Gray::new(8, vec![1.0; 64]).unwrap();
        let dots = [DVec2::ONE, DVec2::new(-5.0, 1e9)];
        assert_eq!(stippling(&white, &dots), Err(MeasureError::AllZero));
        assert_eq!(
            stippling(&black, &dots[..1]),
            Err(MeasureError::TooFew { found: 1, needed: 2 })
        );
        assert_eq!(
            stippling(&black, &[DVec2::ONE, DVec2::NAN]),
            Err(MeasureError::NotFinite { point: 1 })
        );
        assert!(stippling(&black, &dots).is_ok());
    }
}
