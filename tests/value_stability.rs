//! The promise that the same inputs give the same points, bit for bit, in every version, profile and
//! on every platform. A hash here may change only together with an entry in the changelog.

mod common;

use common::{map, noise, points};
use glam::{DVec2, Vec2};
use sha2::{Digest as _, Sha256};
use twelvefold::{Amount, Constant, Domain, Function, Importance, Placement, Region, Sampling};

/// The first 16 hexadecimal digits of SHA-256 over rank and both coordinates, in the order of ranks,
/// in `f64` and then in `f32`.
fn hash<I: Importance>(sampling: &Sampling<'_, I>) -> String {
    let mut hasher = Sha256::new();
    for (rank, at) in points(sampling).unwrap() {
        hasher.update(rank.to_le_bytes());
        for coordinate in at.to_array() {
            hasher.update(coordinate.to_bits().to_le_bytes());
        }
    }
    let mut single: Vec<_> = sampling.points::<Vec2>().unwrap().map(Result::unwrap).collect();
    single.sort_by_key(|sample| sample.rank);
    for sample in single {
        hasher.update(sample.rank.to_le_bytes());
        for coordinate in sample.position.to_array() {
            hasher.update(coordinate.to_bits().to_le_bytes());
        }
    }
    hasher.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn points_are_those_of_the_first_release() {
    let unit = Placement::new(Domain::unit(), 1);
    let uniform = Sampling::new(&unit, &Constant::ONE, Amount::Points(10_000.0)).unwrap();

    let far = Domain::new(DVec2::new(-1e6, 3e5), DVec2::new(200.0, 0.5)).unwrap();
    let far = Placement::new(far, u64::MAX);
    let shifted = Sampling::new(&far, &Constant::ONE, Amount::Points(3000.0)).unwrap();

    let image = map(320, 200, |x, y| noise(x, y) * noise(x / 40, y / 40));
    let over = Placement::new(image.domain(), 2);
    let mapped = Sampling::new(&over, &image, Amount::Points(20_000.0)).unwrap();

    let parabola = Function::new(|p: DVec2| p.x * p.y, |_: &Region| 1.0).with_integral(0.25);
    let closure = Sampling::new(&unit, &parabola, Amount::Points(2000.0)).unwrap();

    let spot = DVec2::new(0.25, 0.5);
    let deep = Function::new(
        move |p: DVec2| f64::from(p.distance_squared(spot) < 1e-10),
        move |r: &Region| f64::from(r.centre.distance(spot) < 1e-5 + r.radius),
    )
    .with_integral(core::f64::consts::PI * 1e-10);
    let deep = Sampling::new(&unit, &deep, Amount::Points(500.0)).unwrap();

    let found = [hash(&uniform), hash(&shifted), hash(&mapped), hash(&closure), hash(&deep)];
    assert_eq!(
        found,
        [
            "447ceb02fc57e810",
            "b914312521e45fdf",
            "411afae54b2c868b",
            "e752d9083803a5fd",
            "420a363cdf794f38",
        ]
    );
}
