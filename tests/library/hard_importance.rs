//! Hard cases of importance: amounts, pixels and closures that are wrong, extreme or break naive samplers.

use crate::common::{few_tiles, map, noise, points};
use glam::{DVec2, Vec2};
use twelvefold::{
    Amount, Constant, Disc, Domain, Function, ImageMap, Importance, InvalidPixels, MapError,
    Pixels, Placement, Sampling, SamplingError,
};

#[test]
fn amounts_that_are_no_amount_are_errors() {
    let placement = Placement::new(Domain::UNIT, 1);
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -5e-324] {
        for amount in [Amount::Points(value), Amount::Density(value)] {
            let error = Sampling::new(&placement, &Constant::ONE, amount).unwrap_err();
            assert!(matches!(error, SamplingError::Amount { .. }), "{error}");
        }
    }
    for value in [0.0, -0.0, 5e-324] {
        for amount in [Amount::Points(value), Amount::Density(value)] {
            let sampling = Sampling::new(&placement, &Constant::ONE, amount).unwrap();
            assert_eq!(points(&sampling).unwrap(), []);
        }
    }
    let zero = Constant::new(0.0).unwrap();
    let none = Sampling::new(&placement, &zero, Amount::Points(1.0)).unwrap_err();
    assert_eq!(none, SamplingError::NoImportance);
    assert!(Sampling::new(&placement, &zero, Amount::Points(0.0)).is_ok());
    assert!(points(&Sampling::new(&placement, &zero, Amount::Density(1e9)).unwrap()).is_ok());
}

#[test]
fn pixels_that_are_no_importance_are_located_or_follow_the_policy() {
    let with = |value: f32, policy| {
        let mut pixels = vec![1.0; 12];
        pixels[7] = value;
        Pixels::new(4, 3, pixels, policy).and_then(ImageMap::new)
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -1e-45] {
        match with(value, InvalidPixels::Reject).unwrap_err() {
            MapError::InvalidPixel { x: 3, y: 1, value: found } => {
                assert_eq!(found.to_bits(), value.to_bits());
            }
            other => panic!("{other}"),
        }
        let lenient = with(value, InvalidPixels::ZeroNegative);
        assert_eq!(lenient.is_ok(), value.is_finite(), "{value}");
        assert_eq!(with(value, InvalidPixels::ZeroAll).unwrap().pixels()[7], 0.0);
    }
    for value in [0.0, -0.0, 1e-45, f32::MAX] {
        for policy in [InvalidPixels::Reject, InvalidPixels::ZeroNegative, InvalidPixels::ZeroAll] {
            let map = with(value, policy).unwrap();
            assert_eq!(map.pixels()[7].to_bits(), value.to_bits());
            let placement = Placement::new(map.domain(), 3);
            let sampling = Sampling::new(&placement, &map, Amount::Points(1000.0)).unwrap();
            let found = points(&sampling).unwrap();
            let inside = found.iter().filter(|(_, p)| p.floor() == DVec2::new(3.0, 1.0)).count();
            match value {
                f32::MAX => assert_eq!(inside, found.len()),
                _ => assert_eq!(inside, 0),
            }
        }
    }
}

#[test]
fn sizes_that_are_no_image_are_errors_and_thin_ones_are_not() {
    for (width, height) in [(0, 0), (0, 5), (5, 0)] {
        let empty = Pixels::new(width, height, vec![], InvalidPixels::Reject)
            .and_then(ImageMap::new)
            .unwrap_err();
        assert_eq!(empty, MapError::Empty { width, height });
    }
    let short =
        Pixels::new(3, 3, vec![0.0; 8], InvalidPixels::Reject).and_then(ImageMap::new).unwrap_err();
    assert_eq!(short, MapError::Length { expected: 9, found: 8 });
    let wrapped = Pixels::new(usize::MAX, 2, vec![0.0; 8], InvalidPixels::Reject)
        .and_then(ImageMap::new)
        .unwrap_err();
    assert_eq!(wrapped, MapError::Length { expected: usize::MAX, found: 8 });

    let sizes = [(1, 1), (1, 1000), (1000, 1), (3, 257), (255, 129), (17, 1), (2, 3)];
    for (width, height) in sizes {
        let image = map(width, height, |x, y| 0.1 + noise(x, y));
        let placement = Placement::new(image.domain(), 8);
        let sampling = Sampling::new(&placement, &image, Amount::Points(2000.0)).unwrap();
        let count = points(&sampling).unwrap().len();
        assert!((1800..2200).contains(&count), "{width} × {height}: {count}");
    }
}

#[test]
fn an_image_without_importance_has_no_points() {
    let black = map(100, 100, |_, _| 0.0);
    let placement = Placement::new(black.domain(), 1);
    let error = Sampling::new(&placement, &black, Amount::Points(10.0)).unwrap_err();
    assert_eq!(error, SamplingError::NoImportance);
    let sampling = Sampling::new(&placement, &black, Amount::Density(1e6)).unwrap();
    assert_eq!(points(&sampling).unwrap(), []);
}

#[test]
fn subnormal_and_huge_pixels_give_their_count() {
    for value in [1e-45f32, f32::MIN_POSITIVE, 1e30, f32::MAX] {
        let image = map(64, 64, |x, y| if (x + y) % 3 == 0 { value } else { 0.0 });
        let placement = Placement::new(image.domain(), 4);
        let sampling = Sampling::new(&placement, &image, Amount::Points(3000.0)).unwrap();
        let found = points(&sampling).unwrap();
        assert!((2800..3200).contains(&found.len()), "{value}: {}", found.len());
        assert!(found.iter().all(|(_, p)| (p.x as usize + p.y as usize).is_multiple_of(3)));
    }
    // A constant so small that no density makes up for it.
    let placement = Placement::new(Domain::UNIT, 4);
    let tiny = Constant::new(5e-324).unwrap();
    let error = Sampling::new(&placement, &tiny, Amount::Points(100.0)).unwrap_err();
    assert!(matches!(error, SamplingError::NoImportance), "{error}");
}

#[test]
fn importance_times_magnification_may_overflow_without_harm() {
    let placement = Placement::new(Domain::UNIT, 4);
    let huge = Constant::new(f64::MAX).unwrap();
    let error = Sampling::new(&placement, &huge, Amount::Density(1e10)).unwrap_err();
    assert!(matches!(error, SamplingError::TooDense { .. }), "{error}");
    let some = Sampling::new(&placement, &huge, Amount::Points(100.0)).unwrap();
    assert!((70..130).contains(&points(&some).unwrap().len()));
}

#[test]
fn closures_that_break_their_promise_are_errors() {
    let placement = Placement::new(Domain::UNIT, 4);
    let bad_values = [f64::NAN, -1.0, f64::INFINITY, 1.5];
    for bad in bad_values {
        let broken =
            Function::new(move |p: DVec2| if p.x > 0.9 { bad } else { 1.0 }, |_: &Disc| 1.0);
        let sampling = Sampling::new(&placement, &broken, Amount::Density(1e4)).unwrap();
        match points(&sampling).unwrap_err() {
            SamplingError::InvalidValue { at, value, bound } => {
                assert!(at.x > 0.9 && value.to_bits() == bad.to_bits() && bound == 1.0);
            }
            other => panic!("{other}"),
        }
    }
    for bad in [f64::NAN, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
        let broken = Function::new(|_| 1.0, move |_: &Disc| bad);
        let refused = Sampling::new(&placement, &broken, Amount::Density(1e4)).err();
        assert!(matches!(refused, Some(SamplingError::InvalidBound { .. })), "{refused:?}");
        // Only far down: met by the walk.
        let broken = Function::new(|_| 1.0, move |r: &Disc| if r.radius < 0.1 { bad } else { 1.0 });
        let sampling = Sampling::new(&placement, &broken, Amount::Density(1e6)).unwrap();
        let error = points(&sampling).unwrap_err();
        assert!(matches!(error, SamplingError::InvalidBound { .. }), "{error}");
    }
    // −0 is zero.
    let nothing = Function::new(|_| -0.0, |_: &Disc| -0.0);
    let sampling = Sampling::new(&placement, &nothing, Amount::Density(1e6)).unwrap();
    assert_eq!(points(&sampling).unwrap(), []);
}

/// Importance 1, with some lower bound.
struct Floor(f64);

impl Importance for Floor {
    fn value(&self, _: DVec2) -> f64 {
        1.0
    }

    fn upper_bound(&self, _: &Disc) -> f64 {
        1.0
    }

    fn lower_bound(&self, _: &Disc) -> f64 {
        self.0
    }
}

#[test]
fn no_lower_bound_makes_more_points_than_the_upper_one_admits() {
    let placement = Placement::new(Domain::UNIT, 4);
    let points_of = |importance: &dyn Importance, relaxed: bool| {
        let sampling = Sampling::new(&placement, &importance, Amount::Density(20_000.0)).unwrap();
        let sampling = if relaxed { sampling.relaxed().unwrap() } else { sampling };
        let mut buffer = vec![Vec2::ZERO; 25_000];
        let filled = sampling.fill(&mut buffer).unwrap();
        assert!(filled.complete);
        buffer.truncate(filled.written);
        buffer.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).unwrap());
        buffer
    };
    for relaxed in [false, true] {
        let expected = points_of(&Floor(0.0), relaxed);
        for floor in [f64::NAN, -1.0, f64::NEG_INFINITY, 5e-324, 0.3, 1.0, 2.0, f64::INFINITY] {
            assert!(points_of(&Floor(floor), relaxed) == expected, "{floor}");
        }
    }
}

#[test]
fn one_hot_texel_in_sixty_seven_million_gets_all_points_in_few_tiles() {
    let (side, hot) = (8192, 5003 * 8192 + 7177);
    let mut pixels = vec![0.0f32; side * side];
    pixels[hot] = 1.0;
    let image =
        Pixels::new(side, side, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap();
    for seed in 0..3 {
        let placement = Placement::new(image.domain(), seed);
        let sampling =
            Sampling::within(&placement, &image, Amount::Points(100.0), few_tiles()).unwrap();
        let found = points(&sampling).unwrap();
        assert!((70..130).contains(&found.len()), "{}", found.len());
        assert!(found.iter().all(|(_, p)| p.floor() == DVec2::new(7177.0, 5003.0)));
        for sample in sampling.points::<Vec2>().unwrap() {
            assert_eq!(sample.unwrap().position.floor(), Vec2::new(7177.0, 5003.0));
        }
    }
}

#[test]
fn ten_million_texels_are_sampled() {
    // As wide as odd.
    let (width, height) = (3167, 3163);
    let pixels: Vec<f32> =
        (0..height).flat_map(|y| (0..width).map(move |x| ((x ^ y) & 255) as f32)).collect();
    let image =
        Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap();
    let placement = Placement::new(image.domain(), 1);
    let sampling = Sampling::new(&placement, &image, Amount::Points(1000.0)).unwrap();
    let count = points(&sampling).unwrap().len();
    assert!((850..1150).contains(&count), "{count}");
}

#[test]
fn a_checkerboard_at_the_sampling_rate_is_followed() {
    // One point a white texel, on average.
    let board = map(128, 128, |x, y| ((x + y) % 2) as f32);
    let mut counts = Vec::new();
    for seed in 0..10 {
        let placement = Placement::new(board.domain(), seed);
        let sampling = Sampling::new(&placement, &board, Amount::Points(8192.0)).unwrap();
        let found = points(&sampling).unwrap();
        assert!(found.iter().all(|(_, p)| (p.x as usize + p.y as usize) % 2 == 1));
        counts.push(found.len());
    }
    assert!(counts.iter().all(|n| (7900..8500).contains(n)), "{counts:?}");
}

#[test]
fn a_million_times_the_mean_is_followed() {
    let side = 2048;
    let image = map(side, side, |x, y| match (x, y) {
        (1000, 700) => 4e6,
        _ => noise(x, y),
    });
    let ratio = 4e6 / image.mean();
    assert!(ratio > 1e6, "{ratio}");
    let placement = Placement::new(image.domain(), 6);
    let sampling = Sampling::new(&placement, &image, Amount::Points(20_000.0)).unwrap();
    let found = points(&sampling).unwrap();
    let hot = found.iter().filter(|(_, p)| p.floor() == DVec2::new(1000.0, 700.0)).count() as f64;
    let expected = 20_000.0 * ratio / (side * side) as f64;
    assert!((hot / expected - 1.0).abs() < 0.02, "{hot} {expected}");
}
