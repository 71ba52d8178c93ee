//! The force on a dot: away from its neighbors, towards the picture's ink.

use super::cells::{Cells, LANES};
use super::density::{Density, FINEST};

/// Reach of the repulsion between dots, in spacings. Below 1.4 dots clump.
pub(super) const REACH: f32 = 1.5;
/// Reach of the picture's pull, in spacings. Less than that of the repulsion: dots blur the picture, and
/// this sharpens it by as much. At 1.5 thin dark lines are lost; at .7 dots follow the pixels' noise.
pub(super) const PULL: f32 = 1.0;
/// Both forces are gradients of the kernel (1 − u²)⁴ · 5/(π R²), whose weight grows as its reach shrinks.
const GAIN: f32 = (REACH / PULL) * (REACH / PULL) * (REACH / PULL) * (REACH / PULL);
/// What darker pixels pull with, at most, on a dot on flat ground: so many times the ground's own tone. The pull's
/// sharpening draws dots across an edge; where the ground is flat right up to it there is nothing to sharpen, and
/// the dots are missing there. Discs on grounds 1.4 to 10 times lighter, hard and smoothed, had up to 1.2 % too many
/// dots and their grounds .1 to 1.5 % too few; now .5 % at most, mostly below .2. With 1.3 or 1.5 others are off by as much.
/// It costs 8 % of an iteration at 60,000 dots.
pub(super) const FLAT_PULL: f32 = 1.4;
/// So many of the nine pixels about a place are of the lightest or the darkest tone among them on flat ground,
/// also where a smoothed edge passes. With fewer, photographs have flat ground as well, and lose contrast.
pub(super) const FLAT: usize = 6;

/// Force on a dot at (x, y) where the spacing is `spacing`, for dots and a picture of width × height pixels:
///
/// ```text
/// F = Σ dots q   (p − q) (1 − |p − q|² / R²)₊³            R = 1.5 spacings
///   − (R/r)⁴ Σ pixels m   mass(m) (p − m) (1 − |p − m|² / r²)₊³        r = 1 spacing
/// ```
///
/// where mass(m) is no more than the [`ceiling`] at p,
/// with dots and pixels mirrored at the borders. Dots lie in runs, one for each row of cells, and pixels
/// in rows; both are looked at eight at a time:
///
/// ```text
///        cells, R about p                        pixels, r about p
///   ┌────┬────┬────┬────┐                     · · · · · · · · · · · ·
///   │  . │.  .│   .│ .  │  run, 8 + 8 lanes   · ┌ ─ ─ ─ ─ ─ ─ ─ ┐ · ·  8 lanes
///   ├────┼────┼────┼────┤                     · │ · · · · · · · │ · ·  8 lanes
///   │ .  │ p .│ .  │.  .│  run, 8 + 8 lanes   · │ · · · p · · · │ · ·  …
///   ├────┼────┼────┼────┤                     · │ · · · · · · · │ · ·
///   │.   │ . .│  . │ .  │  …                  · └ ─ ─ ─ ─ ─ ─ ─ ┘ · ·
///   └────┴────┴────┴────┘
/// ```
///
/// Each lane has its sum, and the sums are added in one order at the end. Lanes past the end of a run
/// have weight 0; pixels past the end of a row are too far to have any.
#[inline(always)]
pub(super) fn force(
    cells: &Cells,
    density: &Density,
    size: [f32; 2],
    [x, y]: [f32; 2],
    spacing: f32,
) -> [f32; 2] {
    let reach = REACH * spacing;
    let mut away = repulsion(cells, x, y, reach);
    let [width, height] = size;
    let across = (x < reach).then_some(-x).or((x > width - reach).then_some(2.0 * width - x));
    let down = (y < reach).then_some(-y).or((y > height - reach).then_some(2.0 * height - y));
    // what a mirrored dot does to this one, this one does to it mirrored, which is mirrored back
    if let Some(mirrored) = across {
        let [fx, fy] = repulsion(cells, mirrored, y, reach);
        away = [away[0] - fx, away[1] + fy];
    }
    if let Some(mirrored) = down {
        let [fx, fy] = repulsion(cells, x, mirrored, reach);
        away = [away[0] + fx, away[1] - fy];
    }
    if let (Some(u), Some(v)) = (across, down) {
        let [fx, fy] = repulsion(cells, u, v, reach);
        away = [away[0] - fx, away[1] - fy];
    }
    let towards = pull(density, x, y, PULL * spacing);
    [away[0] - GAIN * towards[0], away[1] - GAIN * towards[1]]
}

/// Of a positive number or 0; `max` would ask about NaN.
#[inline(always)]
fn positive(value: f32) -> f32 {
    if value > 0.0 { value } else { 0.0 }
}

/// The numbers of the lanes.
const LANE: [i32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7];

#[inline(always)]
fn sum(lanes: [f32; LANES]) -> f32 {
    ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6]))
        + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]))
}

#[inline(always)]
fn repulsion(cells: &Cells, x: f32, y: f32, reach: f32) -> [f32; 2] {
    let inverse = 1.0 / (reach * reach);
    let (mut fx, mut fy) = ([0.0_f32; LANES], [0.0_f32; LANES]);
    for run in cells.runs(x, y, reach) {
        // the last lanes may read past the run: the list ends with eight that are nowhere
        let xs = cells.x[run.start..run.end + LANES - 1].windows(LANES).step_by(LANES);
        let ys = cells.y[run.start..run.end + LANES - 1].windows(LANES).step_by(LANES);
        let mut left = run.len() as i32;
        for (xs, ys) in xs.zip(ys) {
            let (xs, ys) = (eight(xs), eight(ys));
            for lane in 0..LANES {
                let (dx, dy) = (x - xs[lane], y - ys[lane]);
                let near = 1.0 - (dx * dx + dy * dy) * inverse;
                // where a lane is past the run, 0 and not a product: the dot may be nowhere
                let inside = LANE[lane] < left && near > 0.0;
                let near = if inside { near } else { 0.0 };
                let weight = near * near * near;
                let (dx, dy) = (if inside { dx } else { 0.0 }, if inside { dy } else { 0.0 });
                fx[lane] += dx * weight;
                fy[lane] += dy * weight;
            }
            left -= LANES as i32;
        }
    }
    [sum(fx), sum(fy)]
}

/// A window of eight as an array.
#[inline(always)]
fn eight(window: &[f32]) -> &[f32; LANES] {
    window.first_chunk().unwrap_or(&[0.0; LANES])
}

#[inline(always)]
fn pull(density: &Density, x: f32, y: f32, reach: f32) -> [f32; 2] {
    let parts = density.parts_per_pixel;
    // in parts of pixels, from the corner of the margin
    let (u, v) = (x * parts + density.margin[0] as f32, y * parts + density.margin[1] as f32);
    let radius = reach * parts;
    if radius < PULL * FINEST as f32 * 0.9 {
        return pull_divided(density, x, y, reach);
    }
    let inverse = 1.0 / (radius * radius);
    // first and last pixels whose centers may be in reach; the margin is wider than the reach
    let (u0, u1) = ((u - radius - 0.5) as usize, (u + radius - 0.5) as usize);
    let (v0, v1) = ((v - radius - 0.5) as usize, (v + radius - 0.5) as usize);
    let blocks = (u1 - u0) / LANES + 1;
    // distances of the lanes' pixels in the first block
    let (mut fx, mut fy) = ([0.0_f32; LANES], [0.0_f32; LANES]);
    let from = u - u0 as f32 - 0.5;
    let ceiling = ceiling(density, u as usize, v as usize);
    for row in v0..=v1 {
        let dy = v - row as f32 - 0.5;
        let start = row * density.stride + u0;
        let Some(masses) = density.mass.get(start..start + blocks * LANES) else { break };
        let near_y = 1.0 - dy * dy * inverse;
        let mut first = from;
        for masses in masses.as_chunks::<LANES>().0 {
            for lane in 0..LANES {
                let dx = first - LANE[lane] as f32;
                let near = positive(near_y - dx * dx * inverse);
                let mass = if masses[lane] < ceiling { masses[lane] } else { ceiling };
                let weight = near * near * near * mass;
                fx[lane] += dx * weight;
                fy[lane] += dy * weight;
            }
            first -= LANES as f32;
        }
    }
    [sum(fx) / parts, sum(fy) / parts]
}

/// The most that a part of a pixel pulls with on a dot at part (u, v): on flat ground [`FLAT_PULL`] times the
/// ground's tone, which beside an edge is the lighter one, unless the dot is on the darker; between the two, half
/// of each.
#[inline(always)]
fn ceiling(density: &Density, u: usize, v: usize) -> f32 {
    // whole pixels, or groups, to the left and right, above and below
    let side = (density.parts_per_pixel as usize).max(1);
    let mut about = [[0.0_f32; 3]; 3];
    for (j, row) in about.iter_mut().enumerate() {
        let start = (v + j * side).saturating_sub(side) * density.stride;
        for (i, mass) in row.iter_mut().enumerate() {
            let column = (u + i * side).saturating_sub(side);
            *mass = density.mass.get(start + column).copied().unwrap_or(0.0);
        }
    }
    let own = about[1][1];
    let about = about.as_flattened();
    let lower = |a: f32, b: &f32| if *b < a { *b } else { a };
    let higher = |a: f32, b: &f32| if *b > a { *b } else { a };
    let (lightest, darkest) = (about.iter().fold(own, lower), about.iter().fold(own, higher));
    let alike = about.iter().filter(|mass| **mass == lightest || **mass == darkest).count();
    if alike < FLAT {
        return f32::INFINITY;
    }
    FLAT_PULL * if own == darkest { own } else { 0.5 * (lightest + own) }
}

/// The pull where the spacing is less than [`FINEST`] parts of pixels: parts are divided further, into
/// pieces of a fixed fraction of the reach.
#[cold]
fn pull_divided(density: &Density, x: f32, y: f32, reach: f32) -> [f32; 2] {
    const PIECES: i32 = 3;
    let parts = density.parts_per_pixel;
    let side = reach / PIECES as f32;
    let piece = side * parts;
    let (mut fx, mut fy) = (0.0_f32, 0.0_f32);
    for j in -PIECES..PIECES {
        for i in -PIECES..PIECES {
            // pieces about the dot: what one loses to a pixel's border its other side gains
            let (dx, dy) = ((i as f32 + 0.5) * side, (j as f32 + 0.5) * side);
            let near = positive(1.0 - (dx * dx + dy * dy) / (reach * reach));
            let u = (x + dx) * parts + density.margin[0] as f32;
            let v = (y + dy) * parts + density.margin[1] as f32;
            let (u, v) = (u as usize, v as usize);
            let mass = density.mass.get(v * density.stride + u).copied().unwrap_or(0.0);
            let weight = near * near * near * mass * (piece * piece);
            fx -= dx * weight;
            fy -= dy * weight;
        }
    }
    [fx, fy]
}
