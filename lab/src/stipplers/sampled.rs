//! Voronoi cells of dots, by sampling: every pixel as a few points, each of which goes to its nearest dot.

use glam::DVec2;

use super::Darkness;

/// Sums over one dot's cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    /// ∫ darkness.
    pub(super) mass: f64,
    /// ∫ darkness × position.
    pub(super) moment: DVec2,
    /// ∫ darkness × position squared: x², y², x·y.
    pub(super) spread: [f64; 3],
}

impl Cell {
    /// The center of the cell's darkness; `None` where it is white.
    pub(super) fn centroid(&self) -> Option<DVec2> {
        (self.mass > 0.0).then(|| self.moment / self.mass)
    }

    /// The direction in which the cell is longest, of length 1.
    pub(super) fn longest(&self) -> DVec2 {
        let Some(center) = self.centroid() else { return DVec2::X };
        let [xx, yy, xy] = self.spread.map(|spread| spread / self.mass);
        let (xx, yy, xy) =
            (xx - center.x * center.x, yy - center.y * center.y, xy - center.x * center.y);
        DVec2::from_angle(0.5 * (2.0 * xy).atan2(xx - yy))
    }
}

/// Samples a pixel has on a side, so that a dot's cell has two hundred where the photograph is darkest. With sixty
/// a dot on average, cells there have some twenty, and centroids stick to samples: a hundred rounds of Lloyd's method
/// then leave a tone error a third larger.
fn fineness(darkness: &Darkness<'_>, dots: usize) -> usize {
    let darkest = darkness.values.iter().fold(0.0_f32, |most, &value| most.max(value));
    let pixels = darkness.sum() / f64::from(darkest) / dots as f64;
    ((200.0 / pixels).sqrt().ceil() as usize).clamp(1, 32)
}

/// The cells of dots, which lie in the photograph.
pub(super) fn cells(darkness: &Darkness<'_>, dots: &[DVec2]) -> Vec<Cell> {
    let grid = Grid::new(darkness.size(), dots);
    let fine = fineness(darkness, dots.len());
    let part = 1.0 / fine as f64;
    let mut cells = vec![Cell::default(); dots.len()];
    let mut near = 0;
    for y in 0..darkness.height * fine {
        let row = &darkness.values[y / fine * darkness.width..][..darkness.width];
        for x in 0..darkness.width * fine {
            let mass = f64::from(row[x / fine]) * part * part;
            if mass > 0.0 {
                let at = part * DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                // The last sample's dot is a good guess, which keeps the search short.
                near = grid.nearest(dots, at, near);
                let cell = &mut cells[near];
                cell.mass += mass;
                cell.moment += mass * at;
                let squares = [at.x * at.x, at.y * at.y, at.x * at.y];
                cell.spread.iter_mut().zip(squares).for_each(|(s, square)| *s += mass * square);
            }
        }
    }
    cells
}

/// Dots in buckets.
struct Grid {
    side: f64,
    columns: usize,
    rows: usize,
    /// Where each bucket's dots begin in `members`, and the end.
    start: Vec<usize>,
    members: Vec<usize>,
}

impl Grid {
    fn new(size: DVec2, dots: &[DVec2]) -> Self {
        let side = (size.x * size.y / dots.len() as f64).sqrt();
        let columns = (size.x / side).ceil() as usize;
        let rows = (size.y / side).ceil() as usize;
        let mut grid =
            Self { side, columns, rows, start: vec![0; columns * rows + 1], members: vec![] };
        for dot in dots {
            let (x, y) = grid.bucket(*dot);
            grid.start[y * columns + x + 1] += 1;
        }
        for i in 0..columns * rows {
            grid.start[i + 1] += grid.start[i];
        }
        let mut next = grid.start.clone();
        grid.members = vec![0; dots.len()];
        for (i, dot) in dots.iter().enumerate() {
            let (x, y) = grid.bucket(*dot);
            grid.members[next[y * columns + x]] = i;
            next[y * columns + x] += 1;
        }
        grid
    }

    fn bucket(&self, at: DVec2) -> (usize, usize) {
        let place = |c: f64, count: usize| ((c / self.side).max(0.0) as usize).min(count - 1);
        (place(at.x, self.columns), place(at.y, self.rows))
    }

    /// The dot nearest to a place: ring after ring of buckets, until no ring can hold a nearer one.
    fn nearest(&self, dots: &[DVec2], at: DVec2, guess: usize) -> usize {
        let (column, row) = self.bucket(at);
        let mut best = (dots[guess].distance_squared(at), guess);
        for ring in 0..self.columns.max(self.rows) {
            let clear = (ring as f64 - 1.0).max(0.0) * self.side;
            if ring > 0 && clear * clear > best.0 {
                break;
            }
            let (top, bottom) = (row.saturating_sub(ring), (row + ring).min(self.rows - 1));
            let (left, right) =
                (column.saturating_sub(ring), (column + ring).min(self.columns - 1));
            for y in top..=bottom {
                let edge = y.abs_diff(row) == ring;
                for x in left..=right {
                    if edge || x.abs_diff(column) == ring {
                        let bucket = y * self.columns + x;
                        for &i in &self.members[self.start[bucket]..self.start[bucket + 1]] {
                            let squared = dots[i].distance_squared(at);
                            if squared < best.0 {
                                best = (squared, i);
                            }
                        }
                    }
                }
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn cells_share_out_all_darkness_and_the_nearest_is_the_nearest() {
        let values: Vec<f32> = (0..40 * 30).map(|i| (i % 17) as f32 / 16.0).collect();
        let darkness = Darkness::new(40, &values).unwrap();
        let mut random = Random::new(3, &[]);
        let dots: Vec<DVec2> =
            (0..70).map(|_| DVec2::new(40.0 * random.unit(), 30.0 * random.unit())).collect();
        let total: f64 = cells(&darkness, &dots).iter().map(|cell| cell.mass).sum();
        assert!((total / darkness.sum() - 1.0).abs() < 1e-9);
        let grid = Grid::new(darkness.size(), &dots);
        for i in 0..500 {
            let at = DVec2::new(40.0 * random.unit(), 30.0 * random.unit());
            let slow =
                dots.iter().map(|dot| dot.distance_squared(at)).fold(f64::INFINITY, f64::min);
            let found = dots[grid.nearest(&dots, at, i % 70)].distance_squared(at);
            assert_eq!(found, slow);
        }
    }
}
