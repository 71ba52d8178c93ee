//! Estimates: unbiased where they say so, exact counts, and how much each weight gains.

use crate::common::{environment, map, noise, photograph};
use glam::{DVec2, DVec3};
use twelvefold::estimate::{
    ExactError, Warp, Weighted, Weighting, exactly, normalize, post_stratify,
};
use twelvefold::{
    Amount, BilinearMap, Constant, Disc, Domain, EnvironmentMap, Function, ImageMap, Importance,
    InvalidPixels, Limits, Placement, Sampling, SamplingError,
};

/// Functions to integrate, of coordinates in [0, 1)² of the domain: one even, one smooth, one with an
/// edge, one that vanishes at the border.
const FUNCTIONS: [fn(DVec2) -> f64; 4] = [
    |_| 1.0,
    |p| (-20.0 * p.distance_squared(DVec2::new(0.4, 0.6))).exp(),
    |p| if 0.8 * p.x + 0.6 * p.y < 0.7 { 1.0 } else { 0.0 },
    |p| p.x * (1.0 - p.x) * p.y * (1.0 - p.y),
];

/// Mean and standard error of the mean.
#[derive(Default)]
struct Running {
    n: f64,
    mean: f64,
    squares: f64,
}

impl Running {
    fn add(&mut self, value: f64) {
        self.n += 1.0;
        let off = value - self.mean;
        self.mean += off / self.n;
        self.squares += off * (value - self.mean);
    }

    fn deviation(&self) -> f64 {
        (self.squares / (self.n - 1.0)).sqrt()
    }

    /// How many standard errors the mean is from the truth.
    fn z(&self, truth: f64) -> f64 {
        (self.mean - truth) / (self.deviation() / self.n.sqrt()).max(1e-300)
    }
}

/// ∫ f over the part of the domain where the importance is above 0, by the midpoint rule.
fn integrals<I: Importance>(importance: &I, domain: &Domain) -> [f64; 4] {
    let side = 1024usize;
    let mut sums = [0.0; 4];
    for j in 0..side {
        for i in 0..side {
            let unit = (DVec2::new(i as f64, j as f64) + 0.5) / side as f64;
            if importance.value(domain.min() + unit * domain.size()) > 0.0 {
                for (sum, f) in sums.iter_mut().zip(FUNCTIONS) {
                    *sum += f(unit);
                }
            }
        }
    }
    sums.map(|sum| sum * domain.area() / (side * side) as f64)
}

fn sum_weighted(points: &[Weighted], domain: &Domain, f: fn(DVec2) -> f64) -> f64 {
    let unit = |p: &Weighted| (p.position - domain.min()) / domain.size();
    points.iter().map(|p| f(unit(p)) * p.weight).sum()
}

/// z of the mean estimate of each function, over `seeds` placements of a set expecting `n` points.
fn bias<I: Importance>(
    importance: &I,
    domain: Domain,
    n: f64,
    seeds: u64,
    weighting: Weighting,
) -> [f64; 4] {
    let mut running: [Running; 4] = Default::default();
    for seed in 0..seeds {
        let placement = Placement::new(domain, seed);
        let sampling = Sampling::new(&placement, importance, Amount::Points(n)).unwrap();
        let points: Vec<Weighted> =
            sampling.weighted(weighting).unwrap().map(Result::unwrap).collect();
        for (running, f) in running.iter_mut().zip(FUNCTIONS) {
            running.add(sum_weighted(&points, &domain, f));
        }
    }
    let truths = integrals(importance, &domain);
    let mut z = [0.0; 4];
    for ((z, running), truth) in z.iter_mut().zip(&running).zip(truths) {
        *z = running.z(truth);
    }
    z
}

/// A ramp from 0 to 2 along a slanted direction, bounded over discs.
fn ramp() -> impl Importance {
    let value = |p: DVec2| (1.5 * p.x + 0.5 * p.y).max(0.0);
    Function::new(value, move |r: &Disc| value(r.center + r.radius)).with_integral(1.0)
}

/// Placement by seed makes every estimate unbiased, 8 points included. 48 figures of about N(0, 1): the
/// largest stays below 4 with probability 0.997, and the sum of squares near 48. (Those of one set are
/// correlated, so the test of the sum is loose.)
fn check_unbiased<I: Importance>(name: &str, importance: &I, domain: Domain) {
    for n in [8.0, 16.0, 64.0] {
        for weighting in [Weighting::Density, Weighting::Smoothed] {
            let z = bias(importance, domain, n, 4000, weighting);
            println!("{name:11} n = {n:3} {weighting:?}: z = {z:6.2?}");
            assert!(z.iter().all(|z| z.abs() < 4.0), "{name} n = {n} {weighting:?}: {z:?}");
        }
    }
}

#[test]
fn constant_importance_is_unbiased() {
    check_unbiased("constant", &Constant::ONE, Domain::UNIT);
    let elongated = Domain::new(DVec2::new(3.0, -1.0), DVec2::new(0.1, 7.0)).unwrap();
    check_unbiased("elongated", &Constant::ONE, elongated);
}

#[test]
fn a_ramp_is_unbiased() {
    check_unbiased("ramp", &ramp(), Domain::UNIT);
}

#[test]
fn a_photograph_is_unbiased() {
    let photograph = photograph();
    check_unbiased("photograph", &photograph, photograph.domain());
    let bilinear = BilinearMap::new(photograph);
    check_unbiased("bilinear", &bilinear, bilinear.map().domain());
}

#[test]
fn an_environment_is_unbiased() {
    let sky = environment();
    check_unbiased("environment", sky.importance(), sky.importance().domain());
}

#[test]
fn what_lies_where_the_importance_is_zero_is_not_seen() {
    // The documented condition: half of the area of f is missing.
    let half = map(2, 1, |x, _| x as f32);
    let placement = Placement::new(half.domain(), 1);
    let sampling = Sampling::new(&placement, &half, Amount::Points(4000.0)).unwrap();
    let weights = sampling.weighted(Weighting::Density).unwrap();
    let area: f64 = weights.map(|point| point.unwrap().weight).sum();
    assert!((area - 1.0).abs() < 0.02, "{area}");
}

#[test]
fn an_aligned_placement_is_unbiased_and_a_complete_level() {
    let mut running: [Running; 4] = Default::default();
    for seed in 0..4000 {
        let placement = Placement::aligned(Domain::UNIT, seed, 23.0).unwrap();
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Density(23.0)).unwrap();
        let points: Vec<Weighted> =
            sampling.weighted(Weighting::Density).unwrap().map(Result::unwrap).collect();
        for (running, f) in running.iter_mut().zip(FUNCTIONS) {
            running.add(sum_weighted(&points, &Domain::UNIT, f));
        }
    }
    for (running, truth) in running.iter().zip(integrals(&Constant::ONE, &Domain::UNIT)) {
        assert!(running.z(truth).abs() < 4.0, "{}", running.z(truth));
    }
    // No two centers of one level are closer than an edge; between levels they are.
    for (density, seed) in [(300.0, 1), (1000.0, 2), (2718.0, 3), (9999.0, 4)] {
        let edge = (1.0 / ((4.0 * 3f64.sqrt() - 6.0) * density)).sqrt();
        let placement = Placement::aligned(Domain::UNIT, seed, density).unwrap();
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Density(density)).unwrap();
        let points: Vec<DVec2> =
            sampling.points::<DVec2>().unwrap().map(|s| s.unwrap().position).collect();
        let mut nearest = f64::INFINITY;
        for (i, a) in points.iter().enumerate() {
            for b in &points[..i] {
                nearest = nearest.min(a.distance(*b));
            }
        }
        assert!((nearest / edge - 1.0).abs() < 1e-9, "{}", nearest / edge);
        assert!((points.len() as f64 / density - 1.0).abs() < 0.05);
    }
}

#[test]
fn alignment_refuses_what_no_level_has() {
    for density in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Placement::aligned(Domain::UNIT, 1, density).err();
        assert!(matches!(refused, Some(SamplingError::Amount { .. })), "{refused:?}");
    }
    let refused = Placement::aligned(Domain::UNIT, 1, 1e15).err();
    assert!(matches!(refused, Some(SamplingError::TooDense { .. })), "{refused:?}");
    for density in [1e-300, 1e-9, 1e-4, 0.5, 1e12] {
        assert!(Placement::aligned(Domain::UNIT, 1, density).is_ok(), "{density}");
    }
}

/// Root-mean-square relative error of each function over seeds.
fn errors(
    seeds: u64,
    truths: [f64; 4],
    domain: Domain,
    mut points: impl FnMut(u64) -> Vec<Weighted>,
) -> [f64; 4] {
    let mut squares = [0.0; 4];
    for seed in 0..seeds {
        let points = points(seed);
        for ((square, f), truth) in squares.iter_mut().zip(FUNCTIONS).zip(truths) {
            *square += (sum_weighted(&points, &domain, f) / truth - 1.0).powi(2);
        }
    }
    squares.map(|square| (square / seeds as f64).sqrt())
}

#[test]
fn each_refinement_lowers_the_error_as_documented() {
    let photograph = map(64, 64, |x, y| 0.05 + photograph().pixels()[y * 64 + x]);
    let domain = photograph.domain();
    let truths = integrals(&photograph, &domain);
    let n = 4096usize;
    let weighted = |seed, weighting| {
        let placement = Placement::new(domain, seed);
        let sampling = Sampling::new(&placement, &photograph, Amount::Points(n as f64)).unwrap();
        sampling.weighted(weighting).unwrap().map(Result::unwrap).collect::<Vec<_>>()
    };
    let seeds = 60;
    let plain = errors(seeds, truths, domain, |seed| weighted(seed, Weighting::Density));
    let smoothed = errors(seeds, truths, domain, |seed| weighted(seed, Weighting::Smoothed));
    let normalized = errors(seeds, truths, domain, |seed| {
        let mut points = weighted(seed, Weighting::Density);
        normalize(&mut points, n as f64);
        points
    });
    let stratified = errors(seeds, truths, domain, |seed| {
        let mut points = weighted(seed, Weighting::Density);
        post_stratify(&mut points, &photograph, 6.0);
        points
    });
    let exact = errors(seeds, truths, domain, |seed| {
        exactly(&Placement::new(domain, seed), &photograph, n, Limits::default()).unwrap()
    });
    let warp = Warp::new(&photograph).unwrap();
    let warped =
        errors(seeds, truths, domain, |seed| warp.level(n, seed, Limits::default()).unwrap());
    let mut random = 1u64;
    let mut uniform = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (random >> 11) as f64 / (1u64 << 53) as f64
    };
    let white = errors(seeds, truths, domain, |_| {
        (0..n).map(|i| warp.weighted(DVec2::new(uniform(), uniform()), n, i as u64)).collect()
    });
    println!("white noise     {white:.5?}");
    println!("1/density       {plain:.5?}");
    println!("smoothed        {smoothed:.5?}");
    println!("normalized      {normalized:.5?}");
    println!("exactly n       {exact:.5?}");
    println!("post-stratified {stratified:.5?}");
    println!("warped          {warped:.5?}");
    // The smooth function, the second one.
    assert!(plain[1] < 0.6 * white[1]);
    assert!(smoothed[1] < plain[1]);
    assert!(stratified[1] < 0.7 * plain[1]);
    assert!(warped[1] < 0.5 * plain[1]);
}

#[test]
fn warped_points_follow_the_map_and_are_unbiased() {
    for (name, image) in [("photograph", photograph()), ("sky", environment().importance().clone())]
    {
        let warp = Warp::new(&image).unwrap();
        let truths = integrals(&image, &image.domain());
        let mut running: [Running; 4] = Default::default();
        for seed in 0..3000 {
            let points = warp.level(16, seed, Limits::default()).unwrap();
            assert_eq!(points.len(), 16);
            for (running, f) in running.iter_mut().zip(FUNCTIONS) {
                running.add(sum_weighted(&points, &image.domain(), f));
            }
        }
        for (running, truth) in running.iter().zip(truths) {
            println!("{name} warped, n = 16: z = {:.2}", running.z(truth));
            assert!(running.z(truth).abs() < 4.0, "{name}: {}", running.z(truth));
        }
    }
}

#[test]
fn a_warp_preserves_measure_at_odd_sizes_and_stays_in_the_square() {
    let image = map(5, 3, |x, y| if (x, y) == (4, 1) { 0.0 } else { noise(x, y) });
    let domain = Domain::new(DVec2::new(-7.0, 1e3), DVec2::new(0.3, 50.0)).unwrap();
    let image = image.over(domain);
    let warp = Warp::new(&image).unwrap();
    let side = 600usize;
    let mut counts = [0.0; 15];
    for j in 0..side {
        for i in 0..side {
            let at = (DVec2::new(i as f64, j as f64) + 0.5) / side as f64;
            let position = warp.position(at);
            assert!(domain.contains(position));
            let pixel = ((position - domain.min()) / domain.size() * DVec2::new(5.0, 3.0)).floor();
            counts[pixel.y as usize * 5 + pixel.x as usize] += 1.0 / (side * side) as f64;
        }
    }
    let sum: f32 = image.pixels().iter().sum();
    for (count, pixel) in counts.iter().zip(image.pixels()) {
        assert!((count - f64::from(pixel / sum)).abs() < 3e-3, "{count}");
    }
    assert_eq!(counts[9], 0.0);
    for wild in [f64::NAN, f64::INFINITY, -1.0, 1.0, 1.0f64.next_down(), 5e-324] {
        for at in [DVec2::new(wild, 0.5), DVec2::new(0.5, wild), DVec2::splat(wild)] {
            let position = warp.position(at);
            assert!(domain.contains(position) && image.value(position) > 0.0);
        }
    }
    assert!(Warp::new(&map(3, 3, |_, _| 0.0)).is_none());
}

#[test]
fn exactly_n_is_n_and_every_prefix_is_the_smaller_set() {
    let sky = environment();
    let domain = sky.importance().domain();
    for seed in 0..20 {
        let placement = Placement::new(domain, seed);
        let all = exactly(&placement, sky.importance(), 700, Limits::default()).unwrap();
        assert_eq!(all.len(), 700);
        for n in [0, 1, 2, 7, 8, 64, 333, 699] {
            let some = exactly(&placement, sky.importance(), n, Limits::default()).unwrap();
            assert_eq!(some.len(), n);
            for (a, b) in some.iter().zip(&all) {
                assert_eq!((a.rank, a.position), (b.rank, b.position));
                let ratio = a.density / b.density * 700.0 / n as f64;
                assert!((ratio - 1.0).abs() < 1e-12);
            }
        }
        // The same points as the threshold that just admits them.
        let mut previous = 0.0;
        for point in &all {
            let key = point.rank as f64 / sky.importance().value(point.position);
            assert!(key > previous - 1.0 / sky.importance().value(point.position));
            previous = key;
        }
    }
}

#[test]
fn exactly_n_needs_no_integral_and_no_limit_on_contrast() {
    let side = 256;
    let spike = map(side, side, |x, y| if (x, y) == (99, 7) { 1e9 } else { 1e-3 });
    let bump = Function::new(
        |p: DVec2| (1.0 - 40.0 * p.distance(DVec2::new(0.3, 0.4))).max(0.0),
        |r: &Disc| {
            (1.0 - 40.0 * (r.center.distance(DVec2::new(0.3, 0.4)) - r.radius)).clamp(0.0, 1.0)
        },
    );
    for n in [1, 10, 1000, 5000] {
        let placement = Placement::new(spike.domain(), 4);
        let points = exactly(&placement, &spike, n, Limits::default()).unwrap();
        assert_eq!(points.len(), n);
        let placement = Placement::new(Domain::UNIT, 4);
        let points = exactly(&placement, &bump, n, Limits::default()).unwrap();
        assert_eq!(points.len(), n);
        let area: f64 = points.iter().map(|point| point.weight).sum();
        let disc = core::f64::consts::PI / 1600.0;
        assert!(n < 1000 || (area / disc - 1.0).abs() < 0.2, "{n}: {area} {disc}");
    }
}

#[test]
fn exactly_n_says_when_there_are_not_so_many() {
    let placement = Placement::new(Domain::UNIT, 4);
    let zero = Constant::new(0.0).unwrap();
    let none = exactly(&placement, &zero, 5, Limits::default()).unwrap_err();
    assert_eq!(none, ExactError::TooFew { asked: 5, found: 0 });
    // A spot so small that the deepest level has few points in it.
    let spot = DVec2::new(0.3, 0.4);
    let tiny = Function::new(
        move |p: DVec2| f64::from(p.distance(spot) < 1e-6),
        move |r: &Disc| f64::from(r.center.distance(spot) < 1e-6 + r.radius),
    );
    assert_eq!(exactly(&placement, &tiny, 50, Limits::default()).unwrap().len(), 50);
    match exactly(&placement, &tiny, 1000, Limits::default()).unwrap_err() {
        ExactError::TooFew { asked: 1000, found } => assert!((20..999).contains(&found), "{found}"),
        other => panic!("{other}"),
    }
    let limits = Limits { points: 99, ..Limits::default() };
    assert_eq!(
        exactly(&placement, &Constant::ONE, 100, limits).unwrap_err(),
        ExactError::Sampling(SamplingError::TooManyPoints { expected: 100.0, limit: 99 })
    );
    assert_eq!(exactly(&placement, &Constant::ONE, 99, limits).unwrap().len(), 99);
    let broken = Function::new(|_| f64::NAN, |_: &Disc| 1.0);
    assert!(matches!(
        exactly(&placement, &broken, 10, Limits::default()),
        Err(ExactError::Sampling(SamplingError::InvalidValue { .. }))
    ));
}

#[test]
fn post_stratified_weights_add_up_and_are_not_negative() {
    let sky = environment();
    let image = sky.importance();
    for (n, seed) in [(1.0, 1), (3.0, 2), (300.0, 3), (5000.0, 4)] {
        for per_cell in [f64::NAN, 0.0, 1.0, 6.0, 1e9] {
            let placement = Placement::new(image.domain(), seed);
            let sampling = Sampling::new(&placement, image, Amount::Points(n)).unwrap();
            let mut points: Vec<Weighted> =
                sampling.weighted(Weighting::Density).unwrap().map(Result::unwrap).collect();
            post_stratify(&mut points, image, per_cell);
            let total: f64 = points.iter().map(|p| p.weight * p.density).sum();
            assert!(points.is_empty() || (total / n - 1.0).abs() < 1e-9, "{total} {n}");
            assert!(points.iter().all(|p| p.weight >= 0.0 && p.weight.is_finite()));
        }
    }
    post_stratify(&mut [], image, 4.0);
    normalize(&mut [], 4.0);
}

#[test]
fn light_from_an_environment_is_unbiased_in_solid_angle() {
    // Irradiance on three surfaces, against the sum over pixels.
    let sky = environment();
    let normals = [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::NEG_Y];
    let truth = |normal: DVec3| {
        let (width, height) = sky.size();
        let mut sum = 0.0;
        for y in 0..height * 16 {
            for x in 0..width * 16 {
                let light = sky.sample((DVec2::new(x as f64, y as f64) + 0.5) / 16.0);
                sum += f64::from(light.radiance[1])
                    * light.direction.dot(normal).max(0.0)
                    * sky.solid_angle(y / 16)
                    / 256.0;
            }
        }
        sum
    };
    let estimate = |points: &[Weighted], n: f64, normal: DVec3, sky: &EnvironmentMap| -> f64 {
        points
            .iter()
            .map(|p| sky.sample(p.position))
            .map(|l| f64::from(l.radiance[1]) * l.direction.dot(normal).max(0.0) / (n * l.pdf))
            .sum()
    };
    let warp = Warp::new(sky.importance()).unwrap();
    for normal in normals {
        let (mut plain, mut warped) = (Running::default(), Running::default());
        for seed in 0..4000 {
            let placement = Placement::new(sky.importance().domain(), seed);
            let sampling =
                Sampling::new(&placement, sky.importance(), Amount::Points(16.0)).unwrap();
            let points: Vec<Weighted> =
                sampling.weighted(Weighting::Density).unwrap().map(Result::unwrap).collect();
            plain.add(estimate(&points, 16.0, normal, &sky));
            let points = warp.level(16, seed, Limits::default()).unwrap();
            warped.add(estimate(&points, 16.0, normal, &sky));
        }
        let truth = truth(normal);
        println!("normal {normal}: z = {:.2}, {:.2}", plain.z(truth), warped.z(truth));
        assert!(plain.z(truth).abs() < 4.0 && warped.z(truth).abs() < 4.0);
        assert!(warped.deviation() < plain.deviation());
    }
}

#[test]
fn a_bilinear_map_is_sampled_like_its_function() {
    let image =
        ImageMap::new(9, 7, (0..63).map(|i| (i % 10) as f32).collect(), InvalidPixels::Reject);
    let bilinear = BilinearMap::new(image.unwrap());
    let domain = bilinear.map().domain();
    let placement = Placement::new(domain, 3);
    let sampling = Sampling::new(&placement, &bilinear, Amount::Points(20_000.0)).unwrap();
    let points: Vec<_> = sampling.points::<DVec2>().unwrap().map(Result::unwrap).collect();
    assert!((points.len() as f64 / 20_000.0 - 1.0).abs() < 0.01);
    // The left half holds its share of the integral, by the midpoint rule.
    let (mut left, mut all, side) = (0.0, 0.0, 700usize);
    for j in 0..side {
        for i in 0..side {
            let at = (DVec2::new(i as f64, j as f64) + 0.5) / side as f64 * domain.size();
            let value = bilinear.value(at);
            all += value;
            left += if at.x < 4.5 { value } else { 0.0 };
        }
    }
    let found = points.iter().filter(|s| s.position.x < 4.5).count() as f64;
    assert!((found / points.len() as f64 - left / all).abs() < 0.005);
}
