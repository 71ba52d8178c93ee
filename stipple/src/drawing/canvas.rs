//! A picture in memory that collects the ink of dots.

use std::ops::Range;

use glam::DVec2;

use super::coverage::{Disc, FULL, Stamp};

/// Places within a pixel, each way, at which discs are kept ready: a dot moves by at most a 32nd of a
/// pixel to the nearest.
const PLACES: usize = 16;

/// The largest radius, in pixels, of discs kept ready; together they take under two mebibytes. Larger
/// dots are made one by one, which costs less than putting them down.
const READY_RADIUS: f64 = 24.0;

/// Ink for each pixel of a picture. Dots add up, and no pixel gets more than full coverage, so the
/// order of dots is of no consequence.
#[derive(Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    ink: Vec<u16>,
    radius: f64,
    /// Discs for each place within a pixel, row by row; empty when the radius is large.
    ready: Vec<Stamp>,
}

impl Canvas {
    /// An empty canvas for dots of `radius` pixels, or `None` when the system has no memory for it.
    pub(super) fn new(width: usize, height: usize, radius: f64) -> Option<Self> {
        let count = width.checked_mul(height)?;
        let mut ink = Vec::new();
        ink.try_reserve_exact(count).ok()?;
        ink.resize(count, 0);
        let ready = if radius <= READY_RADIUS {
            let place = |index: usize| index as f64 / PLACES as f64;
            let sides = PLACES + 1;
            (0..sides * sides)
                .map(|index| {
                    Stamp::new(Disc { x: place(index % sides), y: place(index / sides), radius })
                })
                .collect()
        } else {
            Vec::new()
        };
        Some(Self { width, height, ink, radius, ready })
    }

    /// Adds a dot with its center at (x, y), in pixels; what lies outside the canvas is cut off.
    pub(super) fn dot(&mut self, x: f64, y: f64) {
        if self.ready.is_empty() {
            self.large_dot(Disc { x, y, radius: self.radius });
            return;
        }
        let (column, row) = (x.floor(), y.floor());
        let place = |offset: f64| (offset * PLACES as f64).round() as usize;
        let stamp = &self.ready[place(y - row) * (PLACES + 1) + place(x - column)];
        add(&mut self.ink, self.width, self.height, stamp, column as i64, row as i64);
    }

    /// Adds a disc row by row, without a picture of the part that lies outside the canvas.
    fn large_dot(&mut self, disc: Disc) {
        let Disc { x, y, radius } = disc;
        let columns = span(x, radius, self.width);
        let mut area = vec![0.0; columns.len()];
        for row in span(y, radius, self.height) {
            disc.row(row as f64, columns.start as f64, &mut area);
            let pixels = &mut self.ink[row * self.width..][columns.clone()];
            for (pixel, area) in pixels.iter_mut().zip(&area) {
                *pixel = pixel.saturating_add((area * f64::from(FULL)).round() as u16);
            }
        }
    }

    /// Draws a line of the dots' radius from one place to another. A line that goes on where another ends is
    /// as if both were one: what both cover is covered once.
    pub(super) fn line(&mut self, [from, to]: [DVec2; 2]) {
        let reach = self.radius + 1.0;
        let (low, high) = (from.min(to), from.max(to));
        let along = to - from;
        let squared = along.length_squared();
        for row in span(0.5 * (low.y + high.y), 0.5 * (high.y - low.y) + reach, self.height) {
            // The part of the line near this row, for long lines that lie aslant.
            let [first, last] = if along.y == 0.0 {
                [low.x, high.x]
            } else {
                let x_at = |y: f64| from.x + along.x * ((y - from.y) / along.y).clamp(0.0, 1.0);
                let y = row as f64 + 0.5;
                [x_at(y - reach), x_at(y + reach)]
            };
            let (left, right) = (first.min(last), first.max(last));
            let columns = span(0.5 * (left + right), 0.5 * (right - left) + reach, self.width);
            let pixels = &mut self.ink[row * self.width..][columns.clone()];
            for (pixel, column) in pixels.iter_mut().zip(columns) {
                let away = DVec2::new(column as f64, row as f64) + 0.5 - from;
                let part =
                    if squared > 0.0 { (away.dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
                let distance = (away - part * along).length();
                // What a straight border at this distance leaves of a pixel; thin lines cover their width.
                let inside = (distance + 0.5).min(self.radius) - (distance - 0.5).max(-self.radius);
                let ink = (inside.clamp(0.0, 1.0) * f64::from(FULL)).round() as u16;
                *pixel = (*pixel).max(ink);
            }
        }
    }

    /// Removes all ink.
    pub(super) fn clear(&mut self) {
        self.ink.fill(0);
    }

    /// Rows from the top, each with its pixels' ink from 0 to [`FULL`].
    pub(super) fn rows(&self) -> impl Iterator<Item = &[u16]> {
        self.ink.chunks_exact(self.width)
    }
}

/// The pixels of a row or column of `length` that may lie within `radius` of `center`.
fn span(center: f64, radius: f64, length: usize) -> Range<usize> {
    // Casts take what is below zero to zero.
    let start = ((center - radius) as usize).min(length);
    let end = ((center + radius).ceil() as usize).min(length);
    start..end.max(start)
}

/// Adds `stamp` around pixel (`column`, `row`).
fn add(ink: &mut [u16], width: usize, height: usize, stamp: &Stamp, column: i64, row: i64) {
    let (left, top) = (column + stamp.left, row + stamp.top);
    // The part of the stamp that lies on the canvas.
    let skipped = usize::try_from(-left).unwrap_or(0).min(stamp.width);
    let start = usize::try_from(left).unwrap_or(0).min(width);
    let length = (stamp.width - skipped).min(width - start);
    for (offset, coverage) in stamp.coverage.chunks_exact(stamp.width).enumerate() {
        let Ok(y) = usize::try_from(top + offset as i64) else { continue };
        if y >= height {
            break;
        }
        let pixels = &mut ink[y * width + start..][..length];
        for (pixel, &units) in pixels.iter_mut().zip(&coverage[skipped..]) {
            *pixel = pixel.saturating_add(units);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(canvas: &Canvas) -> f64 {
        canvas.ink.iter().map(|&units| f64::from(units)).sum::<f64>() / f64::from(FULL)
    }

    #[test]
    fn dots_of_any_size_leave_their_area_of_ink() {
        for radius in [0.05, 0.4, 1.0, 7.5, 23.9, 24.1, 40.0] {
            let mut canvas = Canvas::new(200, 100, radius).unwrap();
            canvas.dot(50.31, 49.77);
            canvas.dot(149.99, 50.0);
            let area = 2.0 * std::f64::consts::PI * radius * radius;
            assert!((ink(&canvas) / area - 1.0).abs() < 2e-3, "radius {radius}: {}", ink(&canvas));
        }
    }

    #[test]
    fn the_center_of_the_ink_is_the_dots() {
        let mut canvas = Canvas::new(20, 20, 2.3).unwrap();
        canvas.dot(9.4, 11.85);
        let (mut sum, mut x, mut y) = (0.0, 0.0, 0.0);
        for (row, pixels) in canvas.rows().enumerate() {
            for (column, &units) in pixels.iter().enumerate() {
                let units = f64::from(units);
                sum += units;
                x += units * (column as f64 + 0.5);
                y += units * (row as f64 + 0.5);
            }
        }
        assert!((x / sum - 9.4).abs() <= 1.0 / 32.0 + 1e-3);
        assert!((y / sum - 11.85).abs() <= 1.0 / 32.0 + 1e-3);
    }

    #[test]
    fn dots_across_the_border_are_cut_off() {
        for radius in [1.5, 30.0] {
            for (x, y) in [(0.0, 0.0), (10.0, 0.0), (0.0, 8.0), (9.999, 7.999), (5.0, 8.0)] {
                let mut canvas = Canvas::new(10, 8, radius).unwrap();
                canvas.dot(x, y);
                assert!(ink(&canvas) > 0.2);
            }
        }
        let mut canvas = Canvas::new(10, 8, 1.5).unwrap();
        canvas.dot(0.0, 0.0);
        let quarter = std::f64::consts::PI * 1.5 * 1.5 / 4.0;
        assert!((ink(&canvas) - quarter).abs() < 1e-3);
        canvas.dot(-50.0, 4.0);
        canvas.dot(1e9, 4.0);
        assert!((ink(&canvas) - quarter).abs() < 1e-3);
    }

    #[test]
    fn a_dot_as_large_as_the_canvas_and_larger_takes_no_memory_of_its_own() {
        let mut canvas = Canvas::new(100, 50, 1e6).unwrap();
        canvas.dot(99.0, 1.0);
        assert!(canvas.ink.iter().all(|&units| units == FULL));
    }

    #[test]
    fn lines_leave_their_area_of_ink_in_any_direction() {
        for radius in [0.2, 0.8, 3.0] {
            for to in [[90.0, 10.5], [60.0, 70.0], [10.0, 90.0], [35.0, 11.0]] {
                let from = DVec2::new(10.0, 10.5);
                let to = DVec2::from_array(to);
                let mut canvas = Canvas::new(100, 100, radius).unwrap();
                canvas.line([from, 0.5 * (from + to)]);
                canvas.line([0.5 * (from + to), to]);
                canvas.line([to, from]);
                let area =
                    2.0 * radius * from.distance(to) + std::f64::consts::PI * radius * radius;
                assert!(
                    (ink(&canvas) / area - 1.0).abs() < 0.03,
                    "{radius} {to}: {}",
                    ink(&canvas)
                );
            }
        }
    }

    #[test]
    fn dots_on_one_place_are_no_darker_than_full() {
        let mut canvas = Canvas::new(3, 3, 1.0).unwrap();
        for _ in 0..10 {
            canvas.dot(1.5, 1.5);
        }
        assert_eq!(canvas.ink[4], FULL);
    }
}
