//! Hard cases of where and how deep: the last levels, work and its limits, tiny, huge, far and thin domains.

use std::collections::HashSet;

use crate::common::{few_tiles, points};
use glam::{DVec2, Vec2};
use twelvefold::{
    Amount, Constant, Disc, Domain, DomainError, Function, Limits, Placement, Sampling,
    SamplingError,
};

/// Importance 1 in a disc and 0 elsewhere, with its exact bound.
fn disc(center: DVec2, radius: f64) -> Function<impl Fn(DVec2) -> f64, impl Fn(&Disc) -> f64> {
    Function::new(
        move |p: DVec2| f64::from(p.distance(center) < radius),
        move |r: &Disc| f64::from(r.center.distance(center) < radius + r.radius),
    )
}

/// The greatest density that a placement admits.
fn greatest_density(placement: &Placement<'_>) -> f64 {
    let admitted = |density: f64| {
        Sampling::within(placement, &Constant::ONE, Amount::Density(density), few_tiles()).is_ok()
    };
    let (mut low, mut high) = (1.0f64, 1e300);
    assert!(admitted(low) && !admitted(high));
    // Bisection of the bits: ends at neighboring numbers.
    while low.next_up() < high {
        let middle = f64::from_bits((low.to_bits() + high.to_bits()) / 2);
        if admitted(middle) { low = middle } else { high = middle }
    }
    low
}

#[test]
fn the_last_level_is_reached_and_what_is_past_it_is_an_error() {
    for seed in 0..4 {
        let placement = Placement::new(Domain::UNIT, seed);
        let density = greatest_density(&placement);
        assert!((1e13..1e14).contains(&density), "{density}");
        let too_dense = Amount::Density(density.next_up());
        assert!(matches!(
            Sampling::within(&placement, &Constant::ONE, too_dense, few_tiles()),
            Err(SamplingError::TooDense { .. })
        ));

        let radius = 2e-6;
        let (center, expected) =
            (DVec2::new(0.3, 0.8), core::f64::consts::PI * radius * radius * density);
        let spot = disc(center, radius);
        let sampling = Sampling::within(&placement, &spot, Amount::Density(density), few_tiles());
        let found = points(&sampling.unwrap()).unwrap();
        assert!((found.len() as f64 / expected - 1.0).abs() < 0.2, "{} {expected}", found.len());
        // Ranks of the last level, all different, as are the positions, one edge apart or more.
        assert!(found.last().unwrap().0 > 1 << 59);
        assert!(found.windows(2).all(|w| w[0].0 < w[1].0));
        let edge = (1.0 / (0.9282 * density)).sqrt();
        let mut nearest = f64::INFINITY;
        for (i, (_, a)) in found.iter().enumerate() {
            assert!(a.distance(center) < radius);
            for (_, b) in &found[..i] {
                nearest = nearest.min(a.distance(*b));
            }
        }
        assert!(nearest > 0.9 * edge, "{nearest} {edge}");
    }
}

#[test]
fn a_magnification_of_a_million_millions_finds_its_few_points_in_few_tiles() {
    for seed in 0..20 {
        let placement = Placement::new(Domain::UNIT, seed);
        let spot = disc(DVec2::new(0.7, 0.2), 5e-6);
        let sampling =
            Sampling::within(&placement, &spot, Amount::Density(1e12), few_tiles()).unwrap();
        let count = points(&sampling).unwrap().len();
        assert!((55..105).contains(&count), "{count} points where 78.5 are expected");
    }
}

#[test]
fn work_is_announced_and_stopped_at_its_limits() {
    let placement = Placement::new(Domain::UNIT, 1);
    let points_limit = Limits { points: 1000, ..Limits::default() };
    let amount = Amount::Points(1001.0);
    assert_eq!(
        Sampling::within(&placement, &Constant::ONE, amount, points_limit).unwrap_err(),
        SamplingError::TooManyPoints { expected: 1001.0, limit: 1000 }
    );
    // Without an integral, the bound counts.
    let half = Function::new(|p: DVec2| f64::from(p.x < 0.5), |_: &Disc| 1.0);
    let amount = Amount::Density(1001.0);
    assert!(matches!(
        Sampling::within(&placement, &half, amount, points_limit),
        Err(SamplingError::TooManyPoints { .. })
    ));
    let tiles_limit = Limits { tiles: 50, ..Limits::default() };
    let sampling = Sampling::within(&placement, &half, Amount::Density(1e6), tiles_limit);
    assert_eq!(points(&sampling.unwrap()).unwrap_err(), SamplingError::TilesLimit { limit: 50 });
}

#[test]
fn tiny_and_huge_domains_hold_the_same_points_scaled() {
    let unit = Placement::new(Domain::UNIT, 77);
    let unit = Sampling::new(&unit, &Constant::ONE, Amount::Points(5000.0)).unwrap();
    let expected = points(&unit).unwrap();
    // Powers of two scale without rounding: then the points are the same to the bit.
    for scale in [2f64.powi(-20), 2f64.powi(30), 2f64.powi(-300), 2f64.powi(300)] {
        let domain = Domain::new(DVec2::ZERO, DVec2::splat(scale)).unwrap();
        let placement = Placement::new(domain, 77);
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(5000.0)).unwrap();
        let scaled = expected.iter().map(|(rank, at)| (*rank, *at * scale)).collect::<Vec<_>>();
        assert_eq!(points(&sampling).unwrap(), scaled);
    }
    for scale in [1e-6, 1e9] {
        let domain = Domain::new(DVec2::ZERO, DVec2::splat(scale)).unwrap();
        let placement = Placement::new(domain, 77);
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(5000.0)).unwrap();
        let found = points(&sampling).unwrap();
        assert_eq!(found.len(), expected.len());
        for ((rank, at), (expected_rank, expected_at)) in found.iter().zip(&expected) {
            assert_eq!(rank, expected_rank);
            assert!((*at / scale).distance(*expected_at) < 1e-15);
        }
    }
}

#[test]
fn far_from_the_origin_no_point_is_lost() {
    let shapes = [
        (DVec2::new(1e9, -1e9), DVec2::splat(1e-6)),
        (DVec2::new(-3e5, 1e6), DVec2::new(1e-6, 2e-6)),
        (DVec2::new(1e15, 1e15), DVec2::new(100.0, 50.0)),
        (DVec2::new(-1e12, 0.0), DVec2::splat(1e9)),
    ];
    for (corner, size) in shapes {
        // Thousands of points between two neighboring coordinates.
        for seed in 0..4 {
            let near = Placement::new(Domain::new(DVec2::ZERO, size).unwrap(), seed);
            let far = Placement::new(Domain::new(corner, size).unwrap(), seed);
            let amount = Amount::Density(100_000.0 / (size.x * size.y));
            let near = Sampling::new(&near, &Constant::ONE, amount).unwrap();
            let far_points = Sampling::new(&far, &Constant::ONE, amount).unwrap();
            let expected = points(&near).unwrap();
            let found = points(&far_points).unwrap();
            let rounding = 2e-16 * corner.abs().max_element();
            assert_eq!(found.len(), expected.len(), "{corner} seed {seed}");
            for ((rank, at), (expected_rank, expected_at)) in found.iter().zip(&expected) {
                assert_eq!(rank, expected_rank);
                assert!(far.domain().contains(*at), "{at}");
                let error = (*at - corner - *expected_at).abs().max_element();
                assert!(error <= rounding, "{error} {rounding}");
            }
        }
    }
}

#[test]
fn single_precision_stays_inside_a_domain_that_it_can_hardly_resolve() {
    // 200 units at 10⁹: f32 has four numbers there. Every point is one of them.
    let domain = Domain::new(DVec2::splat(1e9), DVec2::splat(200.0)).unwrap();
    let placement = Placement::new(domain, 5);
    let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(2000.0)).unwrap();
    let mut count = 0;
    for sample in sampling.points::<Vec2>().unwrap() {
        assert!(domain.contains(sample.unwrap().position.as_dvec2()));
        count += 1;
    }
    assert!((1800..2200).contains(&count));
    let empty = Domain::new(DVec2::splat(1e9 + 1.0), DVec2::ONE).unwrap();
    let placement = Placement::new(empty, 5);
    let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(9.0)).unwrap();
    assert_eq!(sampling.points::<Vec2>().err(), Some(SamplingError::Precision));
}

#[test]
fn rectangles_that_are_no_domain_are_errors() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for min in [DVec2::new(nan, 0.0), DVec2::new(0.0, -inf), DVec2::splat(inf)] {
        assert_eq!(Domain::new(min, DVec2::ONE), Err(DomainError::NotFinite));
    }
    for bad in [0.0, -0.0, -1.0, nan, inf, 1e-101, 1e101, 5e-324] {
        for size in [DVec2::new(bad, 1.0), DVec2::new(1.0, bad)] {
            assert!(matches!(Domain::new(DVec2::ZERO, size), Err(DomainError::Size { .. })));
        }
    }
    assert_eq!(Domain::new(DVec2::splat(1e300), DVec2::ONE), Err(DomainError::TooFar));
    assert_eq!(Domain::new(DVec2::splat(1e16), DVec2::ONE), Err(DomainError::TooFar));
}

#[test]
fn extreme_shapes_give_their_count() {
    for size in [DVec2::new(1e-8, 1.0), DVec2::new(1e4, 1e-4), DVec2::new(1e-100, 1e100)] {
        let domain = Domain::new(DVec2::ZERO, size).unwrap();
        for seed in 0..5 {
            let placement = Placement::new(domain, seed);
            match Sampling::new(&placement, &Constant::ONE, Amount::Points(100.0))
                .and_then(|sampling| points(&sampling))
            {
                Ok(found) => assert!((60..=140).contains(&found.len()), "{}", found.len()),
                // 10⁻²⁰⁰ times as wide as long: the last level is coarser than the domain.
                Err(error) => assert!(matches!(error, SamplingError::TooDense { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn a_domain_too_thin_for_single_precision_is_an_error_and_others_lose_no_points() {
    let (mut refused, mut equal) = (0, 0);
    for case in 0..120u64 {
        // Steps that no two of the three share a period of.
        let part = |step: f64| (case as f64 * step).fract();
        let aspect = 10f64.powf(9.0 * part(0.618_034));
        let scale = 10f64.powf(20.0 * part(0.754_878) - 10.0);
        let size = match case % 2 {
            0 => DVec2::new(scale, scale * aspect),
            _ => DVec2::new(scale * aspect, scale),
        };
        let count = 10f64.powf(1.0 + 2.5 * part(0.569_840));
        let placement = Placement::new(Domain::new(DVec2::ZERO, size).unwrap(), case);
        let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(count)).unwrap();
        let single: Result<Vec<_>, _> =
            sampling.points::<Vec2>().map(|points| points.map(Result::unwrap).collect());
        let Ok(single) = single else {
            assert_eq!(single, Err(SamplingError::Precision));
            assert!(aspect > 43_000.0, "{aspect}");
            refused += 1;
            continue;
        };
        assert!(aspect < 44_000.0, "{aspect}");
        let double = points(&sampling).unwrap();
        let doubt = 3.0 * f64::from(f32::EPSILON) * size.length();
        // Only what rounding can carry over a side is in one set and not in the other.
        let near = |at: DVec2| at.min(size - at).min_element() <= 1.01 * doubt;
        let in_single: HashSet<_> = single.iter().map(|sample| sample.rank).collect();
        let in_double: HashSet<_> = double.iter().map(|(rank, _)| *rank).collect();
        let lost = double.iter().filter(|(rank, _)| !in_single.contains(rank));
        let gained = single.iter().filter(|sample| !in_double.contains(&sample.rank));
        assert!(lost.clone().all(|(_, at)| near(*at)), "{size}");
        assert!(gained.clone().all(|sample| near(sample.position.as_dvec2())), "{size}");
        let differing = lost.count() + gained.count();
        assert!(differing <= 3 + double.len() / 32, "{differing} of {} in {size}", double.len());
        equal += usize::from(differing == 0);
        // Too few are in doubt for one to be met.
        if count * doubt < 1e-4 * size.min_element() {
            assert_eq!(differing, 0, "{size}");
        }
    }
    assert!(refused > 30 && equal > 30, "{refused} {equal}");
}
