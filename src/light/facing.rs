//! Light for a surface with a known normal: the map's density times a bound of the cosine.

use alloc::vec::Vec;
use core::borrow::Borrow;
use core::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::sampler::LightSampler;
use crate::estimate::sums::{Cell, SumPyramid};
use crate::importance::{EnvironmentMap, EnvironmentSample};

/// The most cells of the coarse map, across and down together with their cost: a [`turn`] reads each once.
///
/// [`turn`]: FacingSampler::turn
const MOST_CELLS: usize = 2048;

/// Samples of the light above a surface's horizon.
///
/// The map is divided into at most 2,048 cells of equal numbers of pixels. A cell is picked in
/// proportion to its light times the greatest cosine of a direction in it with the normal; within the
/// cell, directions follow the map. So the density is above 0 wherever the surface sees light, and close
/// to the product of light and cosine that diffuse surfaces reflect: on an overcast sky no sample
/// in two is lost below the horizon.
///
/// A [turn](Self::turn) to another normal costs 10 to 70 µs, as much as 50 to 200 samples, and a sample
/// little more than [`LightSampler::sample`]: worth it for a plane, a facet, or some hundred samples of
/// one normal, not for one sample a normal.
///
/// ```
/// use glam::DVec3;
/// use twelvefold::light::{Filter, LightSampler};
/// use twelvefold::{EnvironmentMap, InvalidPixels};
/// let sky = EnvironmentMap::new(64, 32, vec![[1.0; 3]; 64 * 32], InvalidPixels::Reject)?;
/// let lights = LightSampler::new(&sky, Filter::Nearest).ok_or("black")?;
/// let facing = lights.facing(DVec3::Z).ok_or("no light above")?;
/// let n = 256;
/// let samples = (0..n).map(|i| facing.nth(i, 1));
/// let irradiance: f64 = samples.map(|l| l.direction.z.max(0.0) / (l.pdf * f64::from(n))).sum();
/// assert!((irradiance / std::f64::consts::PI - 1.0).abs() < 0.005);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FacingSampler<'s, M> {
    lights: &'s LightSampler<M>,
    /// The level of the map's sums whose blocks are the cells.
    level: usize,
    /// Cells across and down.
    size: (usize, usize),
    cones: Vec<Cone>,
    /// Light × greatest cosine, and their sums.
    weights: Vec<f32>,
    sums: SumPyramid,
}

/// A cell's light, and a cone that holds it.
#[derive(Clone, Copy, Debug)]
struct Cone {
    light: f64,
    axis: DVec3,
    cosine: f64,
    sine: f64,
}

impl Cone {
    /// A number not below the cosine of any of its directions with the normal, 0 if none is above 0.
    fn greatest_cosine(&self, normal: DVec3) -> f64 {
        let cosine = self.axis.dot(normal);
        if cosine >= self.cosine {
            return 1.0;
        }
        // cos(α − r), α from the axis to the normal.
        let sine = libm::sqrt((1.0 - cosine * cosine).max(0.0));
        (cosine * self.cosine + sine * self.sine).max(0.0)
    }
}

impl<M: Borrow<EnvironmentMap>> LightSampler<M> {
    /// The same light for a surface that faces `normal`, of any length above 0: directions below its
    /// horizon are not sampled, and grazing ones seldom. `None` if no light comes from above the
    /// horizon, and for a normal without length.
    ///
    /// Costs some microseconds and allocates; see [`FacingSampler`].
    #[must_use]
    pub fn facing(&self, normal: DVec3) -> Option<FacingSampler<'_, M>> {
        FacingSampler::new(self, normal)
    }
}

impl<'s, M: Borrow<EnvironmentMap>> FacingSampler<'s, M> {
    pub(super) fn new(lights: &'s LightSampler<M>, normal: DVec3) -> Option<Self> {
        let sums = lights.sums();
        let fits = |level: &usize| {
            let (width, height) = sums.cells(*level);
            width * height <= MOST_CELLS
        };
        let level = (0..=sums.top().level).find(fits)?;
        let size = sums.cells(level);
        let cones = cones(lights, level, size);
        let weights = alloc::vec![0.0; cones.len()];
        let sums = SumPyramid::new(&weights, size);
        let mut sampler = Self { lights, level, size, cones, weights, sums };
        sampler.turn(normal).then_some(sampler)
    }

    /// The same for another normal. Allocates nothing. `false`, and then of no use until it is turned
    /// again, if no light comes from above that horizon or the normal has no length.
    #[must_use]
    pub fn turn(&mut self, normal: DVec3) -> bool {
        let scaled = normal / normal.abs().max_element();
        let normal = scaled / libm::sqrt(scaled.dot(scaled));
        if !normal.is_finite() {
            self.weights.fill(0.0);
        } else {
            for (weight, cone) in self.weights.iter_mut().zip(&self.cones) {
                // As f32 not 0 where the product is not.
                let product = cone.light * cone.greatest_cosine(normal);
                *weight = if product > 0.0 { (product as f32).max(f32::from_bits(1)) } else { 0.0 };
            }
        }
        self.sums.add_up(&self.weights);
        let sum = self.sums.total();
        sum > 0.0 && sum.is_finite()
    }

    /// As [`LightSampler::sample`]. Dark, with density 0, after a [`turn`](Self::turn) that failed.
    #[must_use]
    pub fn sample(&self, at: [f64; 2]) -> EnvironmentSample {
        if self.sums.total() <= 0.0 {
            return EnvironmentSample { direction: DVec3::Z, pdf: 0.0, radiance: [0.0; 3] };
        }
        let at = DVec2::from_array(at);
        let (x, y, at) = self.sums.find(&self.weights, self.sums.top(), at);
        let light = self.lights.sample_in(Cell { level: self.level, x, y }, at);
        EnvironmentSample { pdf: light.pdf * self.factor(x, y), ..light }
    }

    /// As [`LightSampler::nth`].
    #[must_use]
    pub fn nth(&self, i: u32, seed: u64) -> EnvironmentSample {
        self.sample(super::Sobol::new(seed).point(i))
    }

    /// As [`LightSampler::evaluate`].
    #[must_use]
    pub fn evaluate(&self, direction: DVec3) -> EnvironmentSample {
        let light = self.lights.evaluate(direction);
        match self.lights.place(direction) {
            Some((column, row, _)) if self.sums.total() > 0.0 => {
                let factor = self.factor(column >> self.level, row >> self.level);
                EnvironmentSample { pdf: light.pdf * factor, ..light }
            }
            _ => EnvironmentSample { pdf: 0.0, ..light },
        }
    }

    /// How much more often than by light alone a cell is picked.
    fn factor(&self, x: usize, y: usize) -> f64 {
        let index = y * self.size.0 + x;
        let by_light = self.cones[index].light / self.lights.sums().total();
        if by_light > 0.0 {
            f64::from(self.weights[index]) / self.sums.total() / by_light
        } else {
            0.0
        }
    }
}

/// The cells of a level of the sums.
fn cones<M: Borrow<EnvironmentMap>>(
    lights: &LightSampler<M>,
    level: usize,
    (across, down): (usize, usize),
) -> Vec<Cone> {
    let map = lights.map();
    let (width, height) = map.size();
    let side = 1usize << level;
    let mut cones = Vec::with_capacity(across * down);
    for y in 0..down {
        let (upper, lower) = (y * side, ((y + 1) * side).min(height));
        let angle = |row: f64| PI * row / height as f64;
        // At most half the height, and half the width where it is widest: a bound of the distance from
        // the middle along a meridian and then a parallel.
        let tall = angle((lower - upper) as f64);
        let widest = if (upper..=lower).contains(&(height / 2)) {
            1.0
        } else {
            libm::sin(angle(upper as f64)).max(libm::sin(angle(lower as f64)))
        };
        let middle_row = (upper + lower) / 2;
        for x in 0..across {
            let (left, right) = (x * side, ((x + 1) * side).min(width));
            let wide = 2.0 * PI * (right - left) as f64 / width as f64 * widest;
            // The middle row's border is the middle to half a row, which counts as well.
            let radius = (0.5 * (tall + wide) + 0.5 * angle(1.0) + 1e-9).min(PI);
            let axis = map.direction(
                middle_row.min(height - 1),
                0.5 * (left + right) as f64,
                if middle_row == height { 1.0 } else { 0.0 },
            );
            cones.push(Cone {
                light: lights.sums().sum(lights.pixels(), Cell { level, x, y }),
                axis,
                cosine: libm::cos(radius),
                sine: libm::sin(radius),
            });
        }
    }
    cones
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::importance::InvalidPixels;
    use crate::light::{Filter, Frame};
    use crate::random::SplitMix64;

    fn sky(width: usize, height: usize) -> EnvironmentMap {
        let mut random = SplitMix64::new(3);
        let mut pixels: Vec<[f32; 3]> = (0..width * height)
            .map(|i| if i % 5 == 0 { [0.0; 3] } else { [0; 3].map(|_| random.unit() as f32) })
            .collect();
        pixels[width * (height / 3) + width / 4] = [500.0; 3];
        EnvironmentMap::new(width, height, pixels, InvalidPixels::Reject)
            .unwrap()
            .in_frame(Frame::GLTF)
    }

    #[test]
    fn the_density_is_a_density_and_misses_nothing_above_the_horizon() {
        for (width, height) in [(96, 48), (9, 5), (1, 1)] {
            let map = sky(width, height);
            for filter in [Filter::Nearest, Filter::Bilinear] {
                let lights = LightSampler::new(&map, filter).unwrap();
                let mut facing = lights.facing(DVec3::Y).unwrap();
                for normal in [DVec3::Z, DVec3::new(3.0, -4.0, 0.5)] {
                    assert!(facing.turn(normal));
                    let fine = 8;
                    let mut sum = 0.0;
                    for y in 0..fine * height {
                        for x in 0..fine * width {
                            let (x, y) =
                                ((x as f64 + 0.5) / fine as f64, (y as f64 + 0.5) / fine as f64);
                            let direction = map.direction(y as usize, x, y.fract());
                            let light = facing.evaluate(direction);
                            sum += light.pdf * map.solid_angle(y as usize) / (fine * fine) as f64;
                            let lit = direction.dot(normal) > 0.0 && light.radiance != [0.0; 3];
                            assert!(!lit || light.pdf > 0.0, "{direction} {normal}");
                        }
                    }
                    assert!((sum - 1.0).abs() < 2e-4, "{width} {filter:?} {sum}");
                }
            }
        }
    }

    #[test]
    fn estimates_are_the_same_with_less_error() {
        let map = sky(96, 48);
        let lights = LightSampler::new(&map, Filter::Nearest).unwrap();
        let normal = DVec3::new(0.0, 0.8, -0.6);
        let facing = lights.facing(normal).unwrap();
        let estimate = |light: EnvironmentSample| {
            let again = f64::from(light.radiance[1]) * light.direction.dot(normal).max(0.0);
            again / light.pdf
        };
        let mut random = SplitMix64::new(6);
        let n = 20_000;
        let (mut sums, mut squares) = ([0.0; 2], [0.0; 2]);
        for _ in 0..n {
            let at = [random.unit(), random.unit()];
            for (k, light) in [lights.sample(at), facing.sample(at)].into_iter().enumerate() {
                let pdf = [lights.pdf(light.direction), facing.evaluate(light.direction).pdf][k];
                assert!((pdf / light.pdf - 1.0).abs() < 1e-12);
                let value = estimate(light);
                (sums[k], squares[k]) = (sums[k] + value, squares[k] + value * value);
            }
        }
        let n = f64::from(n);
        let variance = [0, 1].map(|k| squares[k] / n - (sums[k] / n) * (sums[k] / n));
        let error = libm::sqrt((variance[0] + variance[1]) / n);
        assert!((sums[0] - sums[1]).abs() / n < 4.0 * error, "{sums:?} {error}");
        assert!(variance[1] < 0.25 * variance[0], "{variance:?}");
    }

    #[test]
    fn a_surface_that_faces_away_gets_nothing() {
        let mut pixels = alloc::vec![[0.0f32; 3]; 64 * 32];
        pixels[3] = [1.0; 3];
        let map = EnvironmentMap::new(64, 32, pixels, InvalidPixels::Reject).unwrap();
        let lights = LightSampler::new(&map, Filter::Nearest).unwrap();
        let mut facing = lights.facing(DVec3::Z).unwrap();
        for none in [DVec3::NEG_Z, DVec3::ZERO, DVec3::NAN] {
            assert!(lights.facing(none).is_none());
            assert!(!facing.turn(none));
            assert_eq!(facing.sample([0.5; 2]).pdf, 0.0);
            assert_eq!(facing.evaluate(DVec3::Z).pdf, 0.0);
        }
        assert!(facing.turn(1e300 * DVec3::Z));
        assert_eq!(
            facing.evaluate(facing.sample([0.5; 2]).direction).pdf,
            facing.sample([0.5; 2]).pdf
        );
    }
}
