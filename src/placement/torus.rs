//! Tori: the tiles of a domain without a border.
//!
//! ```text
//! level 3   k × l cells of the snub-square tiling (4 vertices each) over the domain: the roots
//! level 4   14 children of each: the frontier, every tile with its center in the domain
//! rank      digit · roots + root's place among the roots, and on by the rule of all ranks
//! ```
//!
//! Nothing is stored a tile: tile `i` is the child with digit `i` mod 14 of the root at place `i`/14.

use glam::DVec2;

use crate::tables::{ExactPoint, Tables};
use crate::tiling::counts::Numbering;
use crate::tiling::{FCode, MAX_CHILDREN, RankError, TileType, snub_square};
use crate::tree::frame::Frame;
use crate::tree::node::Node;

/// The level of the roots: their children are the frontier.
pub(super) const ROOT_LEVEL: u8 = 3;

/// The most cells along a side: the rectangles of screens and sheets are within 16 : 9, whose 576 roots with all
/// their children cost a walk that needs them half a millisecond.
pub(super) const MAX_CELLS: u32 = 16;

/// How far, relatively, the ratio of the sides may be from k : l: sides that once were `f32` are this near.
const RATIO_TOLERANCE: f64 = 2e-7;

/// 1/ρ and 1/ρ², ρ³ = ρ + 1: steps of the R2 sequence, whose beginnings are spread over the square. Cells
/// come in such an order, so that no region has its points before another.
const STEPS: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3);

/// The cells of a seamless domain, and where they lie.
#[derive(Clone, Debug)]
pub(super) struct Torus {
    /// Cells along x and y, without a common divisor.
    cells: [u32; 2],
    /// From a cell to the next in order, along x and y: coprime to `cells`, so that cell s is at
    /// (s·steps) mod cells, and no two are the same.
    steps: [u32; 2],
    /// How the vertices of a cell are turned, by 90° each: about the same tiling, with other types.
    quarters: u8,
    /// What coordinates are relative to: the root nearest to the domain's center, in edges of the roots.
    reference: ExactPoint,
    /// Where it is, relative to the domain's least corner.
    origin: DVec2,
    size: DVec2,
    /// Half an edge of the roots and of their children, along the tiling's x axis.
    half_edges: [DVec2; 2],
}

impl Torus {
    /// The whole numbers k and l to which a rectangle's sides are, if they are small.
    pub(super) fn cells_of(size: DVec2) -> Option<[u32; 2]> {
        // Ascending, so that the first found have no common divisor.
        (1..=MAX_CELLS).find_map(|rows| {
            let columns = libm::round(f64::from(rows) * (size.x / size.y));
            let ratio = size.x * f64::from(rows) / (size.y * columns);
            let fits = (1.0..=f64::from(MAX_CELLS)).contains(&columns);
            (fits && (ratio - 1.0).abs() <= RATIO_TOLERANCE).then_some([columns as u32, rows])
        })
    }

    /// The number of roots.
    pub(super) fn roots(cells: [u32; 2]) -> u64 {
        4 * u64::from(cells[0]) * u64::from(cells[1])
    }

    /// Half an edge of the roots along the tiling's x axis: a cell is 2 cos 15° edges wide, and its side
    /// is at 15°, so that half an edge at −15° is a quarter of (1, −tan 15°) cells.
    pub(super) fn half_edge(size: DVec2, cells: [u32; 2]) -> DVec2 {
        let cell = size.x / f64::from(cells[0]);
        0.25 * cell * DVec2::new(1.0, crate::tiling::numbers::SQRT_3 - 2.0)
    }

    /// With the corner of a cell at `shift`, in the domain's sides from its least corner, and the cells
    /// turned.
    pub(super) fn new(size: DVec2, cells: [u32; 2], shift: DVec2, quarters: u8) -> Self {
        let half_edge = Self::half_edge(size, cells);
        let half_edges = [half_edge, half_edge / crate::tiling::numbers::LAMBDA];
        let steps = [0, 1].map(|i| coprime_near(STEPS[i], cells[i]));
        let mut torus = Self {
            cells,
            steps,
            quarters: quarters % 4,
            reference: ExactPoint::default(),
            origin: shift * size,
            size,
            half_edges,
        };
        let mut nearest = (f64::INFINITY, ExactPoint::default(), DVec2::ZERO);
        for place in 0..Self::roots(cells) {
            let center = torus.home(torus.root(place).center, 0);
            let at = torus.position(center, 0);
            let distance = at.distance_squared(0.5 * size);
            if distance < nearest.0 {
                nearest = (distance, center, at);
            }
        }
        (torus.reference, torus.origin) = (nearest.1, nearest.2);
        torus
    }

    /// Where the reference is, relative to the domain's least corner.
    pub(super) fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The root at this place among the roots, its center relative to the reference.
    fn root(&self, place: u64) -> Node {
        let cells = self.cells.map(u64::from);
        let count = cells[0] * cells[1];
        let (vertex, cell) = ((place / count) as usize % 4, place % count);
        let [column, row] = [0, 1].map(|i| (cell * u64::from(self.steps[i]) % cells[i]) as i32);
        let (kind, rotation, center) = snub_square::VERTICES[vertex];
        let turned = exact(center).turned_back((4 - self.quarters) % 4);
        let [x, y] = snub_square::CELL.map(exact);
        let center = turned.plus(x.times(column)).plus(y.times(row)).minus(self.reference);
        let rotation = (rotation + 3 * self.quarters) % 12;
        Node { kind, rotation, level: ROOT_LEVEL, center, rank: place }
    }

    /// Tile `i` of the frontier.
    pub(super) fn node(
        &self,
        tables: &Tables<'_>,
        numbering: &Numbering,
        i: usize,
    ) -> Option<Node> {
        let place = (i / MAX_CHILDREN) as u64;
        if place >= Self::roots(self.cells) {
            return None;
        }
        let node = self.root(place).child(tables, numbering, i % MAX_CHILDREN)?;
        Some(Node { center: self.home(node.center, 1), ..node })
    }

    /// Whether there is more than one.
    pub(super) fn has_many_cells(&self) -> bool {
        self.cells != [1, 1]
    }

    /// The root of tile `i` of the frontier, with its center in the domain.
    pub(super) fn root_of(&self, i: usize) -> Node {
        let root = self.root((i / MAX_CHILDREN) as u64);
        Node { center: self.home(root.center, 0), ..root }
    }

    /// The first tile of the frontier, from tile `i` on, whose rank is below `limit`, and which it is: what
    /// few points are made of is found without looking at all the others.
    pub(super) fn node_below(
        &self,
        tables: &Tables<'_>,
        numbering: &Numbering,
        i: usize,
        limit: u64,
    ) -> Option<(usize, Node)> {
        let roots = Self::roots(self.cells);
        let (place, digit) = ((i / MAX_CHILDREN) as u64, (i % MAX_CHILDREN) as u64);
        // Ranks rise with digits: where this one's is too high, so are those of the digits after it.
        let i = if digit * roots + place < limit { i } else { i - i % MAX_CHILDREN + MAX_CHILDREN };
        // And with places, of the digit 0.
        let place = (i / MAX_CHILDREN) as u64;
        if place >= limit {
            return None;
        }
        Some((i, self.node(tables, numbering, i)?))
    }

    /// The root of a tile of the frontier, and the way from it.
    pub(super) fn way_to(&self, node: &Node) -> (Node, Result<FCode, RankError>) {
        let roots = Self::roots(self.cells);
        let root = self.root(node.rank % roots);
        // No root is an `a` tile: the digit is the rank among its own children.
        (root, FCode::from_rank(TileType::C, 1, node.rank / roots))
    }

    /// The image, by whole periods, of a point `below` levels below the roots that lies in the domain.
    fn home(&self, at: ExactPoint, below: usize) -> ExactPoint {
        let sides = self.position(at, below) / self.size;
        let [across, down] = sides.to_array().map(|sides| libm::floor(sides) as i32);
        let [x, y] = snub_square::CELL.map(|side| (0..below).fold(exact(side), |z, _| z.finer()));
        let [columns, rows] = self.cells.map(|count| count as i32);
        at.plus(x.times(-columns * across)).plus(y.times(-rows * down))
    }

    /// Relative to the domain's least corner.
    fn position(&self, at: ExactPoint, below: usize) -> DVec2 {
        let frame = Frame::new(self.half_edges[below.min(1)], self.origin, 0);
        DVec2::from_array(frame.position(at))
    }
}

/// The number nearest to `part` of `count` that has no common divisor with it.
fn coprime_near(part: f64, count: u32) -> u32 {
    let wanted = (part * f64::from(count)) as u32;
    (0..count)
        .flat_map(|by| [wanted + by, wanted.saturating_sub(by)])
        .find(|step| gcd(*step, count) == 1)
        .unwrap_or(1)
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// A ring element with small coefficients.
fn exact(z: crate::tiling::Cyclotomic) -> ExactPoint {
    let [a, b, c, d] = z.0.map(|a| a as i32);
    ExactPoint { u: 2 * a + c, v: b, p: b + 2 * d, q: c }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ratios_are_found_and_others_are_not() {
        let cells = |x: f64, y: f64| Torus::cells_of(DVec2::new(x, y));
        assert_eq!(cells(1.0, 1.0), Some([1, 1]));
        assert_eq!(cells(0.3, 0.1), Some([3, 1]));
        assert_eq!(cells(1920.0, 1080.0), Some([16, 9]));
        assert_eq!(cells(f64::from(1.6f32), f64::from(0.9f32)), Some([16, 9]));
        assert_eq!(cells(2e-90, 8e-90), Some([1, 4]));
        assert_eq!(cells(1.0, 1.000_001), None);
        assert_eq!(cells(17.0, 1.0), None);
        assert_eq!(cells(1.0, 1e90), None);
        assert_eq!(cells(core::f64::consts::PI, 1.0), None);
    }

    #[test]
    fn every_cell_has_one_place() {
        for columns in 1..=MAX_CELLS {
            for rows in (1..=MAX_CELLS).filter(|rows| gcd(*rows, columns) == 1) {
                let size = DVec2::new(columns.into(), rows.into());
                let torus = Torus::new(size, [columns, rows], DVec2::new(0.3, 0.6), 1);
                let mut seen = std::collections::HashSet::new();
                for place in 0..Torus::roots([columns, rows]) {
                    let ExactPoint { u, v, p, q } = torus.home(torus.root(place).center, 0);
                    assert!(seen.insert([u, v, p, q]));
                }
            }
        }
    }
}
