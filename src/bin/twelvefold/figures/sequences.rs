//! Figure 7: Halton's, Hammersley's and the dodecagonal points side by side.

use std::f64::consts::SQRT_2;

use glam::DVec2;
use twelvefold::paper::LAMBDA;
use twelvefold::tiling::{Rules, TileType};

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{Window, tiles_in};

/// How many points of each.
const POINTS: usize = 1024;

const SIDE: f64 = 330.0;

/// A point of the unit square and its threshold in [0, 1).
type Point = (DVec2, f64);

/// Figure 7: "(left) Halton, (center) Hammersley, and (right) dodecagonal low-discrepancy sequences
/// of 2D points. Color designates threshold value in the range [0..1]."
pub(super) fn sequences(rules: &Rules) -> Result<String> {
    let gap = 18.0;
    let margin = 12.0;
    let size = DVec2::new(3.0 * SIDE + 2.0 * gap + 2.0 * margin, SIDE + 92.0);
    let mut page = Canvas::new(
        size,
        "Halton, Hammersley and dodecagonal points",
        "Left to right, 1024 points each in a square. Color shows the threshold, from 0, dark \
         violet, to 1, yellow: the share of the sequence that comes before the point.",
    );
    let panels = [
        ("Halton (bases 2, 3)", halton()),
        ("Hammersley", hammersley()),
        ("dodecagonal", dodecagonal(rules)?),
    ];
    for (i, (name, points)) in panels.iter().enumerate() {
        let corner = DVec2::new(margin + (SIDE + gap) * i as f64, margin);
        draw(&mut page, name, points, corner);
    }
    draw_scale(&mut page, DVec2::new(size.x / 2.0 - 150.0, SIDE + 54.0), DVec2::new(300.0, 12.0));
    Ok(page.finish())
}

fn draw(page: &mut Canvas, name: &str, points: &[Point], corner: DVec2) {
    let view = View {
        scale: SIDE,
        centre: DVec2::splat(0.5),
        origin: corner + DVec2::splat(SIDE / 2.0),
    };
    page.rectangle(corner, DVec2::splat(SIDE), "fill=\"#fff\" stroke=\"#888\"");
    page.open("");
    for (point, threshold) in points {
        page.circle(view.map(*point), 3.1, &format!("fill=\"{}\"", color(*threshold)));
    }
    page.close();
    page.text(
        corner + DVec2::new(SIDE / 2.0, SIDE + 22.0),
        name,
        "text-anchor=\"middle\" font-size=\"15\" fill=\"#111\"",
    );
}

fn color(threshold: f64) -> String {
    let color = colorous::VIRIDIS.eval_continuous(threshold);
    format!("#{color:x}")
}

/// The thresholds' color scale, from 0 to 1.
fn draw_scale(page: &mut Canvas, corner: DVec2, size: DVec2) {
    const STEPS: usize = 60;
    let step = size.x / STEPS as f64;
    for i in 0..STEPS {
        let fill = format!("fill=\"{}\"", color((i as f64 + 0.5) / STEPS as f64));
        let min = corner + DVec2::new(step * i as f64, 0.0);
        // A little overlap hides the seams.
        page.rectangle(min, DVec2::new(step + 0.5, size.y), &fill);
    }
    let style = "font-size=\"13\" text-anchor=\"middle\" fill=\"#333\"";
    page.text(corner + DVec2::new(-12.0, 11.0), "0", style);
    page.text(corner + DVec2::new(size.x + 14.0, 11.0), "1", style);
    page.text(corner + DVec2::new(size.x / 2.0, 29.0), "threshold", style);
}

/// The digits of `index` in `base` mirrored at the point: van der Corput's sequence.
fn radical_inverse(base: usize, mut index: usize) -> f64 {
    let (mut inverse, mut weight) = (0.0, 1.0);
    while index > 0 {
        weight /= base as f64;
        inverse += weight * (index % base) as f64;
        index /= base;
    }
    inverse
}

fn fraction(index: usize) -> f64 {
    index as f64 / POINTS as f64
}

fn halton() -> Vec<Point> {
    let point = |i| DVec2::new(radical_inverse(2, i), radical_inverse(3, i));
    (0..POINTS).map(|i| (point(i), fraction(i))).collect()
}

fn hammersley() -> Vec<Point> {
    let point = |i| DVec2::new(fraction(i), radical_inverse(2, i));
    (0..POINTS).map(|i| (point(i), fraction(i))).collect()
}

/// The first tiles by rank in a square window, off the root's centre and turned.
fn dodecagonal(rules: &Rules) -> Result<Vec<Point>> {
    const LEVELS: usize = 6;
    let edges = LAMBDA.powi(LEVELS as i32);
    // In root edges. 
    let side = 0.06;
    let window = Window { centre: DVec2::new(0.137, 0.104), size: DVec2::splat(side * SQRT_2) };
    let turn = DVec2::from_angle(0.3);
    let tiles = tiles_in(rules, TileType::A, LEVELS, &window.in_units_of(edges), 0.0)?;
    let mut inside: Vec<(u64, DVec2)> = tiles
        .iter()
        .map(|ranked| {
            let offset = ranked.centre() / edges - window.centre;
            (ranked.rank, offset.rotate(turn) / side + 0.5)
        })
        .filter(|(_, point)| point.min_element() >= 0.0 && point.max_element() < 1.0)
        .collect();
    inside.sort_unstable_by_key(|(rank, _)| *rank);
    let end = inside.get(POINTS).ok_or("too few tiles in the window")?.0;
    Ok(inside[..POINTS].iter().map(|(rank, point)| (*point, *rank as f64 / end as f64)).collect())
}
