//! A texture that repeats: even dots under a map that goes on over its border, drawn as 3 × 3 copies of one
//! tile. Writes an SVG; the dots are in it once.
//!
//! `cargo run --release --example seamless -- tiles.svg`

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use glam::DVec2;
use twelvefold::{Amount, Domain, ImageMap, InvalidPixels, Pixels, Placement, Sampling};

/// Pixels of the map along a side, and the size of a tile in the picture.
const SIDE: usize = 128;
const TILE: f64 = 240.0;

fn main() -> Result<(), Box<dyn Error>> {
    let Some(path) = std::env::args().nth(1) else {
        return Err("which file? cargo run --release --example seamless -- tiles.svg".into());
    };
    // Waves whose periods are whole parts of the tile.
    let darkness = |i: usize| {
        let at = DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) + 0.5;
        let at = at * (TAU / SIDE as f64);
        let waves = (at.x + (2.0 * at.y).sin()).cos() + (at.y - at.x.sin()).cos();
        (1.1 + 0.5 * waves) as f32
    };
    let pixels = (0..SIDE * SIDE).map(darkness).collect();
    let map = ImageMap::new(Pixels::new(SIDE, SIDE, pixels, InvalidPixels::Reject)?)?;
    let map = map.over(Domain::new(DVec2::ZERO, DVec2::splat(TILE))?);

    let placement = Placement::seamless(map.domain(), 12)?;
    let sampling = Sampling::new(&placement, &map, Amount::Points(1200.0))?.relaxed()?;
    let all = 3.0 * TILE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {all} {all}\" width=\"{all}\" height=\"{all}\">\n\
         <rect width=\"{all}\" height=\"{all}\" fill=\"#fff\"/>\n<defs><path id=\"t\" fill=\"none\" \
         stroke=\"#123\" stroke-width=\"2.6\" stroke-linecap=\"round\" d=\""
    );
    for sample in sampling.points::<DVec2>()? {
        let DVec2 { x, y } = sample?.position;
        write!(svg, "M{x:.1} {y:.1}h0")?;
    }
    svg += "\"/></defs>\n";
    for i in 0..9u32 {
        let [x, y] = [i % 3, i / 3].map(|place| f64::from(place) * TILE);
        writeln!(svg, "<use href=\"#t\" x=\"{x}\" y=\"{y}\"/>")?;
    }
    // Ticks in the margins tell where the tiles meet.
    for at in [TILE, 2.0 * TILE] {
        let far = all - 8.0;
        writeln!(
            svg,
            "<path stroke=\"#d22\" d=\"M{at} 0v8M{at} {far}v8M0 {at}h8M{far} {at}h8\"/>"
        )?;
    }
    svg += "</svg>\n";
    std::fs::write(path, svg)?;
    Ok(())
}
