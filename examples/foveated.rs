//! Foveated rendering: where the viewer looks, a sample a pixel; the farther away, the fewer. The gaze
//! moves; each frame the importance is computed anew and points are made from it. Writes a PNG a frame.
//!
//! `cargo run --release --example foveated -- FOLDER [FRAMES]`

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use glam::Vec2;
use twelvefold::{Amount, ImageMap, InvalidPixels, PixelData, PixelView, Placement, Sampling};

const WIDTH: usize = 960;
const HEIGHT: usize = 540;

/// Pixels of the screen in one of the importance map on each side: acuity varies slowly.
const COARSE: usize = 4;

/// Samples a pixel where the viewer looks, and the distance in pixels at which acuity has halved.
const SHARPEST: f64 = 0.5;
const HALF: f32 = 60.0;

/// Where the viewer looks, in pixels: an eight.
fn gaze(turn: f32) -> Vec2 {
    let angle = turn * std::f32::consts::TAU;
    Vec2::new(480.0 + 330.0 * angle.sin(), 270.0 + 170.0 * (2.0 * angle).sin())
}

/// Acuity falls as 1/(1 + distance/half), so samples an area by its square.
fn paint(gaze: Vec2, map: &mut [f32]) {
    for (i, value) in map.iter_mut().enumerate() {
        let at = Vec2::new((i % (WIDTH / COARSE)) as f32, (i / (WIDTH / COARSE)) as f32) + 0.5;
        let acuity = 1.0 / (1.0 + gaze.distance(at * COARSE as f32) / HALF);
        *value = acuity * acuity;
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (folder, frames) = match &arguments[..] {
        [folder] => (folder, 8),
        [folder, frames] => (folder, frames.parse::<usize>()?),
        _ => return Err("usage: foveated FOLDER [FRAMES]".into()),
    };
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;

    let (wide, high) = (WIDTH / COARSE, HEIGHT / COARSE);
    let mut acuity = vec![0.0; wide * high];
    paint(gaze(0.0), &mut acuity);
    let screen =
        twelvefold::Domain::new(glam::DVec2::ZERO, glam::DVec2::new(WIDTH as f64, HEIGHT as f64))?;
    let mut map = ImageMap::new(wide, high, acuity.clone(), InvalidPixels::Reject)?.over(screen);
    let placement = Placement::new(screen, 1);
    let mut buffer = vec![Vec2::ZERO; WIDTH * HEIGHT];
    for frame in 0..frames {
        paint(gaze(frame as f32 / frames as f32), &mut acuity);
        let start = Instant::now();
        let view =
            PixelView::new(PixelData::F32(&acuity), wide, high).ok_or("a view of the map")?;
        map.update(&view, InvalidPixels::Reject)?;
        let sampling = Sampling::new(&placement, &map, Amount::Density(SHARPEST))?.relaxed()?;
        let filled = sampling.fill(&mut buffer)?;
        let time = start.elapsed().as_secs_f64() * 1e6;

        let mut pixels = vec![255u8; WIDTH * HEIGHT];
        for point in &buffer[..filled.written] {
            pixels[point.y as usize * WIDTH + point.x as usize] = 0;
        }
        let path = folder.join(format!("frame-{frame:03}.png"));
        let file = std::io::BufWriter::new(std::fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, WIDTH as u32, HEIGHT as u32);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header()?.write_image_data(&pixels)?;
        println!("frame {frame}: {} samples in {time:.0} µs", filled.written);
    }
    Ok(())
}
