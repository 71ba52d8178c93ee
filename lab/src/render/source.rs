//! Where a pixel's samples come from: the ways to sample light that are compared.

use glam::{DVec2, DVec3};
use rand::SeedableRng as _;
use rand::distr::Distribution as _;
use rand::rngs::SmallRng;
use rand_distr::weighted::WeightedAliasIndex;
use twelvefold::estimate::SeamlessSet;
use twelvefold::light::{Filter, LightSampler, Sobol};
use twelvefold::{EnvironmentMap, EnvironmentSample, Limits, SamplingError};

use crate::random::Random;
use crate::rivals::{self, InverseCdf};

/// A way to sample light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// An alias table, with white noise.
    Alias,
    /// Inverted cumulative sums, rows first, with Owen-scrambled Sobol points: pbrt's way.
    InverseCdf,
    /// This library's warp with its Sobol points.
    SobolWarp,
    /// This library's warp with a seamless set of the tiling, shifted anew for each pixel.
    SeamlessWarp,
}

impl SourceKind {
    /// All.
    pub const ALL: [Self; 4] = [Self::Alias, Self::InverseCdf, Self::SobolWarp, Self::SeamlessWarp];

    /// As in a table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Alias => "alias table, white noise",
            Self::InverseCdf => "inverse CDF, Owen Sobol",
            Self::SobolWarp => "warp, Sobol",
            Self::SeamlessWarp => "warp, seamless set",
        }
    }
}

/// Point i of the Owen-scrambled Sobol sequence.
fn sobol(i: usize, seed: u64) -> [f64; 2] {
    rivals::sobol(i as u32, seed as u32).as_dvec2().to_array()
}

/// Samples of an environment's light, `count` a pixel, and as many pairs of numbers for its surface.
#[derive(Debug)]
pub struct Source<'m> {
    kind: SourceKind,
    map: &'m EnvironmentMap,
    count: usize,
    alias: WeightedAliasIndex<f32>,
    inverse: InverseCdf<f64>,
    lights: LightSampler<&'m EnvironmentMap>,
    set: SeamlessSet,
}

impl<'m> Source<'m> {
    /// Of a map that is not black; `None` if it is.
    ///
    /// # Errors
    /// [`SamplingError`] for a count past the limits of a seamless set.
    pub fn new(
        map: &'m EnvironmentMap,
        kind: SourceKind,
        count: usize,
    ) -> Result<Option<Self>, SamplingError> {
        let set = SeamlessSet::new(count, Limits::default())?;
        let importance = map.importance();
        let alias = WeightedAliasIndex::new(importance.pixels().to_vec()).ok();
        let lights = LightSampler::new(map, Filter::Nearest);
        Ok(alias.zip(lights).map(|(alias, lights)| Self {
            kind,
            map,
            count,
            alias,
            inverse: InverseCdf::new(importance),
            lights,
            set,
        }))
    }

    /// Samples a pixel.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The light from a direction, and its density.
    pub(super) fn evaluate(&self, direction: DVec3) -> EnvironmentSample {
        self.lights.evaluate(direction)
    }

    /// Calls `light` with each of a pixel's light samples.
    pub(super) fn lights(&self, pixel: u64, mut light: impl FnMut(EnvironmentSample)) {
        match self.kind {
            SourceKind::Alias => {
                let seed = 2 * pixel;
                let mut random = Random::new(seed, &[]);
                let mut texels = SmallRng::seed_from_u64(seed);
                let (width, _) = self.map.size();
                for _ in 0..self.count {
                    let index = self.alias.sample(&mut texels);
                    let corner = DVec2::new((index % width) as f64, (index / width) as f64);
                    light(self.map.sample(corner + random.point()));
                }
            }
            SourceKind::InverseCdf => {
                for i in 0..self.count {
                    let at = self.inverse.position(sobol(i, 2 * pixel));
                    light(self.map.sample(at.into()));
                }
            }
            SourceKind::SobolWarp => {
                let points = Sobol::new(2 * pixel);
                (0..self.count as u32).for_each(|i| light(self.lights.sample(points.point(i))));
            }
            SourceKind::SeamlessWarp => {
                let points = self.set.points(2 * pixel);
                points.for_each(|point| light(self.lights.sample(point.to_array())));
            }
        }
    }

    /// Calls `take` with each of a pixel's pairs of uniform numbers for its surface.
    pub(super) fn pairs(&self, pixel: u64, mut take: impl FnMut([f64; 2])) {
        let seed = 2 * pixel + 1;
        match self.kind {
            SourceKind::Alias => {
                let mut random = Random::new(seed, &[]);
                (0..self.count).for_each(|_| take(random.point().to_array()));
            }
            SourceKind::InverseCdf => {
                (0..self.count).for_each(|i| take(sobol(i, seed)));
            }
            SourceKind::SobolWarp => {
                let points = Sobol::new(seed);
                (0..self.count as u32).for_each(|i| take(points.point(i)));
            }
            SourceKind::SeamlessWarp => {
                self.set.points(seed).for_each(|point| take(point.to_array()));
            }
        }
    }
}
