//! Seamless domains: sets on a torus, against all tiles of the torus found by the rules alone, and by what
//! may not matter.

use glam::{DVec2, Vec2};
use twelvefold::tiling::{Cyclotomic, Tile, TileType, snub_square};
use twelvefold::{
    Amount, BilinearMap, Constant, Domain, Function, ImageMap, Importance, InvalidPixels, Limits,
    Pixels, Placement, Sampling, SamplingError, StippleMap, Tables, estimate,
};

use crate::common::{every_depth, map, noise, points};

/// Domains of several ratios, one of them far from the origin.
fn domains() -> [(Domain, [u32; 2]); 4] {
    let domain = |x, y, w, h| Domain::new(DVec2::new(x, y), DVec2::new(w, h)).unwrap();
    [
        (Domain::UNIT, [1, 1]),
        (domain(-3.5, 100.25, 3.0, 2.0), [3, 2]),
        (domain(1e3, 5.0, 0.2, 0.8), [1, 4]),
        (domain(0.0, 0.0, 1.6, 0.9), [16, 9]),
    ]
}

/// The shortest way from a to b on the torus.
fn away(domain: &Domain, a: DVec2, b: DVec2) -> DVec2 {
    let sides = (b - a) / domain.size();
    (sides - sides.round()) * domain.size()
}

/// The distance of each point to the nearest other on the torus, by way of a grid.
fn nearest(domain: &Domain, points: &[(u64, DVec2)]) -> Vec<f64> {
    let cell = (domain.area() / points.len() as f64).sqrt();
    let count = (domain.size() / cell).floor().max(DVec2::ONE);
    let cell_of = |at: DVec2| {
        let i = ((at - domain.min()) / domain.size() * count).floor();
        i.clamp(DVec2::ZERO, count - 1.0)
    };
    let index = |i: DVec2| {
        let i = i.rem_euclid(count);
        (i.y * count.x + i.x) as usize
    };
    let mut grid = vec![Vec::new(); (count.x * count.y) as usize];
    for (i, (_, at)) in points.iter().enumerate() {
        grid[index(cell_of(*at))].push(i);
    }
    let of = |(i, (_, at)): (usize, &(u64, DVec2))| {
        let mut least = f64::INFINITY;
        for (dx, dy) in (-2..=2).flat_map(|y| (-2..=2).map(move |x| (f64::from(x), f64::from(y)))) {
            for j in &grid[index(cell_of(*at) + DVec2::new(dx, dy))] {
                if *j != i {
                    least = least.min(away(domain, *at, points[*j].1).length());
                }
            }
        }
        least
    };
    points.iter().enumerate().map(of).collect()
}

/// All tiles of a square torus some levels below its roots: rank and center in domain sides, without
/// placement or walk. The shift is any.
fn all_tiles(quarters: u8, levels: usize) -> Vec<(u64, DVec2)> {
    let rules = Tables::built_in().rules();
    let mut tiles: Vec<(u64, Tile)> = (0..)
        .zip(snub_square::VERTICES)
        .map(|(rank, (kind, rotation, center))| {
            let center = center.checked_rotate(3 * quarters).unwrap();
            (rank, Tile { kind, rotation: (rotation + 3 * quarters) % 12, center })
        })
        .collect();
    let mut period = snub_square::CELL;
    let (mut before, mut count) = (0, 4);
    for _ in 0..levels {
        let parents = std::mem::take(&mut tiles);
        for (rank, tile) in parents {
            for digit in 0..tile.kind.child_count() as u8 {
                let child = rules.child_of(&tile, digit).unwrap().unwrap();
                let rank = match digit {
                    13 => 13 * count + rank - before,
                    _ => u64::from(digit) * count + rank,
                };
                tiles.push((rank, child));
            }
        }
        (before, count) = (count, 14 * count - before);
        period = period.map(|side| side.checked_mul_lambda().unwrap());
    }
    let [x, y] = period.map(|side| DVec2::from_array(side.to_f64()));
    let in_sides = |z: Cyclotomic| {
        let at = DVec2::from_array(z.to_f64());
        DVec2::new(at.dot(x), at.dot(y)) / x.length_squared()
    };
    tiles.sort_by_key(|(rank, _)| *rank);
    assert!(tiles.iter().map(|(rank, _)| *rank).eq(0..count));
    assert!(tiles.iter().any(|(_, tile)| tile.kind == TileType::A));
    tiles.iter().map(|(rank, tile)| (*rank, in_sides(tile.center))).collect()
}

#[test]
fn the_points_are_all_tiles_of_the_torus() {
    let all: Vec<_> = (0..4).map(|quarters| all_tiles(quarters, 3)).collect();
    let mut seen = [false; 4];
    for seed in 0..16 {
        let placement = Placement::seamless(Domain::UNIT, seed).unwrap();
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(10_864.0)).unwrap();
        let found = points(&sampling).unwrap();
        let is = |tiles: &Vec<(u64, DVec2)>| {
            let shift = found[0].1 - tiles[0].1;
            tiles.len() == found.len()
                && tiles.iter().zip(&found).all(|((rank, at), (found, position))| {
                    let away = away(&Domain::UNIT, *at + shift, *position);
                    rank == found && away.length() < 1e-12
                })
        };
        let quarters = all.iter().position(is).expect("one of the four turns");
        seen[quarters] = true;
    }
    assert!(seen.iter().all(|seen| *seen), "{seen:?}");
}

#[test]
fn complete_levels_have_their_counts_and_one_nearest_distance() {
    for (domain, [columns, rows]) in domains() {
        let cells = f64::from(columns * rows);
        for (seed, tiles) in [(1, 4.0), (2, 56.0), (3, 780.0)] {
            let n = tiles * cells;
            let placement = Placement::seamless(domain, seed).unwrap();
            let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(n)).unwrap();
            let found = points(&sampling).unwrap();
            assert!(found.iter().map(|(rank, _)| *rank).eq(0..n as u64));
            assert!(found.iter().all(|(_, at)| domain.contains(*at)));
            // A cell is 2 cos 15° edges wide, and λ times as many a level on.
            let finer = 2.0 + 3.0f64.sqrt();
            let levels = [4.0, 56.0, 780.0].iter().position(|level| *level == tiles).unwrap();
            let edges = f64::from(columns) * finer.sqrt() * finer.powi(levels as i32);
            let edge = domain.size().x / edges;
            for least in nearest(&domain, &found) {
                assert!((least / edge - 1.0).abs() < 1e-9, "{domain:?} {n}: {least} {edge}");
            }
        }
    }
}

#[test]
fn every_number_of_points_is_exact_and_no_pair_is_close() {
    for (domain, _) in domains() {
        for (seed, n) in [(4, 0.0), (5, 1.0), (6, 37.0), (7, 1000.0), (8, 4321.0)] {
            let placement = Placement::seamless(domain, seed).unwrap();
            let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(n)).unwrap();
            for sampling in [sampling, sampling.relaxed().unwrap()] {
                let found = points(&sampling).unwrap();
                assert!(found.iter().map(|(rank, _)| *rank).eq(0..n as u64), "{domain:?} {n}");
                assert!(found.iter().all(|(_, at)| domain.contains(*at)));
                let single = sampling.points::<Vec2>().unwrap();
                let mut ranks: Vec<u64> = single.map(|sample| sample.unwrap().rank).collect();
                ranks.sort_unstable();
                assert!(ranks.into_iter().eq(0..n as u64));
                if n >= 1000.0 {
                    // 0.26 spacings is one edge of the next level.
                    let spacing = (domain.area() / n).sqrt();
                    let least = nearest(&domain, &found).into_iter().fold(f64::INFINITY, f64::min);
                    assert!(least > 0.24 * spacing, "{domain:?} {n}: {}", least / spacing);
                }
            }
        }
    }
}

#[test]
fn nine_copies_are_as_even_across_their_seams_as_within() {
    // Points in discs centered on a seam, or on the middle of the domain, over many seeds.
    let spread = |relaxed: bool, center: DVec2| {
        let counts: Vec<f64> = (0..150)
            .map(|seed| {
                let placement = Placement::seamless(Domain::UNIT, seed).unwrap();
                let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(500.0));
                let sampling = sampling.unwrap();
                let sampling = if relaxed { sampling.relaxed().unwrap() } else { sampling };
                let found = points(&sampling).unwrap();
                let copies = (0..9).flat_map(|i| {
                    let copy = DVec2::new(f64::from(i % 3), f64::from(i / 3));
                    found.iter().map(move |(_, at)| *at + copy)
                });
                copies.filter(|at| at.distance(center) < 0.2).count() as f64
            })
            .collect();
        let mean = counts.iter().sum::<f64>() / counts.len() as f64;
        let variance = counts.iter().map(|n| (n - mean) * (n - mean)).sum::<f64>();
        (mean, variance / counts.len() as f64)
    };
    let expected = 500.0 * std::f64::consts::PI * 0.04;
    for relaxed in [false, true] {
        let [within, seam, corner] = [1.5, 1.0, 2.0]
            .map(|at| spread(relaxed, DVec2::new(at, if at < 2.0 { 1.5 } else { at })));
        for (mean, variance) in [within, seam, corner] {
            // White noise has 63.
            assert!((mean - expected).abs() < 0.5, "{mean} {expected}");
            assert!(variance < 12.0 && variance < 2.0 * within.1, "{variance} {within:?}");
        }
    }
}

/// A map that goes over its border without a seam, with a region of 0.
fn waves(width: usize, height: usize) -> ImageMap {
    let tau = std::f64::consts::TAU;
    map(width, height, |x, y| {
        let wave = |i: usize, n: usize| (tau * (i as f64 + 0.5) / n as f64).sin();
        (wave(x, width) + wave(y, height) + 0.3 * f64::from(noise(x, y))).max(0.0) as f32
    })
}

fn check_cuts<I: Importance>(sampling: Sampling<'_, I>) {
    let domain = sampling.placement().domain();
    let whole = points(&sampling).unwrap();
    let mut buffer = vec![DVec2::ZERO; whole.len() + 1];
    let filled = sampling.fill(&mut buffer).unwrap();
    assert!(filled.complete && filled.written == whole.len());
    let key = |at: &DVec2| (at.x.to_bits(), at.y.to_bits());
    let mut written: Vec<_> = buffer[..filled.written].iter().map(key).collect();
    let mut listed: Vec<_> = whole.iter().map(|(_, at)| key(at)).collect();
    written.sort_unstable();
    listed.sort_unstable();
    assert!(written == listed);

    let division = sampling.divide(5).unwrap();
    let mut parts: Vec<(u64, DVec2)> = (0..5)
        .flat_map(|i| division.part(i).unwrap().points::<DVec2>().unwrap())
        .map(|sample| sample.map(|s| (s.rank, s.position)).unwrap())
        .collect();
    parts.sort_by_key(|(rank, _)| *rank);
    assert_eq!(parts, whole);

    // Corners, a strip over all the width, and more than the domain.
    for [x, y, w, h] in [
        [0.0, 0.0, 0.1, 0.2],
        [0.85, 0.7, 0.15, 0.3],
        [0.0, 0.97, 1.0, 0.03],
        [-1.0, -1.0, 3.0, 3.0],
    ] {
        let low = domain.min() + DVec2::new(x, y) * domain.size();
        let rectangle = Domain::new(low, DVec2::new(w, h) * domain.size()).unwrap();
        let expected: Vec<_> =
            whole.iter().filter(|(_, at)| rectangle.contains(*at)).copied().collect();
        assert_eq!(points(&sampling.clipped(rectangle)).unwrap(), expected);
    }
}

#[test]
fn parts_clips_and_buffers_hold_the_same_points() {
    for (seed, (domain, _)) in (0..).zip(domains()) {
        let placement = Placement::seamless(domain, seed).unwrap();
        let waves = waves(48, 32);
        let waves = waves.over(domain);
        let amount = Amount::Points(1500.0);
        let constant = Sampling::new(&placement, &Constant::ONE, amount).unwrap();
        let mapped = Sampling::new(&placement, &waves, amount).unwrap();
        check_cuts(constant);
        check_cuts(constant.relaxed().unwrap());
        check_cuts(mapped);
        check_cuts(mapped.relaxed().unwrap());
    }
    let stipple = {
        let pixels = waves(48, 32).pixels().to_vec();
        let pixels = Pixels::new(48, 32, pixels, InvalidPixels::Reject).unwrap();
        StippleMap::new(pixels, 1500.0).unwrap()
    };
    let placement = Placement::seamless(stipple.domain(), 8).unwrap();
    let stippled = Sampling::new(&placement, &stipple, Amount::Points(1500.0)).unwrap();
    check_cuts(stippled.relaxed().unwrap());
    // Enough for whole blocks of moved points.
    let placement = Placement::seamless(Domain::UNIT, 9).unwrap();
    let many = Sampling::new(&placement, &Constant::ONE, Amount::Points(20_000.0)).unwrap();
    check_cuts(many.relaxed().unwrap());
}

#[test]
fn the_baked_depth_and_the_order_of_steps_change_nothing() {
    let domain = domains()[1].0;
    let waves = waves(48, 32).over(domain);
    let amount = Amount::Points(2000.0);
    let placement = Placement::seamless(domain, 3).unwrap();
    let expected = points(&Sampling::new(&placement, &waves, amount).unwrap()).unwrap();
    for tables in every_depth() {
        let placement = Placement::seamless_in(domain, 3, *tables).unwrap();
        assert_eq!(points(&Sampling::new(&placement, &waves, amount).unwrap()).unwrap(), expected);
    }
    let rectangle = Domain::new(domain.min(), 0.3 * domain.size()).unwrap();
    let sampling = Sampling::new(&placement, &waves, amount).unwrap();
    assert_eq!(
        points(&sampling.relaxed().unwrap().clipped(rectangle)).unwrap(),
        points(&sampling.clipped(rectangle).relaxed().unwrap()).unwrap()
    );
}

#[test]
fn importance_wraps() {
    let waves = waves(64, 64).over(Domain::UNIT);
    let amount = Amount::Points(800.0);
    let strip = |at: f64| !(0.1..0.9).contains(&at);
    let (mut fixed, mut relaxed) = (0usize, 0usize);
    let seeds = 60;
    for seed in 0..seeds {
        let placement = Placement::seamless(Domain::UNIT, seed).unwrap();
        let sampling = Sampling::new(&placement, &waves, amount).unwrap();
        let found = points(&sampling).unwrap();
        assert!(found.iter().all(|(_, at)| waves.value(*at) > 0.0));
        fixed += found.iter().filter(|(_, at)| strip(at.x) || strip(at.y)).count();
        let found = points(&sampling.relaxed().unwrap()).unwrap();
        // Never where there is nothing, on whichever side.
        assert!(found.iter().all(|(_, at)| waves.value(*at) > 0.0));
        relaxed += found.iter().filter(|(_, at)| strip(at.x) || strip(at.y)).count();
    }
    let (mut border, mut all) = (0.0, 0.0);
    for i in 0..640 * 640 {
        let at = DVec2::new(f64::from(i % 640) + 0.5, f64::from(i / 640) + 0.5) / 640.0;
        let value = waves.value(at);
        all += value;
        border += if strip(at.x) || strip(at.y) { value } else { 0.0 };
    }
    let expected = 800.0 * border / all * seeds as f64;
    for count in [fixed, relaxed] {
        assert!((count as f64 / expected - 1.0).abs() < 0.01, "{count} {expected}");
    }
}

#[test]
fn an_interpolated_map_wraps_too() {
    // Light in the first column only: interpolated, half a pixel of the last one has some.
    let columns = map(16, 16, |x, _| if x == 0 { 1.0 } else { 0.0 });
    let across = |map: &BilinearMap| {
        let placement = Placement::seamless(map.map().domain(), 4).unwrap();
        let sampling = Sampling::new(&placement, map, Amount::Points(2000.0)).unwrap();
        check_cuts(sampling);
        check_cuts(sampling.relaxed().unwrap());
        let found = points(&sampling).unwrap();
        assert!(found.iter().all(|(_, at)| map.value(*at) > 0.0));
        found.iter().filter(|(_, at)| at.x > 15.0).count()
    };
    let side = |map: ImageMap| map.over(Domain::new(DVec2::ZERO, DVec2::splat(16.0)).unwrap());
    assert_eq!(across(&BilinearMap::new(side(columns.clone()))), 0);
    // An eighth: half a pixel falling from a half to nothing, of one in all.
    let wrapped = across(&BilinearMap::seamless(side(columns)));
    assert!(wrapped.abs_diff(250) < 25, "{wrapped}");
}

/// What is left out of a walk changes no point: counts and ranks at every number of points, of a map whose
/// greatest value is anywhere.
#[test]
fn few_points_are_those_of_the_lowest_ranks_everywhere() {
    for (domain, [columns, rows]) in domains() {
        let tiles = f64::from(56 * columns * rows);
        let spot = |at: DVec2| {
            let away = away(&domain, domain.min() + 0.3 * domain.size(), at) / domain.size();
            if away.length() < 0.1 { 1.0 } else { 0.02 }
        };
        let uneven = Function::new(spot, |_: &twelvefold::Disc| 1.0);
        for seed in 0..3 {
            let placement = Placement::seamless(domain, seed).unwrap();
            let most = Sampling::new(&placement, &Constant::ONE, Amount::Points(1.5 * tiles));
            let most = points(&most.unwrap()).unwrap();
            for part in [0.001, 0.02, 0.07, 0.4, 0.999, 1.2] {
                let density = Amount::Density(part * tiles / domain.area());
                let all = Sampling::new(&placement, &Constant::ONE, density).unwrap();
                let few = points(&all).unwrap();
                assert_eq!(few, most[..few.len()]);
                // Rank + u < T, at every place by itself.
                let sampling = Sampling::new(&placement, &uneven, density).unwrap();
                let found = points(&sampling).unwrap();
                let kept = |(rank, at): &&(u64, DVec2)| {
                    let limit = part * tiles * spot(*at);
                    // Not told here within a rank of the limit, where u decides.
                    (*rank as f64) < limit - 1.0
                };
                assert!(
                    found.iter().filter(kept).eq(most.iter().filter(kept)),
                    "{domain:?} {part}"
                );
                let past = |(rank, at): &&(u64, DVec2)| *rank as f64 > part * tiles * spot(*at);
                assert_eq!(found.iter().filter(past).count(), 0);
            }
        }
    }
}

#[test]
fn a_bound_that_is_too_low_across_the_seam_is_an_error() {
    // Honest about discs in the domain's left half only.
    let broken = Function::new(
        |at: DVec2| if at.x > 0.9 { 2.0 } else { 1.0 },
        |region: &twelvefold::Disc| if region.center.x < 0.9 - region.radius { 1.0 } else { 2.0 },
    );
    let placement = Placement::seamless(Domain::UNIT, 2).unwrap();
    let sampling = Sampling::new(&placement, &broken, Amount::Density(3000.0)).unwrap();
    // This one is honest: tiles over the left border see the right one's importance.
    let found = points(&sampling).unwrap();
    let right = found.iter().filter(|(_, at)| at.x > 0.9).count();
    assert!(right.abs_diff(600) < 40, "{right}");
    let nan = Function::new(
        |_: DVec2| 1.0,
        |region: &twelvefold::Disc| {
            if region.radius < 0.2 { f64::NAN } else { 1.0 }
        },
    );
    let sampling = Sampling::new(&placement, &nan, Amount::Density(3000.0)).unwrap();
    assert!(matches!(points(&sampling), Err(SamplingError::InvalidBound { .. })));
}

#[test]
fn exactly_n_weighted_points_and_progressive_ones() {
    let waves = waves(32, 32).over(Domain::UNIT);
    let placement = Placement::seamless(Domain::UNIT, 5).unwrap();
    let found = estimate::exactly(&placement, &waves, 777, Limits::default()).unwrap();
    assert_eq!(found.len(), 777);
    let fewer = estimate::exactly(&placement, &waves, 300, Limits::default()).unwrap();
    assert!(fewer.iter().zip(&found).all(|(a, b)| a.rank == b.rank && a.position == b.position));
    // A periodic integral: ∫ sin²(2πx) = 1/2, at a complete level far better than at random.
    let placement = Placement::seamless(Domain::UNIT, 6).unwrap();
    let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(780.0)).unwrap();
    let sum: f64 = points(&sampling)
        .unwrap()
        .iter()
        .map(|(_, at)| (std::f64::consts::TAU * at.x).sin().powi(2))
        .sum();
    assert!((sum / 780.0 - 0.5).abs() < 1e-4, "{}", sum / 780.0);
}

#[test]
fn other_ratios_are_errors() {
    for (width, height) in [(17.0, 1.0), (1.0, 1.001), (std::f64::consts::E, 1.0)] {
        let domain = Domain::new(DVec2::ZERO, DVec2::new(width, height)).unwrap();
        let error = Placement::seamless(domain, 1).unwrap_err();
        assert_eq!(error, SamplingError::Ratio { width, height });
        assert!(error.to_string().contains("whole numbers up to 16"), "{error}");
    }
}

#[test]
fn the_deepest_level_is_reached() {
    let placement = Placement::seamless(Domain::UNIT, 3).unwrap();
    let spot = Function::new(
        |at: DVec2| f64::from(at.distance(DVec2::new(0.0, 0.5)) < 2e-6),
        |region: &twelvefold::Disc| {
            f64::from(region.center.distance(DVec2::new(0.0, 0.5)) < 2e-6 + region.radius)
        },
    );
    let limits = Limits { points: u64::MAX, tiles: 20_000 };
    let density = 4.0 * 7.0e14;
    let sampling = Sampling::within(&placement, &spot, Amount::Density(density), limits).unwrap();
    let found = points(&sampling).unwrap();
    let expected = density * std::f64::consts::PI * 2e-12; // half of the disc is wrapped off
    assert!((found.len() as f64 / expected - 1.0).abs() < 0.1, "{} {expected}", found.len());
    let too_dense = Amount::Density(1e16);
    assert!(matches!(
        Sampling::within(&placement, &spot, too_dense, limits),
        Err(SamplingError::TooDense { .. })
    ));
}
