//! Tiles as shapes: the dual cell of a vertex, and the tiles of a level in a window.

use std::f64::consts::FRAC_PI_6;

use glam::DVec2;
use twelvefold::tiling::rank::child_rank;
use twelvefold::tiling::{RankError, Rules, Tile, TileCounts, TileType};
use twelvefold_lab::paper::LAMBDA;

use super::Result;

/// A tile with its rank.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ranked {
    pub(crate) tile: Tile,
    pub(crate) rank: u64,
}

impl Ranked {
    /// The center in edges of the tile's level.
    pub(crate) fn center(&self) -> DVec2 {
        center(&self.tile)
    }
}

/// The center in edges of the tile's level.
pub(crate) fn center(tile: &Tile) -> DVec2 {
    tile.center.to_f64().into()
}

/// The unit vector at `k`·30°; halves of k are the bisectors.
pub(crate) fn direction(k: f64) -> DVec2 {
    DVec2::from_angle(k * FRAC_PI_6)
}

/// The directions k of the edges of the square-triangle tiling at the tile, turned with it, 0..12.
pub(crate) fn star(tile: &Tile) -> impl Iterator<Item = u8> {
    let rotation = tile.rotation;
    tile.kind.star().iter().map(move |k| (k + rotation) % 12)
}

/// The corners of the tile's cell, anticlockwise, in edges of the tile's level.
///
/// The cell is the dual of the vertex: its corners are the centers of the triangles and squares around
/// it, 1/√3 along the bisector of a triangle's 60°, 1/√2 along that of a square's 90°.
pub(crate) fn cell(tile: &Tile) -> Vec<DVec2> {
    let star = tile.kind.star();
    let center = center(tile);
    let next = star.iter().cycle().skip(1);
    star.iter()
        .zip(next)
        .map(|(first, second)| {
            let between = f64::from((second + 12 - first) % 12);
            let distance =
                if between < 2.5 { 1.0 / 3f64.sqrt() } else { std::f64::consts::FRAC_1_SQRT_2 };
            center + distance * direction(f64::from(first + tile.rotation) + between / 2.0)
        })
        .collect()
}

/// A rectangle of the plane, closed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    pub(crate) center: DVec2,
    pub(crate) size: DVec2,
}

impl Window {
    /// The distance of a point from the window, 0 inside.
    pub(crate) fn distance(&self, point: DVec2) -> f64 {
        let past = (point - self.center).abs() - self.size / 2.0;
        past.max(DVec2::ZERO).length()
    }

    /// The same window in a unit `factor` times as small.
    pub(crate) fn in_units_of(&self, factor: f64) -> Self {
        Self { center: self.center * factor, size: self.size * factor }
    }
}

/// The tiles `levels` below a root whose centers lie within `margin` of the window, both in edges of
/// that level; depth first. Visits only subtrees that reach the window.
///
/// # Errors
/// When the level is past the last.
pub(crate) fn tiles_in(
    rules: &Rules,
    root: TileType,
    levels: usize,
    window: &Window,
    margin: f64,
) -> Result<Vec<Ranked>> {
    let mut search = Search { rules, root, levels, window, margin, found: Vec::new() };
    search.descend(&Ranked { tile: Tile::root(root), rank: 0 }, 0)?;
    Ok(search.found)
}

/// Every tile `levels` below the root.
///
/// # Errors
/// When the level is past the last.
pub(crate) fn tiles_of(rules: &Rules, root: TileType, levels: usize) -> Result<Vec<Ranked>> {
    let everywhere = Window { center: DVec2::ZERO, size: DVec2::INFINITY };
    tiles_in(rules, root, levels, &everywhere, 0.0)
}

/// The child of a tile of level `level` under `root`, with its rank.
///
/// # Errors
/// When the child's level is past the last or the tile has no such child.
pub(crate) fn child(
    rules: &Rules,
    root: TileType,
    level: usize,
    parent: &Ranked,
    digit: u8,
) -> Result<Ranked> {
    let rank = child_rank(TileCounts::of(root), level, parent.rank, digit)?;
    let tile = rules
        .child_of(&parent.tile, digit)?
        .ok_or(RankError::NoSuchChild { rank: parent.rank, digit })?;
    Ok(Ranked { tile, rank })
}

struct Search<'a> {
    rules: &'a Rules,
    root: TileType,
    levels: usize,
    window: &'a Window,
    margin: f64,
    found: Vec<Ranked>,
}

impl Search<'_> {
    fn descend(&mut self, ranked: &Ranked, level: usize) -> Result<()> {
        let edge = LAMBDA.powi((self.levels - level) as i32);
        // Descendants lie within edge/√2 of their ancestor's center.
        let reach = if level == self.levels { 0.0 } else { edge * std::f64::consts::FRAC_1_SQRT_2 };
        if self.window.distance(ranked.center() * edge) > reach + self.margin {
            return Ok(());
        }
        if level == self.levels {
            self.found.push(*ranked);
            return Ok(());
        }
        for digit in 0..ranked.tile.kind.child_count() as u8 {
            let child = child(self.rules, self.root, level, ranked, digit)?;
            self.descend(&child, level + 1)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    fn area(corners: &[DVec2]) -> f64 {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b) / 2.0).sum()
    }

    #[test]
    fn a_cell_has_its_types_area_wherever_it_lies() {
        for kind in TileType::ALL {
            for rotation in 0..12 {
                let tile = Tile { rotation, ..Tile::root(kind) };
                let (p, q) = kind.area();
                let expected = (p as f64 + q as f64 * 3f64.sqrt()) / 4.0;
                assert!((area(&cell(&tile)) - expected).abs() < 1e-14, "{tile:?}");
            }
        }
    }

    #[test]
    fn the_cells_of_a_level_tile_the_plane() {
        let tables = twelvefold::Tables::built_in();
        // Inside 0.2929 of 52 edges, where all tiles descend from the root.
        let window = Window { center: DVec2::new(2.5, -1.0), size: DVec2::new(13.0, 12.0) };
        let tiles = tiles_in(&tables.rules(), TileType::A, 3, &window, 2.0).unwrap();

        // Every edge of a cell in the window is the edge of one other cell, in the other direction.
        let key = |p: DVec2| p.to_array().map(|v| (v * 1e6).round() as i64);
        let mut edges: HashMap<_, usize> = HashMap::new();
        let cells: Vec<_> = tiles.iter().map(|ranked| (ranked, cell(&ranked.tile))).collect();
        let sides = |corners: &[DVec2]| -> Vec<[DVec2; 2]> {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(a, b)| [*a, *b]).collect()
        };
        for [a, b] in cells.iter().flat_map(|(_, corners)| sides(corners)) {
            *edges.entry((key(a), key(b))).or_default() += 1;
        }
        assert!(edges.values().all(|count| *count == 1), "cells overlap");
        let mut inside = 0;
        for (_, corners) in cells.iter().filter(|(r, _)| window.distance(r.center()) == 0.0) {
            for [a, b] in sides(corners) {
                assert_eq!(edges.get(&(key(b), key(a))), Some(&1), "a gap beside {a} {b}");
            }
            inside += 1;
        }
        // 4√3 − 6 is the mean area of a cell.
        let expected = window.size.element_product() / (4.0 * 3f64.sqrt() - 6.0);
        assert!((f64::from(inside) - expected).abs() < 8.0, "{inside} {expected}");
    }

    #[test]
    fn a_window_finds_the_same_tiles_as_the_whole_level() {
        let tables = twelvefold::Tables::built_in();
        let window = Window { center: DVec2::new(-9.0, 4.0), size: DVec2::new(7.0, 30.0) };
        for root in TileType::ALL {
            let found = tiles_in(&tables.rules(), root, 3, &window, 0.5).unwrap();
            let all = tiles_of(&tables.rules(), root, 3).unwrap();
            assert_eq!(all.len() as u64, TileCounts::of(root).at(3).unwrap());
            let expected: Vec<u64> = all
                .iter()
                .filter(|ranked| window.distance(ranked.center()) <= 0.5)
                .map(|ranked| ranked.rank)
                .collect();
            assert_eq!(found.iter().map(|ranked| ranked.rank).collect::<Vec<_>>(), expected);
            assert!(expected.len() > 100 && expected.len() < all.len() / 2);
        }
    }
}
