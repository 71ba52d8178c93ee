//! What is trained in which order.

use super::force::Law;
use super::random::Random;
use super::table::Table;
use super::train::{self, Pass, Stage};
use crate::tiling::{OutOfRange, Rules};

/// A grid of slots: segments of (first τ, generations, slots a unit), and single slots.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// See [`Table::zeros`].
    pub segments: Vec<(f64, usize, f64)>,
    /// See [`Table::zeros`].
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

/// All phases of one layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// The phases, in order.
    pub phases: Vec<Phase>,
}

impl Grid {
    fn zeros(&self) -> Table {
        Table::zeros(&self.segments, &self.extra)
    }
}

fn stage(
    sweeps: usize,
    sigma: f64,
    stiffness: f64,
    contact: f64,
    step: f32,
    settle: bool,
) -> Stage {
    let law = Law { sigma, stiffness, contact };
    Stage { sweeps, law, step, pull: 0.05, shrink: 0.0, settle }
}

impl Schedule {
    /// The smooth layer.
    #[must_use]
    pub fn smooth() -> Self {
        let grid = |segments: [(f64, usize, f64); 4]| Grid {
            segments: segments.to_vec(),
            extra: vec![(1.004, segments[0].1), (1.03, segments[0].1)],
        };
        let first = Pass {
            amplitude: 0.15,
            wavelength: 60.0,
            points: [40e3, 80e3],
            stages: vec![
                stage(25, 0.45, 0.0, 0.0, 0.22, false),
                stage(20, 0.40, 0.0, 0.0, 0.22, false),
                stage(30, 0.35, 0.0, 0.0, 0.22, true),
            ],
        };
        let hinged = |sweeps| Pass {
            amplitude: 0.12,
            stages: vec![stage(sweeps, 0.35, 2.0, 0.78, 0.14, true)],
            ..first.clone()
        };
        Self {
            phases: vec![
                Phase {
                    grid: grid([(1.0, 3, 20.0), (2.0, 2, 14.0), (3.0, 2, 7.0), (5.0, 2, 5.0)]),
                    passes: vec![first.clone(), hinged(35)],
                },
                Phase {
                    grid: grid([(1.0, 3, 20.0), (2.0, 2, 28.0), (3.0, 2, 12.0), (5.0, 2, 6.0)]),
                    passes: vec![hinged(30), hinged(30)],
                },
            ],
        }
    }

    /// The number of sweeps.
    #[must_use]
    pub fn sweeps(&self) -> usize {
        let passes = self.phases.iter().flat_map(|phase| &phase.passes);
        passes.flat_map(|pass| &pass.stages).map(|stage| stage.sweeps).sum()
    }

    /// Trains a layer.
    ///
    /// # Errors
    /// As [`train::pass`].
    pub fn train(
        &self,
        rules: &Rules,
        seed: u64,
        progress: &mut dyn FnMut(usize),
    ) -> Result<Option<Table>, OutOfRange> {
        let mut table: Option<Table> = None;
        let mut number = 0;
        for phase in &self.phases {
            let mut next = match table.take() {
                Some(table) => table.resampled(rules, phase.grid.zeros()),
                None => phase.grid.zeros(),
            };
            for pass in &phase.passes {
                number += 1;
                let seed = Random::new(seed, &[number]).bits();
                train::pass(rules, &mut next, pass, seed, progress)?;
            }
            table = Some(next);
        }
        Ok(table)
    }
}
