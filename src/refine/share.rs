//! A cell's share of the picture: how much lies in it, where its center is, and how dense its edges are.

use super::density::Density;
use super::power::{BORDER, Cell};

/// Lines through a black cell: a share is then right to a percent, and neighbors lose what one wins.
const LINES: f64 = 9.0;
/// The most lines through a part of a pixel.
const MOST_LINES: f64 = 16.0;
/// A cell with fewer lines is taken for one of even density.
const FEWEST: usize = 3;
/// Samples along an edge.
const SAMPLES: usize = 4;
/// Neighbors of higher number that a dot keeps; even dots have three.
pub(super) const NEIGHBORS: usize = 8;

/// What a dot's cell holds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    /// Dots that the picture asks for in the cell.
    pub(super) mass: f64,
    /// From the dot to the center of that mass, in pixels.
    pub(super) center: [f64; 2],
    /// Neighbors of a higher number, and by how much this cell would grow, for a unit of weight, at
    /// their cost; filled from the first on, the others 0.
    pub(super) growth: [(u32, f32); NEIGHBORS],
}

/// What a cell must know of a neighbor.
pub(super) struct Other {
    pub(super) distance: f64,
    /// The density that their edge has at least.
    pub(super) floor: f64,
}

impl Share {
    /// Of the cell of `dot` at (x, y).
    pub(super) fn new(
        density: &Density,
        cell: &Cell,
        dot: u32,
        [x, y]: [f64; 2],
        other: impl Fn(u32) -> Other,
    ) -> Self {
        let picture = Pixels { density, at: density.place(x, y), parts: density.parts_per_pixel() };
        let mut share = picture.share(cell);
        let mut kept = share.growth.iter_mut();
        for (from, to, beyond) in cell.edges() {
            if beyond == BORDER || beyond < dot {
                continue;
            }
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let length = (dx * dx + dy * dy).sqrt();
            let Other { distance, floor } = other(beyond);
            if distance > 0.0 {
                // the edge moves by 1 / (2 d) for a unit of weight
                let density = picture.along(from, to).max(floor);
                let growth = (density * length / (2.0 * distance)) as f32;
                if growth > 0.0 && growth < f32::INFINITY {
                    let Some(kept) = kept.next() else { break };
                    *kept = (beyond, growth);
                }
            }
        }
        share
    }
}

/// The picture about a dot.
struct Pixels<'a> {
    density: &'a Density,
    /// Where the dot is, in parts of pixels from the corner of the margin.
    at: [f64; 2],
    parts: f64,
}

impl Pixels<'_> {
    /// Mass and center of a cell, by lines across it.
    ///
    /// ```text
    ///        · · ╱▔▔▔╲ · ·     each line from where it enters the cell to where it leaves,
    ///        ──┼━━━━━━━┼──     each pixel on it by the length that it has in common with it:
    ///        · · ╲▁▁▁╱ · ·     neighbors share their edge, so that no ink counts twice
    /// ```
    fn share(&self, cell: &Cell) -> Share {
        let lines = (LINES / self.density.finest).ceil().clamp(1.0, MOST_LINES);
        let part = |place: [f64; 2]| {
            [place[0] * self.parts + self.at[0], place[1] * self.parts + self.at[1]]
        };
        let bounds = cell.places().iter().fold([f64::INFINITY, 0.0], |[top, bottom], place| {
            let v = part(*place)[1];
            [if v < top { v } else { top }, if v > bottom { v } else { bottom }]
        });
        let first = (bounds[0] * lines + 0.5) as usize;
        let last = (bounds[1] * lines + 0.5) as usize;
        if last.saturating_sub(first) < FEWEST {
            return self.even_share(cell);
        }
        let [mut mass, mut mass_x, mut mass_y] = [0.0_f64; 3];
        for line in first..last {
            let v = (line as f64 + 0.5) / lines;
            let Some([left, right]) = crossings(cell, part, v) else { continue };
            let Some(row) = self.density.row(v as usize) else { continue };
            let [sum, moment] = along(row, left, right);
            mass += sum;
            mass_x += moment;
            mass_y += sum * v;
        }
        if mass > 0.0 {
            let center = |moment: f64, at: f64| (moment / mass - at) / self.parts;
            Share {
                mass: mass / lines,
                center: [center(mass_x, self.at[0]), center(mass_y, self.at[1])],
                ..Share::default()
            }
        } else {
            Share::default()
        }
    }

    /// Mass and center of a cell as dense as the picture is at the dot.
    fn even_share(&self, cell: &Cell) -> Share {
        let [mut area, mut area_x, mut area_y] = [0.0_f64; 3];
        for (from, to, _) in cell.edges() {
            // a triangle with the dot
            let triangle = 0.5 * (from[0] * to[1] - from[1] * to[0]);
            area += triangle;
            area_x += triangle * (from[0] + to[0]) / 3.0;
            area_y += triangle * (from[1] + to[1]) / 3.0;
        }
        if area > 0.0 {
            let mass = area * self.along([0.0; 2], [0.0; 2]);
            Share { mass, center: [area_x / area, area_y / area], ..Share::default() }
        } else {
            Share::default()
        }
    }

    /// Mean density on a line, in dots a squared pixel.
    fn along(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        for sample in 0..SAMPLES {
            let share = (sample as f64 + 0.5) / SAMPLES as f64;
            let u = (from[0] + share * (to[0] - from[0])) * self.parts + self.at[0];
            let v = (from[1] + share * (to[1] - from[1])) * self.parts + self.at[1];
            let row = self.density.row(v as usize).unwrap_or_default();
            sum += row.get(u as usize).copied().map_or(0.0, f64::from);
        }
        sum / SAMPLES as f64 * self.parts * self.parts
    }
}

/// Where the line at height `v` enters and leaves a cell, if it does.
#[inline(always)]
fn crossings(cell: &Cell, part: impl Fn([f64; 2]) -> [f64; 2], v: f64) -> Option<[f64; 2]> {
    let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
    for (from, to, _) in cell.edges() {
        let (from, to) = (part(from), part(to));
        if (from[1] <= v) != (to[1] <= v) {
            let u = from[0] + (v - from[1]) / (to[1] - from[1]) * (to[0] - from[0]);
            left = if u < left { u } else { left };
            right = if u > right { u } else { right };
        }
    }
    (left < right).then_some([left, right])
}

/// Mass of a row from `left` to `right`, and its moment.
#[inline(always)]
fn along(row: &[f32], left: f64, right: f64) -> [f64; 2] {
    let (first, last) = (left as usize, (right as usize).min(row.len().saturating_sub(1)));
    let piece = |at: usize, from: f64, to: f64| {
        let mass = row.get(at).copied().map_or(0.0, f64::from) * (to - from);
        [mass, mass * 0.5 * (from + to)]
    };
    if first >= last {
        return piece(first, left, right);
    }
    let [mut sum, mut moment] = piece(first, left, (first + 1) as f64);
    for (at, mass) in row.iter().enumerate().take(last).skip(first + 1) {
        let mass = f64::from(*mass);
        sum += mass;
        moment += mass * (at as f64 + 0.5);
    }
    let [end, end_moment] = piece(last, last as f64, right);
    [sum + end, moment + end_moment]
}
