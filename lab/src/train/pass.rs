//! Passes of training: fresh patches, many sweeps, one step of every vector a sweep.

use glam::DVec2;
use rayon::prelude::*;

use super::field::{spacing, threshold_of_phase};
use super::force::{Law, Points, READS, Sum};
use super::image::Image;
use super::place::{Place, Region, density};
use super::procedural;
use super::ramp::Ramp;
use super::site::sites;
use super::table::Table;
use crate::random::Random;
use twelvefold::tiling::{OutOfRange, Rules};

/// Settings of one pass: fresh patches, then stages of sweeps over them.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The waves' amplitude in ln τ; half of it in every other patch.
    pub amplitude: f64,
    /// The waves' length in spacings; 0.6 of it in every other patch.
    pub wavelength: f64,
    /// Points a patch, at least and at most; 13,930·τ between.
    pub points: [f64; 2],
    /// Sweeps.
    pub stages: Vec<Stage>,
}

/// Sweeps under one law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// How many.
    pub sweeps: usize,
    /// The force.
    pub law: Law,
    /// The step, in spacings for a unit of mean force.
    pub step: f32,
    /// The part of the way to the neighbor slots that a vector is pulled each sweep.
    pub pull: f32,
    /// Whether step and pull fall to a tenth over the last 40 % of the sweeps.
    pub settle: bool,
}

/// The share of the last step that a vector keeps.
const MOMENTUM: f32 = 0.7;

/// The most that a vector moves in a sweep, in spacings: stiff contacts must not throw points across
/// their neighbors.
const LONGEST_STEP: f32 = 0.05;

/// Added to an entry's weight, so that rare classes move slowly.
const INERTIA: f32 = 3.0;

/// Below this weight an entry copies the next slot's.
const UNSEEN: f32 = 0.5;

/// Sweeps for which a list of pairs serves.
const LIST_EVERY: usize = 3;

/// Trains `table` on fresh patches, one an interval between slots. The result depends on the
/// arguments alone, not on the number of threads. `progress` is called after each sweep.
///
/// # Errors
/// [`OutOfRange`] for fields that need levels too deep for the ground; none of the ramps does.
pub fn pass(
    rules: &Rules,
    table: &mut Table,
    pass: &Pass,
    seed: u64,
    progress: &mut dyn FnMut(),
) -> Result<(), OutOfRange> {
    let intervals = table.slots().len() - 1;
    let mut patches = (0..intervals)
        .into_par_iter()
        .map(|i| patch(rules, table, pass, i, &mut Random::new(seed, &[i as u64])))
        .collect::<Result<Vec<_>, _>>()?;
    sweeps(table, &mut patches, &pass.stages, progress);
    Ok(())
}

/// Trains a rough layer on procedural images (see [`procedural`]) at phases spread over a level. Points read
/// `smooth` and `rough` mixed by the detail around them; only `rough` learns.
///
/// # Errors
/// As [`pass`].
pub fn image_pass(
    rules: &Rules,
    smooth: &Table,
    rough: &mut Table,
    images: &ImagePass,
    seed: u64,
    progress: &mut dyn FnMut(),
) -> Result<(), OutOfRange> {
    let mut patches = (0..images.patches)
        .into_par_iter()
        .map(|i| {
            let mut random = Random::new(seed, &[i as u64]);
            image_patch(rules, smooth, rough, images, i, &mut random)
        })
        .collect::<Result<Vec<_>, _>>()?;
    sweeps(rough, &mut patches, &images.stages, progress);
    Ok(())
}

fn image_patch(
    rules: &Rules,
    smooth: &Table,
    rough: &Table,
    images: &ImagePass,
    number: usize,
    random: &mut Random,
) -> Result<Points, OutOfRange> {
    let tau = super::evaluate::phase(number, images.patches);
    let values = procedural::image(random);
    let image = Image::accepting(values, procedural::SIDE, images.points, tau, images.acceptance);
    let Some(field) = image else {
        return Err(OutOfRange);
    };
    let half = field.half_extent();
    let margin = DVec2::splat(6.0 * spacing(threshold_of_phase(tau)));
    let ground = Place::random(rules, half.length(), random)?;
    let sites = sites(&ground, &field, Region::Rectangle(half))?;
    let mut points = Points::new(
        &sites,
        |site| {
            let mut reads = [(0, 0.0); READS];
            for (read, (entry, weight)) in reads.iter_mut().zip(rough.reads(site)) {
                *read = (entry, weight * site.detail as f32);
            }
            reads
        },
        |site| site.detail > 0.0 && (site.center.abs() + margin).cmplt(half).all(),
    );
    points.displace(|i| {
        let v = smooth.read(&sites[i]);
        v * (1.0 - sites[i].detail as f32)
    });
    Ok(points)
}

/// Settings of a pass on images.
#[derive(Clone, Debug, PartialEq)]
pub struct ImagePass {
    /// How many images.
    pub patches: usize,
    /// Points an image.
    pub points: f64,
    /// Half-side, in spacings, of the box whose mean decides on acceptance.
    pub acceptance: f64,
    /// The stages.
    pub stages: Vec<Stage>,
}

fn sweeps(table: &mut Table, patches: &mut [Points], stages: &[Stage], progress: &mut dyn FnMut()) {
    let mut velocities = vec![[0.0f32; 2]; table.vectors.len()];
    for stage in stages {
        let law = stage.law.table();
        for sweep in 0..stage.sweeps {
            let list = sweep < 6 || sweep % LIST_EVERY == 0;
            let vectors = &table.vectors;
            patches.par_iter_mut().for_each(|patch| patch.sweep(vectors, &law, list));
            // In the order of the patches, so that no sum depends on the threads.
            let mut sums = vec![Sum::default(); vectors.len()];
            for patch in patches.iter() {
                for (sum, more) in sums[patch.first..].iter_mut().zip(&patch.sums) {
                    sum.force += more.force;
                    sum.weight += more.weight;
                }
            }
            let left = (stage.sweeps - sweep) as f32 / stage.sweeps as f32;
            let settle = if stage.settle { (0.1 + 0.9 * left / 0.4).min(1.0) } else { 1.0 };
            update(table, &mut velocities, &sums, stage, settle);
            progress();
        }
    }
}

/// The patch of one interval, at a random place.
fn patch(
    rules: &Rules,
    table: &Table,
    pass: &Pass,
    interval: usize,
    random: &mut Random,
) -> Result<Points, OutOfRange> {
    let phases = [interval, interval + 1].map(|i| f64::from(table.slots()[i].tau));
    let middle = 0.5 * (phases[0] + phases[1]);
    let count = (13_930.0 * middle).clamp(pass.points[0], pass.points[1]);
    let threshold = threshold_of_phase(middle);
    let spacing = spacing(threshold);
    let radius = libm::sqrt(count / (core::f64::consts::PI * density(threshold)));
    let reach = radius + 4.0 * spacing;
    let ground = Place::random(rules, reach, random)?;
    let direction = |random: &mut Random| {
        let (s, c) = libm::sincos(core::f64::consts::TAU * random.unit());
        DVec2::new(c, s)
    };
    let odd = interval % 2 == 1;
    let (amplitude, length) = if odd {
        (0.5 * pass.amplitude, 0.6 * pass.wavelength)
    } else {
        (pass.amplitude, pass.wavelength)
    };
    let field = Ramp {
        phases,
        radius,
        along: direction(random),
        wave: direction(random) / (length * spacing),
        amplitude,
        start: random.unit(),
    };
    let sites = sites(&ground, &field, Region::Disc(reach))?;
    let none = (0, 0.0);
    Ok(Points::new(
        &sites,
        |site| {
            let mut reads = [none; READS];
            reads[..2].copy_from_slice(&table.reads(site));
            reads
        },
        |site| site.center.length() < radius,
    ))
}

fn update(
    table: &mut Table,
    velocities: &mut [[f32; 2]],
    sums: &[Sum],
    stage: &Stage,
    settle: f32,
) {
    let last = table.slots().len() - 1;
    // 1/√ρ in edges is 3.5955/√τ.
    let spacing_at_1 = spacing(threshold_of_phase(1.0)) as f32;
    for slot in 1..last {
        let step = stage.step * settle * spacing_at_1 / libm::sqrtf(table.slots()[slot].tau);
        let most = LONGEST_STEP * step / (stage.step * settle);
        for entry in table.range(slot) {
            let sum = &sums[entry];
            let gain = step / (sum.weight + INERTIA);
            let (velocity, vector) = (&mut velocities[entry], &mut table.vectors[entry]);
            for (k, force) in sum.force.to_array().into_iter().enumerate() {
                velocity[k] = MOMENTUM * velocity[k] + gain * force;
            }
            let length = libm::hypotf(velocity[0], velocity[1]);
            if length > most {
                *velocity = velocity.map(|v| v * (most / length));
            }
            for k in 0..2 {
                vector[k] += velocity[k];
            }
        }
    }
    let before = table.vectors.clone();
    for slot in (1..last).rev() {
        let (own, next) = (table.range(slot), table.range(slot + 1));
        let previous = table.range(slot - 1);
        let tau = |i: usize| table.slots()[i].tau;
        let share = (tau(slot) - tau(slot - 1)) / (tau(slot + 1) - tau(slot - 1));
        let (same_next, same_previous) = (own.len() == next.len(), own.len() == previous.len());
        let pull = stage.pull * settle;
        for class in 0..own.len() {
            let entry = own.start + class;
            if sums[entry].weight < UNSEEN {
                if same_next {
                    table.vectors[entry] = table.vectors[next.start + class];
                }
            } else if same_next && same_previous {
                let (a, b) = (before[previous.start + class], before[next.start + class]);
                for k in 0..2 {
                    let middle = a[k] + (b[k] - a[k]) * share;
                    let v = &mut table.vectors[entry][k];
                    *v += (middle - *v) * pull;
                }
            }
        }
    }
}
