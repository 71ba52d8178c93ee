//! Laws that hold for every importance, seed and amount, as properties.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::{every_depth, map, noise, points};
use glam::{DVec2, Vec2};
use proptest::prelude::*;
use twelvefold::{
    Amount, Constant, Disc, Domain, Function, ImageMap, Importance, InvalidPixels, Pixels,
    Placement, Sampling, StippleMap,
};

/// Sizes, pixels of several characters, and a seed.
fn maps() -> impl Strategy<Value = (ImageMap, u64)> {
    let pixel = prop_oneof![3 => 0.0f32..1.0, 1 => Just(0.0f32), 1 => 0.0f32..50.0];
    (1usize..24, 1usize..24)
        .prop_flat_map(move |(w, h)| {
            let pixels = proptest::collection::vec(pixel.clone(), w * h);
            (Just((w, h)), pixels, any::<u64>())
        })
        .prop_map(|((w, h), pixels, seed)| {
            (
                Pixels::new(w, h, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap(),
                seed,
            )
        })
}

fn ranks(points: &[(u64, DVec2)]) -> BTreeSet<u64> {
    points.iter().map(|(rank, _)| *rank).collect()
}

/// How far a count may be from its expectation, for any importance. Measured standard deviations are
/// far smaller (3.2 % at 64 points of constant importance); thresholding never does worse than a
/// Poisson process, whose six standard deviations this is.
fn count_bound(expected: f64) -> f64 {
    6.0 + 6.0 * expected.sqrt()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_point_is_the_center_of_one_tile_that_is_not_opened(
        (map, seed) in maps(), density in 0.1..30.0f64,
    ) {
        let placement = Placement::new(map.domain(), seed);
        let sampling = Sampling::new(&placement, &map, Amount::Density(density)).unwrap();
        let mut whole = BTreeMap::new();
        let mut known = true;
        sampling
            .opened(|parent, tiles| {
                known &= parent.is_none_or(|tile| whole.remove(&(tile.rank, tile.level)).is_some());
                whole.extend(tiles.iter().map(|tile| ((tile.rank, tile.level), tile.center)));
            })
            .unwrap();
        prop_assert!(known, "a tile was opened that nobody had seen");
        for (rank, at) in points(&sampling).unwrap() {
            let found: Vec<_> = whole.range((rank, 0)..=(rank, u8::MAX)).collect();
            prop_assert_eq!(found.len(), 1, "rank {}", rank);
            prop_assert!(found[0].1.distance(at) < 1e-9 * map.domain().size().max_element());
        }

    }

    #[test]
    fn raising_the_importance_never_removes_a_point(
        (low, seed) in maps(),
        raise in proptest::collection::vec(prop_oneof![Just(0.0f32), 0.0f32..5.0], 24 * 24),
        density in 0.1..30.0f64,
    ) {
        let (width, height) = low.size();
        let raised = low.pixels().iter().zip(&raise).map(|(p, r)| p + r).collect();
        let high = Pixels::new(width, height, raised, InvalidPixels::Reject).and_then(ImageMap::new).unwrap();
        let placement = Placement::new(low.domain(), seed);
        let few = Sampling::new(&placement, &low, Amount::Density(density)).unwrap();
        let many = Sampling::new(&placement, &high, Amount::Density(density)).unwrap();
        let (few, many) = (points(&few).unwrap(), points(&many).unwrap());
        let present: BTreeSet<_> = many.iter().map(|(rank, at)| (*rank, at.to_array().map(f64::to_bits))).collect();
        for (rank, at) in few {
            prop_assert!(present.contains(&(rank, at.to_array().map(f64::to_bits))));
        }
    }

    #[test]
    fn a_greater_density_only_adds((image, seed) in maps(), density in 0.1..10.0f64, more in 1.0..3.0f64) {
        let placement = Placement::new(image.domain(), seed);
        let few = Sampling::new(&placement, &image, Amount::Density(density)).unwrap();
        let many = Sampling::new(&placement, &image, Amount::Density(density * more)).unwrap();
        let (few, many) = (points(&few).unwrap(), points(&many).unwrap());
        prop_assert!(ranks(&few).is_subset(&ranks(&many)));
    }

    #[test]
    fn the_count_follows_the_integral((image, seed) in maps(), amount in 0.0..3000.0f64) {
        prop_assume!(image.mean() > 0.0);
        let placement = Placement::new(image.domain(), seed);
        let sampling = Sampling::new(&placement, &image, Amount::Points(amount)).unwrap();
        let count = points(&sampling).unwrap().len() as f64;
        prop_assert!((count - amount).abs() <= count_bound(amount), "{count} for {amount}");
        let expected = sampling.expected_points().unwrap();
        prop_assert!((expected - amount).abs() <= 1e-9 * amount);
    }

    #[test]
    fn the_count_in_any_rectangle_follows_the_integral_over_it(
        (image, seed) in maps(),
        (x0, x1, y0, y1) in (0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64),
    ) {
        use twelvefold::Importance as _;
        prop_assume!(image.mean() > 0.0 && x0 < x1 && y0 < y1);
        let size = image.domain().size();
        let part = Domain::new(DVec2::new(x0, y0) * size, DVec2::new(x1 - x0, y1 - y0) * size);
        let part = part.unwrap();
        let placement = Placement::new(image.domain(), seed);
        let sampling = Sampling::new(&placement, &image, Amount::Points(2000.0)).unwrap();
        let found = points(&sampling).unwrap();
        let count = found.iter().filter(|(_, p)| part.contains(*p)).count() as f64;
        let expected = sampling.density() * image.integral(&part).unwrap();
        prop_assert!((count - expected).abs() <= count_bound(expected), "{count} for {expected}");
    }

    #[test]
    fn a_hot_texel_has_its_points_inside((seed, x, y) in (any::<u64>(), 0usize..40, 0usize..30)) {
        let image = map(40, 30, |i, j| if (i, j) == (x, y) { 1.0 } else { 0.0 });
        let placement = Placement::new(image.domain(), seed);
        let sampling = Sampling::new(&placement, &image, Amount::Points(200.0)).unwrap();
        let found = points(&sampling).unwrap();
        prop_assert!((150..250).contains(&found.len()), "{}", found.len());
        for (_, at) in &found {
            prop_assert_eq!(at.floor(), DVec2::new(x as f64, y as f64));
        }
        for sample in sampling.points::<Vec2>().unwrap() {
            prop_assert_eq!(sample.unwrap().position.floor(), Vec2::new(x as f32, y as f32));
        }
    }

    #[test]
    fn zero_importance_around_an_area_changes_nothing_in_it(
        (image, seed) in maps(),
        (x0, x1, y0, y1) in (0usize..24, 0usize..24, 0usize..24, 0usize..24),
        density in 0.5..20.0f64,
    ) {
        let (width, height) = image.size();
        let kept = |x: usize, y: usize| (x0..=x1).contains(&x) && (y0..=y1).contains(&y);
        let masked = map(width, height, |x, y| {
            if kept(x, y) { image.pixels()[y * width + x] } else { 0.0 }
        });
        let placement = Placement::new(image.domain(), seed);
        let whole = Sampling::new(&placement, &image, Amount::Density(density)).unwrap();
        let alone = Sampling::new(&placement, &masked, Amount::Density(density)).unwrap();
        let mut inside = points(&whole).unwrap();
        inside.retain(|(_, p)| kept(p.x as usize, p.y as usize));
        prop_assert_eq!(points(&alone).unwrap(), inside);
    }

    #[test]
    fn looser_bounds_give_the_same_points(seed: u64, looseness in 1.0..50.0f64) {
        // Pruning that lost a point would show: a bound without any information prunes nothing.
        let value = |p: DVec2| p.x * p.x * p.y;
        let bound = |r: &Disc| {
            let [x, y] = (r.center + r.radius).clamp(DVec2::ZERO, DVec2::ONE).to_array();
            x * x * y
        };
        let placement = Placement::new(Domain::UNIT, seed);
        let tight = Function::new(value, bound);
        let loose = Function::new(value, move |r: &Disc| (looseness * bound(r)).max(0.1));
        let blind = Function::new(value, |_: &Disc| 1.0);
        let amount = Amount::Density(6000.0);
        let tight = points(&Sampling::new(&placement, &tight, amount).unwrap()).unwrap();
        let loose = points(&Sampling::new(&placement, &loose, amount).unwrap()).unwrap();
        let blind = points(&Sampling::new(&placement, &blind, amount).unwrap()).unwrap();
        prop_assert_eq!(&tight, &loose);
        prop_assert_eq!(&tight, &blind);
    }

    #[test]
    fn every_way_and_depth_gives_the_same_points((image, seed) in maps(), amount in 1.0..2000.0f64) {
        prop_assume!(image.mean() > 0.0);
        let placement = Placement::new(image.domain(), seed);
        let sampling = Sampling::new(&placement, &image, Amount::Points(amount)).unwrap();
        let iterated: Vec<_> = sampling.points::<DVec2>().unwrap().map(Result::unwrap).collect();
        let mut buffer = vec![DVec2::ZERO; iterated.len() + 1];
        let filled = sampling.fill(&mut buffer).unwrap();
        prop_assert!(filled.complete && filled.written == iterated.len());
        prop_assert!(iterated.iter().zip(&buffer).all(|(sample, at)| sample.position == *at));
        for tables in every_depth() {
            let placement = Placement::new_in(image.domain(), seed, *tables);
            let sampling = Sampling::new(&placement, &image, Amount::Points(amount)).unwrap();
            let mut sorted = iterated.clone();
            sorted.sort_by_key(|sample| sample.rank);
            let other: Vec<_> = sorted.iter().map(|s| (s.rank, s.position)).collect();
            prop_assert_eq!(points(&sampling).unwrap(), other);
        }
    }
}

#[test]
fn threads_get_the_same_points() {
    let image = map(100, 80, noise);
    let placement = Placement::new(image.domain(), 5);
    let sampling = Sampling::new(&placement, &image, Amount::Points(5000.0)).unwrap();
    let expected = points(&sampling).unwrap();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| points(&sampling).unwrap())).collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}

#[test]
fn seeds_give_different_points() {
    let mut seen = BTreeSet::new();
    for seed in (0..200).chain([u64::MAX, 1 << 63, 1 << 32]) {
        let placement = Placement::new(Domain::UNIT, seed);
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(20.0)).unwrap();
        for (_, at) in points(&sampling).unwrap() {
            assert!(seen.insert(at.to_array().map(f64::to_bits)), "seed {seed} repeats {at}");
        }
    }
}

#[test]
fn relaxed_points_of_constant_importance_are_unbiased() {
    // All points move by one rule, so that the set stays uniform: equal weights 1/n are right.
    let (seeds, n) = (6000, 40.0);
    let functions: [fn(DVec2) -> f64; 3] =
        [|_| 1.0, |p| f64::from(p.x + p.y < 0.25), |p| p.x * (1.0 - p.x) * p.y * (1.0 - p.y)];
    let integrals = [1.0, 0.25 * 0.25 / 2.0, 1.0 / 36.0];
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    for seed in 0..seeds {
        let placement = Placement::new(Domain::UNIT, seed);
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(n)).unwrap();
        let relaxed = sampling.relaxed().unwrap();
        let points: Vec<DVec2> = relaxed.points().unwrap().map(|p| p.unwrap().position).collect();
        for (i, function) in functions.iter().enumerate() {
            let error = points.iter().map(|p| function(*p)).sum::<f64>() / n - integrals[i];
            sums[i] += error;
            squares[i] += error * error;
        }
    }
    for (sum, squares) in sums.into_iter().zip(squares) {
        let z = sum / f64::sqrt(squares);
        println!("relaxed, constant: z = {z:.2}");
        assert!(z.abs() < 4.0, "z = {z}");
    }
}

/// Where relaxed points lie, in double and in single precision.
fn relaxed<I: Importance>(importance: &I, domain: Domain, seed: u64, count: f64) -> Vec<DVec2> {
    let placement = Placement::new(domain, seed);
    let sampling = Sampling::new(&placement, importance, Amount::Points(count)).unwrap();
    let sampling = sampling.relaxed().unwrap();
    let single = sampling.points::<Vec2>().unwrap().map(|point| point.unwrap().position.as_dvec2());
    let double = sampling.points::<DVec2>().unwrap().map(|point| point.unwrap().position);
    single.chain(double).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_relaxed_point_lies_where_the_importance_is_0(
        seed: u64,
        (width, height) in (1usize..60, 1usize..60),
        coarse in 1usize..9,
        ink in prop_oneof![Just(0.03), Just(0.3), Just(0.8)],
        count in 10.0..1500.0f64,
    ) {
        let at = |x: usize, y: usize| noise(x / coarse + (seed as u16) as usize, y / coarse);
        let pixels: Vec<f32> = (0..width * height)
            .map(|i| at(i % width, i / width))
            .map(|v| if f64::from(v) < ink { 0.2 + v } else { 0.0 })
            .collect();
        let map = Pixels::new(width, height, pixels.clone(), InvalidPixels::Reject).and_then(ImageMap::new).unwrap();
        prop_assume!(map.mean() > 0.0);
        let stipple = Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(|pixels| StippleMap::new(pixels, count)).unwrap();
        let integral = map.mean() * map.domain().area();
        let function = Function::new(|at| map.value(at), |_: &Disc| 1.2).with_integral(integral);
        let domain = map.domain();
        for points in [
            relaxed(&map, domain, seed, count),
            relaxed(&stipple, domain, seed, count),
            relaxed(&function, domain, seed, count),
        ] {
            for point in points {
                prop_assert!(map.value(point) > 0.0, "{}", point);
            }
        }
    }
}

/// Importance at x, y.
type Picture = fn(f64, f64) -> f64;

/// Pictures of 200 × 200 pixels with nothing but hard edges, x, y from -100 to 100, and how many
/// in 10,000 relaxed points may have another within half the spacing there.
const EDGED: [(&str, f64, Picture); 4] = [
    ("disc", 1.0, |x, y| f64::from(u8::from(x * x + y * y < 8100.0))),
    ("disc in a square", 20.0, |x, y| {
        match (x * x + y * y < 2500.0, x.abs().max(y.abs()) < 80.0) {
            (true, _) => 0.92,
            (false, true) => 0.37,
            _ => 0.0,
        }
    }),
    ("strokes", 10.0, |x, y| {
        // Lines of widths from 1 to 3 spacings, at some angle.
        let across = (0.8 * x + 0.6 * y + 160.0) % 40.0;
        f64::from(u8::from((10.0..13.0 + 0.03 * (100.0 + y)).contains(&across)))
    }),
    ("islands", 10.0, |x, y| {
        let is_dark = |t: f64| (t + 100.0) % 24.0 < 12.0;
        if is_dark(x) && is_dark(y) { 0.9 } else { 0.0 }
    }),
];

#[test]
fn relaxed_points_along_an_edge_keep_their_distance_and_their_number() {
    let (side, spacing, seeds) = (200, 3.0, 12);
    let middle = |i: usize| i as f64 + 0.5 - 100.0;
    for (name, most, picture) in EDGED {
        let pixels: Vec<f32> =
            (0..side * side).map(|i| picture(middle(i % side), middle(i / side)) as f32).collect();
        let sum: f64 = pixels.iter().map(|v| f64::from(*v)).sum();
        let count = sum / (spacing * spacing);
        let map = Pixels::new(side, side, pixels, InvalidPixels::Reject)
            .and_then(|pixels| StippleMap::new(pixels, count))
            .unwrap();
        let (mut total, mut near) = (0, 0);
        for seed in 0..seeds {
            let placement = Placement::new(map.domain(), seed);
            let sampling = Sampling::new(&placement, &map, Amount::Points(count)).unwrap();
            let points = points(&sampling.relaxed().unwrap()).unwrap();
            total += points.len();
            let importance = |at: DVec2| picture(middle(at.x as usize), middle(at.y as usize));
            for (i, (_, a)) in points.iter().enumerate() {
                for (_, b) in &points[..i] {
                    // Where they lie on two sides, the finer spacing counts.
                    let local = spacing / importance(*a).max(importance(*b)).sqrt();
                    let distance = a.distance(*b) / local;
                    assert!(distance >= 0.2, "{name} {seed}: {a} {b}");
                    near += 2 * usize::from(distance < 0.5);
                }
            }
        }
        println!("{name}: {near} of {total}");
        // A point that is held at the edge knows nothing of its neighbors: some few come close.
        assert!(near as f64 <= 1e-4 * most * total as f64, "{name}: {near} of {total}");
        let bias = total as f64 / (count * seeds as f64) - 1.0;
        assert!(bias.abs() < 1.2 / (total as f64).sqrt(), "{name}: {bias}");
    }
}
