//! One sample at a time: from two uniform numbers to light, and back.

use alloc::vec::Vec;
use core::borrow::Borrow;

use glam::{DVec2, DVec3};

use super::bilinear::{self, Patch};
use super::sobol::Sobol;
use crate::estimate::sums::{Cell, SumPyramid};
use crate::importance::{EnvironmentMap, EnvironmentSample, importance_of};

/// How a renderer reads a map between its pixels' centers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Filter {
    /// A pixel's radiance holds over the whole pixel.
    #[default]
    Nearest,
    /// Radiance is interpolated linearly between the centers of pixels, over the seam and across the poles.
    Bilinear,
}

/// Samples of a map's light, one at a time, with a density in exact proportion to its luminance.
///
/// The [hierarchical warp](crate::estimate::Warp) from the unit square to the sphere: continuous almost
/// everywhere, so that well-spread numbers give well-spread directions, and invertible. Whatever
/// the filter, density and radiance belong together: the density is above 0 wherever the radiance is,
/// also beside a lamp that only interpolation sees.
///
/// The sampler owns the map or borrows it: `LightSampler<&EnvironmentMap>`, `LightSampler<Arc<…>>`, ….
/// Beside the map's own memory it takes 2.7 bytes a pixel, and 4 more for [`Filter::Bilinear`]. A sample
/// from a map of 512 × 256 pixels costs some 90 ns in the cache and 200 out of it, interpolated half as much
/// again.
#[derive(Clone, Debug)]
pub struct LightSampler<M> {
    map: M,
    filter: Filter,
    /// Interpolated shares of the light; for [`Filter::Nearest`] the map's importance is the same.
    shares: Option<Vec<f32>>,
    sums: SumPyramid,
}

impl<M: Borrow<EnvironmentMap>> LightSampler<M> {
    /// The sampler of a map; `None` if the map is black. O(pixels).
    #[must_use]
    pub fn new(map: M, filter: Filter) -> Option<Self> {
        let light: &EnvironmentMap = map.borrow();
        let size = light.size();
        let shares = match filter {
            Filter::Nearest => None,
            Filter::Bilinear => Some(interpolated_shares(light)),
        };
        let pixels = shares.as_deref().unwrap_or(light.importance().pixels());
        let sums = SumPyramid::new(pixels, size);
        let sum = sums.total();
        (sum > 0.0 && sum.is_finite()).then_some(Self { map, filter, shares, sums })
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &EnvironmentMap {
        self.map.borrow()
    }

    /// How it is read.
    #[must_use]
    pub fn filter(&self) -> Filter {
        self.filter
    }

    /// The light to which a point of [0, 1)² goes. If the point is uniform there, the direction has the
    /// density `pdf` per steradian. Coordinates outside of [0, 1), NaN included, count as the nearest
    /// inside.
    #[must_use]
    pub fn sample(&self, at: [f64; 2]) -> EnvironmentSample {
        self.sample_in(self.sums.top(), DVec2::from_array(at))
    }

    /// Sample `i` of the [Sobol] sequence of a seed: each pixel of a picture has a seed, each of its samples
    /// an i. Any first 2^k of them are better spread than other numbers of them.
    #[must_use]
    pub fn nth(&self, i: u32, seed: u64) -> EnvironmentSample {
        self.sample(Sobol::new(seed).point(i))
    }

    /// The light from a direction of any length above 0, and the density per steradian with which
    /// [`sample`](Self::sample) picks it: what a ray that leaves the scene needs for multiple importance
    /// sampling. `direction` as it was given. Dark for the zero vector, NaN and infinities.
    #[must_use]
    pub fn evaluate(&self, direction: DVec3) -> EnvironmentSample {
        let Some(place) = self.place(direction) else {
            return EnvironmentSample { direction, pdf: 0.0, radiance: [0.0; 3] };
        };
        self.light(direction, place)
    }

    /// The density of [`evaluate`](Self::evaluate).
    #[must_use]
    pub fn pdf(&self, direction: DVec3) -> f64 {
        self.evaluate(direction).pdf
    }

    /// The point of [0, 1)² that [`sample`](Self::sample) takes to this direction, to rounding: for
    /// mutations, and to place a renderer's own points. `None` where the density is 0.
    #[must_use]
    pub fn unit(&self, direction: DVec3) -> Option<[f64; 2]> {
        let (column, row, at) = self.place(direction)?;
        let at = match self.filter {
            _ if self.share(column, row) == 0.0 => return None,
            Filter::Nearest => at,
            Filter::Bilinear => Patch::new(self.map(), column, row).trace(at),
        };
        Some(self.sums.trace(self.pixels(), self.sums.top(), (column, row, at)).to_array())
    }

    pub(super) fn sums(&self) -> &SumPyramid {
        &self.sums
    }

    /// The light to which a point of the square of a cell goes, with its density among all light.
    pub(super) fn sample_in(&self, cell: Cell, at: DVec2) -> EnvironmentSample {
        let (column, row, at) = self.sums.find(self.pixels(), cell, at);
        match self.filter {
            Filter::Nearest => {
                let direction = self.map().direction(row, column as f64 + at.x, at.y);
                self.light(direction, (column, row, at))
            }
            Filter::Bilinear => {
                let patch = Patch::new(self.map(), column, row);
                let at = patch.find(at);
                let direction = self.map().direction(row, column as f64 + at.x, at.y);
                EnvironmentSample {
                    direction,
                    pdf: self.pixel_pdf(column, row) * (patch.value(at) / patch.mean()),
                    radiance: bilinear::radiance(self.map(), column, row, at),
                }
            }
        }
    }

    /// The pixel under a direction, column and row, and where in it.
    pub(super) fn place(&self, direction: DVec3) -> Option<(usize, usize, DVec2)> {
        let (width, height) = self.map().size();
        let position = self.map().position(direction)?;
        let column = (position.x as usize).min(width - 1);
        let row = (position.y as usize).min(height - 1);
        Some((column, row, position - DVec2::new(column as f64, row as f64)))
    }

    /// The light at a place in a pixel.
    fn light(
        &self,
        direction: DVec3,
        (column, row, at): (usize, usize, DVec2),
    ) -> EnvironmentSample {
        let (pdf, radiance) = match self.filter {
            Filter::Nearest => {
                let width = self.map().size().0;
                (1.0, self.map().pixels()[row * width + column])
            }
            Filter::Bilinear => {
                let patch = Patch::new(self.map(), column, row);
                let mean = patch.mean();
                let relative = if mean > 0.0 { patch.value(at) / mean } else { 0.0 };
                (relative, bilinear::radiance(self.map(), column, row, at))
            }
        };
        EnvironmentSample { direction, pdf: pdf * self.pixel_pdf(column, row), radiance }
    }

    /// The mean density over a pixel: what the sums say, `f32` rounding included.
    fn pixel_pdf(&self, column: usize, row: usize) -> f64 {
        self.share(column, row) / (self.sums.total() * self.map().solid_angle(row))
    }

    /// The light of a pixel, in the sums' units.
    pub(super) fn share(&self, column: usize, row: usize) -> f64 {
        f64::from(self.pixels()[row * self.map().size().0 + column])
    }

    pub(super) fn pixels(&self) -> &[f32] {
        self.shares.as_deref().unwrap_or(self.map().importance().pixels())
    }
}

/// Mean interpolated luminance × solid angle of each pixel, relative to a pixel at the equator.
fn interpolated_shares(map: &EnvironmentMap) -> Vec<f32> {
    let (width, height) = map.size();
    let at_equator = map.solid_angle(height / 2);
    (0..height)
        .flat_map(|row| {
            let scale = map.solid_angle(row) / at_equator;
            (0..width).map(move |column| importance_of(Patch::new(map, column, row).mean() * scale))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::importance::InvalidPixels;
    use crate::light::Frame;
    use crate::random::SplitMix64;

    /// A lamp of 10⁵ times the mean among black and dim pixels; lamps at a pole and on the seam.
    fn lamps(width: usize, height: usize) -> EnvironmentMap {
        let mut random = SplitMix64::new(3);
        let mut pixels: Vec<[f32; 3]> = (0..width * height)
            .map(|i| if i % 3 == 0 { [0.0; 3] } else { [0; 3].map(|_| random.unit() as f32) })
            .collect();
        pixels[width * (height / 3) + width / 4] = [1e5, 9e4, 5e4];
        pixels[width - 1] = [40.0; 3];
        pixels[width * (height / 2)] = [60.0, 0.0, 0.0];
        EnvironmentMap::new(width, height, pixels, InvalidPixels::Reject).unwrap()
    }

    const FILTERS: [Filter; 2] = [Filter::Nearest, Filter::Bilinear];

    #[test]
    fn samples_know_their_density_and_are_traced_back() {
        let mut random = SplitMix64::new(8);
        for size in [(16, 8), (7, 5), (2, 1), (1, 3)] {
            let frame = Frame::OPENEXR.rotated(40.0);
            let map = if size.0 * size.1 < 20 {
                EnvironmentMap::new(
                    size.0,
                    size.1,
                    alloc::vec![[0.5; 3]; size.0 * size.1],
                    InvalidPixels::Reject,
                )
                .unwrap()
            } else {
                lamps(size.0, size.1)
            }
            .in_frame(frame);
            for filter in FILTERS {
                let lights = LightSampler::new(&map, filter).unwrap();
                for _ in 0..2000 {
                    let u = [random.unit(), random.unit()];
                    let light = lights.sample(u);
                    assert!(light.pdf > 0.0 && light.radiance != [0.0; 3]);
                    let again = lights.evaluate(light.direction);
                    // Longitude keeps fewer digits near the poles, the density is steep at a lamp.
                    let close = (again.pdf / light.pdf - 1.0).abs() < 1e-5;
                    let Some(back) = lights.unit(light.direction) else {
                        panic!("{filter:?} {size:?} {u:?}")
                    };
                    let near = (back[0] - u[0]).hypot(back[1] - u[1]) < 1e-5;
                    assert!(
                        close && near,
                        "{filter:?} {size:?} {u:?} {back:?} {light:?} {again:?}"
                    );
                }
            }
        }
    }

    /// Σ pdf·ω over a fine grid is 1, and the density is luminance over the whole map's.
    #[test]
    fn the_density_integrates_to_one_and_follows_luminance() {
        for (width, height) in [(16, 8), (7, 5), (3, 1)] {
            let map = lamps(width.max(4), height);
            let (width, height) = map.size();
            for filter in FILTERS {
                let lights = LightSampler::new(&map, filter).unwrap();
                let fine = 32;
                let (mut sum, mut light) = (0.0, 0.0);
                let places = |n: usize| (0..fine * n).map(move |i| (i as f64 + 0.5) / fine as f64);
                for y in places(height) {
                    let share = map.solid_angle(y as usize) / (fine * fine) as f64;
                    for x in places(width) {
                        let row = y as usize;
                        let direction = map.direction(row, x, y - row as f64);
                        let found = lights.evaluate(direction);
                        sum += share * found.pdf;
                        light += share * crate::importance::luminance(found.radiance);
                        let dark = found.radiance == [0.0; 3];
                        assert_eq!(found.pdf == 0.0, dark, "{filter:?} {x} {y} {found:?}");
                    }
                }
                assert!((sum - 1.0).abs() < 1e-5, "{filter:?} {sum}");
                // Interpolation moves some light, but makes none where rows are alike.
                assert!((light / map.total_luminance() - 1.0).abs() < 0.2);
                let middle = lights.evaluate(map.direction(height / 2, 0.4, 0.3));
                let ratio = middle.pdf * light / crate::importance::luminance(middle.radiance);
                assert!((ratio - 1.0).abs() < 1e-3, "{filter:?} {ratio}");
            }
        }
    }

    /// The light on surfaces from uniform numbers, within four standard errors of a fine sum.
    #[test]
    fn estimates_are_unbiased() {
        let map = lamps(16, 8).in_frame(Frame::BLENDER);
        for filter in FILTERS {
            let lights = LightSampler::new(&map, filter).unwrap();
            for normal in [DVec3::Z, DVec3::new(-0.6, 0.48, -0.64)] {
                let mut truth = 0.0;
                for y in 0..256 {
                    for x in 0..512 {
                        let (y, x) = ((f64::from(y) + 0.5) / 32.0, (f64::from(x) + 0.5) / 32.0);
                        let direction = map.direction(y as usize, x, y.fract());
                        let green = f64::from(lights.evaluate(direction).radiance[1]);
                        let share = map.solid_angle(y as usize) / 1024.0;
                        truth += share * green * direction.dot(normal).max(0.0);
                    }
                }
                let estimate = |light: &EnvironmentSample| {
                    f64::from(light.radiance[1]) * light.direction.dot(normal).max(0.0) / light.pdf
                };
                let mut random = SplitMix64::new(11);
                let (n, mut sum, mut squares) = (20_000, 0.0, 0.0);
                for _ in 0..n {
                    let value = estimate(&lights.sample([random.unit(), random.unit()]));
                    (sum, squares) = (sum + value, squares + value * value);
                }
                let mean = sum / f64::from(n);
                let error = libm::sqrt((squares / f64::from(n) - mean * mean) / f64::from(n));
                assert!(
                    (mean - truth).abs() < 4.0 * error + 1e-3 * truth,
                    "{mean} {truth} {error}"
                );
                // The sequence is far closer.
                let n = 4096;
                let sum: f64 = (0..n).map(|i| estimate(&lights.nth(i, 5))).sum();
                let sequence = (sum / f64::from(n) - truth).abs();
                assert!(sequence < 2.0 * error + 1e-3 * truth, "{sequence} {error}");
            }
        }
    }

    #[test]
    fn a_lamps_neighbors_are_sampled_where_interpolation_lights_them() {
        let mut pixels = alloc::vec![[0.0f32; 3]; 32];
        pixels[8] = [1.0; 3];
        let map = EnvironmentMap::new(8, 4, pixels, InvalidPixels::Reject).unwrap();
        // On the other side of the seam, and past the upper border of the lamp's row.
        let beside = map.direction(1, 7.8, 0.6);
        let above = map.direction(0, 0.5, 0.7);
        let nearest = LightSampler::new(&map, Filter::Nearest).unwrap();
        let bilinear = LightSampler::new(&map, Filter::Bilinear).unwrap();
        for direction in [beside, above] {
            assert_eq!(nearest.pdf(direction), 0.0);
            let light = bilinear.evaluate(direction);
            assert!(light.pdf > 0.0 && light.radiance[0] > 0.1);
        }
        assert_eq!(bilinear.evaluate(DVec3::NAN).pdf, 0.0);
        assert_eq!(bilinear.unit(map.direction(1, 4.0, 0.5)), None);
        let black = EnvironmentMap::new(2, 1, alloc::vec![[0.0; 3]; 2], InvalidPixels::Reject);
        assert!(LightSampler::new(black.unwrap(), Filter::Bilinear).is_none());
    }
}
