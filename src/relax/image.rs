//! Images as fields: which importance decides on acceptance, on the phase, and on the layer.
//!
//! An importance that varies from pixel to pixel, or has hard edges, thins the points irregularly if
//! each is accepted by the value under it. So, before any point is looked at, three maps are made of
//! the image, each a pixel's value from a box around its centre (clipped to the image), with the local
//! spacing s as the unit of length:
//!
//! 1. s₁ = spacing(mean over half-side s₀), s₀ the spacing of the image's mean importance;
//! 2. *phase map*: mean over half-side `phase_radius`·s₁; s = its spacing, at most 1.5·s₀, as s₁ is;
//! 3. *acceptance map*: mean over half-side `accept_radius`·s;
//! 4. *detail map*: standard deviation/mean over half-side `detail_radius`·s.
//!
//! Points read them bilinearly. The means' boxes do not depend on the pixel's own value, so that the
//! number of points stays unbiased.
//!
//! Averaging alone would soften edges. So a point goes only where the image itself, the pixel under
//! it, asks for points of its rank: rank·`tolerance` < T. One that relaxation moves elsewhere goes up
//! the phase map's gradient until that holds (see [`Field::settle`]).

use glam::DVec2;

use super::field::{Field, spacing, threshold_of_phase};
use super::ground::density;

/// T from an image of importance; its centre lies at 0, x right, y down.
#[derive(Clone, Debug)]
pub struct Image {
    size: [usize; 2],
    /// T for an importance of 1.
    threshold_of_one: f64,
    /// Pixels a base edge.
    scale: f64,
    /// The cap of every spacing, in base edges.
    largest_spacing: f64,
    importance: Vec<f32>,
    phase: Vec<f32>,
    acceptance: Vec<f32>,
    detail: Vec<f32>,
    /// Maxima of the acceptance map over 2^k × 2^k pixels, k = 0, 1, ….
    maxima: Vec<(Vec<f32>, [usize; 2])>,
    rules: ImageRules,
}

/// How an image is read. Radii are half-sides of boxes, in spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageRules {
    /// Of the box whose mean decides on acceptance.
    pub accept_radius: f64,
    /// Of the box whose mean the phase is read from.
    pub phase_radius: f64,
    /// Of the box whose relative standard deviation decides on the rough layer.
    pub detail_radius: f64,
    /// The relative deviations between which the rough layer's share grows from 0 to 1.
    pub detail_range: [f64; 2],
    /// A point may go where the importance is this part of what its rank needs.
    pub tolerance: f64,
}

impl Default for ImageRules {
    fn default() -> Self {
        Self {
            accept_radius: 0.6,
            phase_radius: 1.0,
            detail_radius: 1.0,
            detail_range: [0.03, 0.15],
            tolerance: 0.6,
        }
    }
}

/// Boxes never grow past this many mean spacings.
const LARGEST_SPACING: f64 = 1.5;

/// A point that lands where it may not be goes back up the phase map in steps of this part of a
/// spacing, at most a whole one: along an edge the points stay as far apart as relaxation put them.
const RETREATS: u32 = 16;

/// If that does not help, it goes this much of the way from its tile's centre.
const WAYS: [f64; 3] = [0.5, 0.25, 0.0];

impl Image {
    /// An image of `width` pixels a row such that `count` points are expected on it, at such a scale
    /// that its mean threshold is of phase `tau` in the base level's range.
    ///
    /// Values are finite and ≥ 0, not all 0, and fill rows; otherwise `None`.
    #[must_use]
    pub fn new(
        importance: Vec<f32>,
        width: usize,
        count: f64,
        tau: f64,
        rules: ImageRules,
    ) -> Option<Self> {
        let total: f64 = importance.iter().map(|v| f64::from(*v)).sum();
        let usable = width > 0
            && !importance.is_empty()
            && importance.len().is_multiple_of(width)
            && importance.iter().all(|v| *v >= 0.0 && v.is_finite())
            && total > 0.0;
        if !usable {
            return None;
        }
        let pixels = importance.len() as f64;
        let mean_threshold = threshold_of_phase(tau);
        let mut image = Self {
            size: [width, importance.len() / width],
            threshold_of_one: mean_threshold * pixels / total,
            // count = density · area.
            scale: libm::sqrt(pixels * density(mean_threshold) / count),
            largest_spacing: LARGEST_SPACING * spacing(mean_threshold),
            importance,
            phase: Vec::new(),
            acceptance: Vec::new(),
            detail: Vec::new(),
            maxima: Vec::new(),
            rules,
        };
        image.make_maps(mean_threshold);
        Some(image)
    }

    fn make_maps(&mut self, mean_threshold: f64) {
        let sums = Sums::new(&self.importance, self.size[0]);
        let mean_spacing = spacing(mean_threshold) * self.scale;
        let largest = self.largest_spacing * self.scale;
        let spacing_of = |mean: f64| {
            let threshold = (mean * self.threshold_of_one).max(1e-9 * mean_threshold);
            (spacing(threshold) * self.scale).min(largest)
        };
        let (mut phase, mut acceptance, mut detail) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..self.importance.len() {
            let centre = [(i % self.size[0]) as f64 + 0.5, (i / self.size[0]) as f64 + 0.5];
            let [around, _] = sums.mean_and_square(centre, mean_spacing);
            let radius = self.rules.phase_radius * spacing_of(around);
            let [local, _] = sums.mean_and_square(centre, radius);
            let spacing = spacing_of(local);
            phase.push(local as f32);
            let [accept, _] = if self.rules.accept_radius > 0.0 {
                sums.mean_and_square(centre, self.rules.accept_radius * spacing)
            } else {
                [self.importance[i].into(), 0.0]
            };
            acceptance.push(accept as f32);
            let [mean, square] = sums.mean_and_square(centre, self.rules.detail_radius * spacing);
            let deviation = libm::sqrt((square - mean * mean).max(0.0));
            let [from, to] = self.rules.detail_range.map(|r| r * mean);
            let share = if to > from { (deviation - from) / (to - from) } else { 0.0 };
            detail.push(share.clamp(0.0, 1.0) as f32);
        }
        (self.phase, self.acceptance, self.detail) = (phase, acceptance, detail);
        self.maxima = maxima(&self.acceptance, self.size);
    }

    /// Pixel coordinates of a place: the image is [0, width) × [0, height).
    #[must_use]
    pub fn pixels(&self, p: DVec2) -> DVec2 {
        p * self.scale + 0.5 * self.extent()
    }

    fn extent(&self) -> DVec2 {
        DVec2::new(self.size[0] as f64, self.size[1] as f64)
    }

    /// Half the image's extent, in base edges.
    #[must_use]
    pub fn half_extent(&self) -> DVec2 {
        0.5 * self.extent() / self.scale
    }

    /// Bilinear between pixel centres, clamped outside.
    fn read(&self, map: &[f32], p: DVec2) -> f64 {
        let q = self.pixels(p) - DVec2::splat(0.5);
        let (x, y) = (libm::floor(q.x), libm::floor(q.y));
        let (fx, fy) = (q.x - x, q.y - y);
        let (x, y) = (x as i64, y as i64);
        let value = |x: i64, y: i64| {
            let x = x.clamp(0, self.size[0] as i64 - 1) as usize;
            let y = y.clamp(0, self.size[1] as i64 - 1) as usize;
            f64::from(map[y * self.size[0] + x])
        };
        let top = value(x, y) * (1.0 - fx) + value(x + 1, y) * fx;
        let bottom = value(x, y + 1) * (1.0 - fx) + value(x + 1, y + 1) * fx;
        top * (1.0 - fy) + bottom * fy
    }
}

impl Field for Image {
    fn threshold(&self, p: DVec2) -> f64 {
        self.read(&self.acceptance, p) * self.threshold_of_one
    }

    fn bound(&self, p: DVec2, radius: f64) -> f64 {
        let (pixel, radius) = (self.pixels(p), radius * self.scale + 1.0);
        let mut k = 0;
        while k + 1 < self.maxima.len() && f64::from(1u32 << k) < radius {
            k += 1;
        }
        let (level, size) = &self.maxima[k];
        let texel = |c: f64, axis: usize| {
            // Clamped to the image first, as reading is.
            let inside = (libm::floor(c) as i64).clamp(0, self.size[axis] as i64 - 1);
            ((inside >> k) as usize).min(size[axis] - 1)
        };
        let mut max = 0.0f32;
        for y in texel(pixel.y - radius, 1)..=texel(pixel.y + radius, 1) {
            for x in texel(pixel.x - radius, 0)..=texel(pixel.x + radius, 0) {
                max = max.max(level[y * size[0] + x]);
            }
        }
        f64::from(max) * self.threshold_of_one * (1.0 + 1e-12)
    }

    fn local(&self, p: DVec2) -> f64 {
        self.read(&self.phase, p) * self.threshold_of_one
    }

    fn detail(&self, p: DVec2) -> f64 {
        self.read(&self.detail, p)
    }

    fn settle(&self, centre: DVec2, rank: u64, moved: DVec2) -> DVec2 {
        let needed = self.rules.tolerance * rank as f64 / self.threshold_of_one;
        // The pixel under the point, not a mixture of pixels: edges stay as sharp as the image's.
        let allowed = |p: DVec2| {
            let q = self.pixels(p);
            let x = (q.x.max(0.0) as usize).min(self.size[0] - 1);
            let y = (q.y.max(0.0) as usize).min(self.size[1] - 1);
            needed < f64::from(self.importance[y * self.size[0] + x])
        };
        if allowed(moved) {
            return moved;
        }
        let spacing = spacing(self.local(centre).max(1.0)).min(self.largest_spacing);
        let h = 0.5 * spacing;
        let rise =
            |d: DVec2| self.read(&self.phase, centre + d) - self.read(&self.phase, centre - d);
        let gradient = DVec2::new(rise(DVec2::X * h), rise(DVec2::Y * h));
        let length = gradient.length();
        if length > 0.0 {
            let step = gradient * (spacing / (f64::from(RETREATS) * length));
            for i in 1..=RETREATS {
                let p = moved + step * f64::from(i);
                if allowed(p) {
                    return p;
                }
            }
        }
        for way in WAYS {
            let p = centre + (moved - centre) * way;
            if allowed(p) {
                return p;
            }
        }
        centre
    }
}

fn maxima(values: &[f32], size: [usize; 2]) -> Vec<(Vec<f32>, [usize; 2])> {
    let mut maxima = vec![(values.to_vec(), size)];
    while let Some((below, [w, h])) = maxima.last().filter(|(_, [w, h])| w * h > 1) {
        let next = [w.div_ceil(2), h.div_ceil(2)];
        let at = |x: usize, y: usize| below[y.min(h - 1) * w + x.min(w - 1)];
        let level = (0..next[0] * next[1])
            .map(|i| {
                let (x, y) = (2 * (i % next[0]), 2 * (i / next[0]));
                at(x, y).max(at(x + 1, y)).max(at(x, y + 1)).max(at(x + 1, y + 1))
            })
            .collect();
        maxima.push((level, next));
    }
    maxima
}

/// Integrals of the image and of its square from the corner.
struct Sums {
    sums: Vec<[f64; 2]>,
    size: [usize; 2],
}

impl Sums {
    fn new(values: &[f32], width: usize) -> Self {
        let size = [width, values.len() / width];
        let stride = width + 1;
        let mut sums = vec![[0.0; 2]; stride * (size[1] + 1)];
        for y in 0..size[1] {
            let mut row = [0.0; 2];
            for x in 0..width {
                let v = f64::from(values[y * width + x]);
                row = [row[0] + v, row[1] + v * v];
                let above = sums[y * stride + x + 1];
                sums[(y + 1) * stride + x + 1] = [above[0] + row[0], above[1] + row[1]];
            }
        }
        Self { sums, size }
    }

    /// The integrals over [0, x) × [0, y), inside the image.
    fn corner(&self, x: f64, y: f64) -> [f64; 2] {
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let at = |i: usize, j: usize| {
            self.sums[j.min(self.size[1]) * (self.size[0] + 1) + i.min(self.size[0])]
        };
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        core::array::from_fn(|k| {
            (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy
        })
    }

    /// The means of the value and of its square over a box about a place inside the image.
    fn mean_and_square(&self, centre: [f64; 2], half: f64) -> [f64; 2] {
        let low = centre.map(|c| (c - half).max(0.0));
        let high: [f64; 2] = core::array::from_fn(|k| (centre[k] + half).min(self.size[k] as f64));
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        let (a, b) = (self.corner(high[0], high[1]), self.corner(low[0], high[1]));
        let (c, d) = (self.corner(high[0], low[1]), self.corner(low[0], low[1]));
        core::array::from_fn(|k| (a[k] - b[k] - c[k] + d[k]) / area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relax::random::Random;
    use crate::relax::report::{TEST_IMAGE_SIDE, edge_image, test_image};

    #[test]
    fn images_that_ask_for_nothing_are_refused() {
        let new = |values: Vec<f32>, width| {
            Image::new(values, width, 100.0, 3.0, ImageRules::default()).is_some()
        };
        assert!(new(vec![0.0, 1.0, 0.0, 0.0], 2));
        assert!(!new(vec![], 2) && !new(vec![1.0; 4], 0) && !new(vec![1.0; 5], 2));
        assert!(!new(vec![0.0; 4], 2) && !new(vec![1.0, f32::NAN], 2) && !new(vec![1.0, -1.0], 2));
    }

    #[test]
    fn bounds_hold_inside_and_outside_the_image() {
        let rules = ImageRules { accept_radius: 0.2, ..ImageRules::default() };
        let image = Image::new(test_image(), TEST_IMAGE_SIDE, 5e3, 3.0, rules).unwrap();
        let mut random = Random::new(3, &[]);
        for _ in 0..4000 {
            let mut around =
                |scale: f64| DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * scale;
            let (p, offset) = (around(250.0), around(1.0));
            let radius = random.unit() * random.unit() * 60.0;
            let q = p + offset * radius;
            assert!(image.threshold(q) <= image.bound(p, radius), "{p} {radius}");
        }
    }

    #[test]
    fn uniform_images_are_constant_fields() {
        let image = Image::new(vec![0.3; 5000], 100, 1000.0, 2.5, ImageRules::default()).unwrap();
        let threshold = threshold_of_phase(2.5);
        for p in [DVec2::ZERO, image.half_extent(), DVec2::splat(-1e4)] {
            assert!((image.threshold(p) / threshold - 1.0).abs() < 1e-6);
            assert!((image.local(p) / threshold - 1.0).abs() < 1e-6);
            assert_eq!(image.detail(p), 0.0);
        }
        // The density times the area is the count.
        let area = 4.0 * image.half_extent().element_product();
        assert!((density(threshold) * area / 1000.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn points_stay_on_the_side_of_an_edge_that_asks_for_them() {
        let values = edge_image();
        let image =
            Image::new(values.clone(), TEST_IMAGE_SIDE, 6e4, 3.0, ImageRules::default()).unwrap();
        let is_dark = |p: DVec2| {
            let q = image.pixels(p).clamp(DVec2::ZERO, DVec2::splat(1023.0));
            values[q.y as usize * TEST_IMAGE_SIDE + q.x as usize] > 0.0
        };
        let mut random = Random::new(4, &[]);
        let (mut kept, mut held) = (0, 0);
        for _ in 0..3000 {
            let centre =
                image.half_extent() * (2.0 * DVec2::new(random.unit(), random.unit()) - 1.0);
            if !is_dark(centre) {
                continue;
            }
            let moved = centre + (DVec2::new(random.unit(), random.unit()) - 0.5) * 2.0;
            let settled = image.settle(centre, 1000, moved);
            assert!(is_dark(settled));
            if is_dark(moved) {
                assert_eq!(settled, moved);
                kept += 1;
            } else {
                held += 1;
            }
        }
        assert!(kept > 500 && held > 50, "{kept} {held}");
    }
}
