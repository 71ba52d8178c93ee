//! The slow oracle: every tile of every level, each point tested, nothing pruned, no block table.
//!
//! It works on ring elements and production rules, where the sampler works on baked offsets; they share
//! the placement's numbers (origin, edge, seed) and the rule that a point is computed from the tile at
//! which it is born.

use alloc::vec::Vec;

use glam::DVec2;

use crate::bake::class::Classes;
use crate::bake::displacement::Displacements;
use crate::importance::Importance;
use crate::placement::{FIRST_RELAXED_LEVEL, FRONTIER_LEVEL};
use crate::sampling::Sampling;
use crate::tiling::numbers::SQRT_3;
use crate::tiling::{Cyclotomic, FCode, MAX_LEVEL, Rules, Tile, TileCounts, TileType};

/// A tile, its rank, where its center was born (level and coordinates), and what it was, and what
/// its ancestors were, at each level: classes and rotation.
#[derive(Clone, Copy)]
struct Found {
    tile: Tile,
    rank: u64,
    born: u8,
    at_birth: Cyclotomic,
    path: [(Classes, u8); MAX_LEVEL + 1],
}

/// Every point of the sampling as (rank, position), sorted by rank. The domain's corner must be 0.
pub(crate) fn points<I: Importance>(sampling: &Sampling<'_, I>) -> Vec<(u64, [f64; 2])> {
    let placement = sampling.placement();
    let rules = &placement.tables().rules();
    let domain = placement.domain();
    assert_eq!(domain.min(), DVec2::ZERO);
    let highest = sampling.scale().limit(sampling.importance().upper_bound(&domain.disc()));
    let counts = TileCounts::HEXAGON.all();
    let level = (4..).find(|level| counts[*level] >= highest).unwrap();

    let mut found = Vec::new();
    for start in starts(sampling) {
        descend(rules, start, FRONTIER_LEVEL, level as u8, &mut found);
    }
    let displacements =
        sampling.displacements().map(|table| table.to_relaxation(*rules.digits()).unwrap());
    let mut points = Vec::new();
    let last = DVec2::from(domain.max().to_array().map(f64::next_down));
    for Found { rank, born, at_birth, path, .. } in found {
        let [x, y] = at_birth.to_surds().unwrap().map(|s| s.whole as f64 + SQRT_3 * s.root as f64);
        let h = placement.half_edge(born);
        let fixed = placement.origin() + DVec2::new(h.x * x + -h.y * y, h.y * x + h.x * y);
        if sampling.displacements().is_none() && !domain.contains(fixed) {
            continue;
        }
        let at = fixed.clamp(DVec2::ZERO, last);
        let value = sampling.importance().value(at);
        if rank < sampling.scale().limit(value) {
            let moved = match &displacements {
                Some(table) => {
                    let moved = fixed + step(sampling, table, at, value, &path);
                    let needed = sampling.scale().importance_of(rank);
                    let settled = constrained(sampling.importance(), at, moved, needed);
                    match domain.contains(moved) {
                        // A center beyond the border asks as if it were there, but goes no farther for it.
                        true if settled.distance(fixed) > moved.distance(fixed) => fixed,
                        true => settled,
                        false => moved,
                    }
                }
                None => fixed,
            };
            if domain.contains(moved) {
                points.push((rank, moved.to_array()));
            }
        }
    }
    points.sort_by_key(|(rank, _)| *rank);
    points
}

/// All tiles of the frontier level from which a point could get into the domain, however relaxed:
/// found among all tiles of the level, by their ranks.
fn starts<I: Importance>(sampling: &Sampling<'_, I>) -> Vec<Found> {
    let placement = sampling.placement();
    let rules = placement.tables().rules();
    let known = placement.frontier().next().unwrap();
    let level = usize::from(FRONTIER_LEVEL);
    let path_to = |rank| {
        let code = FCode::from_rank(TileType::A, level, rank).unwrap();
        let mut tile = Tile::root(TileType::A);
        let mut path = [(Classes::root(TileType::A), 0); MAX_LEVEL + 1];
        for (i, digit) in code.oldest_first().enumerate() {
            tile = rules.child_of(&tile, digit).unwrap().unwrap();
            path[i + 1] = (path[i].0.child(digit, tile.kind), tile.rotation);
        }
        (tile, path)
    };
    let at = known.center;
    let shift =
        from_exact(at.u, at.v, at.p, at.q).checked_sub(path_to(known.rank).0.center).unwrap();
    let half_edge = placement.half_edge(FRONTIER_LEVEL);
    let middle = 0.5 * placement.domain().size() - placement.origin();
    (0..TileCounts::HEXAGON.at(level).unwrap())
        .filter_map(|rank| {
            let (mut tile, path) = path_to(rank);
            tile.center = tile.center.checked_add(shift).unwrap();
            let center = 2.0 * half_edge.rotate(DVec2::from(tile.center.to_f64()));
            let near = center.distance(middle) < 2.5 * 2.0 * half_edge.length();
            let at_birth = tile.center;
            near.then_some(Found { tile, rank, born: FRONTIER_LEVEL, at_birth, path })
        })
        .collect()
}

/// Where the importance lets one point go.
fn constrained(importance: &impl Importance, center: DVec2, moved: DVec2, needed: f64) -> DVec2 {
    let ([mut x], [mut y]) = ([moved.x], [moved.y]);
    let to = [core::slice::from_mut(&mut x), core::slice::from_mut(&mut y)];
    importance.constrain([&[center.x], &[center.y]], &[needed], to);
    DVec2::new(x, y)
}

/// The vector by which a point is moved, by the reference lookup.
fn step<I: Importance>(
    sampling: &Sampling<'_, I>,
    table: &Displacements,
    at: DVec2,
    value: f64,
    path: &[(Classes, u8); MAX_LEVEL + 1],
) -> DVec2 {
    let counts = TileCounts::HEXAGON.all();
    let threshold = sampling.scale().threshold(value);
    let level = counts.partition_point(|n| (*n as f64) < threshold).max(1);
    if level < FIRST_RELAXED_LEVEL.into() {
        return DVec2::ZERO;
    }
    let (mut local, mut detail) = ([value], [0.0]);
    sampling.importance().surroundings(&[at.x], &[at.y], &mut local, &mut detail);
    let local = sampling.scale().threshold(local[0]);
    let tau = (local * (1.0 / counts[level - 1] as f64)).clamp(1.0, 7.0 + 4.0 * SQRT_3);
    let [x, y] = table.vector(&path[level].0, tau, detail[0]);
    // From the grandparent's frame to the great-grandparent's, in single precision; from there to the
    // domain's.
    let (grand, great) = (path[level - 2].1, path[level - 3].1);
    let turn = f64::from((grand + 12 - great) % 12) * core::f64::consts::FRAC_PI_6;
    let tidy = |v: f64| if v.abs() < 1e-9 { 0.0 } else { v as f32 };
    let (c, s) = (tidy(libm::cos(turn)), tidy(libm::sin(turn)));
    let (x, y) = (f64::from(c * x + -s * y), f64::from(s * x + c * y));
    let edge = sampling.placement().turned_edge(level as u8, great);
    DVec2::new(edge.x * x + -edge.y * y, edge.y * x + edge.x * y)
}

/// ((u + v√3)/2, (p + q√3)/2) as a ring element: a₁ = v, a₂ = q, a₀ = (u − q)/2, a₃ = (p − v)/2.
fn from_exact(u: i32, v: i32, p: i32, q: i32) -> Cyclotomic {
    assert!((u - q) % 2 == 0 && (p - v) % 2 == 0);
    Cyclotomic([(u - q) / 2, v, q, (p - v) / 2].map(i64::from))
}

fn descend(rules: &Rules, from: Found, level: u8, deepest: u8, found: &mut Vec<Found>) {
    if level == deepest {
        found.push(from);
        return;
    }
    let counts = TileCounts::HEXAGON.all();
    let (tiles, before) = (counts[usize::from(level)], counts[usize::from(level) - 1]);
    for digit in 0..from.tile.kind.child_count() as u8 {
        let tile = rules.child_of(&from.tile, digit).unwrap().unwrap();
        let mut path = from.path;
        path[usize::from(level) + 1] =
            (path[usize::from(level)].0.child(digit, tile.kind), tile.rotation);
        let child = match digit {
            0 => Found { tile, path, ..from },
            13 => Found {
                tile,
                rank: 13 * tiles + from.rank - before,
                born: level + 1,
                at_birth: tile.center,
                path,
            },
            _ => Found {
                tile,
                rank: u64::from(digit) * tiles + from.rank,
                born: level + 1,
                at_birth: tile.center,
                path,
            },
        };
        descend(rules, child, level + 1, deepest, found);
    }
}

mod tests {
    use super::*;
    use crate::bake;
    use crate::bake::displacement::{Layer, Slot, born_classes};
    use crate::{
        Amount, Constant, Domain, Function, ImageMap, InvalidPixels, Pixels, Placement, StippleMap,
        Tables,
    };
    use glam::Vec2;
    use proptest::prelude::*;

    fn sampled<I: Importance>(sampling: &Sampling<'_, I>) -> Vec<(u64, [f64; 2])> {
        let mut points: Vec<_> = sampling
            .points::<DVec2>()
            .unwrap()
            .map(|s| s.map(|s| (s.rank, s.position.to_array())).unwrap())
            .collect();
        points.sort_by_key(|(rank, _)| *rank);
        points
    }

    fn random_map(width: usize, height: usize, contrast: f32, bits: u64) -> ImageMap {
        let mut random = crate::random::SplitMix64::new(bits);
        let pixels = (0..width * height)
            .map(|_| match random.next_u64() % 5 {
                0 => 0.0,
                1 => contrast,
                _ => random.unit() as f32,
            })
            .collect();
        Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap()
    }

    /// Two layers of noise: vectors up to some three edges long, all generations, unborn classes.
    fn random_relaxation(rules: &Rules, bits: u64) -> Displacements {
        let mut random = crate::random::SplitMix64::new(!bits);
        let delta = crate::bake::displacement::DELTA;
        let mut layer = |index, slots: &[(f32, u8)]| {
            let slots = (0..slots.len())
                .map(|i| {
                    let (tau, generations) = slots[i];
                    let next = slots.get(i + 1).map_or(0.0, |s| f64::from(s.0));
                    let count = match i {
                        0 => 0,
                        _ if i + 1 == slots.len() => 0,
                        _ => born_classes(generations.into(), next),
                    };
                    let vectors = (0..count).map(|_| {
                        let bits = random.next_u64();
                        [bits as i8, (bits >> 8) as i8]
                    });
                    Slot { tau, generations, scale: 0.015, vectors: vectors.collect() }
                })
                .collect();
            Layer::new(index, slots).unwrap()
        };
        Displacements {
            digits: rules.digits().derivation_order(),
            provenance: "noise".into(),
            smooth: layer(0, &[(1.0, 2), (1.01, 3), (1.5, 4), (2.5, 3), (4.0, 2), (delta, 2)]),
            rough: Some(layer(1, &[(1.0, 2), (2.0, 2), (7.5, 2), (delta, 2)])),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn the_sampler_agrees_with_the_oracle_at_every_depth(
            seed: u64,
            (width, height) in (1usize..20, 1usize..20),
            count in 1.0..300.0f64,
            contrast in prop_oneof![Just(0.0f32), Just(1.0), Just(40.0)],
        ) {
            let map = random_map(width, height, contrast, seed);
            prop_assume!(map.mean() > 0.0);
            for depth in 1..=bake::MAX_DEPTH {
                let rules = Tables::built_in().rules();
                let bytes = bake::bake(&rules, depth, None).unwrap();
                let tables = Tables::from_bytes(&bytes).unwrap();
                let placement = Placement::new_in(map.domain(), seed, tables);
                let sampling = Sampling::new(&placement, &map, Amount::Points(count)).unwrap();
                prop_assert_eq!(sampled(&sampling), points(&sampling));
                let uniform = Sampling::new(&placement, &Constant::ONE, Amount::Points(count)).unwrap();
                prop_assert_eq!(sampled(&uniform), points(&uniform));
            }
        }

        #[test]
        fn the_relaxed_sampler_agrees_with_the_oracle_at_every_depth(
            seed: u64,
            (width, height) in (1usize..20, 1usize..20),
            count in 3.0..150.0f64,
            contrast in prop_oneof![Just(0.0f32), Just(1.0), Just(40.0)],
        ) {
            let map = random_map(width, height, contrast, seed);
            prop_assume!(map.mean() > 0.0);
            let rules = Tables::built_in().rules();
            let displacements = random_relaxation(&rules, seed);
            for depth in 1..=3 {
                let bytes = bake::bake(&rules, depth, Some(&displacements)).unwrap();
                let tables = Tables::from_bytes(&bytes).unwrap();
                let placement = Placement::new_in(map.domain(), seed, tables);
                let sampling = Sampling::new(&placement, &map, Amount::Points(count)).unwrap();
                let sampling = sampling.relaxed().unwrap();
                let (a, b) = (sampled(&sampling), points(&sampling));
                let wrong: Vec<_> = a.iter().zip(&b).filter(|(a, b)| a != b).collect();
                prop_assert!(a == b, "depth {depth} {} {} {wrong:?}", a.len(), b.len());
                let pixels = map.pixels().to_vec();
                let stipple =
                    Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(|pixels| StippleMap::new(pixels, count)).unwrap();
                let stippled = Sampling::new(&placement, &stipple, Amount::Points(count)).unwrap();
                let stippled = stippled.relaxed().unwrap();
                prop_assert_eq!(sampled(&stippled), points(&stippled));
                let uniform = Sampling::new(&placement, &Constant::ONE, Amount::Points(count));
                let uniform = uniform.unwrap().relaxed().unwrap();
                prop_assert_eq!(sampled(&uniform), points(&uniform));
                let mut buffer = alloc::vec![DVec2::ZERO; 1000];
                let filled = uniform.fill(&mut buffer).unwrap();
                let mut filled: Vec<_> =
                    buffer[..filled.written].iter().map(|p| p.to_array()).collect();
                let mut listed: Vec<_> = points(&uniform).iter().map(|(_, p)| *p).collect();
                filled.sort_by(|a, b| a.partial_cmp(b).unwrap());
                listed.sort_by(|a, b| a.partial_cmp(b).unwrap());
                prop_assert_eq!(filled, listed);
            }
        }

        #[test]
        fn closures_agree_with_the_oracle(seed: u64, count in 1.0..2000.0f64) {
            let placement = Placement::new(Domain::UNIT, seed);
            let bump = Function::new(
                |p: DVec2| p.x * p.x * (1.0 - p.y).max(0.0),
                |r: &crate::Disc| {
                    let x = (r.center.x.abs() + r.radius).min(1.0);
                    x * x * (1.0 - (r.center.y - r.radius)).clamp(0.0, 1.0)
                },
            );
            let sampling = Sampling::new(&placement, &bump, Amount::Density(6.0 * count)).unwrap();
            prop_assert_eq!(sampled(&sampling), points(&sampling));
        }
    }

    #[test]
    fn thresholds_on_just_below_and_just_above_tile_counts_and_ranks_agree_with_the_oracle() {
        let domain = Domain::UNIT;
        for seed in 0..3 {
            let placement = Placement::new(domain, seed);
            let any = Sampling::new(&placement, &Constant::ONE, Amount::Points(1.0)).unwrap();
            let counts = TileCounts::HEXAGON.all();
            let ranks = points(&any.with_scale(counts[6] as f64, 0.0));
            let some_ranks = ranks.iter().skip(seed as usize).step_by(41).map(|(rank, _)| *rank);
            for integer in some_ranks.chain(counts[4..=6].iter().copied()) {
                let t = integer as f64;
                for t in [t.next_down(), t, t.next_up(), t + 1.0] {
                    let sampling = any.with_scale(t, 0.0);
                    assert_eq!(sampled(&sampling), points(&sampling), "T = {t}");
                }
                // The point of rank k appears as soon as T passes k.
                let present = |t| sampled(&any.with_scale(t, 0.0)).iter().any(|p| p.0 == integer);
                assert!(!present(t));
                assert_eq!(present(t.next_up()), ranks.iter().any(|p| p.0 == integer));
            }
        }
    }

    #[test]
    fn the_frontier_is_every_tile_that_reaches_the_domain() {
        use crate::placement::FRONTIER_LEVEL;
        use crate::tiling::numbers::REACH;
        let rules = Tables::built_in().rules();
        let mut level = alloc::vec![Tile::root(crate::tiling::TileType::A)];
        for _ in 0..FRONTIER_LEVEL {
            level = level
                .iter()
                .flat_map(|t| (0..14).filter_map(|d| rules.child_of(t, d).unwrap()))
                .collect();
        }
        for seed in 0..40 {
            let domain =
                Domain::new(DVec2::ZERO, DVec2::new(1.0, 0.01 + 0.1 * seed as f64)).unwrap();
            // Without relaxed offsets, which widen the frontier.
            let bytes = bake::bake(&rules, 1, None).unwrap();
            let tables = Tables::from_bytes(&bytes).unwrap();
            let placement = Placement::new_in(domain, seed, tables);
            let frontier: Vec<_> = placement.frontier().collect();
            // Find the absolute center of one frontier tile by its rank, then compare all.
            let h = placement.half_edge(FRONTIER_LEVEL);
            let place = |z: Cyclotomic| 2.0 * h.rotate(DVec2::from(z.to_f64()));
            let by_rank = |rank| {
                crate::tiling::FCode::from_rank(crate::tiling::TileType::A, 4, rank)
                    .unwrap()
                    .tile(&rules)
                    .unwrap()
            };
            let first = by_rank(frontier[0].rank);
            let expected = frontier[0].center;
            let shift = placement.origin()
                + 2.0
                    * h.rotate(DVec2::from(
                        from_exact(expected.u, expected.v, expected.p, expected.q).to_f64(),
                    ))
                - place(first.center);
            let reach = REACH * 2.0 * h.length();
            let touching = level
                .iter()
                .filter(|t| {
                    let c = place(t.center) + shift;
                    c.distance(0.5 * domain.size()) <= reach + 0.5 * domain.diagonal()
                })
                .count();
            assert_eq!(touching, frontier.len());
            assert!((2..=9).contains(&touching), "{touching}");
            for node in frontier {
                let tile = by_rank(node.rank);
                assert_eq!((tile.kind, tile.rotation), (node.kind, node.rotation));
            }
        }
    }

    #[test]
    fn precisions_agree_but_for_rounding() {
        let map = random_map(64, 48, 3.0, 9);
        let placement = Placement::new(map.domain(), 5);
        let sampling = Sampling::new(&placement, &map, Amount::Points(30_000.0)).unwrap();
        let single: Vec<_> = sampling.points::<Vec2>().unwrap().map(Result::unwrap).collect();
        let double: Vec<_> = sampling.points::<DVec2>().unwrap().map(Result::unwrap).collect();
        assert!(single.len().abs_diff(double.len()) < 10, "{} {}", single.len(), double.len());
        let mut common = 0;
        let by_rank: alloc::collections::BTreeMap<_, _> =
            double.iter().map(|s| (s.rank, s.position)).collect();
        for s in &single {
            if let Some(exact) = by_rank.get(&s.rank) {
                common += 1;
                let error = s.position.as_dvec2().distance(*exact);
                assert!(error < 80.0 * 2.0f64.powi(-21), "{error}");
            }
        }
        assert!(common + 10 > single.len());
    }
}
