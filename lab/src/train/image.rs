//! Images as fields: the library's own maps, read where the ground's tiles are.
//!
//! [`StippleMap`] says what decides on acceptance, on the phase and on the layer, and where a point may
//! go; fixed centers are accepted by a [`BilinearMap`] of the same pixels.

use glam::DVec2;

use super::field::{Field, threshold_of_phase};
use super::place::density;
use twelvefold::Disc;
use twelvefold::importance::{BilinearMap, ImageMap, Importance, InvalidPixels, StippleMap};

/// T from an image of importance; its center lies at 0, x right, y down.
#[derive(Clone, Debug)]
pub struct Image<I> {
    importance: I,
    /// Width and height in pixels.
    extent: DVec2,
    /// T for an importance of 1.
    threshold_of_one: f64,
    /// Pixels a base edge.
    scale: f64,
}

impl Image<StippleMap> {
    /// For relaxed points: an image of `width` pixels a row such that `count` points are expected on it,
    /// at such a scale that its mean threshold is of phase `tau` in the base level's range.
    ///
    /// Values are finite and ≥ 0, not all 0, and fill rows; otherwise `None`.
    #[must_use]
    pub fn stippled(importance: Vec<f32>, width: usize, count: f64, tau: f64) -> Option<Self> {
        Self::accepting(importance, width, count, tau, StippleMap::ACCEPTANCE)
    }

    /// The same with a half-side of the box, in spacings, whose mean decides on acceptance.
    pub(super) fn accepting(
        importance: Vec<f32>,
        width: usize,
        count: f64,
        tau: f64,
        acceptance: f64,
    ) -> Option<Self> {
        Self::new(importance, width, count, tau, |image| {
            StippleMap::of_image(image, count, acceptance).ok()
        })
    }
}

impl Image<BilinearMap> {
    /// For fixed centers, otherwise as [`stippled`](Image::stippled).
    #[must_use]
    pub fn fixed(importance: Vec<f32>, width: usize, count: f64, tau: f64) -> Option<Self> {
        Self::new(importance, width, count, tau, |image| Some(BilinearMap::new(image)))
    }
}

impl<I: Importance> Image<I> {
    fn new(
        importance: Vec<f32>,
        width: usize,
        count: f64,
        tau: f64,
        prepare: impl FnOnce(ImageMap) -> Option<I>,
    ) -> Option<Self> {
        let height = importance.len().checked_div(width)?;
        let image = ImageMap::new(width, height, importance, InvalidPixels::Reject).ok()?;
        let mean = image.mean();
        if !(mean > 0.0 && count > 0.0) {
            return None;
        }
        let extent = DVec2::new(width as f64, height as f64);
        let mean_threshold = threshold_of_phase(tau);
        Some(Self {
            importance: prepare(image)?,
            extent,
            threshold_of_one: mean_threshold / mean,
            // count = density · area.
            scale: libm::sqrt(extent.element_product() * density(mean_threshold) / count),
        })
    }

    /// Pixel coordinates of a place: the image is [0, width) × [0, height).
    #[must_use]
    pub fn pixels(&self, p: DVec2) -> DVec2 {
        p * self.scale + 0.5 * self.extent
    }

    /// Half the image's extent, in base edges.
    #[must_use]
    pub fn half_extent(&self) -> DVec2 {
        0.5 * self.extent / self.scale
    }
}

impl<I: Importance + Sync> Field for Image<I> {
    fn threshold(&self, p: DVec2) -> f64 {
        self.importance.value(self.pixels(p)) * self.threshold_of_one
    }

    fn bound(&self, p: DVec2, radius: f64) -> f64 {
        // A little more, for the rounding of places.
        let radius = radius * self.scale * (1.0 + 1e-9) + 1e-6;
        let region = Disc { center: self.pixels(p), radius };
        self.importance.upper_bound(&region) * self.threshold_of_one
    }

    fn local(&self, p: DVec2) -> f64 {
        let at = self.pixels(p);
        self.importance.local(at, self.importance.value(at)) * self.threshold_of_one
    }

    fn detail(&self, p: DVec2) -> f64 {
        self.importance.detail(self.pixels(p))
    }

    fn settle(&self, center: DVec2, rank: u64, moved: DVec2) -> DVec2 {
        let there = self.pixels(moved);
        let needed = rank as f64 / self.threshold_of_one;
        let settled = self.importance.constrain(self.pixels(center), there, needed);
        if settled == there { moved } else { (settled - 0.5 * self.extent) / self.scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::train::evaluate::{TEST_IMAGE_SIDE, edge_image, test_image};

    #[test]
    fn images_that_ask_for_nothing_are_refused() {
        let new = |values: Vec<f32>, width| Image::stippled(values, width, 100.0, 3.0).is_some();
        assert!(new(vec![0.0, 1.0, 0.0, 0.0], 2));
        assert!(!new(vec![], 2) && !new(vec![1.0; 4], 0) && !new(vec![1.0; 5], 2));
        assert!(!new(vec![0.0; 4], 2) && !new(vec![1.0, f32::NAN], 2) && !new(vec![1.0, -1.0], 2));
    }

    #[test]
    fn bounds_hold_inside_and_outside_the_image() {
        let image = Image::accepting(test_image(), TEST_IMAGE_SIDE, 5e3, 3.0, 0.2).unwrap();
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
        let image = Image::stippled(vec![0.3; 5000], 100, 1000.0, 2.5).unwrap();
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
        let image = Image::stippled(values.clone(), TEST_IMAGE_SIDE, 6e4, 3.0).unwrap();
        let is_dark = |p: DVec2| {
            let q = image.pixels(p).clamp(DVec2::ZERO, DVec2::splat(1023.0));
            values[q.y as usize * TEST_IMAGE_SIDE + q.x as usize] > 0.0
        };
        let mut random = Random::new(4, &[]);
        let (mut kept, mut held) = (0, 0);
        for _ in 0..3000 {
            let center =
                image.half_extent() * (2.0 * DVec2::new(random.unit(), random.unit()) - 1.0);
            if !is_dark(center) {
                continue;
            }
            let moved = center + (DVec2::new(random.unit(), random.unit()) - 0.5) * 2.0;
            let settled = image.settle(center, 1000, moved);
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
