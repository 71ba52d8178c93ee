//! A line that never meets itself.
//!
//! Where two strokes ab and cd of a way meet, ac and bd are shorter together, by the triangle inequality, so
//! exchanging them until no two meet comes to an end. Whether they meet is decided in whole numbers. Only
//! strokes along one straight line may be no shorter when exchanged; then one of their dots gives way.

use std::collections::HashSet;

use glam::DVec2;

/// Whole numbers in a unit of coordinates.
const RESOLUTION: f64 = 1e3;

/// Coordinates are kept within ± 2⁴⁰, so that products of their differences fit in 128 bits with ease.
const FARTHEST: f64 = (1u64 << 40) as f64;

type Place = [i64; 2];

/// Where the dots are, in whole numbers, no two in one place.
#[derive(Debug)]
pub(super) struct Places {
    places: Vec<Place>,
    taken: HashSet<Place>,
}

impl Places {
    /// Dots rounded to the nearest place; those in one place become one.
    pub(super) fn new(dots: &[DVec2]) -> Self {
        let mut taken = HashSet::with_capacity(dots.len());
        let whole = |t: f64| (t * RESOLUTION).round().clamp(-FARTHEST, FARTHEST) as i64;
        let mut places: Vec<Place> = dots.iter().map(|dot| [whole(dot.x), whole(dot.y)]).collect();
        places.retain(|place| taken.insert(*place));
        Self { places, taken }
    }

    pub(super) fn dots(&self) -> Vec<DVec2> {
        self.places
            .iter()
            .map(|[x, y]| DVec2::new(*x as f64 / RESOLUTION, *y as f64 / RESOLUTION))
            .collect()
    }

    fn at(&self, dot: u32) -> Place {
        self.places[dot as usize]
    }

    fn distance(&self, a: u32, b: u32) -> f64 {
        let ([a, b], [c, d]) = (self.at(a), self.at(b));
        DVec2::new((a - c) as f64, (b - d) as f64).length()
    }

    fn meet(&self, a: u32, b: u32, c: u32, d: u32) -> bool {
        meet(self.at(a), self.at(b), self.at(c), self.at(d))
    }

    /// Moves a dot to a free place next to it, another one on each try.
    fn give_way(&mut self, dot: u32, tries: usize) {
        const AROUND: [Place; 8] =
            [[0, 1], [1, 0], [0, -1], [-1, 0], [1, 1], [1, -1], [-1, -1], [-1, 1]];
        let [x, y] = self.at(dot);
        for k in 0..AROUND.len() {
            let [right, down] = AROUND[(tries + k) % AROUND.len()];
            let place = [x + right, y + down];
            if self.taken.insert(place) {
                self.taken.remove(&[x, y]);
                self.places[dot as usize] = place;
                return;
            }
        }
    }
}

/// On which side of the line from p to q the place r lies: −1, 0 on it, or 1.
fn side(p: Place, q: Place, r: Place) -> i128 {
    let from = |s: Place| [i128::from(s[0] - p[0]), i128::from(s[1] - p[1])];
    let ([a, b], [c, d]) = (from(q), from(r));
    (a * d - b * c).signum()
}

/// Whether r lies in the rectangle of which p and q are corners.
fn within(p: Place, q: Place, r: Place) -> bool {
    (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]))
}

/// Whether the segments ab and cd, ends counted, have a point in common.
fn meet(a: Place, b: Place, c: Place, d: Place) -> bool {
    if (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k])) {
        return false;
    }
    let (e, f, g, h) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    (e * f < 0 && g * h < 0)
        || (e == 0 && within(a, b, c))
        || (f == 0 && within(a, b, d))
        || (g == 0 && within(c, d, a))
        || (h == 0 && within(c, d, b))
}

/// The way through the dots in `order`, changed where its strokes meet. A dot in `places` may move by a
/// resolution step.
pub(super) fn uncrossed(mut order: Vec<u32>, places: &mut Places) -> Vec<u32> {
    let mut stands = vec![0; order.len()];
    for (&dot, at) in order.iter().zip(0..) {
        stands[dot as usize] = at;
    }
    for tries in 0.. {
        let meetings = meetings(&order, places);
        if meetings.is_empty() {
            break;
        }
        for [a, b, c, d] in meetings {
            let stand = |dot: u32| -> usize { stands[dot as usize] };
            // Earlier exchanges may have turned these strokes around, or taken them away.
            let [(i, next_i), (j, next_j)] = {
                let mut strokes = [(stand(a), stand(b)), (stand(c), stand(d))]
                    .map(|(from, to)| (from.min(to), from.max(to)));
                strokes.sort_unstable();
                strokes
            };
            if next_i != i + 1 || next_j != j + 1 || j == next_i {
                continue;
            }
            let [a, b, c, d] = [order[i], order[next_i], order[j], order[next_j]];
            if !places.meet(a, b, c, d) {
                continue;
            }
            let before = places.distance(a, b) + places.distance(c, d);
            if places.distance(a, c) + places.distance(b, d) >= before {
                places.give_way(c, tries);
                continue;
            }
            order[next_i..=j].reverse();
            for (&dot, at) in order[next_i..=j].iter().zip(next_i..) {
                stands[dot as usize] = at;
            }
        }
    }
    order
}

/// The pairs of strokes ab, cd of a way that meet, but for those that follow each other. O(dots) where
/// strokes are short.
fn meetings(order: &[u32], places: &Places) -> Vec<[u32; 4]> {
    let Some(cells) = Cells::new(order, places) else { return Vec::new() };
    // A pair may share several cells.
    let mut found: Vec<[u32; 2]> = Vec::new();
    for strokes in cells.cells() {
        for (k, &(_, i)) in strokes.iter().enumerate() {
            for &(_, j) in &strokes[k + 1..] {
                let [a, b, c, d] = [i, i + 1, j, j + 1].map(|at| order[at as usize]);
                if j > i + 1 && places.meet(a, b, c, d) {
                    found.push([i, j]);
                }
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found.iter().map(|[i, j]| [*i, i + 1, *j, j + 1].map(|at| order[at as usize])).collect()
}

/// Which strokes pass through which square cells.
struct Cells {
    /// Pairs of a cell and a stroke, sorted.
    passing: Vec<(u64, u32)>,
}

impl Cells {
    /// `None` when there are fewer than two strokes.
    fn new(order: &[u32], places: &Places) -> Option<Self> {
        let strokes = order.len().checked_sub(1).filter(|strokes| *strokes > 1)?;
        let stroke = |i: usize| [places.at(order[i]), places.at(order[i + 1])];
        let least = |k: usize| places.places.iter().map(|place| place[k]).min().unwrap_or(0);
        let least = [least(0), least(1)];
        let total: f64 = (0..strokes).map(|i| places.distance(order[i], order[i + 1])).sum();
        // Twice the mean stroke: few strokes pass through more than four cells.
        let cell = ((2.0 * total / strokes as f64).ceil() as i64).max(1);
        let mut passing = Vec::with_capacity(3 * strokes);
        for i in 0..strokes {
            let [mut p, mut q] = stroke(i);
            if p[1] > q[1] {
                (p, q) = (q, p);
            }
            let [p, q] = [p, q].map(|[x, y]| [x - least[0], y - least[1]]);
            for row in p[1] / cell..=q[1] / cell {
                // The part of the stroke within this row of cells, rounded outwards.
                let x_at = |y: i64| {
                    let y = i128::from(y.clamp(p[1], q[1]) - p[1]);
                    let height = i128::from(q[1] - p[1]).max(1);
                    p[0] + (i128::from(q[0] - p[0]) * y / height) as i64
                };
                let ends = if p[1] == q[1] {
                    [p[0], q[0]]
                } else {
                    [row, row + 1].map(|r| x_at(r * cell))
                };
                let first = (ends[0].min(ends[1]) - 1).max(0) / cell;
                let last = (ends[0].max(ends[1]) + 1) / cell;
                for column in first..=last {
                    passing.push(((row as u64) << 32 | column as u64, i as u32));
                }
            }
        }
        passing.sort_unstable();
        Some(Self { passing })
    }

    /// The strokes of each cell through which any pass.
    fn cells(&self) -> impl Iterator<Item = &[(u64, u32)]> {
        self.passing.chunk_by(|one, other| one.0 == other.0)
    }
}
