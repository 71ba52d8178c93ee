//! Laws of refining, and the force computed the slow way.

use alloc::vec;
use alloc::vec::Vec;

use glam::DVec2;

use super::{RefineError, Refiner, refine};

/// Places that look random: halves of a 64-bit mix of the index.
fn scattered(n: usize, width: f64, height: f64) -> Vec<DVec2> {
    let mix = |i: u64| {
        let z = (i ^ (i >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let unit = |bits: u64| (bits >> 11) as f64 / (1_u64 << 53) as f64;
    (0..n as u64)
        .map(|i| {
            let a = mix((i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
            DVec2::new(unit(a) * width, unit(mix(a)) * height)
        })
        .collect()
}

fn on_ink(points: &[DVec2], width: usize, height: usize, pixels: &[f32]) -> bool {
    points.iter().all(|p| {
        p.x >= 0.0
            && p.y >= 0.0
            && p.x < width as f64
            && p.y < height as f64
            && pixels[p.y as usize * width + p.x as usize] > 0.0
    })
}

#[test]
fn dots_from_anywhere_end_on_ink_and_finite() {
    let lone = |w: usize, h: usize, at: usize| {
        let mut pixels = vec![0.0; w * h];
        pixels[at] = 1e6;
        pixels
    };
    let pictures = [
        (1, 1, vec![1.0]),
        (1, 40, vec![0.5; 40]),
        (40, 1, vec![0.5; 40]),
        (2, 3, vec![f32::MIN_POSITIVE / 8.0; 6]),
        (3, 2, vec![f32::MAX; 6]),
        (16, 16, lone(16, 16, 37)),
        (16, 16, (0..256).map(|i| if i % 7 == 0 { 1e-6 } else { (i % 2) as f32 }).collect()),
    ];
    for (width, height, pixels) in &pictures {
        for n in [0, 1, 2, 3, 5, 300] {
            for start in 0..3 {
                let mut points = match start {
                    0 => scattered(n, *width as f64, *height as f64),
                    1 => vec![DVec2::new(0.3, 0.3); n],
                    _ => scattered(n, 1e9, 1e300),
                };
                refine(&mut points, *width, *height, pixels, 4).unwrap();
                assert!(on_ink(&points, *width, *height, pixels), "{width}×{height} {n} {start}");
            }
        }
    }
}

#[test]
fn mistakes_are_named() {
    let point = [DVec2::ZERO, DVec2::new(0.0, f64::NAN)];
    let new = |w, h, pixels: &[f32], points: &[DVec2]| Refiner::new(w, h, pixels, points).err();
    assert_eq!(new(2, 2, &[1.0; 4], &point), Some(RefineError::Point { index: 1 }));
    assert_eq!(new(2, 2, &[0.0; 4], &point[..1]), Some(RefineError::NoInk));
    assert_eq!(new(0, 9, &[], &point[..1]), Some(RefineError::NoInk));
    assert_eq!(new(0, 9, &[], &[]), None);
    let size = RefineError::Size { width: usize::MAX, height: 2, pixels: 1 };
    assert_eq!(new(usize::MAX, 2, &[1.0], &[]), Some(size));
    let pixel = RefineError::Pixel { x: 1, y: 1, value: -1.0 };
    assert_eq!(new(2, 2, &[1.0, 0.0, 0.0, -1.0], &[]), Some(pixel));
}

#[test]
fn random_dots_on_even_ground_become_even() {
    let mut points = scattered(400, 60.0, 60.0);
    refine(&mut points, 60, 60, &[0.7; 3600], 20).unwrap();
    let hexagonal = (2.0 / 3.0_f64.sqrt() * 9.0).sqrt();
    let nearest = |i: usize| {
        let others = (0..points.len()).filter(|j| *j != i);
        others.map(|j| points[i].distance(points[j])).fold(f64::INFINITY, f64::min) / hexagonal
    };
    let distances: Vec<f64> = (0..points.len()).map(nearest).collect();
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    assert!(mean > 0.8, "{mean}");
}

#[test]
fn stopping_early_is_asking_for_fewer() {
    let pixels: Vec<f32> = (0..30 * 20).map(|i| (i % 30) as f32).collect();
    let start = scattered(700, 30.0, 20.0);
    let mut asked = start.clone();
    refine(&mut asked, 30, 20, &pixels, 3).unwrap();
    let mut refiner = Refiner::new(30, 20, &pixels, &start).unwrap();
    let mut shown = start.clone();
    for _ in 0..3 {
        refiner.step();
        refiner.write(&mut shown).unwrap();
    }
    assert_eq!(asked, shown);
    let short = RefineError::Length { expected: 700, found: 699 };
    assert_eq!(refiner.write(&mut shown[1..]), Err(short));
}
