//! The slow oracle: every tile of every level, each point tested, nothing pruned, no block table.
//!
//! It works on ring elements and production rules, where the sampler works on baked offsets; they share
//! the placement's numbers (origin, edge, seed) and the rule that a point is computed from the tile at
//! which it is born.

use alloc::vec::Vec;

use glam::DVec2;

use crate::importance::Importance;
use crate::sampling::Sampling;
use crate::tiling::cyclotomic::SQRT_3;
use crate::tiling::{Cyclotomic, Rules, Tile, TileCounts};

/// A tile, its rank, and where its centre was born: level and coordinates.
#[derive(Clone, Copy)]
struct Found {
    tile: Tile,
    rank: u64,
    born: u8,
    at_birth: Cyclotomic,
}

/// Every point of the sampling as (rank, position), sorted by rank. The domain's corner must be 0.
pub(crate) fn points<I: Importance>(sampling: &Sampling<'_, I>) -> Vec<(u64, [f64; 2])> {
    let placement = sampling.placement();
    let rules = &placement.tables().rules();
    let domain = placement.domain();
    assert_eq!(domain.min(), DVec2::ZERO);
    let highest = sampling.scale().limit(sampling.importance().upper_bound(&domain.region()));
    let counts = TileCounts::HEXAGON.all();
    let level = (4..).find(|level| counts[*level] >= highest).unwrap();

    let mut found = Vec::new();
    for node in placement.frontier() {
        let centre = from_exact(node.centre.u, node.centre.v, node.centre.p, node.centre.q);
        let tile = Tile { kind: node.kind, rotation: node.rotation, centre };
        let start = Found { tile, rank: node.rank, born: node.level, at_birth: centre };
        descend(rules, start, node.level, level as u8, &mut found);
    }
    let mut points = Vec::new();
    for Found { rank, born, at_birth, .. } in found {
        let [x, y] = at_birth.to_surds().unwrap().map(|s| s.whole as f64 + SQRT_3 * s.root as f64);
        let h = placement.half_edge(born);
        let at = placement.origin() + DVec2::new(h.x * x + -h.y * y, h.y * x + h.x * y);
        if domain.contains(at) {
            let value = sampling.importance().value(at);
            if rank < sampling.scale().limit(value) {
                points.push((rank, at.to_array()));
            }
        }
    }
    points.sort_by_key(|(rank, _)| *rank);
    points
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
        let child = match digit {
            0 => Found { tile, ..from },
            13 => Found {
                tile,
                rank: 13 * tiles + from.rank - before,
                born: level + 1,
                at_birth: tile.centre,
            },
            _ => Found {
                tile,
                rank: u64::from(digit) * tiles + from.rank,
                born: level + 1,
                at_birth: tile.centre,
            },
        };
        descend(rules, child, level + 1, deepest, found);
    }
}

mod tests {
    use super::*;
    use crate::bake;
    use crate::{Amount, Constant, Domain, Function, ImageMap, InvalidPixels, Placement, Tables};
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
        let mut random = crate::seed::SplitMix64::new(bits);
        let pixels = (0..width * height)
            .map(|_| match random.next_u64() % 5 {
                0 => 0.0,
                1 => contrast,
                _ => random.unit() as f32,
            })
            .collect();
        ImageMap::new(width, height, pixels, InvalidPixels::Reject).unwrap()
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
                let bytes = bake::bake(&rules, depth).unwrap();
                let tables = Tables::from_bytes(&bytes).unwrap();
                let placement = Placement::with_tables(map.domain(), seed, tables);
                let sampling = Sampling::new(&placement, &map, Amount::Points(count)).unwrap();
                prop_assert_eq!(sampled(&sampling), points(&sampling));
                let uniform = Sampling::new(&placement, &Constant::ONE, Amount::Points(count)).unwrap();
                prop_assert_eq!(sampled(&uniform), points(&uniform));
            }
        }

        #[test]
        fn closures_agree_with_the_oracle(seed: u64, count in 1.0..2000.0f64) {
            let placement = Placement::new(Domain::unit(), seed);
            let bump = Function::new(
                |p: DVec2| p.x * p.x * (1.0 - p.y).max(0.0),
                |r: &crate::Region| {
                    let x = (r.centre.x.abs() + r.radius).min(1.0);
                    x * x * (1.0 - (r.centre.y - r.radius)).clamp(0.0, 1.0)
                },
            );
            let sampling = Sampling::new(&placement, &bump, Amount::Density(6.0 * count)).unwrap();
            prop_assert_eq!(sampled(&sampling), points(&sampling));
        }
    }

    #[test]
    fn thresholds_on_just_below_and_just_above_tile_counts_and_ranks_agree_with_the_oracle() {
        let domain = Domain::unit();
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
        use crate::placement::{FRONTIER_LEVEL, REACH};
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
            let placement = Placement::new(domain, seed);
            let frontier: Vec<_> = placement.frontier().collect();
            // Find the absolute centre of one frontier tile by its rank, then compare all.
            let h = placement.half_edge(FRONTIER_LEVEL);
            let place = |z: Cyclotomic| 2.0 * h.rotate(DVec2::from(z.to_f64()));
            let by_rank = |rank| {
                crate::tiling::FCode::from_rank(crate::tiling::TileType::A, 4, rank)
                    .unwrap()
                    .tile(&rules)
                    .unwrap()
            };
            let first = by_rank(frontier[0].rank);
            let expected = frontier[0].centre;
            let shift = placement.origin()
                + 2.0
                    * h.rotate(DVec2::from(
                        from_exact(expected.u, expected.v, expected.p, expected.q).to_f64(),
                    ))
                - place(first.centre);
            let reach = REACH * 2.0 * h.length();
            let touching = level
                .iter()
                .filter(|t| {
                    let c = place(t.centre) + shift;
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
