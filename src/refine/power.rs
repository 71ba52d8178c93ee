//! The power diagram: which place belongs to which dot, where each dot has a weight.
//!
//! Crates for Delaunay triangulation (`spade`, `delaunator`) know no weights, and those for power diagrams want
//! a lifted convex hull in three dimensions; both would build a graph of all dots only for us to ask each
//! dot for its own cell. The grid that finds neighbors for the force finds them here too, dots are independent, and
//! the bits are ours.

use alloc::vec::Vec;

use super::cells::Cells;
use super::error::{RefineError, filled};
use super::ink::Ink;

/// Vertices that a cell may have. Even dots have six; the cell of a dot that has more
/// neighbors than this is a little too large.
const VERTICES: usize = 32;
/// No neighbor: the cut is the picture's border, or the end of what a dot may reach.
pub(super) const BORDER: u32 = u32::MAX;
/// How far a cell goes, in spacings, in a square about its dot. Even cells end at .6; those on the shore of a white
/// sea would cross it, and each would ask half of all dots where it ends.
const FURTHEST: f64 = 3.0;

/// A convex cell. Places are relative to its dot, in pixels; counterclockwise where y is up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    len: usize,
    places: [[f64; 2]; VERTICES],
    /// The dot on the other side of the edge that begins at each vertex, or [`BORDER`].
    beyond: [u32; VERTICES],
}

impl Cell {
    pub(super) const EMPTY: Self =
        Self { len: 0, places: [[0.0; 2]; VERTICES], beyond: [BORDER; VERTICES] };

    pub(super) fn places(&self) -> &[[f64; 2]] {
        &self.places[..self.len]
    }

    /// Both ends of each edge, and the dot beyond it.
    pub(super) fn edges(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2], u32)> + '_ {
        let places = self.places();
        let next = places.iter().cycle().skip(1);
        places.iter().zip(next).zip(&self.beyond).map(|((from, to), beyond)| (*from, *to, *beyond))
    }

    fn rectangle([left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> Self {
        let mut cell = Self { len: 4, ..Self::EMPTY };
        cell.places[..4].copy_from_slice(&[
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
        ]);
        cell
    }

    /// The square of the furthest vertex's distance.
    fn radius2(&self) -> f64 {
        let squares = self.places().iter().map(|[x, y]| x * x + y * y);
        squares.fold(0.0, |most, square| if square > most { square } else { most })
    }

    /// Cuts off what lies beyond x·`normal` = `offset`, with `neighbor` on the other side; `room` is
    /// for the result. Returns whether anything was cut.
    #[inline(always)]
    fn cut(&mut self, room: &mut Self, normal: [f64; 2], offset: f64, neighbor: u32) -> bool {
        let beyond = |[x, y]: [f64; 2]| x * normal[0] + y * normal[1] - offset;
        let mut sides = [0.0_f64; VERTICES];
        let mut any = false;
        for (side, place) in sides.iter_mut().zip(self.places()) {
            *side = beyond(*place);
            any |= *side > 0.0;
        }
        if !any {
            return false;
        }
        let mut len = 0;
        let mut push = |place: [f64; 2], beyond: u32| {
            if len < VERTICES {
                room.places[len] = place;
                room.beyond[len] = beyond;
            }
            len += 1;
        };
        for at in 0..self.len {
            let next = if at + 1 == self.len { 0 } else { at + 1 };
            let (from, to) = (self.places[at], self.places[next]);
            let (side, other) = (sides[at], sides[next]);
            let crossing = || {
                let share = side / (side - other);
                [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
            };
            match (side <= 0.0, other <= 0.0) {
                (true, true) => push(from, self.beyond[at]),
                (true, false) => {
                    push(from, self.beyond[at]);
                    push(crossing(), neighbor);
                }
                (false, true) => push(crossing(), self.beyond[at]),
                (false, false) => {}
            }
        }
        if len > VERTICES {
            return false;
        }
        room.len = len;
        core::mem::swap(self, room);
        true
    }
}

/// The dots of [`Cells`], with weights.
#[derive(Debug)]
pub(super) struct Power<'a> {
    ink: &'a Ink<'a>,
    cells: &'a Cells,
    weights: &'a [f64],
    /// From the finest on; the last is one block.
    levels: Vec<Level>,
}

/// The greatest weight about each place. Weights change slowly, and by many squared spacings from end to end of a
/// picture: one bound for all of it would have dots ask far more neighbors.
#[derive(Debug)]
struct Level {
    /// Grid cells along a block.
    block: usize,
    /// Blocks a row.
    across: usize,
    /// The greatest weight in each block and the eight about it: of all dots less than a block away.
    near: Vec<f64>,
}

/// Blocks along a block of the next level.
const FINER: usize = 4;

impl<'a> Power<'a> {
    /// With the weights of the dots in their order in the cells, in squared pixels.
    pub(super) fn new(
        ink: &'a Ink<'a>,
        cells: &'a Cells,
        weights: &'a [f64],
    ) -> Result<Self, RefineError> {
        let mut levels = Vec::new();
        let mut block = FINER;
        let [mut across, mut down] = cells.size().map(|cells| cells.div_ceil(block));
        let mut own = filled(across * down, f64::NEG_INFINITY)?;
        for ((x, y), weight) in cells.x.iter().zip(&cells.y).zip(weights) {
            let [column, row] = cells.at(*x, *y);
            let own = &mut own[row / block * across + column / block];
            *own = own.max(*weight);
        }
        loop {
            let mut near = filled(across * down, f64::NEG_INFINITY)?;
            for (at, near) in near.iter_mut().enumerate() {
                let (column, row) = (at % across, at / across);
                for j in row.saturating_sub(1)..(row + 2).min(down) {
                    for i in column.saturating_sub(1)..(column + 2).min(across) {
                        *near = near.max(own[j * across + i]);
                    }
                }
            }
            levels.push(Level { block, across, near });
            if across * down == 1 {
                return Ok(Self { ink, cells, weights, levels });
            }
            let size = [across, down].map(|blocks| blocks.div_ceil(FINER));
            let mut coarser = filled(size[0] * size[1], f64::NEG_INFINITY)?;
            for (at, weight) in own.iter().enumerate() {
                let to = at / across / FINER * size[0] + at % across / FINER;
                coarser[to] = f64::max(coarser[to], *weight);
            }
            own = coarser;
            [across, down] = size;
            block = block.saturating_mul(FINER);
        }
    }

    /// Whether no dot with `between` grid cells between it and a dot at (x, y) can cut a cell with a vertex at the
    /// square root of `radius2`, if that dot has this weight.
    fn enough(&self, [x, y]: [f32; 2], weight: f64, between: usize, radius2: f64) -> bool {
        let [column, row] = self.cells.at(x, y);
        let side = self.cells.side();
        let mut from = 0;
        for level in &self.levels {
            let last = level.near.len() == 1;
            if last || between < level.block {
                let distance = between.max(from) as f64 * side;
                let square = distance * distance;
                let heaviest = level.near[row / level.block * level.across + column / level.block];
                let cuts = square + weight - heaviest;
                let none = distance > 0.0 && cuts > 0.0 && cuts * cuts > 4.0 * square * radius2;
                if !none {
                    return false;
                }
            }
            from = level.block;
        }
        true
    }

    /// The cell of a dot where the spacing is `spacing`: all places x of the picture, no more than
    /// [`FURTHEST`] spacings away, with
    ///
    /// ```text
    /// |x − dot|² − weight ≤ |x − other|² − other's weight      for every other dot
    /// ```
    ///
    /// Neighbors are asked in rings of grid cells about the dot's, until none can be near enough to
    /// cut:
    ///
    /// ```text
    ///   2 2 2 2 2     A dot at distance d cuts at (d² + weight − other's weight) / 2d from
    ///   2 1 1 1 2     here: nothing, where that is more than the furthest vertex. All dots of
    ///   2 1 . 1 2     ring k are at least k − 1 sides of a grid cell away, and none is heavier
    ///   2 1 1 1 2     than the heaviest, near and far.
    ///   2 2 2 2 2
    /// ```
    pub(super) fn cell(&self, dot: usize, spacing: f64, cell: &mut Cell, room: &mut Cell) {
        let place = |dot: usize| [f64::from(self.cells.x[dot]), f64::from(self.cells.y[dot])];
        let [x, y] = place(dot);
        let weight = self.weights[dot];
        let most = FURTHEST * spacing;
        let low = |from: usize, at: f64| (from as f64 - at).max(-most);
        let high = |to: usize, at: f64| (to as f64 - at).min(most);
        let (columns, rows) = (self.ink.columns, self.ink.rows);
        *cell = Cell::rectangle(
            [low(columns[0], x), low(rows[0], y)],
            [high(columns[1], x), high(rows[1], y)],
        );
        let mut radius2 = cell.radius2();
        let at = [self.cells.x[dot], self.cells.y[dot]];
        let mut ring = 0_usize;
        loop {
            if self.enough(at, weight, ring.saturating_sub(1), radius2) {
                return;
            }
            let mut inside = false;
            for run in self.cells.ring(self.cells.x[dot], self.cells.y[dot], ring) {
                inside = true;
                for other in run {
                    let [u, v] = place(other);
                    let normal = [u - x, v - y];
                    let d2 = normal[0] * normal[0] + normal[1] * normal[1];
                    if d2 == 0.0 {
                        continue;
                    }
                    let offset = 0.5 * (d2 + weight - self.weights[other]);
                    if offset > 0.0 && offset * offset >= radius2 * d2 {
                        continue;
                    }
                    if cell.cut(room, normal, offset, other as u32) {
                        if cell.len == 0 {
                            return;
                        }
                        radius2 = cell.radius2();
                    }
                }
            }
            if !inside {
                return;
            }
            ring += 1;
        }
    }
}
