//! Uniform point sets side by side: ours, relaxed and fixed, and what else is in use.
//!
//! ```text
//! cargo run --release --example evenness [COUNT]
//! ```
//!
//! Each line is the worst of a few sets of about COUNT (16,384) points: power at low frequency (white
//! noise = 1), mean and least nearest distance (hexagonal lattice = 1).

use glam::DVec2;
use twelvefold::Tables;
use twelvefold::bake::displacement::Displacements;
use twelvefold_lab::measure::{Evenness, Window, evenness};
use twelvefold_lab::random::Random;
use twelvefold_lab::train::report::{phase, uniform, worst};

/// Sets a line.
const SETS: u64 = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: usize = std::env::args().nth(1).map_or(Ok(16_384), |text| text.parse())?;
    println!("{:<28} {:>7} {:>7} {:>7}", "", "lowE", "dmean", "dmin");
    let print = |name: &str, measured: &[Evenness]| {
        if let Some(e) = worst(measured) {
            let (power, mean, least) = (e.low_frequency, e.mean_distance, e.least_distance);
            println!("{name:<28} {power:>7.4} {mean:>7.3} {least:>7.3}");
        }
    };

    let rules = Tables::built_in().rules();
    let table = Displacements::from_bytes(include_bytes!("../../tables/relaxed.bin"))?;
    for (name, table) in [("relaxed", Some(&table)), ("fixed centres", None)] {
        let mut measured = Vec::new();
        for k in 0..16 {
            let mut random = Random::new(1, &[k]);
            let tau = phase(k as usize, 16);
            measured.extend(uniform(&rules, table, tau, count as f64, &mut random)?);
        }
        print(&format!("ours, {name}, 16 densities"), &measured);
    }

    // Sets of the unit square are measured inside it, so that border points have neighbours.
    let window = Window::new(DVec2::ZERO, DVec2::ONE).shrunk(0.03);
    let sets = |make: &dyn Fn(u64) -> Vec<DVec2>| -> Vec<Evenness> {
        (0..SETS).filter_map(|seed| evenness(&make(seed), window)).collect()
    };
    let indexed = |at: &dyn Fn(usize) -> DVec2| -> Vec<DVec2> { (0..count).map(at).collect() };
    let white = |seed| {
        let mut random = Random::new(seed, &[]);
        (0..count).map(|_| DVec2::new(random.unit(), random.unit())).collect()
    };
    print("white noise", &sets(&white));
    // Deterministic sequences: SETS stretches of each.
    let halton = |seed| {
        indexed(&|i| {
            let i = i + seed as usize * count;
            DVec2::new(radical_inverse(2, i), radical_inverse(3, i))
        })
    };
    print("Halton", &sets(&halton));
    let hammersley =
        |_| indexed(&|i| DVec2::new((i as f64 + 0.5) / count as f64, radical_inverse(2, i)));
    print("Hammersley", &sets(&hammersley));
    let r2 = |seed| {
        indexed(&|i| {
            // Roberts 2018: the plastic constant's powers.
            const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
            let p = STEP * (i + 1 + seed as usize * count) as f64;
            p - p.floor()
        })
    };
    print("R2", &sets(&r2));
    let sobol = |seed| {
        indexed(&|i| {
            let at = |d| f64::from(sobol_burley::sample(i as u32, d, seed as u32));
            DVec2::new(at(0), at(1))
        })
    };
    print("Owen-scrambled Sobol", &sets(&sobol));
    let poisson = |seed| poisson_disk(count, seed);
    print("Poisson disk (Bridson)", &sets(&poisson));
    Ok(())
}

/// Van der Corput: the digits of i mirrored at the point.
fn radical_inverse(base: usize, mut i: usize) -> f64 {
    let (mut value, mut unit) = (0.0, 1.0);
    while i > 0 {
        unit /= base as f64;
        value += (i % base) as f64 * unit;
        i /= base;
    }
    value
}

/// About `count` points, by the density that Bridson's algorithm reaches: 0.7 of the square a radius.
fn poisson_disk(count: usize, seed: u64) -> Vec<DVec2> {
    let radius = (0.7 / count as f64).sqrt();
    fast_poisson::Poisson2D::new()
        .with_dimensions([1.0, 1.0], radius)
        .with_seed(seed)
        .generate()
        .into_iter()
        .map(DVec2::from)
        .collect()
}
