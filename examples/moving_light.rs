//! A light moves over a 480 × 270 map for 600 frames: every frame the map changes, and points are made
//! anew. Prints the cost of a frame, allocations, and how many points appear or vanish where the map
//! did not change: none.
//!
//! `cargo run --release --example moving_light`

use std::collections::HashMap;
use std::error::Error;
use std::time::Instant;

use glam::Vec2;
use twelvefold::{
    Amount, ImageMap, InvalidPixels, PixelData, PixelView, Pixels, Placement, Sample, Sampling,
};

const WIDTH: usize = 480;
const HEIGHT: usize = 270;
const FRAMES: usize = 600;

/// Points a squared pixel where the importance is 1.
const DENSITY: f64 = 0.25;

/// A dim ramp, and a light of finite reach.
fn paint(frame: usize, pixels: &mut [f32]) {
    let turn = frame as f32 / FRAMES as f32 * std::f32::consts::TAU;
    let light = Vec2::new(240.0 + 160.0 * turn.cos(), 135.0 + 80.0 * (2.0 * turn).sin());
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let (x, y) = ((i % WIDTH) as f32, (i / WIDTH) as f32);
        let near = (1.0 - light.distance_squared(Vec2::new(x, y)) / 3600.0).max(0.0);
        *pixel = 0.1 + 0.2 * x / WIDTH as f32 + 2.0 * near * near;
    }
}

fn percentile(sorted: &[f64], part: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * part) as usize]
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut pixels = vec![0.0; WIDTH * HEIGHT];
    paint(0, &mut pixels);
    let mut map = Pixels::new(WIDTH, HEIGHT, pixels.clone(), InvalidPixels::Reject)
        .and_then(ImageMap::new)?;
    let placement = Placement::new(map.domain(), 1);
    let mut buffer = vec![Vec2::ZERO; 200_000];

    let mut before: HashMap<u64, Vec2> = HashMap::new();
    let mut old_pixels = pixels.clone();
    let (mut updates, mut fills) = (Vec::with_capacity(FRAMES), Vec::with_capacity(FRAMES));
    let (mut points, mut allocations) = (0, 0);
    let (mut kept, mut changed, mut flickering, mut moved) = (0u64, 0u64, 0u64, 0u64);
    for frame in 0..FRAMES {
        paint(frame, &mut pixels);
        // What a renderer would do each frame: timed, and its allocations counted.
        let mut outcome = Ok(());
        let allocated = allocation_counter::measure(|| {
            outcome = (|| -> Result<(), Box<dyn Error>> {
                let start = Instant::now();
                let view = PixelView::new(PixelData::F32(&pixels), WIDTH, HEIGHT)?;
                map.update(&view, InvalidPixels::Reject)?;
                updates.push(start.elapsed().as_secs_f64() * 1e6);
                let start = Instant::now();
                let sampling = Sampling::new(&placement, &map, Amount::Density(DENSITY))?;
                let filled = sampling.fill(&mut buffer)?;
                fills.push(start.elapsed().as_secs_f64() * 1e6);
                assert!(filled.complete);
                points += filled.written;
                Ok(())
            })();
        });
        outcome?;
        // The first frame warms up.
        if frame > 0 {
            allocations += allocated.count_total;
        }

        // Which points came and went, and whether the map had changed under them.
        let sampling = Sampling::new(&placement, &map, Amount::Density(DENSITY))?;
        let samples = sampling.points::<Vec2>()?.collect::<Result<Vec<Sample<Vec2>>, _>>()?;
        let now: HashMap<u64, Vec2> = samples.iter().map(|s| (s.rank, s.position)).collect();
        if frame > 0 {
            let same_pixel = |p: &Vec2| {
                let i = p.y as usize * WIDTH + p.x as usize;
                pixels[i].to_bits() == old_pixels[i].to_bits()
            };
            let appeared = now.iter().filter(|(rank, _)| !before.contains_key(rank));
            let vanished = before.iter().filter(|(rank, _)| !now.contains_key(rank));
            for (_, position) in appeared.chain(vanished) {
                changed += 1;
                flickering += u64::from(same_pixel(position));
            }
            for (rank, position) in &now {
                if let Some(old) = before.get(rank) {
                    kept += 1;
                    moved += u64::from(old != position);
                }
            }
        }
        before = now;
        old_pixels.copy_from_slice(&pixels);
    }

    updates.sort_by(f64::total_cmp);
    fills.sort_by(f64::total_cmp);
    println!("{FRAMES} frames, {} points a frame on average", points / FRAMES);
    for (name, times) in [("map update", &updates), ("points", &fills)] {
        let (median, late) = (percentile(times, 0.5), percentile(times, 0.99));
        println!("{name}: median {median:.0} µs, 99th percentile {late:.0} µs");
    }
    println!("allocations after warm-up: {allocations}");
    println!(
        "a frame keeps {} points and adds or removes {}; where the map did not change: {flickering}; \
         points that moved: {moved}",
        kept / (FRAMES as u64 - 1),
        changed / (FRAMES as u64 - 1),
    );
    Ok(())
}
