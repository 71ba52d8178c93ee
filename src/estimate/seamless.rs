//! A level of the tiling without borders: a square torus, evened out along the axes.
//!
//! The tiling of a level is a square-triangle tiling whose vertices are tile centers. Periodic ones exist,
//! too: the snub-square tiling 3².4.3.4 has only vertices of the types c and d, four to a square cell.
//! (Subdividing it keeps the periods, but adds no merit here: deeper levels come in coarser numbers.)
//! n/4 of its cells make a torus:
//!
//! ```text
//!   1. shape      two integer vectors that span as many cells, nearly a square, at an angle where few
//!                 vertices are in line with it
//!   2. vertices   of those cells, stretched to the unit square by a percent or so
//!   3. even out   along x the k-th point from the left goes to k/n, and so along y
//!   4. shift      by a random vector modulo 1, with a random symmetry of the square
//! ```
//!
//! The third step moves points by less than their spacing, and leaves each strip along the axes its
//! share of points, so that warps along the axes are not punished for what the tiling does between.

use alloc::vec::Vec;

use glam::DVec2;

use super::sums::BELOW_ONE;
use crate::error::SamplingError;
use crate::random::SplitMix64;
use crate::sampling::Limits;
use crate::tiling::numbers::SQRT_3;

/// Exactly n points of the unit torus, evenly spread in all directions and along the axes.
///
/// Every seed gives the same set, shifted at random and turned or mirrored: each point alone is
/// uniform, so that estimates with weights 1/n are unbiased; and there is no border, so that
/// periodic integrands (longitude is periodic) meet no edge. Warped to a map by
/// [`Warp`](super::Warp) it leaves about as much error as Owen-scrambled Sobol points (at 2^k points 0.8
/// to 1.7 times on smooth skies, 0.7 to 1.2 behind occluders; less at other numbers); but no beginning
/// of it is a good set. Best where n is a multiple of 4: one to three points that lack show, as up to 2.5
/// times the error of the next multiple.
///
/// ```
/// use twelvefold::estimate::SeamlessSet;
/// let set = SeamlessSet::new(1000, Default::default())?;
/// let mean: f64 = set.points(7).map(|p| (p.x * p.y).sqrt()).sum::<f64>() / 1000.0;
/// assert!((mean - 4.0 / 9.0).abs() < 2e-3);
/// # Ok::<(), twelvefold::SamplingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeamlessSet {
    /// Places along the axes, each a permutation of 0..n.
    places: Vec<[u32; 2]>,
}

/// The vertices of the snub-square cell: 0, ζ², ζ + ζ² and ζ² + ζ³ edges, along its sides 1 + ζ and ζ³ + ζ⁴,
/// which are 2 cos 15° edges long.
const VERTICES: [DVec2; 4] = [
    DVec2::ZERO,
    DVec2::new(0.5 * (SQRT_3 - 1.0), 0.5 * (SQRT_3 - 1.0)),
    DVec2::new(0.5 * SQRT_3, 0.5),
    DVec2::new(0.5, 0.5 * SQRT_3),
];

impl SeamlessSet {
    /// The set of n points: some 150 ns a point, 8 bytes each, and 20 more while it is made.
    ///
    /// # Errors
    /// [`SamplingError::TooManyPoints`] for more than the limits, or than 2³¹.
    pub fn new(n: usize, limits: Limits) -> Result<Self, SamplingError> {
        let limit = limits.points.min(1 << 31);
        if n as u64 > limit {
            return Err(SamplingError::TooManyPoints { expected: n as f64, limit });
        }
        let points = vertices(n);
        let mut places = alloc::vec![[0u32; 2]; n];
        let mut order: Vec<u32> = (0..n as u32).collect();
        for axis in 0..2 {
            order.sort_unstable_by(|a, b| {
                let at = |i: &u32| points[*i as usize][axis];
                at(a).total_cmp(&at(b)).then(a.cmp(b))
            });
            for (place, i) in (0..).zip(&order) {
                places[*i as usize][axis] = place;
            }
        }
        Ok(Self { places })
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The points in [0, 1)² under a seed.
    pub fn points(&self, seed: u64) -> impl ExactSizeIterator<Item = DVec2> + '_ {
        let mut random = SplitMix64::new(seed);
        let symmetry = random.next_u64() >> 61;
        let n = self.places.len() as f64;
        let shift = DVec2::new(random.unit(), random.unit()) * n;
        let wrapped = move |place: f64, shift: f64| {
            let along = place + shift;
            ((if along < n { along } else { along - n }) / n).min(BELOW_ONE)
        };
        self.places.iter().map(move |[x, y]| {
            let mirrored = |place: u32, bit: u64| {
                let place = f64::from(place);
                if symmetry & bit == 0 { place } else { n - 1.0 - place }
            };
            let (x, y) = (mirrored(*x, 1), mirrored(*y, 2));
            let (x, y) = if symmetry & 4 == 0 { (x, y) } else { (y, x) };
            DVec2::new(wrapped(x, shift.x), wrapped(y, shift.y))
        })
    }
}

/// The first n of the vertices in a torus of ⌈n/4⌉ cells, in [0, 1] along each axis.
fn vertices(n: usize) -> Vec<[f64; 2]> {
    let cells = n.div_ceil(4) as i64;
    let mut points = Vec::with_capacity(4 * n.div_ceil(4));
    if cells == 0 {
        return points;
    }
    let Torus { p, q, r, u } = Torus::of_cells(cells);
    // Modulo the lattice of (p, q) and (−r, u) all cells are those of this many columns and rows.
    let rows = bezout(q, u).0;
    let columns = cells / rows;
    let [p, q, r, u] = [p, q, r, u].map(|c| c as f64);
    for j in 0..rows {
        for i in 0..columns {
            for vertex in VERTICES {
                let DVec2 { x, y } = vertex + DVec2::new(i as f64, j as f64);
                let unit = [(x * u + y * r) / cells as f64, (y * p - x * q) / cells as f64];
                points.push(unit.map(|c| c - libm::floor(c)));
            }
        }
    }
    points.truncate(n);
    points
}

/// The parallelogram of (p, q) and (−r, u), in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Torus {
    p: i64,
    q: i64,
    r: i64,
    u: i64,
}

/// Cosines and sines of the angles between the torus' sides and the cells' that are tried: 7½°, 22½°, 37½°,
/// and the same from 90° down. Every 15° there are lines of vertices, and at 0°, 15° and 45° the error is
/// two to ten times as large as halfway between them.
const ANGLES: [DVec2; 6] = [
    DVec2::new(0.991_444_861_373_810_4, 0.130_526_192_220_051_6),
    DVec2::new(0.923_879_532_511_286_7, 0.382_683_432_365_089_8),
    DVec2::new(0.793_353_340_291_235_2, 0.608_761_429_008_720_6),
    DVec2::new(0.608_761_429_008_720_6, 0.793_353_340_291_235_2),
    DVec2::new(0.382_683_432_365_089_8, 0.923_879_532_511_286_7),
    DVec2::new(0.130_526_192_220_051_6, 0.991_444_861_373_810_4),
];

/// How far from the ideal (p, q) is looked, in cells: enough for sides within some percent of a square's.
const SEARCH: i64 = 4;

impl Torus {
    /// The best one of exactly so many cells, at least 1.
    fn of_cells(cells: i64) -> Self {
        let side = libm::sqrt(cells as f64);
        // There always is a straight one, if nothing better.
        let straight = Self { p: 1, q: 0, r: 0, u: cells };
        let mut best = (f64::INFINITY, straight);
        for angle in ANGLES {
            let (p0, q0) = ((side * angle.x) as i64, (side * angle.y) as i64);
            for p in (p0 - SEARCH).max(0)..=p0 + SEARCH {
                for q in (q0 - SEARCH).max(0)..=q0 + SEARCH {
                    if let Some(torus) = Self::squarest(cells, p, q) {
                        let cost = torus.cost(angle);
                        if cost < best.0 {
                            best = (cost, torus);
                        }
                    }
                }
            }
        }
        best.1
    }

    /// That of this many cells and side (p, q) whose other side is nearest to (−q, p). `None` if p's and
    /// q's common divisors do not divide the number.
    fn squarest(cells: i64, p: i64, q: i64) -> Option<Self> {
        let (divisor, x, y) = bezout(p, q);
        if divisor == 0 || cells % divisor != 0 {
            return None;
        }
        // One solution of p·u + q·r = cells; the others are steps of (q, −p) away.
        let (u, r) = (x * (cells / divisor), y * (cells / divisor));
        let (step_u, step_r) = (q / divisor, -p / divisor);
        let away = ((p - u) * step_u + (q - r) * step_r) as f64;
        let steps = libm::round(away / (step_u * step_u + step_r * step_r) as f64) as i64;
        Some(Self { p, q, r: r + steps * step_r, u: u + steps * step_u })
    }

    /// How far from a square at this angle, squared, as a part of the area. The stretch counts most.
    fn cost(self, angle: DVec2) -> f64 {
        let Self { p, q, r, u } = self;
        let cells = (p * u + q * r) as f64;
        let stretch = DVec2::new((r - q) as f64, (u - p) as f64).length_squared() / cells;
        let turn = (DVec2::new(p as f64, q as f64) / libm::sqrt(cells) - angle).length_squared();
        4.0 * stretch + turn
    }
}

/// The greatest common divisor d of two numbers from 0 up, and x and y with a·x + b·y = d.
fn bezout(a: i64, b: i64) -> (i64, i64, i64) {
    if b == 0 {
        return (a, 1, 0);
    }
    let (divisor, x, y) = bezout(b, a % b);
    (divisor, y, x - a / b * y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cell_is_the_snub_square_tilings() {
        // Every vertex has five neighbors at the distance of an edge, 1/(2 cos 15°) of the side, at the
        // angles of 3².4.3.4.
        let edge = 1.0 / libm::sqrt(2.0 + SQRT_3);
        for vertex in VERTICES {
            let mut angles = Vec::new();
            for other in VERTICES {
                for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
                    let away = other + DVec2::new(f64::from(i), f64::from(j)) - vertex;
                    if (away.length() - edge).abs() < 1e-9 {
                        angles.push(libm::atan2(away.y, away.x).to_degrees());
                    } else {
                        assert!(away.length() < 1e-9 || away.length() > 1.2 * edge);
                    }
                }
            }
            angles.sort_by(f64::total_cmp);
            assert_eq!(angles.len(), 5, "{vertex}");
            let gap = |k: usize| (angles[(k + 1) % 5] - angles[k] + 360.0) % 360.0;
            let squares = (0..5).filter(|k| (gap(*k) - 90.0).abs() < 1e-9).count();
            let triangles = (0..5).filter(|k| (gap(*k) - 60.0).abs() < 1e-9).count();
            assert_eq!((squares, triangles), (2, 3));
        }
    }

    #[test]
    fn a_torus_has_its_cells_and_is_nearly_square() {
        for cells in (1..400).chain([4096, 9973, 250_000, 1 << 29]) {
            let Torus { p, q, r, u } = Torus::of_cells(cells);
            assert_eq!(p * u + q * r, cells);
            let stretch = DVec2::new((r - q) as f64, (u - p) as f64).length();
            let side = libm::sqrt(cells as f64);
            // Two cells cannot be much of a square; from some hundred on it is one, more and more nearly.
            let most = [(1000, 0.06), (100, 0.3), (0, 2.0)];
            let most = most.iter().find(|(from, _)| cells > *from).map_or(0.0, |(_, most)| *most);
            assert!(stretch <= most * side, "{cells}: {p} {q} {r} {u}");
        }
    }

    #[test]
    fn points_are_distinct_places_and_none_are_close() {
        for n in [0usize, 1, 2, 3, 4, 7, 100, 1000, 1001, 4096] {
            let set = SeamlessSet::new(n, Limits::default()).unwrap();
            assert_eq!((set.len(), set.is_empty()), (n, n == 0));
            for axis in 0..2 {
                let mut along: Vec<u32> = set.places.iter().map(|place| place[axis]).collect();
                along.sort_unstable();
                assert!(along.into_iter().eq(0..n as u32));
            }
            let points: Vec<DVec2> = set.points(3).collect();
            assert!(points.iter().all(|p| p.cmpge(DVec2::ZERO).all() && p.cmplt(DVec2::ONE).all()));
            if (1000..2000).contains(&n) {
                // Over the border as well. A white set of 1,000 has pairs at 0.02 spacings.
                for (i, a) in points.iter().enumerate() {
                    for b in &points[..i] {
                        let away = (*a - *b).abs();
                        let away = away.min(1.0 - away).length() * libm::sqrt(n as f64);
                        assert!(away > 0.6, "{n}: {away}");
                    }
                }
            }
        }
        let few = Limits { points: 10, ..Limits::default() };
        assert!(SeamlessSet::new(11, few).is_err());
    }

    #[test]
    fn every_point_is_uniform_over_seeds() {
        let set = SeamlessSet::new(20, Limits::default()).unwrap();
        let mut cells = [0.0f64; 16];
        for seed in 0..4000 {
            if let Some(p) = set.points(seed).nth(7) {
                cells[(4.0 * p.x) as usize + 4 * (4.0 * p.y) as usize] += 1.0;
            }
        }
        let chi: f64 = cells.iter().map(|count| (count - 250.0) * (count - 250.0) / 250.0).sum();
        // 15 degrees of freedom: 15 ± 5.5.
        assert!(chi < 42.0, "{chi}");
    }
}
