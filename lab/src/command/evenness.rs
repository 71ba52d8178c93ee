//! Uniform point sets side by side: ours, relaxed and fixed, and what else is in use.
//!
//! Each line is the worst of a few sets of about COUNT (16,384) points: power at low frequency (white
//! noise = 1), mean and least nearest distance (hexagonal lattice = 1).

use glam::DVec2;
use twelvefold::Tables;
use twelvefold::bake::displacement::Displacements;
use twelvefold_lab::measure::{Evenness, Window, evenness};
use twelvefold_lab::random::Random;
use twelvefold_lab::rivals;
use twelvefold_lab::train::evaluate::{phase, uniform, worst};

use twelvefold_files::failure::Failure;

use crate::args::EvennessOptions;

/// Sets a line.
const SETS: u64 = 4;

/// Runs the subcommand.
pub(crate) fn run(options: &EvennessOptions) -> Result<(), Failure> {
    let count = options.points as usize;
    write_table(count).map_err(|error| Failure::about("evenness", error))
}

fn write_table(count: usize) -> Result<(), Box<dyn std::error::Error>> {
    println!("{:<28} {:>7} {:>7} {:>7}", "", "lowE", "dmean", "dmin");
    let print = |name: &str, measured: &[Evenness]| {
        if let Some(e) = worst(measured) {
            let (power, mean, least) = (e.low_frequency, e.mean_distance, e.least_distance);
            println!("{name:<28} {power:>7.4} {mean:>7.3} {least:>7.3}");
        }
    };

    let rules = Tables::built_in().rules();
    let table = Displacements::from_bytes(include_bytes!("../../../tables/relaxed.bin"))?;
    for (name, table) in [("relaxed", Some(&table)), ("fixed centers", None)] {
        let mut measured = Vec::new();
        for k in 0..16 {
            let mut random = Random::new(1, &[k]);
            let tau = phase(k as usize, 16);
            measured.extend(uniform(&rules, table, tau, count as f64, &mut random)?);
        }
        print(&format!("ours, {name}, 16 densities"), &measured);
    }

    // Sets of the unit square are measured inside it, so that border points have neighbors.
    let window = Window::UNIT.shrunk(0.03)?;
    let sets = |make: &dyn Fn(u64) -> Vec<DVec2>| -> Vec<Evenness> {
        (0..SETS).filter_map(|seed| evenness(&make(seed), window).ok()).collect()
    };
    let white = |seed| {
        let mut random = Random::new(seed, &[]);
        (0..count).map(|_| DVec2::new(random.unit(), random.unit())).collect()
    };
    print("white noise", &sets(&white));
    // Deterministic sequences: SETS stretches of each.
    let stretch = |at: fn(u32) -> DVec2| {
        let from = move |seed: u64| seed as u32 * count as u32;
        move |seed| (0..count as u32).map(|i| at(i + from(seed))).collect::<Vec<DVec2>>()
    };
    print("Halton", &sets(&stretch(rivals::halton)));
    let hammersley = |_| {
        let at = |i: u32| DVec2::new((f64::from(i) + 0.5) / count as f64, rivals::halton(i).x);
        (0..count as u32).map(at).collect()
    };
    print("Hammersley", &sets(&hammersley));
    print("R2", &sets(&stretch(rivals::r2)));
    let sobol =
        |seed| (0..count as u32).map(|i| rivals::sobol(i, seed as u32).as_dvec2()).collect();
    print("Owen-scrambled Sobol", &sets(&sobol));
    let poisson = |seed| rivals::poisson_disk(count, seed).iter().map(DVec2::from_array).collect();
    print("Poisson disk (Bridson)", &sets(&poisson));
    Ok(())
}
