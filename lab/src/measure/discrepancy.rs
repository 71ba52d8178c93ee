//! Discrepancy: how far the share of points in a box [0, x) × [0, y) is from the box's area.

use glam::DVec2;

use super::MeasureError;

/// The most points of which the star discrepancy is computed exactly: half a second.
pub const EXACT_LIMIT: usize = 16_384;

/// Cells a side of the grid on which larger sets are bounded.
const GRID: usize = 8192;

/// Bounds of a number; equal where it is known exactly (but for rounding).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The number is at least this.
    pub lower: f64,
    /// The number is at most this.
    pub upper: f64,
}

/// The star discrepancy of points of the unit square: sup |points in [0, x) × [0, y) / n − x·y| over all
/// 0 ≤ x, y ≤ 1.
///
/// Exact up to [`EXACT_LIMIT`] points, in O(n²) (Bundschuh and Zhu, *A method for exact calculation of
/// the discrepancy of low-dimensional finite point sets*, 1993). Larger sets are bounded to
/// 2/8192 on a grid: upper − lower ≤ 0.000244 + the share of points in one row and one column of it.
///
/// # Errors
/// [`MeasureError::TooFew`] without points, [`MeasureError::OutsideUnitSquare`] with one outside of
/// [0, 1]².
pub fn star(points: &[DVec2]) -> Result<Bounds, MeasureError> {
    check(points)?;
    if points.len() <= EXACT_LIMIT {
        let exact = star_exact(points);
        return Ok(Bounds { lower: exact, upper: exact });
    }
    Ok(star_on_grid(points, GRID))
}

/// At least one point, each in [0, 1]².
fn check(points: &[DVec2]) -> Result<(), MeasureError> {
    if points.is_empty() {
        return Err(MeasureError::TooFew { found: 0, needed: 1 });
    }
    let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all();
    match points.iter().position(|p| !inside(p)) {
        Some(point) => Err(MeasureError::OutsideUnitSquare { point }),
        None => Ok(()),
    }
}

fn star_exact(points: &[DVec2]) -> f64 {
    let n = points.len() as f64;
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    // The y of the points so far, between 0 and 1: between neighbors no box changes its count.
    let mut ys = vec![0.0, 1.0];
    let mut worst = 0.0f64;
    for taken in 0..=sorted.len() {
        let x = if taken == 0 { 0.0 } else { sorted[taken - 1].x };
        let next_x = sorted.get(taken).map_or(1.0, |p| p.x);
        for (k, pair) in ys.windows(2).enumerate() {
            let share = k as f64 / n;
            // The smallest closed box with these points, and the largest open one with no more.
            worst = worst.max(share - x * pair[0]).max(next_x * pair[1] - share);
        }
        if let Some(point) = sorted.get(taken) {
            let at = ys.partition_point(|y| *y <= point.y).clamp(1, ys.len() - 1);
            ys.insert(at, point.y);
        }
    }
    worst
}

/// Every box lies between two boxes with corners on the grid, which bound its count and its area.
fn star_on_grid(points: &[DVec2], side: usize) -> Bounds {
    let n = points.len() as f64;
    let cell = |c: f64| ((c * side as f64) as usize).min(side - 1);
    let mut cells: Vec<(usize, usize)> = points.iter().map(|p| (cell(p.y), cell(p.x))).collect();
    cells.sort_unstable();
    let mut rest = cells.as_slice();
    // below[i]: points in columns before i of the rows so far.
    let mut below = vec![0u32; side + 1];
    let mut row = vec![0u32; side];
    let mut bounds = Bounds { lower: 0.0, upper: 0.0 };
    for y in 0..side {
        row.fill(0);
        while let Some(((_, x), after)) = rest.split_first().filter(|(cell, _)| cell.0 == y) {
            row[*x] += 1;
            rest = after;
        }
        let mut with_row = 0;
        let mut above_left = 0;
        for x in 0..side {
            with_row += row[x];
            let fewer = f64::from(below[x]) / n;
            let more = f64::from(below[x + 1] + with_row) / n;
            let small = x as f64 * y as f64 / (side * side) as f64;
            let large = (x + 1) as f64 * (y + 1) as f64 / (side * side) as f64;
            // The corner itself is a box: an open one, whose points lie in the cells before it.
            bounds.lower = bounds.lower.max((more - large).abs());
            bounds.upper = bounds.upper.max(more - small).max(large - fewer);
            below[x] += above_left;
            above_left = with_row;
        }
        below[side] += above_left;
    }
    bounds
}

/// The L2 star discrepancy of points of the unit square: the root of ∫ (share − area)² over all boxes,
/// by Warnock's formula (1972) in O(n log n).
///
/// # Errors
/// As [`star`].
pub fn l2_star(points: &[DVec2]) -> Result<f64, MeasureError> {
    check(points)?;
    let n = points.len() as f64;
    let single: f64 = points.iter().map(|p| (1.0 - p.x * p.x) * (1.0 - p.y * p.y)).sum();
    // Pairs: (1 − max x)(1 − max y). With x ascending, the later point has the greater x; sums over y
    // come from trees of partial sums.
    let mut by_y: Vec<usize> = (0..points.len()).collect();
    by_y.sort_by(|i, j| points[*i].y.total_cmp(&points[*j].y));
    let mut place = vec![0; points.len()];
    for (at, i) in by_y.iter().enumerate() {
        place[*i] = at;
    }
    let mut by_x: Vec<usize> = (0..points.len()).collect();
    by_x.sort_by(|i, j| points[*i].x.total_cmp(&points[*j].x));
    let mut counts = PartialSums::new(points.len());
    let mut above = PartialSums::new(points.len());
    let (mut pairs, mut total_above) = (0.0, 0.0);
    for i in by_x {
        let p = points[i];
        let (x, y) = (1.0 - p.x, 1.0 - p.y);
        let lower = counts.before(place[i]);
        let higher = total_above - above.before(place[i]);
        pairs += x * (2.0 * (lower * y + higher) + y);
        counts.add(place[i], 1.0);
        above.add(place[i], y);
        total_above += y;
    }
    let squared = 1.0 / 9.0 - single / (2.0 * n) + pairs / (n * n);
    Ok(libm::sqrt(squared.max(0.0)))
}

/// Sums of the first entries of an array that changes: a Fenwick tree.
struct PartialSums(Vec<f64>);

impl PartialSums {
    fn new(len: usize) -> Self {
        Self(vec![0.0; len + 1])
    }

    fn add(&mut self, at: usize, value: f64) {
        let mut i = at + 1;
        while i < self.0.len() {
            self.0[i] += value;
            i += i & i.wrapping_neg();
        }
    }

    /// The sum of entries 0..at.
    fn before(&self, at: usize) -> f64 {
        let (mut i, mut sum) = (at, 0.0);
        while i > 0 {
            sum += self.0[i];
            i &= i - 1;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn inverse(mut i: u32, base: u32) -> f64 {
        let (mut value, mut place) = (0.0, 1.0);
        while i > 0 {
            place /= f64::from(base);
            value += f64::from(i % base) * place;
            i /= base;
        }
        value
    }

    fn halton(n: u32) -> Vec<DVec2> {
        (0..n).map(|i| DVec2::new(inverse(i, 2), inverse(i, 3))).collect()
    }

    fn hammersley(n: u32) -> Vec<DVec2> {
        (0..n).map(|i| DVec2::new(f64::from(i) / f64::from(n), inverse(i, 2))).collect()
    }

    fn random(n: usize) -> Vec<DVec2> {
        let mut random = Random::new(6, &[]);
        (0..n).map(|_| DVec2::new(random.unit(), random.unit())).collect()
    }

    /// Every box whose corners are coordinates of points, open and closed.
    fn star_by_trying(points: &[DVec2]) -> f64 {
        let mut worst = 0.0f64;
        let xs: Vec<f64> = points.iter().map(|p| p.x).chain([1.0]).collect();
        let ys: Vec<f64> = points.iter().map(|p| p.y).chain([1.0]).collect();
        for x in &xs {
            for y in &ys {
                let share = |count: usize| count as f64 / points.len() as f64;
                let open = points.iter().filter(|p| p.x < *x && p.y < *y).count();
                let closed = points.iter().filter(|p| p.x <= *x && p.y <= *y).count();
                worst = worst.max(share(closed) - x * y).max(x * y - share(open));
            }
        }
        worst
    }

    #[test]
    fn star_is_the_worst_box() {
        for n in [1, 2, 3, 10, 64, 100] {
            for points in [halton(n), hammersley(n), random(n as usize)] {
                let exact = star(&points).unwrap();
                assert_eq!(exact.lower, exact.upper);
                assert!((exact.lower - star_by_trying(&points)).abs() < 1e-15, "{n}");
            }
        }
        // Coordinates in common, and on the border.
        let grid: Vec<DVec2> =
            (0..25).map(|i| DVec2::new(f64::from(i % 5), f64::from(i / 5)) / 4.0).collect();
        assert!((star(&grid).unwrap().lower - star_by_trying(&grid)).abs() < 1e-15);
        let outside = Err(MeasureError::OutsideUnitSquare { point: 1 });
        for point in [DVec2::new(0.5, 1.5), DVec2::NAN, DVec2::NEG_INFINITY] {
            assert_eq!(star(&[DVec2::ONE, point]), outside);
            assert_eq!(l2_star(&[DVec2::ONE, point]).err(), outside.err());
        }
        assert_eq!(star(&[]), Err(MeasureError::TooFew { found: 0, needed: 1 }));
    }

    #[test]
    fn grid_bounds_hold_the_exact_value() {
        for points in [halton(2000), hammersley(3000), random(5000)] {
            let exact = star_exact(&points);
            for side in [64, 1000] {
                let Bounds { lower, upper } = star_on_grid(&points, side);
                assert!(
                    lower <= exact + 1e-12 && exact <= upper + 1e-12,
                    "{lower} {exact} {upper}"
                );
                assert!(upper - lower < 6.0 / side as f64);
            }
        }
    }

    #[test]
    fn l2_star_is_warnocks_double_sum() {
        for points in [halton(77), hammersley(128), random(200)] {
            let n = points.len() as f64;
            let mut pairs = 0.0;
            for a in &points {
                for b in &points {
                    pairs += (1.0 - a.x.max(b.x)) * (1.0 - a.y.max(b.y));
                }
            }
            let single: f64 = points.iter().map(|p| (1.0 - p.x * p.x) * (1.0 - p.y * p.y)).sum();
            let expected = (1.0 / 9.0 - single / (2.0 * n) + pairs / (n * n)).sqrt();
            assert!((l2_star(&points).unwrap() - expected).abs() < 1e-10);
        }
        // One point at the origin: every box holds it, ∫ (1 − xy)² = 1 − 1/2 + 1/9.
        let one = l2_star(&[DVec2::ZERO]).unwrap();
        assert!((one - (11.0f64 / 18.0).sqrt()).abs() < 1e-15);
        assert_eq!(l2_star(&[]), Err(MeasureError::TooFew { found: 0, needed: 1 }));
    }

    #[test]
    fn halton_and_hammersley_have_their_known_values() {
        // L2: scipy 1.17, scipy.stats.qmc.discrepancy(points, method="L2-star"); star: every box tried
        // in exact fractions.
        let known = [
            (halton(16), 0.2013888888888889, 0.06824779161021033),
            (halton(100), 0.0502391975308642, 0.015271739964097211),
            (halton(256), 0.018759645061728395, 0.0053063698909994695),
            (hammersley(16), 0.171875, 0.06929083896187715),
            (hammersley(100), 0.0378125, 0.014476824834972467),
            (hammersley(256), 0.01605224609375, 0.006277231397399603),
        ];
        for (points, expected_star, expected_l2) in known {
            let (star, l2) = (star(&points).unwrap().lower, l2_star(&points).unwrap());
            assert!((star - expected_star).abs() < 1e-14, "{star} {expected_star}");
            assert!((l2 - expected_l2).abs() < 1e-12, "{l2} {expected_l2}");
        }
    }
}
