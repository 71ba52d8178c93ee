//! Relaxed points: the CPU's set, at the CPU's places within the documented error.

use std::collections::BTreeMap;

use glam::Vec2;
use twelvefold::export::Export;
use twelvefold::{Amount, Domain, ImageMap, InvalidPixels, Sample, Sampling};
use twelvefold_gpu::{Arithmetic, Importance, Order, Plan, Points, RELAXED_ERROR, Source};

use crate::device::{Device, device};
use crate::exact::{Case, noise, peak, rectangle, smooth};

fn check(gpu: &Device, case: &Case, order: Order) {
    let size = (case.width as u32, case.height as u32);
    let plan = Plan::new(&case.placement, size, case.room(), order, Points::Relaxed, 4).unwrap();
    let sampler = gpu.sampler(plan.clone(), Source::Buffer, Arithmetic::Barriers);
    let buffer = gpu.buffer(&case.pixels);
    let output = gpu.run(&sampler, Importance::Buffer(&buffer), case.density);
    assert!(output.status.is_complete(), "{:?}", output.status);
    let map = ImageMap::new(case.width, case.height, case.pixels.clone(), InvalidPixels::Reject)
        .unwrap()
        .over(case.domain);
    let sampling = Sampling::new(&case.placement, &map, Amount::Density(case.density)).unwrap();
    let mut cpu = BTreeMap::new();
    for sample in sampling.relaxed().unwrap().points::<Vec2>().unwrap() {
        let Sample { rank, position } = sample.unwrap();
        cpu.insert(rank, position);
    }
    // Edges of the coarsest relaxed level are the longest.
    let export = Export::of(&case.placement);
    let edge = 2.0 * export.half_edges[6].length() * RELAXED_ERROR;
    let most = edge as f32 + 4.0 * f32::EPSILON * case.domain.max().abs().max_element() as f32;
    let (mut differ, mut extra, mut worst) = (0, 0, 0.0f32);
    for (key, at) in output.keys.iter().zip(&output.positions) {
        let at = Vec2::from_array(at.map(f32::from_bits));
        match cpu.remove(&plan.keys().rank(*key).unwrap()) {
            None => extra += 1,
            Some(place) => {
                differ += usize::from(place != at);
                worst = worst.max((place - at).abs().max_element());
            }
        }
    }
    println!(
        "{} points: {differ} differ by up to {worst:e} ({most:e} allowed), {} missing, {extra} extra",
        output.keys.len(),
        cpu.len()
    );
    assert!(worst <= most, "{worst} {most}");
    assert_eq!((cpu.len(), extra), (0, 0));
}

#[test]
fn relaxed_points_are_where_the_cpu_has_them() {
    let Some(gpu) = device() else { return };
    for (seed, points) in [(1, 300.0), (2, 5000.0), (3, 60_000.0)] {
        for case in [
            Case::new(Domain::UNIT, seed, (128, 128), points, smooth),
            Case::new(rectangle([-2.0, 5.0], [1.0, 0.7]), seed, (10, 7), points, noise),
            Case::new(Domain::UNIT, seed, (128, 128), points, peak),
            // So dark at the left that old centers are points of coarse levels.
            Case::new(Domain::UNIT, seed, (64, 1), points, |x, _| (8.0 * x).powi(4) / 4096.0),
        ] {
            check(gpu, &case, Order::Ordered);
        }
    }
    check(gpu, &Case::new(Domain::UNIT, 4, (64, 64), 20_000.0, peak), Order::Append);
}
