//! Where dots may be: on pixels above 0 of the picture as it was given.

use super::error::{RefineError, reserve};

/// The picture as it was given: every value finite and at least 0, at least one above 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ink<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: &'a [f32],
    /// Sum of all pixels.
    pub(super) total: f64,
    /// Greatest pixel.
    pub(super) darkest: f32,
    /// Columns and rows that hold ink: from the first to one past the last.
    pub(super) columns: [usize; 2],
    pub(super) rows: [usize; 2],
}

impl<'a> Ink<'a> {
    /// Reads every pixel once.
    pub(super) fn new(
        width: usize,
        height: usize,
        pixels: &'a [f32],
    ) -> Result<Option<Self>, RefineError> {
        if width.checked_mul(height) != Some(pixels.len()) {
            return Err(RefineError::Size { width, height, pixels: pixels.len() });
        }
        let mut ink = Self {
            width,
            height,
            pixels,
            total: 0.0,
            darkest: 0.0,
            columns: [width, 0],
            rows: [height, 0],
        };
        if pixels.is_empty() {
            return Ok(None);
        }
        for (y, row) in pixels.chunks_exact(width).enumerate() {
            // eight lanes, so that the order of the sum does not depend on the vectors' width
            let (eights, rest) = row.as_chunks::<8>();
            let mut sums = [0.0_f64; 8];
            let mut most = [0.0_f32; 8];
            let mut fine = true;
            for eight in eights {
                for lane in 0..8 {
                    fine &= eight[lane] >= 0.0 && eight[lane] < f32::INFINITY;
                    sums[lane] += f64::from(eight[lane]);
                    most[lane] = if eight[lane] > most[lane] { eight[lane] } else { most[lane] };
                }
            }
            for (lane, value) in rest.iter().enumerate() {
                fine &= *value >= 0.0 && *value < f32::INFINITY;
                sums[lane] += f64::from(*value);
                most[lane] = if *value > most[lane] { *value } else { most[lane] };
            }
            if !fine {
                let bad = |value: &f32| !(*value >= 0.0 && *value < f32::INFINITY);
                let x = row.iter().position(bad).unwrap_or(0);
                return Err(RefineError::Pixel { x, y, value: row[x] });
            }
            let most = most.iter().fold(0.0, |a: f32, b| a.max(*b));
            if most > 0.0 {
                ink.total += sums.iter().sum::<f64>();
                ink.darkest = ink.darkest.max(most);
                ink.rows = [ink.rows[0].min(y), y + 1];
                let first = row.iter().position(|value| *value > 0.0).unwrap_or(0);
                let last = row.iter().rposition(|value| *value > 0.0).unwrap_or(0);
                ink.columns = [ink.columns[0].min(first), ink.columns[1].max(last + 1)];
            }
        }
        Ok((ink.total > 0.0).then_some(ink))
    }

    /// Whether a dot may be here: inside of the picture, on a pixel above 0.
    #[inline(always)]
    pub(super) fn holds(&self, x: f32, y: f32) -> bool {
        // not finite and negative ones fail here; the conversion saturates
        if !(x >= 0.0 && y >= 0.0) {
            return false;
        }
        let (u, v) = (x as usize, y as usize);
        u < self.width && v < self.height && self.pixels[v * self.width + u] > 0.0
    }

    /// Where a dot at a place with ink that wants to move by (dx, dy) comes to: there, or half way, or along
    /// one axis (the longer way first), or a quarter of the way, or it stays.
    #[inline(always)]
    pub(super) fn slide(&self, x: f32, y: f32, dx: f32, dy: f32) -> (f32, f32) {
        if self.holds(x + dx, y + dy) {
            return (x + dx, y + dy);
        }
        self.slide_along(x, y, dx, dy)
    }

    #[cold]
    fn slide_along(&self, x: f32, y: f32, dx: f32, dy: f32) -> (f32, f32) {
        let (along_x, along_y) = ((x + dx, y), (x, y + dy));
        let (longer, shorter) =
            if dx.abs() > dy.abs() { (along_x, along_y) } else { (along_y, along_x) };
        let (half, quarter) = ((x + 0.5 * dx, y + 0.5 * dy), (x + 0.25 * dx, y + 0.25 * dy));
        for (x, y) in [half, longer, shorter, quarter] {
            if self.holds(x, y) {
                return (x, y);
            }
        }
        (x, y)
    }
}

/// For every pixel the nearest column with ink in its row: four bytes a pixel, made only when a dot
/// has to be brought to ink.
pub(super) struct NearestInk<'a> {
    ink: Ink<'a>,
    columns: alloc::vec::Vec<u32>,
}

/// No ink in this row.
const NONE: u32 = u32::MAX;

impl<'a> NearestInk<'a> {
    pub(super) fn new(ink: Ink<'a>) -> Result<Self, RefineError> {
        let mut columns = reserve::<u32>(ink.pixels.len())?;
        for row in ink.pixels.chunks_exact(ink.width) {
            let from = columns.len();
            let mut last = NONE;
            for (x, value) in row.iter().enumerate() {
                last = if *value > 0.0 { x as u32 } else { last };
                columns.push(last);
            }
            let mut next = NONE;
            for x in (0..row.len()).rev() {
                next = if row[x] > 0.0 { x as u32 } else { next };
                let before = columns[from + x];
                let nearer =
                    before == NONE || next != NONE && (next as usize - x) < x - before as usize;
                if nearer {
                    columns[from + x] = next;
                }
            }
        }
        Ok(Self { ink, columns })
    }

    /// The middle half of the nearest pixel with ink, at the place nearest to (x, y), which is brought
    /// into the picture first. Of pixels equally far, the upper one, then the left one.
    pub(super) fn bring(&self, x: f32, y: f32) -> (f32, f32) {
        let (width, height) = (self.ink.width, self.ink.height);
        let u = (x.max(0.0) as usize).min(width - 1);
        let v = (y.max(0.0) as usize).min(height - 1);
        let mut best = (usize::MAX, u, v);
        let mut distance = 0;
        while distance < height && distance.saturating_mul(distance) < best.0 {
            let rows = [v.checked_sub(distance), Some(v + distance).filter(|row| *row < height)];
            for row in rows.into_iter().flatten() {
                let column = self.columns[row * width + u];
                if column != NONE {
                    let across = u.abs_diff(column as usize);
                    let squared = across * across + distance * distance;
                    if squared < best.0 {
                        best = (squared, column as usize, row);
                    }
                }
            }
            distance += 1;
        }
        let within =
            |place: f32, pixel: usize| place.clamp(pixel as f32 + 0.25, pixel as f32 + 0.75);
        (within(x, best.1), within(y, best.2))
    }
}
