//! Thresholds over the plane, in rank units: a tile centre p is a point if its rank < T(p).

use glam::DVec2;

use super::ground::{BASE_LEVEL, density, edge};
use crate::tiling::TileCounts;

/// A threshold at every place. Lengths in edges of the ground's base level.
pub trait Field: Sync {
    /// T(p), finite and ≥ 0.
    fn threshold(&self, p: DVec2) -> f64;

    /// An upper bound of T within `radius` of `p`.
    fn bound(&self, p: DVec2, radius: f64) -> f64;

    /// T averaged at the scale of `spacing`: what the phase is read from.
    fn local(&self, p: DVec2, spacing: f64) -> f64 {
        let _ = spacing;
        self.threshold(p)
    }

    /// How much detail there is at the scale of `spacing`, 0 … 1: the share of the rough layer.
    fn detail(&self, p: DVec2, spacing: f64) -> f64 {
        let _ = (p, spacing);
        0.0
    }
}

/// T relative to the tile count of the level above the base level: the phase τ of a field in the base
/// level's range.
#[must_use]
pub fn threshold_of_phase(tau: f64) -> f64 {
    tau * TileCounts::HEXAGON.all()[BASE_LEVEL - 1] as f64
}

/// The same T everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant(pub f64);

impl Field for Constant {
    fn threshold(&self, _: DVec2) -> f64 {
        self.0
    }

    fn bound(&self, _: DVec2, _: f64) -> f64 {
        self.0
    }
}

/// T from the value of an image, bilinear between pixel centres, clamped outside; see [`Image::new`].
#[derive(Clone, Debug)]
pub struct Image {
    values: Vec<f32>,
    size: [usize; 2],
    /// T for a value of 1.
    threshold_of_one: f64,
    /// Pixels a base edge.
    scale: f64,
    /// Maxima over 2^k × 2^k pixels.
    maxima: Vec<(Vec<f32>, [usize; 2])>,
    /// Which rules apply.
    rules: ImageRules,
}

/// How an image is read; radii in spacings of the local density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageRules {
    /// acceptance averaging
    pub accept_radius: f64,
    /// Half-side of the box over which the phase's importance is averaged.
    pub phase_radius: f64,
    /// Half-side of the box whose contrast ln(max/min) decides on the rough layer.
    pub contrast_radius: f64,
    /// The contrast where the rough layer begins to count.
    pub contrast_from: f64,
    /// The contrast where it counts alone.
    pub contrast_to: f64,
}

impl Default for ImageRules {
    fn default() -> Self {
        Self {
            accept_radius: 0.0,
            phase_radius: 1.0,
            contrast_radius: 1.0,
            contrast_from: 0.07,
            contrast_to: 0.6,
        }
    }
}

impl Image {
    /// An image of `width` pixels a row such that `count` points are expected on it, at such a scale
    /// that its mean threshold is of phase `tau` in the base level's range. Its centre lies at 0.
    ///
    /// Values are finite and ≥ 0, not all 0, and fill rows; otherwise `None`.
    #[must_use]
    pub fn new(
        values: Vec<f32>,
        width: usize,
        count: f64,
        tau: f64,
        rules: ImageRules,
    ) -> Option<Self> {
        let total: f64 = values.iter().map(|v| f64::from(*v)).sum();
        let usable = width > 0
            && !values.is_empty()
            && values.len().is_multiple_of(width)
            && values.iter().all(|v| *v >= 0.0 && v.is_finite())
            && total > 0.0;
        if !usable {
            return None;
        }
        let mean = total / values.len() as f64;
        let threshold = threshold_of_phase(tau);
        // count = density · area.
        let scale = libm::sqrt(values.len() as f64 * density(threshold) / count);
        let size = [width, values.len() / width];
        let mut maxima = vec![(values.clone(), size)];
        while let Some((below, [w, h])) = maxima.last().filter(|(_, [w, h])| w * h > 1) {
            let next = [w.div_ceil(2), h.div_ceil(2)];
            let at = |x: usize, y: usize| below[y.min(h - 1) * w + x.min(w - 1)];
            let level = (0..next[0] * next[1]).map(|i| {
                let (x, y) = (2 * (i % next[0]), 2 * (i / next[0]));
                at(x, y).max(at(x + 1, y)).max(at(x, y + 1)).max(at(x + 1, y + 1))
            });
            let level = level.collect();
            maxima.push((level, next));
        }
        Some(Self { values, size, threshold_of_one: threshold / mean, scale, maxima, rules })
    }

    /// Pixel coordinates of a place: x right, y down, the image [0, width) × [0, height).
    #[must_use]
    pub fn pixels(&self, p: DVec2) -> DVec2 {
        p * self.scale + 0.5 * DVec2::new(self.size[0] as f64, self.size[1] as f64)
    }

    /// Half the image's extent, in base edges.
    #[must_use]
    pub fn half_extent(&self) -> DVec2 {
        0.5 * DVec2::new(self.size[0] as f64, self.size[1] as f64) / self.scale
    }

    fn value(&self, x: i64, y: i64) -> f64 {
        let x = x.clamp(0, self.size[0] as i64 - 1) as usize;
        let y = y.clamp(0, self.size[1] as i64 - 1) as usize;
        f64::from(self.values[y * self.size[0] + x])
    }

    fn bilinear(&self, pixel: DVec2) -> f64 {
        let q = pixel - DVec2::splat(0.5);
        let (x, y) = (libm::floor(q.x), libm::floor(q.y));
        let (fx, fy) = (q.x - x, q.y - y);
        let (x, y) = (x as i64, y as i64);
        let top = self.value(x, y) * (1.0 - fx) + self.value(x + 1, y) * fx;
        let bottom = self.value(x, y + 1) * (1.0 - fx) + self.value(x + 1, y + 1) * fx;
        top * (1.0 - fy) + bottom * fy
    }

    /// The pixels that a box of this half-side covers at least in part, with the covered lengths.
    fn covered(&self, pixel: DVec2, half: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        let axis = move |c: f64| {
            let (low, high) = (c - half, c + half);
            let (first, last) = (libm::floor(low) as i64, libm::ceil(high) as i64);
            (first..last).map(move |i| {
                let length = high.min(i as f64 + 1.0) - low.max(i as f64);
                (i, length)
            })
        };
        axis(pixel.y).flat_map(move |(y, height)| {
            axis(pixel.x).map(move |(x, width)| (self.value(x, y), width * height))
        })
    }
}

impl Field for Image {
    fn threshold(&self, p: DVec2) -> f64 {
        let t = self.bilinear(self.pixels(p)) * self.threshold_of_one;
        if self.rules.accept_radius == 0.0 {
            return t;
        }
        let half = spacing(t.max(1.0)) * self.rules.accept_radius * self.scale;
        let (mut sum, mut area) = (0.0, 0.0);
        for (value, covered) in self.covered(self.pixels(p), half) {
            sum += value * covered;
            area += covered;
        }
        sum / area * self.threshold_of_one
    }

    fn bound(&self, p: DVec2, radius: f64) -> f64 {
        let (pixel, radius) =
            (self.pixels(p), radius * self.scale + 1.0 + 40.0 * self.rules.accept_radius);
        let mut k = 0;
        while k + 1 < self.maxima.len() && f64::from(1u32 << k) < radius {
            k += 1;
        }
        let (level, [w, h]) = &self.maxima[k];
        let texel =
            |c: f64, n: usize| ((libm::floor(c) as i64) >> k).clamp(0, n as i64 - 1) as usize;
        let mut max = 0.0f32;
        for y in texel(pixel.y - radius, *h)..=texel(pixel.y + radius, *h) {
            for x in texel(pixel.x - radius, *w)..=texel(pixel.x + radius, *w) {
                max = max.max(level[y * w + x]);
            }
        }
        f64::from(max) * self.threshold_of_one * (1.0 + 1e-12)
    }

    fn local(&self, p: DVec2, spacing: f64) -> f64 {
        let half = spacing * self.rules.phase_radius * self.scale;
        let (mut sum, mut area) = (0.0, 0.0);
        for (value, covered) in self.covered(self.pixels(p), half) {
            sum += value * covered;
            area += covered;
        }
        sum / area * self.threshold_of_one
    }

    fn detail(&self, p: DVec2, spacing: f64) -> f64 {
        let half = spacing * self.rules.contrast_radius * self.scale;
        let (mut min, mut max) = (f64::INFINITY, 0.0f64);
        for (value, _) in self.covered(self.pixels(p), half) {
            min = min.min(value);
            max = max.max(value);
        }
        let contrast = libm::log(max / min.max(1e-30));
        let ImageRules { contrast_from, contrast_to, .. } = self.rules;
        ((contrast - contrast_from) / (contrast_to - contrast_from)).clamp(0.0, 1.0)
    }
}

/// The spacing 1/√ρ of a threshold, in base edges.
#[must_use]
pub fn spacing(threshold: f64) -> f64 {
    1.0 / libm::sqrt(density(threshold))
}

/// The level whose range (N_{L−1}, N_L] holds `threshold`, its edge in base edges, and N_{L−1}.
/// Thresholds up to 1 are of level 1.
#[must_use]
pub fn level_of(threshold: f64) -> (usize, f64, f64) {
    let counts = TileCounts::HEXAGON.all();
    let level = counts.partition_point(|n| (*n as f64) < threshold).max(1);
    (level, edge(level), counts[level - 1] as f64)
}
