//! Trees over a terrain: dense in valleys, none on cliffs, above the tree line or in the lake. Writes them
//! as points with normals (PLY), and a picture of them seen from above (PNG).
//!
//! `cargo run --release --example scatter -- trees.ply trees.png`

use std::error::Error;
use std::fmt::Write as _;
use std::time::Instant;

use glam::{DVec2, DVec3, Vec2};
use twelvefold::{Amount, Domain, ImageMap, InvalidPixels, Placement, Sampling};

/// The terrain is a square of so many meters, its heights a grid of so many nodes a side.
const METRES: f64 = 4000.0;
const SIDE: usize = 512;

const TREES: f64 = 10_000.0;

/// Meters: the lake, and where trees end.
const WATER: f64 = 90.0;
const TREE_LINE: f64 = 480.0;

/// Heights, with slopes by differences.
struct Terrain {
    heights: Vec<f64>,
}

impl Terrain {
    /// Hills of several sizes: smooth noise, each octave half as wide and half as high.
    fn new() -> Self {
        let corner = |octave: i64, x: i64, y: i64| {
            let mut z = (octave * 0x51_7cc1 + x * 0x27_d4eb + y * 0x16_5667) as u64;
            z = (z ^ (z >> 15)).wrapping_mul(0xd168_aaad_9e37_79b9);
            ((z ^ (z >> 32)) & 0xffff) as f64 / 65_535.0
        };
        let noise = |octave: i64, p: DVec2| {
            let (cell, part) = (p.floor(), p - p.floor());
            let smooth = part * part * (3.0 - 2.0 * part);
            let at = |dx, dy| corner(octave, cell.x as i64 + dx, cell.y as i64 + dy);
            let upper = at(0, 0) + smooth.x * (at(1, 0) - at(0, 0));
            let lower = at(0, 1) + smooth.x * (at(1, 1) - at(0, 1));
            upper + smooth.y * (lower - upper)
        };
        let height = |i: usize| {
            let p = DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) / SIDE as f64;
            (0..7).map(|k| 420.0 * 0.5f64.powi(k) * noise(k.into(), p * 3.0 * 2f64.powi(k))).sum()
        };
        Self { heights: (0..SIDE * SIDE).map(height).collect() }
    }

    fn node(&self, x: usize, y: usize) -> f64 {
        self.heights[y.min(SIDE - 1) * SIDE + x.min(SIDE - 1)]
    }

    /// Height in meters at a place in meters, and the normal there.
    fn at(&self, place: DVec2) -> (f64, DVec3) {
        let p = (place / METRES * SIDE as f64 - 0.5)
            .clamp(DVec2::ZERO, DVec2::splat(SIDE as f64 - 1.0));
        let (x, y) = (p.x as usize, p.y as usize);
        let part = p - p.floor();
        let [a, b] = [self.node(x, y), self.node(x + 1, y)];
        let [c, d] = [self.node(x, y + 1), self.node(x + 1, y + 1)];
        let (upper, lower) = (a + part.x * (b - a), c + part.x * (d - c));
        let step = METRES / SIDE as f64;
        let right = ((b - a) * (1.0 - part.y) + (d - c) * part.y) / step;
        let down = ((c - a) * (1.0 - part.x) + (d - b) * part.x) / step;
        (upper + part.y * (lower - upper), DVec3::new(-right, -down, 1.0).normalize())
    }

    /// How many trees a node wants, from 0 to 1: fewer the steeper and the higher.
    fn wish(&self, place: DVec2) -> f32 {
        let (height, normal) = self.at(place);
        if height < WATER {
            return 0.0;
        }
        let level = ((normal.z - 0.8) / 0.2).clamp(0.0, 1.0);
        let low = ((TREE_LINE - height) / (TREE_LINE - WATER)).clamp(0.0, 1.0);
        // A density over the map; on a slope, trees stand on more ground than the map shows.
        (level * low) as f32
    }
}

/// A tree: where it stands, and which way is up from the ground.
struct Tree {
    place: DVec3,
    normal: DVec3,
}

fn ply(trees: &[Tree]) -> String {
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\nend_header\n",
        trees.len()
    );
    for Tree { place, normal } in trees {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:.3} {:.3} {:.3} {:.4} {:.4} {:.4}",
            place.x, place.y, place.z, normal.x, normal.y, normal.z
        );
    }
    text
}

/// The terrain lit from the upper left, trees as dark dots.
fn picture(terrain: &Terrain, trees: &[Tree], side: usize) -> Vec<u8> {
    let light = DVec3::new(-0.6, -0.6, 0.6).normalize();
    let mut pixels = Vec::with_capacity(3 * side * side);
    for i in 0..side * side {
        let pixel = DVec2::new((i % side) as f64 + 0.5, (i / side) as f64 + 0.5);
        let (height, normal) = terrain.at(pixel / side as f64 * METRES);
        let shade = 0.35 + 0.65 * normal.dot(light).max(0.0);
        let color = if height < WATER {
            DVec3::new(70.0, 110.0, 150.0)
        } else {
            let bare = ((height - WATER) / (TREE_LINE - WATER)).clamp(0.0, 1.0);
            shade * DVec3::new(190.0, 200.0, 150.0).lerp(DVec3::new(225.0, 215.0, 205.0), bare)
        };
        pixels.extend(color.to_array().map(|c| c as u8));
    }
    for tree in trees {
        let center = tree.place.truncate() / METRES * side as f64;
        let reach = 0.0022 * side as f64;
        for y in (center.y - reach).max(0.0) as usize..=((center.y + reach) as usize).min(side - 1)
        {
            for x in
                (center.x - reach).max(0.0) as usize..=((center.x + reach) as usize).min(side - 1)
            {
                let off = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - center;
                if off.length_squared() < reach * reach {
                    pixels[3 * (y * side + x)..][..3].copy_from_slice(&[38, 70, 40]);
                }
            }
        }
    }
    pixels
}

fn write_png(path: &str, side: usize, pixels: &[u8]) -> Result<(), Box<dyn Error>> {
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, side as u32, side as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [ply_path, png_path] = &arguments[..] else {
        return Err("usage: scatter TREES.ply TREES.png".into());
    };
    let terrain = Terrain::new();
    let step = METRES / SIDE as f64;
    let wishes = (0..SIDE * SIDE)
        .map(|i| terrain.wish(step * DVec2::new((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5)))
        .collect();
    // What is below is all that an app does when the density changes.
    let domain = Domain::new(DVec2::ZERO, DVec2::splat(METRES))?;
    let map = ImageMap::new(SIDE, SIDE, wishes, InvalidPixels::Reject)?.over(domain);
    let placement = Placement::new(domain, 7);
    let sampling = Sampling::new(&placement, &map, Amount::Points(TREES))?.relaxed()?;
    let mut buffer = vec![Vec2::ZERO; 12_000];
    let start = Instant::now();
    let filled = sampling.fill(&mut buffer)?;
    let time = start.elapsed();

    let trees: Vec<Tree> = buffer[..filled.written]
        .iter()
        .map(|place| {
            let (height, normal) = terrain.at(place.as_dvec2());
            Tree { place: place.as_dvec2().extend(height), normal }
        })
        .collect();
    std::fs::write(ply_path, ply(&trees))?;
    let side = 900;
    write_png(png_path, side, &picture(&terrain, &trees, side))?;
    println!("{} trees in {:.2} ms", trees.len(), time.as_secs_f64() * 1e3);
    Ok(())
}
