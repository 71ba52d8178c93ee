//! The nearest dots of each dot.

use glam::DVec2;

/// Dots sorted into square cells, about two in each.
pub(crate) struct Grid {
    least: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where each cell's dots begin in `members`.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Grid {
    pub(crate) fn new(dots: &[DVec2]) -> Self {
        let least = dots.iter().fold(DVec2::INFINITY, |least, dot| least.min(*dot));
        let most = dots.iter().fold(DVec2::NEG_INFINITY, |most, dot| most.max(*dot));
        let size = (most - least).max(DVec2::ZERO);
        let cells = (dots.len() / 2).max(1) as f64;
        // Dots on a line have no area: then the cells are as many as fit along it.
        let cell = (size.x * size.y / cells).sqrt().max(size.max_element() / cells);
        let cell = if cell > 0.0 { cell } else { 1.0 };
        Self::with_cell(dots, least, size, cell)
    }

    /// A grid for looking at all dots within `reach` of a place.
    pub(crate) fn with_cells_of(dots: &[DVec2], reach: f64) -> Self {
        let least = dots.iter().fold(DVec2::INFINITY, |least, dot| least.min(*dot));
        let most = dots.iter().fold(DVec2::NEG_INFINITY, |most, dot| most.max(*dot));
        let size = (most - least).max(DVec2::ZERO);
        // No more cells than a few for each dot, however short the reach.
        let widest = (size.x * size.y / (4 * dots.len().max(1)) as f64).sqrt();
        let longest = size.max_element() / (4 * dots.len().max(1)) as f64;
        Self::with_cell(dots, least, size, reach.max(widest).max(longest))
    }

    /// Visits every dot in the cell of `at` and in those around it.
    pub(crate) fn around(&self, at: DVec2, mut visit: impl FnMut(u32)) {
        let (column, row) = self.cell_of(at);
        for y in row.saturating_sub(1)..=(row + 1).min(self.rows - 1) {
            for x in column.saturating_sub(1)..=(column + 1).min(self.columns - 1) {
                self.members(x, y).iter().for_each(|&index| visit(index));
            }
        }
    }

    fn with_cell(dots: &[DVec2], least: DVec2, size: DVec2, cell: f64) -> Self {
        let columns = (size.x / cell) as usize + 1;
        let rows = (size.y / cell) as usize + 1;
        let mut grid = Self {
            least,
            cell,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            members: vec![],
        };
        let homes: Vec<u32> = dots.iter().map(|&dot| grid.home(dot) as u32).collect();
        for &home in &homes {
            grid.starts[home as usize + 1] += 1;
        }
        for i in 0..columns * rows {
            grid.starts[i + 1] += grid.starts[i];
        }
        let mut next = grid.starts.clone();
        grid.members = vec![0; dots.len()];
        for (&home, index) in homes.iter().zip(0..) {
            let slot = &mut next[home as usize];
            grid.members[*slot as usize] = index;
            *slot += 1;
        }
        grid
    }

    /// Column and row of a place; those outside belong to the nearest cell.
    fn cell_of(&self, at: DVec2) -> (usize, usize) {
        let cell = (at - self.least) / self.cell;
        ((cell.x as usize).min(self.columns - 1), (cell.y as usize).min(self.rows - 1))
    }

    fn home(&self, at: DVec2) -> usize {
        let (column, row) = self.cell_of(at);
        row * self.columns + column
    }

    fn members(&self, column: usize, row: usize) -> &[u32] {
        let home = row * self.columns + column;
        &self.members[self.starts[home] as usize..self.starts[home + 1] as usize]
    }

    /// The dots in the cells that are exactly `ring` cells away from that of `at`.
    fn ring(&self, at: DVec2, ring: usize, mut visit: impl FnMut(u32)) {
        let (column, row) = self.cell_of(at);
        let columns = column.saturating_sub(ring)..=(column + ring).min(self.columns - 1);
        for y in row.saturating_sub(ring)..=(row + ring).min(self.rows - 1) {
            if y.abs_diff(row) == ring {
                for x in columns.clone() {
                    self.members(x, y).iter().for_each(|&index| visit(index));
                }
                continue;
            }
            if column >= ring {
                self.members(column - ring, y).iter().for_each(|&index| visit(index));
            }
            if ring > 0 && column + ring < self.columns {
                self.members(column + ring, y).iter().for_each(|&index| visit(index));
            }
        }
    }

    fn rings(&self) -> usize {
        self.columns.max(self.rows)
    }
}

/// For each dot its `count` nearest, or all others if they are fewer; nearest first, of equally near ones
/// the one that comes first in the list. O(dots × count) where they are evenly spread.
pub(super) fn nearest(dots: &[DVec2], count: usize) -> Vec<u32> {
    let count = count.min(dots.len().saturating_sub(1));
    let grid = Grid::new(dots);
    let mut lists = Vec::with_capacity(dots.len() * count);
    let mut found: Vec<(f64, u32)> = Vec::new();
    for (&at, own) in dots.iter().zip(0..) {
        found.clear();
        for ring in 0..grid.rings() {
            // What is farther out than this ring is at least so many whole cells away.
            let whole = ring.saturating_sub(1) as f64 * grid.cell;
            if found.len() == count && found.last().is_none_or(|far| far.0 < whole * whole) {
                break;
            }
            grid.ring(at, ring, |index| {
                let far = (dots[index as usize].distance_squared(at), index);
                let place = found.partition_point(|other| *other < far);
                if index != own && place < count {
                    found.truncate(count - 1);
                    found.insert(place.min(found.len()), far);
                }
            });
        }
        lists.extend(found.iter().map(|(_, index)| *index));
    }
    lists
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn the_nearest_are_those_that_a_look_at_all_finds(
            places in prop::collection::vec((0u8..40, 0u8..12), 1..60), count in 1usize..9,
        ) {
            let dots: Vec<DVec2> =
                places.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
            let lists = nearest(&dots, count);
            let count = count.min(dots.len() - 1);
            prop_assert_eq!(lists.len(), dots.len() * count);
            for (i, dot) in dots.iter().enumerate() {
                let mut all: Vec<(f64, u32)> = (0..dots.len())
                    .filter(|j| *j != i)
                    .map(|j| (dots[j].distance_squared(*dot), j as u32))
                    .collect();
                all.sort_by(|a, b| a.partial_cmp(b).unwrap());
                let wanted: Vec<u32> = all[..count].iter().map(|(_, j)| *j).collect();
                prop_assert_eq!(&lists[i * count..][..count], &wanted);
            }
        }
    }
}
