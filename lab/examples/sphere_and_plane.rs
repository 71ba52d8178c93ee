//! Multiple importance sampling, shown: a glossy sphere on a chessboard under a sunny and an overcast sky,
//! with samples of the light, of the surface, and both.
//!
//! ```text
//! cargo run --release -p twelvefold-lab --example sphere_and_plane [PICTURE.png]
//! ```
//!
//! Writes the picture (two skies down; light, surface and both across; 16 samples a pixel) and prints the
//! noise that each way to sample light leaves at equal time.

use std::error::Error;
use std::time::Instant;

use glam::DVec3;
use twelvefold_lab::render::{Picture, Sky, Source, SourceKind, Strategy, render, sky};

/// A panel of the picture.
const PANEL: (usize, usize) = (320, 220);

/// What the table is measured on.
const SMALL: (usize, usize) = (80, 55);

/// Rows of the skies' maps.
const ROWS: usize = 256;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("sphere-and-plane.png".to_owned());
    let mut canvas = image::RgbImage::new(3 * PANEL.0 as u32, 2 * PANEL.1 as u32);
    println!("| sky, samples of | {} |", SourceKind::ALL.map(SourceKind::name).join(" | "));
    println!("|---|---:|---:|---:|---:|");
    for (row, kind) in [Sky::Sunny, Sky::Overcast].into_iter().enumerate() {
        let map = sky(kind, ROWS)?;
        let source = |kind, count| -> Result<Source<'_>, Box<dyn Error>> {
            Ok(Source::new(&map, kind, count)?.ok_or("the sky is black")?)
        };
        let few = source(SourceKind::SobolWarp, 16)?;
        for (column, strategy) in Strategy::ALL.into_iter().enumerate() {
            paint(&mut canvas, (column, row), &render(&few, strategy, PANEL, 1));
        }
        let truth = render(&source(SourceKind::SobolWarp, 8192)?, Strategy::Both, SMALL, 9);
        for strategy in Strategy::ALL {
            print!("| {kind:?}, {} |", strategy.name());
            // As much time as 64 samples of the first take.
            let mut budget = None;
            for kind in SourceKind::ALL {
                let trial = source(kind, 64)?;
                let seconds =
                    (0..5).map(|seed| timed(&trial, strategy, seed).1).fold(1e9, f64::min);
                let budget = *budget.get_or_insert(seconds);
                // A multiple of four, for the seamless sets.
                let count = ((64.0 * budget / seconds / 4.0).round() as usize).max(1) * 4;
                let source = source(kind, count)?;
                let (mut squares, mut least) = (0.0, f64::INFINITY);
                for seed in 10..14 {
                    let (picture, seconds) = timed(&source, strategy, seed);
                    squares += error(&picture, &truth) / 4.0;
                    least = least.min(seconds);
                }
                print!(" {:.2} % ({count}) |", 100.0 * squares.sqrt());
            }
            println!();
        }
    }
    canvas.save(&path)?;
    println!("\n{path} is written");
    Ok(())
}

fn timed(source: &Source<'_>, strategy: Strategy, seed: u64) -> (Picture, f64) {
    let start = Instant::now();
    let picture = render(source, strategy, SMALL, seed);
    (picture, start.elapsed().as_secs_f64())
}

/// Mean square of the relative error, against the mean of the picture where it is darker than that.
fn error(picture: &Picture, truth: &Picture) -> f64 {
    let count = truth.pixels.len() as f64;
    let mean = truth.pixels.iter().map(|pixel| pixel.y).sum::<f64>() / count;
    let relative = |(found, true_value): (&DVec3, &DVec3)| {
        let error = (found.y - true_value.y) / true_value.y.max(mean);
        error * error
    };
    picture.pixels.iter().zip(&truth.pixels).map(relative).sum::<f64>() / count
}

/// Puts a panel on the canvas, with light compressed as c/(1 + c) and encoded for a display.
fn paint(canvas: &mut image::RgbImage, (column, row): (usize, usize), picture: &Picture) {
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let (x, y) = (i % picture.width, i / picture.width);
        let tone = |c: f64| (255.0 * (1.6 * c / (1.0 + 1.6 * c)).powf(1.0 / 2.2)).round() as u8;
        let color = image::Rgb(pixel.to_array().map(tone));
        canvas.put_pixel((column * PANEL.0 + x) as u32, (row * PANEL.1 + y) as u32, color);
    }
}
