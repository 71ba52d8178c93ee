//! Dots sorted into square cells, so that neighbors are found in runs.

use super::error::{RefineError, filled, reserve};
use super::ink::Ink;

/// A dot on its way: position and velocity in pixels, and its place in the caller's list.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Dot {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) vx: f32,
    pub(super) vy: f32,
    pub(super) index: u32,
}

/// Dots by cell, cells row by row; a row of cells is one run. 8 bytes a dot and 4 a cell.
#[derive(Debug)]
pub(super) struct Cells {
    left: f32,
    top: f32,
    per_pixel: f32,
    across: usize,
    down: usize,
    /// First dot of each cell, then the number of dots.
    first: alloc::vec::Vec<u32>,
    /// Coordinates of the sorted dots and [`LANES`] that are nowhere.
    pub(super) x: alloc::vec::Vec<f32>,
    pub(super) y: alloc::vec::Vec<f32>,
}

/// Dots or pixels that are looked at together. Sums keep this many partial sums, whatever the width of
/// the machine's vectors.
pub(super) const LANES: usize = 8;

/// Dots in a cell from which on they are sorted. Even ones are one or two; where the picture is of a few hot pixels they
/// may be all, and each would look at each.
const CROWD: usize = 64;
/// The most cells a dot. More would only be empty.
const CELLS_A_DOT: f64 = 4.0;

impl Cells {
    /// Cells of about `side` pixels over the ink.
    pub(super) fn new(ink: &Ink<'_>, dots: usize, side: f64) -> Result<Self, RefineError> {
        let width = (ink.columns[1] - ink.columns[0]) as f64;
        let height = (ink.rows[1] - ink.rows[0]) as f64;
        let most = CELLS_A_DOT * dots as f64 + 1.0;
        // w/s · h/s ≤ most, and neither more than most, for slits of pictures
        let side = side.max((width * height / most).sqrt()).max(width.max(height) / most);
        let across = (width / side) as usize + 1;
        let down = (height / side) as usize + 1;
        Ok(Self {
            left: ink.columns[0] as f32,
            top: ink.rows[0] as f32,
            per_pixel: (1.0 / side) as f32,
            across,
            down,
            first: filled(across * down + 1, 0)?,
            x: filled(dots + LANES, f32::INFINITY)?,
            y: filled(dots + LANES, f32::INFINITY)?,
        })
    }

    #[inline(always)]
    fn column(&self, x: f32) -> usize {
        (((x - self.left) * self.per_pixel) as usize).min(self.across - 1)
    }

    #[inline(always)]
    fn row(&self, y: f32) -> usize {
        (((y - self.top) * self.per_pixel) as usize).min(self.down - 1)
    }

    /// Counting sort of `dots` into `sorted`, of the same length.
    pub(super) fn sort(&mut self, dots: &[Dot], sorted: &mut [Dot]) {
        self.first.fill(0);
        let cell = |cells: &Self, dot: &Dot| cells.row(dot.y) * cells.across + cells.column(dot.x);
        for dot in dots {
            let cell = cell(self, dot);
            self.first[cell + 1] += 1;
        }
        let mut sum = 0;
        for first in &mut self.first {
            sum += *first;
            *first = sum;
        }
        for dot in dots {
            let cell = cell(self, dot);
            let place = self.first[cell] as usize;
            self.first[cell] += 1;
            sorted[place] = *dot;
            self.x[place] = dot.x;
            self.y[place] = dot.y;
        }
        // each cell's first is now the next one's
        self.first.rotate_right(1);
        self.first[0] = 0;
        // the last entry was the count and is again: nothing lies beyond the last cell
        self.sort_crowds(sorted);
    }

    /// Sorts the dots of each crowded cell by x, so that [`Self::runs`] need not go through all of it.
    fn sort_crowds(&mut self, sorted: &mut [Dot]) {
        for cell in self.first.windows(2) {
            let run = cell[0] as usize..cell[1] as usize;
            if run.len() > CROWD {
                let dots = &mut sorted[run.clone()];
                dots.sort_unstable_by(|one, other| {
                    one.x.total_cmp(&other.x).then(one.index.cmp(&other.index))
                });
                for (at, dot) in run.zip(dots) {
                    (self.x[at], self.y[at]) = (dot.x, dot.y);
                }
            }
        }
    }

    /// A run of cells without the dots of crowded ends that are further than `reach` from `x`.
    #[cold]
    fn narrowed(&self, cells: [usize; 2], x: f32, reach: f32) -> core::ops::Range<usize> {
        let mut run = self.first[cells[0]] as usize..self.first[cells[1] + 1] as usize;
        let [first, last] =
            cells.map(|cell| self.first[cell] as usize..self.first[cell + 1] as usize);
        if first.len() > CROWD {
            run.start += self.x[first].partition_point(|place| *place < x - reach);
        }
        if last.len() > CROWD {
            run.end -= last.len() - self.x[last].partition_point(|place| *place <= x + reach);
        }
        run.start..run.end.max(run.start)
    }

    /// For each row of cells within `reach` of (x, y), the run of dots that holds all within `reach`.
    #[inline(always)]
    pub(super) fn runs(
        &self,
        x: f32,
        y: f32,
        reach: f32,
    ) -> impl Iterator<Item = core::ops::Range<usize>> + '_ {
        let (i0, i1) = (self.column(x - reach), self.column(x + reach));
        (self.row(y - reach)..=self.row(y + reach)).map(move |j| {
            let row = j * self.across;
            let run = self.first[row + i0] as usize..self.first[row + i1 + 1] as usize;
            if run.len() > CROWD { self.narrowed([row + i0, row + i1], x, reach) } else { run }
        })
    }
}

impl Cells {
    /// Side of a cell, in pixels.
    pub(super) fn side(&self) -> f64 {
        1.0 / f64::from(self.per_pixel)
    }

    /// Columns and rows of cells.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.across, self.down]
    }

    /// Column and row of the cell of a place.
    #[inline(always)]
    pub(super) fn at(&self, x: f32, y: f32) -> [usize; 2] {
        [self.column(x), self.row(y)]
    }

    /// How many dots lie in the cell of this place.
    pub(super) fn crowd(&self, x: f32, y: f32) -> usize {
        let cell = self.row(y) * self.across + self.column(x);
        (self.first[cell + 1] - self.first[cell]) as usize
    }

    /// The runs of dots in the cells that are `distance` away from that of (x, y), the longer way of the
    /// two; none if all those lie beyond the borders.
    pub(super) fn ring(
        &self,
        x: f32,
        y: f32,
        distance: usize,
    ) -> impl Iterator<Item = core::ops::Range<usize>> + '_ {
        let (column, row) = (self.column(x), self.row(y));
        let top = row.saturating_sub(distance);
        let bottom = (row + distance).min(self.down - 1);
        let left = column.checked_sub(distance);
        let right = Some(column + distance).filter(|right| *right < self.across);
        let first = left.unwrap_or(0);
        let last = right.unwrap_or(self.across - 1);
        let between = move |row: usize, from: usize, to: usize| {
            let start = row * self.across;
            self.first[start + from] as usize..self.first[start + to + 1] as usize
        };
        let reached = row.checked_sub(distance).is_some()
            || row + distance < self.down
            || left.is_some()
            || right.is_some();
        let rows = if reached { top..bottom + 1 } else { 0..0 };
        rows.flat_map(move |j| {
            if j.abs_diff(row) == distance {
                [Some(between(j, first, last)), None]
            } else {
                [left.map(|at| between(j, at, at)), right.map(|at| between(j, at, at))]
            }
        })
        .flatten()
    }
}

/// Dots from positions, or which one is not finite.
pub(super) fn dots(
    points: impl ExactSizeIterator<Item = [f64; 2]>,
) -> Result<alloc::vec::Vec<Dot>, RefineError> {
    let mut dots = reserve(points.len())?;
    if u32::try_from(points.len()).is_err() {
        return Err(RefineError::Memory { bytes: points.len().saturating_mul(size_of::<Dot>()) });
    }
    for (index, [x, y]) in points.enumerate() {
        if !(x.is_finite() && y.is_finite()) {
            return Err(RefineError::Point { index });
        }
        dots.push(Dot { x: x as f32, y: y as f32, index: index as u32, ..Dot::default() });
    }
    Ok(dots)
}
