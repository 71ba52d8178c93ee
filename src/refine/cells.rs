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
            self.first[row + i0] as usize..self.first[row + i1 + 1] as usize
        })
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
