//! Rectangles of pixels.

use std::ops::Range;

/// Columns and rows of pixels, each from the first one up to one that is not of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
}

impl Area {
    /// All pixels of a picture of this size.
    pub(super) fn whole((width, height): (usize, usize)) -> Self {
        Self { columns: 0..width, rows: 0..height }
    }

    /// How many columns and rows there are.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.columns.len(), self.rows.len())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.rows.is_empty()
    }

    pub(super) fn holds(&self, x: usize, y: usize) -> bool {
        self.columns.contains(&x) && self.rows.contains(&y)
    }

    /// How many pixels there are.
    pub(super) fn count(&self) -> usize {
        self.columns.len().saturating_mul(self.rows.len())
    }

    /// Whether all of another are of this one.
    pub(super) fn covers(&self, other: &Self) -> bool {
        self.meet(other) == *other
    }

    /// The smallest area that holds this one and whole parts of a picture of this size, each of `part` pixels across
    /// and down but for the last.
    pub(super) fn widened(&self, part: (usize, usize), size: (usize, usize)) -> Self {
        let widened = |range: &Range<usize>, part: usize, length: usize| {
            range.start / part * part..range.end.div_ceil(part).saturating_mul(part).min(length)
        };
        Self {
            columns: widened(&self.columns, part.0, size.0),
            rows: widened(&self.rows, part.1, size.1),
        }
    }

    /// What is of both.
    pub(super) fn meet(&self, other: &Self) -> Self {
        let meet = |a: &Range<usize>, b: &Range<usize>| a.start.max(b.start)..a.end.min(b.end);
        Self { columns: meet(&self.columns, &other.columns), rows: meet(&self.rows, &other.rows) }
    }

    /// This part of `pixels`, which are those of `other`, row by row; it must lie in it.
    pub(super) fn cut<P: Copy>(&self, other: &Self, pixels: &[P]) -> Vec<P> {
        let width = other.columns.len();
        let mut part = Vec::with_capacity(self.columns.len() * self.rows.len());
        for y in self.rows.clone() {
            let row = &pixels[(y - other.rows.start) * width..][..width];
            let start = self.columns.start - other.columns.start;
            part.extend_from_slice(&row[start..][..self.columns.len()]);
        }
        part
    }
}
