//! The tiling's laws, proved exhaustively at small levels and in random deep neighborhoods, in exact
//! arithmetic throughout.

use std::collections::{HashMap, HashSet};

use proptest::prelude::*;
use twelvefold::Tables;
use twelvefold::tiling::{Cyclotomic, FCode, Rules, Surd, Tile, TileCounts, TileType};

/// The paper's equation 1 as it prints it: the F-code digit of each child after its type.
const EQUATION_1: [(TileType, &str); 4] = [
    (TileType::A, "a0 c4 c5 c6 cA cB cC b1 b2 b3 b7 b8 b9"),
    (TileType::B, "a0 c4 c5 c6 cA cB cC d1 d2 b3 d7 d8 d9 dD"),
    (TileType::C, "a0 c5 c6 c7 cB cC cD b1 d2 b3 d4 b8 d9 dA"),
    (TileType::D, "a0 c4 c5 c6 cA cB cC d1 d2 b3 d7 d8 b9 dD"),
];

fn rules() -> Rules {
    Tables::built_in().rules()
}

/// Every tile `levels` below `tile`, with absolute coordinates.
fn descendants(rules: &Rules, tile: Tile, levels: usize) -> Vec<Tile> {
    let mut tiles = vec![tile];
    for _ in 0..levels {
        tiles = tiles
            .iter()
            .flat_map(|tile| {
                let digits = 0..rules.children(tile.kind).len() as u8;
                digits.map(|digit| rules.child_of(tile, digit).unwrap().unwrap())
            })
            .collect();
    }
    tiles
}

fn minus(a: Cyclotomic, b: Cyclotomic) -> Cyclotomic {
    a.checked_sub(b).unwrap()
}

fn neighbor(tile: &Tile, k: i32) -> Cyclotomic {
    tile.center.checked_add(Cyclotomic::zeta_power(k)).unwrap()
}

/// The sign of a − b.
fn compare(a: Surd, b: Surd) -> i32 {
    Surd { whole: a.whole - b.whole, root: a.root - b.root }.signum()
}

/// λ^levels times `z`.
fn stretched(z: Cyclotomic, levels: usize) -> Cyclotomic {
    (0..levels).fold(z, |z, _| z.checked_mul_lambda().unwrap())
}

/// Whether `z` lies within (1 − 1/√2)·λ^levels − `margin` of the center of its ancestor `levels` up,
/// so that the whole refined tiling within `margin` of it descends from that ancestor: every other
/// tile of the ancestor's level is at least λ^levels away and reaches λ^levels/√2 far. Rounded inwards.
fn is_interior(z: Cyclotomic, levels: usize, margin: f64) -> bool {
    let edge = (2.0 + 3f64.sqrt()).powi(levels as i32);
    let [x, y] = z.to_f64();
    x.hypot(y) <= 0.2928 * edge - margin
}

/// All pairs of `centers` at distance below 2, once each: (index, index, difference).
fn close_pairs(centers: &[Cyclotomic]) -> Vec<(usize, usize, Cyclotomic)> {
    let cell = |z: &Cyclotomic| z.to_f64().map(|v| (v / 2.0).floor() as i64);
    let mut grid: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (i, z) in centers.iter().enumerate() {
        grid.entry(cell(z)).or_default().push(i);
    }
    let mut pairs = Vec::new();
    for (i, z) in centers.iter().enumerate() {
        let [column, row] = cell(z);
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            for &j in grid.get(&[column + dx, row + dy]).into_iter().flatten() {
                if i < j {
                    pairs.push((i, j, minus(centers[j], *z)));
                }
            }
        }
    }
    pairs
}

/// Every two centers differ, none are closer than 1, and every tile has one at exactly 1.
fn assert_nearest_is_one(tiles: &[Tile]) {
    // Relative to the first: random deep neighborhoods lie too far out for `squared_length`.
    let centers: Vec<_> = tiles.iter().map(|t| minus(t.center, tiles[0].center)).collect();
    assert_eq!(centers.iter().collect::<HashSet<_>>().len(), tiles.len(), "two tiles coincide");
    let mut has_unit_neighbor = vec![tiles.len() == 1; tiles.len()];
    for (i, j, difference) in close_pairs(&centers) {
        match compare(difference.squared_length().unwrap(), Surd::integer(1)) {
            0 => (has_unit_neighbor[i], has_unit_neighbor[j]) = (true, true),
            sign => assert_eq!(sign, 1, "{:?} and {:?} are too close", tiles[i], tiles[j]),
        }
    }
    assert!(has_unit_neighbor.into_iter().all(|has| has));
}

/// The star read off the tiling equals the star of the tile's type, turned by its rotation.
fn assert_star(tile: &Tile, centers: &HashSet<Cyclotomic>) {
    let measured: HashSet<u8> =
        (0..12).filter(|k| centers.contains(&neighbor(tile, i32::from(*k)))).collect();
    let expected: HashSet<u8> = tile.kind.star().iter().map(|k| (k + tile.rotation) % 12).collect();
    assert_eq!(measured, expected, "{tile:?}");
}

fn parity(tile: &Tile) -> u8 {
    (tile.kind.parity() + tile.rotation) % 2
}

/// `(p, q)` with the summed area (p + q√3)/4 in squared edges.
fn area<'a>(tiles: impl IntoIterator<Item = &'a Tile>) -> (i64, i64) {
    tiles.into_iter().fold((0, 0), |(p, q), tile| {
        let (dp, dq) = tile.kind.area();
        (p + dp, q + dq)
    })
}

/// (p + q√3)·(7 + 4√3).
fn times_delta((p, q): (i64, i64)) -> (i64, i64) {
    (7 * p + 12 * q, 4 * p + 7 * q)
}

#[test]
fn child_types_counts_and_digits_are_those_of_equation_1() {
    let rules = rules();
    let mut entries = 0;
    for (parent, children) in EQUATION_1 {
        let mut by_digit: Vec<(u32, char)> = children
            .split(' ')
            .map(|entry| {
                let mut chars = entry.chars();
                let kind = chars.next().unwrap();
                (chars.next().unwrap().to_digit(16).unwrap(), kind)
            })
            .collect();
        by_digit.sort_unstable();
        let derived: Vec<(u32, char)> =
            (0..).zip(rules.children(parent)).map(|(d, c)| (d, c.kind.letter())).collect();
        assert_eq!(derived, by_digit, "{parent:?}");
        // `children` is indexed by digit; the digits behind it must fill 0..count once each.
        let mut digits = rules.digits().of(parent).to_vec();
        digits.sort_unstable();
        assert_eq!(digits, (0..parent.child_count() as u8).collect::<Vec<_>>());
        entries += derived.len();
    }
    assert_eq!(entries, 55);
}

#[test]
fn the_center_child_is_an_a_tile_with_digit_0() {
    let rules = rules();
    for root in TileType::ALL {
        for parent in descendants(&rules, Tile::root(root), 2) {
            let child = rules.child_of(&parent, 0).unwrap().unwrap();
            assert_eq!(child.kind, TileType::A);
            assert_eq!(child.center, stretched(parent.center, 1));
            // The center child stays put: its center is the parent's, exactly.
            assert_eq!(child.center.checked_div_lambda().unwrap(), parent.center);
        }
    }
}

#[test]
fn parity_is_shared_by_a_level_and_flips_with_each() {
    let rules = rules();
    for root in TileType::ALL {
        for level in 0..=4 {
            let expected = (root.parity() + level as u8) % 2;
            for tile in descendants(&rules, Tile::root(root), level) {
                assert_eq!(parity(&tile), expected, "{root:?} level {level} {tile:?}");
                assert!(tile.rotation < 12);
            }
        }
    }
}

#[test]
fn no_two_tiles_are_closer_than_one_edge() {
    let rules = rules();
    for root in TileType::ALL {
        for level in 0..=4 {
            let tiles = descendants(&rules, Tile::root(root), level);
            assert_eq!(tiles.len() as u64, TileCounts::of(root).at(level).unwrap());
            assert_nearest_is_one(&tiles);
        }
    }
}

#[test]
fn every_interior_star_is_the_star_of_its_type() {
    let rules = rules();
    for root in TileType::ALL {
        for level in 1..=4 {
            let tiles = descendants(&rules, Tile::root(root), level);
            let centers: HashSet<_> = tiles.iter().map(|tile| tile.center).collect();
            let interior: Vec<_> =
                tiles.iter().filter(|tile| is_interior(tile.center, level, 1.0)).collect();
            interior.iter().for_each(|tile| assert_star(tile, &centers));
            // The disk's area over the mean area of a cell, 4√3 − 6, less a border of it.
            let radius = 0.2928 * (2.0 + 3f64.sqrt()).powi(level as i32) - 1.0;
            let expected = std::f64::consts::PI * radius * radius / (4.0 * 3f64.sqrt() - 6.0);
            let floor = (expected - 8.0 * radius).max(1.0);
            assert!(interior.len() as f64 >= floor, "{} {floor}", interior.len());
        }
    }
}

#[test]
fn every_vertex_of_the_refined_tiling_has_one_owner() {
    // Around each parent vertex the refined tiling has the vertex itself, a hexagon and a dodecagon,
    // whatever the parent's type; dodecagon vertices are shared, and exactly one parent makes each.
    let rules = rules();
    for root in TileType::ALL {
        let level = 3;
        let parents = descendants(&rules, Tile::root(root), level);
        let mut owners: HashMap<Cyclotomic, usize> = HashMap::new();
        for parent in &parents {
            for child in descendants(&rules, *parent, 1) {
                *owners.entry(child.center).or_default() += 1;
            }
        }
        assert!(owners.values().all(|count| *count == 1));
        let mut claimed = HashSet::new();
        let mut checked = 0;
        for parent in &parents {
            let center = stretched(parent.center, 1);
            let at = |offset: Cyclotomic| center.checked_add(offset).unwrap();
            let hexagon =
                (0..6).map(|i| at(Cyclotomic::zeta_power(2 * i + i32::from(parity(parent)) + 1)));
            let dodecagon = (0..12).map(|k| {
                let turned = Cyclotomic::zeta_power(k);
                at(turned.checked_add(Cyclotomic::zeta_power(k + 1)).unwrap())
            });
            let vertices: Vec<_> =
                std::iter::once(center).chain(hexagon).chain(dodecagon).collect();
            claimed.extend(vertices.iter().copied());
            if is_interior(parent.center, level, 1.0) {
                for vertex in vertices {
                    assert_eq!(owners.get(&vertex), Some(&1), "{root:?} {vertex:?}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 19 * 500, "{checked}");
        // Nothing else is made: every child lies on some parent's center, hexagon or dodecagon.
        assert!(owners.keys().all(|vertex| claimed.contains(vertex)));
    }
}

#[test]
fn the_areas_of_the_children_are_delta_times_their_parents_for_each_tile() {
    let rules = rules();
    for kind in TileType::ALL {
        let parent = Tile::root(kind);
        let children = descendants(&rules, parent, 1);
        assert_eq!(area(&children), times_delta(area([&parent])), "{kind:?}");
        // Hence for whole levels too.
        let mut expected = area([&parent]);
        for level in 0..=4 {
            assert_eq!(area(&descendants(&rules, parent, level)), expected);
            expected = times_delta(expected);
        }
    }
}

#[test]
fn descendants_stay_within_an_edge_over_root_two() {
    let rules = rules();
    let edge_squared =
        |levels| stretched(Cyclotomic([1, 0, 0, 0]), levels).squared_length().unwrap();
    for root in TileType::ALL {
        for level in 1..=4 {
            let farthest = edge_squared(level);
            for tile in descendants(&rules, Tile::root(root), level) {
                let twice = tile.center.squared_length().unwrap();
                let twice = Surd { whole: 2 * twice.whole, root: 2 * twice.root };
                assert_eq!(compare(twice, farthest), -1, "{root:?} level {level} {tile:?}");
            }
        }
    }
}

fn any_root() -> impl Strategy<Value = TileType> {
    prop::sample::select(TileType::ALL.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// The same laws three levels below a random tile of a random level to 13, where coordinates
    /// have up to nine digits.
    #[test]
    fn the_laws_hold_in_random_deep_neighborhoods(
        root in any_root(), level in 0usize..=13, position in 0.0..1.0f64,
    ) {
        let rules = rules();
        let tiles = TileCounts::of(root).at(level).unwrap();
        let rank = ((position * tiles as f64) as u64).min(tiles - 1);
        let ancestor = FCode::from_rank(root, level, rank).unwrap().tile(&rules).unwrap();
        let origin = stretched(ancestor.center, 3);
        let patch = descendants(&rules, ancestor, 3);

        prop_assert_eq!(patch.len() as u64, TileCounts::of(ancestor.kind).at(3).unwrap());
        assert_nearest_is_one(&patch);
        let mut expected_area = area([&ancestor]);
        for _ in 0..3 {
            expected_area = times_delta(expected_area);
        }
        prop_assert_eq!(area(&patch), expected_area);
        let centers: HashSet<_> = patch.iter().map(|tile| tile.center).collect();
        let mut interior = 0;
        for tile in &patch {
            prop_assert_eq!(parity(tile), (root.parity() + (level as u8 + 3) % 2) % 2);
            if is_interior(minus(tile.center, origin), 3, 1.0) {
                assert_star(tile, &centers);
                interior += 1;
            }
        }
        prop_assert!(interior > 500, "{}", interior);
    }
}
