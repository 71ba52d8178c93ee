//! Laws of classes.

use alloc::vec;
use alloc::vec::Vec;

use glam::DVec2;

use super::super::tests::scattered;
use super::super::{RefineError, refine};
use super::{ClassRefiner, Classes};

/// Dots and their classes after some iterations, from even dots.
fn refined(classes: &Classes, count: usize, iterations: usize) -> (Vec<DVec2>, Vec<u8>) {
    let [width, height] = classes.size();
    let mut dots = scattered(count, width as f64, height as f64);
    refine(&mut dots, width, height, classes.total(), 10).unwrap();
    let mut class_of = vec![u8::MAX; count];
    let mut refiner = ClassRefiner::new(classes, &dots).unwrap();
    (0..iterations).for_each(|_| refiner.step());
    refiner.write(&mut dots, &mut class_of).unwrap();
    (dots, class_of)
}

fn of_class(dots: &[DVec2], class_of: &[u8], class: u8) -> Vec<DVec2> {
    dots.iter().zip(class_of).filter(|(_, of)| **of == class).map(|(dot, _)| *dot).collect()
}

/// Variance of the dots in blocks of `block` pixels over their mean: 1 for random dots.
fn block_variance(dots: &[DVec2], side: f64, block: f64) -> f64 {
    let across = (side / block) as usize;
    let mut counts = vec![0.0; across * across];
    for dot in dots {
        counts[(dot.y / block) as usize * across + (dot.x / block) as usize] += 1.0;
    }
    let mean = dots.len() as f64 / counts.len() as f64;
    let squares: f64 = counts.iter().map(|count| (count - mean) * (count - mean)).sum();
    squares / counts.len() as f64 / mean
}

/// Mean distance to the nearest dot, in that of a hexagonal lattice of as many.
fn mean_nearest(dots: &[DVec2], side: f64) -> f64 {
    let nearest = |i: usize| {
        let others = (0..dots.len()).filter(|j| *j != i);
        others.map(|j| dots[i].distance(dots[j])).fold(f64::INFINITY, f64::min)
    };
    let sum: f64 = (0..dots.len()).map(nearest).sum();
    let hexagonal = (2.0 / 3.0_f64.sqrt() * side * side / dots.len() as f64).sqrt();
    sum / dots.len() as f64 / hexagonal
}

#[test]
fn all_dots_are_even_and_those_of_each_class_more_than_a_random_split() {
    const SIDE: usize = 64;
    let shares = [0.4_f32, 0.3, 0.2, 0.1];
    let planes = shares.iter().map(|share| vec![*share; SIDE * SIDE]).collect();
    let classes = Classes::new(SIDE, SIDE, planes).unwrap();
    let (dots, class_of) = refined(&classes, 1500, 10);
    assert!(mean_nearest(&dots, 64.0) > 0.83);
    // The same dots, and every class wherever it falls.
    let mut order: Vec<(u64, usize)> = (0..dots.len())
        .map(|i| ((i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23) ^ 0x5bd1, i))
        .map(|(key, i)| (key.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 7, i))
        .collect();
    order.sort_unstable();
    let mut split = vec![0; dots.len()];
    for (class, (_, i)) in class_of.iter().zip(order) {
        split[i] = *class;
    }
    for (class, share) in (0..4).zip(shares) {
        let ours = of_class(&dots, &class_of, class);
        let random = of_class(&dots, &split, class);
        assert!((ours.len() as f32 - 1500.0 * share).abs() < 4.0, "{class}: {}", ours.len());
        // Blocks of about ten dots of the class.
        let block = if share < 0.3 { 16.0 } else { 8.0 };
        let [even, uneven] = [&ours, &random].map(|dots| block_variance(dots, 64.0, block));
        assert!(even < 0.35 * uneven, "{class}: {even} and {uneven}");
        let [even, uneven] = [&ours, &random].map(|dots| mean_nearest(dots, 64.0));
        assert!(even > 1.1 * uneven, "{class}: {even} and {uneven}");
    }
}

#[test]
fn even_dots_stay_until_they_are_moved_and_polishing_keeps_them_even() {
    let classes = Classes::new(40, 40, vec![vec![0.2; 1600], vec![0.1; 1600]]).unwrap();
    let mut dots = scattered(300, 40.0, 40.0);
    refine(&mut dots, 40, 40, classes.total(), 10).unwrap();
    let mut refiner = ClassRefiner::new(&classes, &dots).unwrap();
    let (mut same, mut class_of) = (dots.clone(), vec![0; 300]);
    refiner.write(&mut same, &mut class_of).unwrap();
    assert_eq!(same, dots);
    (0..5).for_each(|_| refiner.step());
    refiner.polish().unwrap();
    refiner.write(&mut dots, &mut class_of).unwrap();
    assert!(mean_nearest(&dots, 40.0) > 0.83);
    assert!(class_of.iter().filter(|class| **class == 0).count().abs_diff(200) <= 2);
    for class in 0..2 {
        assert!(mean_nearest(&of_class(&dots, &class_of, class), 40.0) > 0.7);
    }
}

#[test]
fn dots_are_of_classes_that_their_pixels_want() {
    // One class left of the middle, one right of it, one in a corner; nothing in the last rows.
    let (width, height) = (40, 30);
    let plane = |wants: fn(usize, usize) -> bool| -> Vec<f32> {
        (0..width * height)
            .map(|i| if i / width < 25 && wants(i % width, i / width) { 0.5 } else { 0.0 })
            .collect()
    };
    let planes = vec![
        plane(|x, _| x < 20),
        plane(|x, _| x >= 20),
        plane(|x, y| x < 9 && y < 9),
        plane(|_, _| false),
    ];
    let classes = Classes::new(width, height, planes).unwrap();
    for count in [0, 1, 2, 5, 400] {
        for iterations in [0, 4] {
            let (dots, class_of) = refined(&classes, count, iterations);
            for (dot, class) in dots.iter().zip(class_of) {
                let pixel = dot.y as usize * width + dot.x as usize;
                assert!(classes.planes()[usize::from(class)][pixel] > 0.0, "{dot} {class}");
            }
        }
    }
}

#[test]
fn odd_pictures_are_no_trouble() {
    let some = [
        (1, 1, vec![vec![1.0], vec![1e-30]]),
        (1, 40, vec![vec![0.5; 40], vec![f32::MIN_POSITIVE / 8.0; 40]]),
        (3, 2, vec![vec![1e38; 6], vec![1e38; 6]]),
        (
            16,
            16,
            vec![vec![1e-6; 256], (0..256).map(|i| if i == 37 { 1e6 } else { 0.0 }).collect()],
        ),
    ];
    for (width, height, planes) in some {
        let classes = Classes::new(width, height, planes).unwrap();
        for count in [1, 3, 300] {
            let (dots, class_of) = refined(&classes, count, 3);
            assert!(dots.iter().all(|dot| dot.is_finite()) && class_of.iter().all(|c| *c < 2));
        }
    }
}

#[test]
fn one_class_alone_has_all_dots_and_mistakes_are_named() {
    let classes = Classes::new(8, 8, vec![vec![1.0; 64]]).unwrap();
    assert!(refined(&classes, 30, 2).1.iter().all(|class| *class == 0));
    let new = |planes| Classes::new(2, 2, planes).err();
    assert_eq!(new(vec![]), Some(RefineError::Classes { count: 0 }));
    assert_eq!(new(vec![vec![0.0; 4]; 65]), Some(RefineError::Classes { count: 65 }));
    let pixel = RefineError::Pixel { x: 1, y: 0, value: -1.0 };
    assert_eq!(new(vec![vec![1.0; 4], vec![0.0, -1.0, 0.0, 0.0]]), Some(pixel));
    let size = RefineError::Size { width: 2, height: 2, pixels: 3 };
    assert_eq!(new(vec![vec![1.0; 3]]), Some(size));
    let infinite = RefineError::Pixel { x: 0, y: 0, value: f32::INFINITY };
    assert_eq!(new(vec![vec![f32::MAX; 4], vec![f32::MAX; 4]]), Some(infinite));
    let blank = Classes::new(2, 2, vec![vec![0.0; 4]; 2]).unwrap();
    assert_eq!(ClassRefiner::new(&blank, &[DVec2::ONE]).err(), Some(RefineError::NoInk));
    let refiner = ClassRefiner::new(&classes, &[DVec2::ONE]).unwrap();
    let length = RefineError::Length { expected: 1, found: 2 };
    assert_eq!(refiner.write(&mut [DVec2::ZERO], &mut [0, 0]), Err(length));
    assert_eq!(refiner.write(&mut [DVec2::ZERO; 2], &mut [0]), Err(length));
}

/// Where dots go is part of what this crate promises: the same bits everywhere.
#[test]
fn the_same_bits() {
    let planes = (0..3)
        .map(|class| (0..48 * 32).map(|i| ((i * (class + 3)) % 7) as f32 / 20.0).collect())
        .collect();
    let classes = Classes::new(48, 32, planes).unwrap();
    let (dots, class_of) = refined(&classes, 300, 5);
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for (dot, class) in dots.iter().zip(class_of) {
        for bits in [dot.x.to_bits(), dot.y.to_bits(), u64::from(class)] {
            hash = (hash ^ bits).wrapping_mul(0x0100_0000_01b3);
        }
    }
    assert_eq!(hash, GOLDEN, "{hash:#x}");
}

const GOLDEN: u64 = 0xba0f_f562_a817_b36c;
