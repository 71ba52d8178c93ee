//! Dots of several classes side by side: ours, bands of rank, and a random split.
//!
//! Each line is of one class, or of all dots together: their number, power at low frequency (white noise = 1),
//! mean and least nearest distance (hexagonal lattice of as many = 1).

use glam::DVec2;
use twelvefold::refine::{ClassRefiner, Classes, ITERATIONS, refine};
use twelvefold::{Amount, InvalidPixels, Pixels, Placement, Sample, Sampling, StippleMap};
use twelvefold_files::failure::Failure;
use twelvefold_lab::measure::{Window, evenness};
use twelvefold_lab::random::Random;

use crate::args::ClassesOptions;

/// Side of the picture, in pixels.
const SIDE: usize = 256;

/// Shares of the classes: alike, and as unlike as those of inks.
const SHARES: [&[f32]; 3] = [&[0.5, 0.5], &[0.25, 0.25, 0.25, 0.25], &[0.5, 0.3, 0.15, 0.05]];

/// Runs the subcommand.
pub(crate) fn run(options: &ClassesOptions) -> Result<(), Failure> {
    write_table(options).map_err(|error| Failure::about("classes", error))
}

fn write_table(options: &ClassesOptions) -> Result<(), Box<dyn std::error::Error>> {
    println!("{:<16} {:<7} {:>6} {:>7} {:>7} {:>7}", "", "", "dots", "lowE", "dmean", "dmin");
    let ranked = ranked(f64::from(options.points))?;
    let mut refined = ranked.clone();
    refine(&mut refined, SIDE, SIDE, &vec![1.0; SIDE * SIDE], ITERATIONS)?;
    for shares in SHARES {
        println!("shares {shares:?}");
        let mut bands = Vec::new();
        let mut end = 0.0;
        for (class, share) in shares.iter().enumerate() {
            end += share;
            let most = (f64::from(end) * ranked.len() as f64).round() as usize;
            bands.resize(most.min(ranked.len()), class as u8);
        }
        bands.resize(ranked.len(), 0);
        print("bands of rank", shares, &ranked, &bands)?;

        let mut random = bands.clone();
        let mut draw = Random::new(1, &[]);
        for i in (1..random.len()).rev() {
            random.swap(i, (draw.unit() * (i + 1) as f64) as usize);
        }
        print("random split", shares, &refined, &random)?;

        let planes = shares.iter().map(|share| vec![*share; SIDE * SIDE]).collect();
        let classes = Classes::new(SIDE, SIDE, planes)?;
        let (mut dots, mut class) = (refined.clone(), bands.clone());
        let mut refiner = ClassRefiner::new(&classes, &dots)?;
        refiner.write(&mut dots, &mut class)?;
        print("exchanged", shares, &dots, &class)?;
        for _ in 0..options.iterations {
            refiner.step();
        }
        refiner.write(&mut dots, &mut class)?;
        print("refined", shares, &dots, &class)?;
        refiner.polish()?;
        refiner.write(&mut dots, &mut class)?;
        print("polished", shares, &dots, &class)?;
    }
    Ok(())
}

/// Even dots in the order of their ranks.
fn ranked(count: f64) -> Result<Vec<DVec2>, Box<dyn std::error::Error>> {
    let pixels = vec![1.0; SIDE * SIDE];
    let map = StippleMap::new(Pixels::new(SIDE, SIDE, pixels, InvalidPixels::Reject)?, count)?;
    let placement = Placement::new(map.domain(), 0);
    let sampling = Sampling::new(&placement, &map, Amount::Points(count))?.relaxed()?;
    let mut samples = Vec::new();
    for sample in sampling.points()? {
        let Sample::<DVec2> { position, rank } = sample?;
        samples.push((rank, position));
    }
    samples.sort_by_key(|(rank, _)| *rank);
    Ok(samples.into_iter().map(|(_, position)| position).collect())
}

fn print(
    method: &str,
    shares: &[f32],
    dots: &[DVec2],
    class_of: &[u8],
) -> Result<(), Box<dyn std::error::Error>> {
    let window = Window::new(DVec2::ZERO, DVec2::splat(SIDE as f64))?.shrunk(0.03 * SIDE as f64)?;
    let line = |what: &str, dots: &[DVec2]| -> Result<(), Box<dyn std::error::Error>> {
        let e = evenness(dots, window)?;
        println!(
            "{method:<16} {what:<7} {:>6} {:>7.3} {:>7.3} {:>7.3}",
            dots.len(),
            e.low_frequency,
            e.mean_distance,
            e.least_distance
        );
        Ok(())
    };
    line("all", dots)?;
    for (class, share) in shares.iter().enumerate() {
        let own = dots.iter().zip(class_of).filter(|(_, of)| usize::from(**of) == class);
        let own: Vec<DVec2> = own.map(|(dot, _)| *dot).collect();
        line(&format!("{share}"), &own)?;
    }
    Ok(())
}
