//! Figure 7: Halton's, Hammersley's and the dodecagonal points side by side.

use std::f64::consts::SQRT_2;

use glam::DVec2;
use twelvefold::tiling::{Rules, TileType};
use twelvefold_lab::paper::LAMBDA;

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
    let size = DVec2::new(3.0 * SIDE + 2.0 * gap + 2.0 * margin, SIDE + 116.0);
    let mut page = Canvas::new(
        size,
        "Halton, Hammersley and dodecagonal points",
        "Left to right, 1024 points each in a square. Color shows the threshold, from 0, dark \
         violet, to 1, yellow: the share of the sequence that comes before the point. The smallest \
         distance of two points is told in units of the hexagonal lattice of the same density.",
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
    draw_scale(&mut page, DVec2::new(size.x / 2.0 - 150.0, SIDE + 74.0), DVec2::new(300.0, 12.0));
    Ok(page.finish())
}

fn draw(page: &mut Canvas, name: &str, points: &[Point], corner: DVec2) {
    let view =
        View { scale: SIDE, center: DVec2::splat(0.5), origin: corner + DVec2::splat(SIDE / 2.0) };
    page.rectangle(corner, DVec2::splat(SIDE), "fill=\"#fff\" stroke=\"#888\"");
    page.open("class=\"points\"");
    for (point, threshold) in points {
        page.circle(view.map(*point), 3.1, &format!("fill=\"{}\"", color(*threshold)));
    }
    page.close();
    page.text(
        corner + DVec2::new(SIDE / 2.0, SIDE + 22.0),
        name,
        "text-anchor=\"middle\" font-size=\"15\" fill=\"#111\"",
    );
    page.text(
        corner + DVec2::new(SIDE / 2.0, SIDE + 42.0),
        &format!("smallest distance {:.2} (hexagonal lattice 1)", smallest_distance(points)),
        "text-anchor=\"middle\" font-size=\"13\" fill=\"#444\"",
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
        // Each reaches to the right end, under the next, so that no seam shows.
        page.rectangle(min, DVec2::new(size.x - step * i as f64, size.y), &fill);
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

/// The distance of the closest two points, in distances of neighbors in the hexagonal lattice of the
/// same density, the most that any set of points could have.
fn smallest_distance(points: &[Point]) -> f64 {
    let lattice = (2.0 / (3f64.sqrt() * points.len() as f64)).sqrt();
    let mut smallest = f64::INFINITY;
    for (i, (a, _)) in points.iter().enumerate() {
        for (b, _) in &points[i + 1..] {
            smallest = smallest.min(a.distance(*b));
        }
    }
    smallest / lattice
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

/// The first tiles by rank in a square window, off the root's center and turned.
fn dodecagonal(rules: &Rules) -> Result<Vec<Point>> {
    const LEVELS: usize = 6;
    let edges = LAMBDA.powi(LEVELS as i32);
    // In root edges.
    let side = 0.06;
    let window = Window { center: DVec2::new(0.137, 0.104), size: DVec2::splat(side * SQRT_2) };
    let turn = DVec2::from_angle(0.3);
    let tiles = tiles_in(rules, TileType::A, LEVELS, &window.in_units_of(edges), 0.0)?;
    let mut inside: Vec<(u64, DVec2)> = tiles
        .iter()
        .map(|ranked| {
            let offset = ranked.center() / edges - window.center;
            (ranked.rank, offset.rotate(turn) / side + 0.5)
        })
        .filter(|(_, point)| point.min_element() >= 0.0 && point.max_element() < 1.0)
        .collect();
    inside.sort_unstable_by_key(|(rank, _)| *rank);
    let end = inside.get(POINTS).ok_or("too few tiles in the window")?.0;
    Ok(inside[..POINTS].iter().map(|(rank, point)| (*point, *rank as f64 / end as f64)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radical_inverses_mirror_the_digits() {
        let first: Vec<f64> = (0..6).map(|i| radical_inverse(2, i)).collect();
        assert_eq!(first, [0.0, 0.5, 0.25, 0.75, 0.125, 0.625]);
        // 17 = (122)₃ becomes (0.221)₃.
        assert!((radical_inverse(3, 17) - 25.0 / 27.0).abs() < 1e-15);
    }

    #[test]
    fn every_sequence_fills_the_unit_square_in_the_order_of_its_thresholds() {
        let tables = twelvefold::Tables::built_in();
        for points in [halton(), hammersley(), dodecagonal(&tables.rules()).unwrap()] {
            assert_eq!(points.len(), POINTS);
            let mut quadrants = [0; 4];
            for (point, threshold) in &points {
                assert!(point.min_element() >= 0.0 && point.max_element() < 1.0);
                assert!((0.0..1.0).contains(threshold));
                quadrants[usize::from(point.x >= 0.5) + 2 * usize::from(point.y >= 0.5)] += 1;
            }
            assert!(points.is_sorted_by(|a, b| a.1 < b.1));
            assert!(
                quadrants.iter().all(|count| (POINTS / 4 - 16..=POINTS / 4 + 16).contains(count))
            );
        }
    }

    #[test]
    fn the_hexagonal_lattice_has_smallest_distance_one() {
        // 30 × 26 points at distance 1/30, rows √3/2 of that apart, nearly fill a square.
        let points: Vec<Point> = (0..30 * 26)
            .map(|i| {
                let (column, row) = (f64::from(i % 30), f64::from(i / 30));
                (DVec2::new(column + (row % 2.0) / 2.0, row * 3f64.sqrt() / 2.0) / 30.0, 0.0)
            })
            .collect();
        let expected = (30.0f64 * 26.0 * 3f64.sqrt() / 2.0).sqrt() / 30.0;
        assert!((smallest_distance(&points) - expected).abs() < 1e-12);
        assert!((expected - 1.0).abs() < 0.15);
    }
}
