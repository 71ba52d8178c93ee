//! What is trained in which order.

use core::fmt;

use super::force::Law;
use super::pass::{self, ImagePass, Pass, Stage};
use super::table::Table;
use crate::random::Random;
use twelvefold::bake::displacement::{DisplacementError, Displacements};
use twelvefold::importance::StippleMap;
use twelvefold::tiling::{OutOfRange, Rules, TileType};

/// A grid of slots: segments of (first τ, generations, slots a unit of τ), each up to the next one's
/// first τ, the last up to δ; and single slots (τ, generations).
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The segments, the first from τ = 1.
    pub segments: Vec<(f64, usize, f64)>,
    /// Slots between.
    pub extra: Vec<(f64, usize)>,
}

/// Passes over one grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// The grid; the table of the phase before is resampled onto it.
    pub grid: Grid,
    /// The passes.
    pub passes: Vec<Pass>,
}

/// All that is trained.
#[derive(Clone, Debug, PartialEq)]
pub struct Recipe {
    /// The smooth layer's phases, in order; at least one.
    pub smooth: Vec<Phase>,
    /// The rough layer's grid and passes, trained after the smooth layer and starting from it.
    pub rough: Option<(Grid, Vec<ImagePass>)>,
}

/// Why training failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TrainError {
    /// A coordinate left its range: a recipe with phases far outside [1, δ].
    Range(OutOfRange),
    /// The result is no valid table: a recipe with an impossible grid, or without a phase.
    Table(DisplacementError),
}

impl fmt::Display for TrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for TrainError {}

impl From<OutOfRange> for TrainError {
    fn from(error: OutOfRange) -> Self {
        Self::Range(error)
    }
}

impl From<DisplacementError> for TrainError {
    fn from(error: DisplacementError) -> Self {
        Self::Table(error)
    }
}

impl Grid {
    fn zeros(&self) -> Table {
        Table::zeros(&self.segments, &self.extra)
    }
}

/// A stage of `sweeps` under exp(−r²/2σ²)·r/σ, with contacts of (stiffness, reach) in spacings.
fn stage(sweeps: usize, sigma: f64, contacts: (f64, f64), step: f32) -> Stage {
    let law = Law { sigma, stiffness: contacts.0, contact: contacts.1 };
    Stage { sweeps, law, step, pull: 0.05, settle: true }
}

const NO_CONTACTS: (f64, f64) = (0.0, 0.0);

impl Recipe {
    /// What `tables/relaxed.bin` is trained with: minutes on two cores.
    ///
    /// Soft forces bring the points into order on a coarse grid. Then, on a finer grid, contacts
    /// raise the least distances: each member of a class pushes its share, so contacts that only a
    /// few members have must be stiff to count, and the step small to keep stiff contacts stable.
    /// Below τ = 3, where a new point displaces many, a class spans three generations.
    #[must_use]
    pub fn standard() -> Self {
        let coarse = Grid {
            segments: vec![(1.0, 3, 20.0), (2.0, 2, 14.0), (3.0, 2, 10.0), (5.0, 2, 7.0)],
            extra: vec![(1.004, 3), (1.03, 3)],
        };
        let fine = Grid {
            segments: vec![
                (1.0, 3, 52.0),
                (1.25, 3, 22.0),
                (2.0, 3, 18.0),
                (3.0, 2, 20.0),
                (5.0, 2, 9.0),
            ],
            extra: vec![(1.004, 3)],
        };
        let soft = Pass {
            amplitude: 0.15,
            wavelength: 60.0,
            points: [40e3, 60e3],
            stages: vec![
                stage(25, 0.45, NO_CONTACTS, 0.22),
                stage(20, 0.40, NO_CONTACTS, 0.22),
                stage(30, 0.35, NO_CONTACTS, 0.22),
            ],
        };
        let stiff = |points, sweeps, sigma, contacts, step| Pass {
            amplitude: 0.12,
            wavelength: 60.0,
            points,
            stages: vec![stage(sweeps, sigma, contacts, step)],
        };
        let images = |patches, stages| ImagePass {
            patches,
            points: 40e3,
            // A little less averaging than in use: the layer meets somewhat rougher sets.
            acceptance: 0.6,
            stages,
        };
        Self {
            smooth: vec![
                Phase { grid: coarse, passes: vec![soft] },
                Phase {
                    grid: fine,
                    passes: vec![
                        stiff([40e3, 50e3], 24, 0.35, (10.0, 0.86), 0.14),
                        stiff([40e3, 50e3], 30, 0.35, (30.0, 0.86), 0.05),
                        // The more points, the rarer the neighborhoods that are seen.
                        stiff([60e3, 70e3], 36, 0.37, (70.0, 0.85), 0.022),
                    ],
                },
            ],
            rough: Some((
                Grid {
                    segments: vec![(1.0, 2, 6.0), (2.0, 2, 4.0), (3.0, 2, 3.0), (5.0, 2, 1.5)],
                    extra: Vec::new(),
                },
                vec![
                    images(
                        32,
                        vec![stage(30, 0.45, NO_CONTACTS, 0.2), stage(30, 0.40, (2.0, 0.65), 0.15)],
                    ),
                    images(80, vec![stage(50, 0.38, (12.0, 0.75), 0.08)]),
                ],
            )),
        }
    }

    /// A recipe of seconds, for tests: a few sweeps of a few small patches on a coarse grid.
    #[must_use]
    pub fn tiny() -> Self {
        let grid =
            Grid { segments: vec![(1.0, 3, 4.0), (2.0, 2, 2.0), (5.0, 2, 0.5)], extra: Vec::new() };
        let pass = Pass {
            amplitude: 0.15,
            wavelength: 30.0,
            points: [2e3, 2e3],
            stages: vec![stage(10, 0.45, NO_CONTACTS, 0.2), stage(4, 0.4, (4.0, 0.8), 0.1)],
        };
        let images = ImagePass {
            patches: 4,
            points: 2e3,
            acceptance: StippleMap::ACCEPTANCE,
            stages: vec![stage(4, 0.4, NO_CONTACTS, 0.2)],
        };
        Self {
            smooth: vec![Phase { grid: grid.clone(), passes: vec![pass] }],
            rough: Some((grid, vec![images])),
        }
    }

    /// The number of sweeps, each of which is reported as progress.
    #[must_use]
    pub fn sweeps(&self) -> usize {
        let smooth = self.smooth.iter().flat_map(|phase| &phase.passes).map(|pass| &pass.stages);
        let rough = self.rough.iter().flat_map(|(_, passes)| passes).map(|pass| &pass.stages);
        smooth.chain(rough).flatten().map(|stage| stage.sweeps).sum()
    }

    /// Trains a table. The result depends on the rules, the recipe and the seed alone, not on the number
    /// of threads. `progress` is called once a sweep.
    ///
    /// # Errors
    /// [`TrainError`] for recipes with impossible grids.
    pub fn train(
        &self,
        rules: &Rules,
        seed: u64,
        provenance: String,
        progress: &mut dyn FnMut(),
    ) -> Result<Displacements, TrainError> {
        let mut number = 0;
        let mut next_seed = || {
            number += 1;
            Random::new(seed, &[number]).bits()
        };
        let mut smooth: Option<Table> = None;
        for phase in &self.smooth {
            let zeros = phase.grid.zeros();
            let mut table = match smooth.take() {
                Some(before) => before.resampled(rules, zeros),
                None => zeros,
            };
            for pass in &phase.passes {
                pass::pass(rules, &mut table, pass, next_seed(), progress)?;
            }
            smooth = Some(table);
        }
        let smooth =
            smooth.ok_or(TrainError::Table(DisplacementError::SlotCount { layer: 0, found: 0 }))?;
        let rough = match &self.rough {
            Some((grid, passes)) => {
                let mut table = smooth.resampled(rules, grid.zeros());
                for pass in passes {
                    pass::image_pass(rules, &smooth, &mut table, pass, next_seed(), progress)?;
                }
                Some(table.quantized(1)?)
            }
            None => None,
        };
        let mut digits = [[0; 14]; 4];
        for kind in TileType::ALL {
            let own = rules.digits().of(kind);
            digits[kind.index()][..own.len()].copy_from_slice(own);
        }
        Ok(Displacements { digits, provenance, smooth: smooth.quantized(0)?, rough })
    }
}
