//! How much of each pixel a disc covers.

/// Full coverage of a pixel, in the units of the canvas.
pub(super) const FULL: u16 = u16::MAX;

/// Lines of integration in each row of pixels that a disc touches.
const LINES: usize = 32;

/// A disc, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Disc {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) radius: f64,
}

impl Disc {
    /// Sets `area` to the area of the disc in each pixel of row `row`, from column `left` on.
    ///
    /// Exact along the row, midpoints of [`LINES`] lines across it. O(pixels).
    pub(super) fn row(&self, row: f64, left: f64, area: &mut [f64]) {
        area.fill(0.0);
        let end = area.len() as f64;
        let low = row.max(self.y - self.radius);
        let high = (row + 1.0).min(self.y + self.radius);
        let step = (high - low).max(0.0) / LINES as f64;
        // First differences of the wanted areas, so that a line costs the same at any length.
        for line in 0..LINES {
            let height = low + (line as f64 + 0.5) * step - self.y;
            let half = (self.radius * self.radius - height * height).max(0.0).sqrt();
            let from = (self.x - half - left).clamp(0.0, end);
            let to = (self.x + half - left).clamp(0.0, end);
            rise(area, from, step);
            rise(area, to, -step);
        }
        let mut sum = 0.0;
        for pixel in area {
            sum += *pixel;
            *pixel = sum;
        }
    }
}

/// Adds, to first differences, `height` times the length of [`from`, ∞) within each pixel.
fn rise(differences: &mut [f64], from: f64, height: f64) {
    let first = from as usize;
    let part = (first + 1) as f64 - from;
    if let Some(difference) = differences.get_mut(first) {
        *difference += part * height;
    }
    if let Some(difference) = differences.get_mut(first + 1) {
        *difference += (1.0 - part) * height;
    }
}

/// A small picture of a disc: coverage of the pixels around its center.
#[derive(Debug, Clone)]
pub(super) struct Stamp {
    /// Column and row of the first pixel, from the pixel that holds the center.
    pub(super) left: i64,
    pub(super) top: i64,
    pub(super) width: usize,
    /// Row by row.
    pub(super) coverage: Vec<u16>,
}

impl Stamp {
    /// A disc whose center lies in the pixel (0, 0), borders included. Its coverage adds up to its
    /// area.
    pub(super) fn new(disc: Disc) -> Self {
        let Disc { x, y, radius } = disc;
        let (left, right) = ((x - radius).floor(), (x + radius).ceil());
        let (top, bottom) = ((y - radius).floor(), (y + radius).ceil());
        let width = (right - left).max(1.0) as usize;
        let height = (bottom - top).max(1.0) as usize;
        let mut area = vec![0.0; width * height];
        for (row, pixels) in area.chunks_exact_mut(width).enumerate() {
            disc.row(top + row as f64, left, pixels);
        }
        // Midpoints overestimate the area of a convex shape a little; the exact area is known.
        let exact = std::f64::consts::PI * radius * radius;
        let sum: f64 = area.iter().sum();
        let correction = if sum > 0.0 { exact / sum } else { 0.0 };
        Self {
            left: left as i64,
            top: top as i64,
            width,
            coverage: rounded(area.iter().map(|area| (area * correction).min(1.0))),
        }
    }
}

/// Coverage in units of [`FULL`], each rounding error carried to the next pixel so that none is lost.
fn rounded(area: impl Iterator<Item = f64>) -> Vec<u16> {
    let mut carried = 0.0;
    area.map(|area| {
        // Not a hair more: differences leave 1e-17 where the disc does not reach.
        if area < 1e-9 {
            return 0;
        }
        let exact = area * f64::from(FULL) + carried;
        let units = exact.round().clamp(0.0, f64::from(FULL));
        carried = exact - units;
        units as u16
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink(stamp: &Stamp) -> f64 {
        stamp.coverage.iter().map(|&units| f64::from(units)).sum::<f64>() / f64::from(FULL)
    }

    #[test]
    fn ink_is_the_discs_area_at_any_radius_and_place() {
        for radius in [0.003, 0.02, 0.3, 0.5, 0.77, 1.0, 1.5, 4.2, 30.0] {
            for (x, y) in [(0.0, 0.0), (0.5, 0.5), (0.03, 0.97), (1.0, 0.25)] {
                let area = std::f64::consts::PI * radius * radius;
                let error = ink(&Stamp::new(Disc { x, y, radius })) - area;
                let allowed = 1.0 / f64::from(FULL) + area * 2e-4;
                assert!(error.abs() <= allowed, "radius {radius} at ({x}, {y}): {error}");
            }
        }
    }

    #[test]
    fn coverage_agrees_with_counting_subpixels() {
        const FINE: i64 = 200;
        for (x, y, radius) in [(0.5, 0.5, 0.4), (0.25, 0.8, 1.3), (0.9, 0.1, 2.6)] {
            let stamp = Stamp::new(Disc { x, y, radius });
            for (index, &units) in stamp.coverage.iter().enumerate() {
                let column = stamp.left + (index % stamp.width) as i64;
                let row = stamp.top + (index / stamp.width) as i64;
                let mut inside = 0;
                for i in 0..FINE * FINE {
                    let u = column as f64 + ((i % FINE) as f64 + 0.5) / FINE as f64 - x;
                    let v = row as f64 + ((i / FINE) as f64 + 0.5) / FINE as f64 - y;
                    inside += i64::from(u * u + v * v < radius * radius);
                }
                let counted = inside as f64 / (FINE * FINE) as f64;
                let stamped = f64::from(units) / f64::from(FULL);
                assert!((stamped - counted).abs() < 0.005, "{stamped} for {counted}");
            }
        }
    }
}
