//! Exactly n relaxed points: as many as were asked, even, and where the importance is.

use std::collections::HashSet;

use glam::DVec2;
use twelvefold::estimate::{ExactError, exactly_relaxed};
use twelvefold::{
    Amount, Constant, Domain, ImageMap, Importance, InvalidPixels, Limits, Pixels, Placement,
    Sample, Sampling, SamplingError, StippleMap,
};

use crate::common::noise;

fn found<I: Importance>(placement: &Placement<'_>, importance: &I, n: usize) -> Vec<Sample<DVec2>> {
    exactly_relaxed(placement, importance, n, Limits::default()).unwrap()
}

/// As many as asked, different ones, in the domain and on ink.
fn check<I: Importance>(importance: &I, domain: Domain, counts: &[usize]) {
    for (seed, &n) in (0..).zip(counts) {
        let placement = Placement::new(domain, seed);
        let points = found(&placement, importance, n);
        assert_eq!(points.len(), n);
        let places: HashSet<_> =
            points.iter().map(|point| point.position.to_array().map(f64::to_bits)).collect();
        assert_eq!(places.len(), n);
        let (low, high) = (domain.min(), domain.min() + domain.size());
        for Sample { position, .. } in &points {
            assert!(position.cmpge(low).all() && position.cmplt(high).all());
            assert!(importance.value(*position) > 0.0);
        }
    }
}

#[test]
fn there_are_as_many_as_asked() {
    let counts = [1, 2, 3, 5, 8, 13, 100, 777, 3000];
    let constant = Constant::new(2.0).unwrap();
    check(&constant, Domain::UNIT, &counts);
    let pixels = |values: Vec<f32>| Pixels::new(64, 64, values, InvalidPixels::Reject).unwrap();
    for values in [grain(), slope(), lines()] {
        let map = ImageMap::new(pixels(values.clone())).unwrap();
        check(&map, map.domain(), &counts);
        let map = StippleMap::new(pixels(values), 800.0).unwrap();
        check(&map, map.domain(), &counts);
    }
}

/// Dark on the right, white on the left.
fn slope() -> Vec<f32> {
    (0..64 * 64).map(|i| (i % 64) as f32).collect()
}

/// Another value at every pixel.
fn grain() -> Vec<f32> {
    (0..64 * 64).map(|i| noise(i % 64, i / 64)).collect()
}

/// Lines a pixel wide, and nothing else.
fn lines() -> Vec<f32> {
    (0..64 * 64).map(|i| f32::from(u8::from(i % 9 == 0 || i / 64 % 17 == 3))).collect()
}

#[test]
fn they_are_points_of_a_sampling() {
    // Of one whose amount is about as large, up to those that come with others at once.
    let map = Pixels::new(64, 64, slope(), InvalidPixels::Reject)
        .and_then(|pixels| StippleMap::new(pixels, 900.0))
        .unwrap();
    let placement = Placement::new(map.domain(), 5);
    let mut points = found(&placement, &map, 900);
    let order = |points: &mut Vec<Sample<DVec2>>| points.sort_by_key(|point| point.rank);
    order(&mut points);
    let ranks = |amount: f64| -> HashSet<u64> {
        let sampling = Sampling::new(&placement, &map, Amount::Points(amount)).unwrap();
        let all = sampling.relaxed().unwrap().points::<DVec2>().unwrap();
        all.map(|point| point.unwrap().rank).collect()
    };
    let more = ranks(1000.0);
    let among = points.iter().filter(|point| more.contains(&point.rank)).count();
    assert!(among > 890, "{among}");
}

#[test]
fn what_cannot_be_is_an_error() {
    let constant = Constant::new(1.0).unwrap();
    let placement = Placement::new(Domain::UNIT, 0);
    assert!(found(&placement, &constant, 0).is_empty());
    let few = Limits { points: 10, ..Limits::default() };
    let many = exactly_relaxed::<DVec2, _>(&placement, &constant, 11, few);
    assert!(matches!(
        many,
        Err(ExactError::Sampling(SamplingError::TooManyPoints { expected: 11.0, limit: 10 }))
    ));
    let memory = exactly_relaxed::<DVec2, _>(
        &placement,
        &constant,
        usize::MAX,
        Limits { points: u64::MAX, ..Limits::default() },
    );
    assert!(matches!(memory, Err(ExactError::Memory { .. })));
    let nothing = Constant::new(0.0).unwrap();
    assert!(exactly_relaxed::<DVec2, _>(&placement, &nothing, 1, Limits::default()).is_err());
}
