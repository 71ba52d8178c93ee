//! Laws of refining.

extern crate std;

mod oracles;

use alloc::vec;
use alloc::vec::Vec;

use glam::DVec2;
use glam::swizzles::Vec2Swizzles as _;

use super::polish::balanced;
use super::{RefineError, Refiner, best, refine};

/// Places that look random: halves of a 64-bit mix of the index.
pub(super) fn scattered(n: usize, width: f64, height: f64) -> Vec<DVec2> {
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
                best(&mut points, *width, *height, pixels, start).unwrap();
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

/// A picture of pseudorandom grays with whole blocks of white.
fn mask(width: usize, height: usize, seed: usize) -> Vec<f32> {
    let values = scattered(width * height + seed, 1.0, 1.0);
    let islands = scattered(64 + seed, 1.0, 1.0);
    (0..width * height)
        .map(|i| {
            let block = i % width / 5 + 8 * (i / width / 5);
            let white = islands[(block + seed) % islands.len()].x < 0.4;
            if white { 0.0 } else { values[i + seed].y as f32 + 0.01 }
        })
        .collect()
}

/// Islands whose ink is what 7, 2, 15 and 40 of 64 dots draw.
fn islands() -> Vec<f32> {
    let mut pixels = vec![0.0_f32; 48 * 48];
    for (x, y, side, ink) in [(3, 3, 5, 7.0), (30, 2, 2, 2.0), (5, 30, 9, 15.0), (26, 24, 20, 40.0)]
    {
        for j in y..y + side {
            pixels[j * 48 + x..j * 48 + x + side].fill(ink / (side * side) as f32);
        }
    }
    pixels
}

#[test]
fn each_island_gets_its_share_from_any_start() {
    let pixels = islands();
    let starts = [
        scattered(64, 48.0, 48.0),
        vec![DVec2::splat(47.9); 64],
        scattered(64, 3.0, 3.0),
        vec![DVec2::new(30.2, 2.2); 64],
    ];
    for start in starts {
        for polished in [false, true] {
            let mut dots = start.clone();
            let way = if polished { best } else { refine };
            way(&mut dots, 48, 48, &pixels, 10).unwrap();
            let counts = [[0, 0], [24, 0], [0, 24], [24, 24]].map(|[x, y]: [usize; 2]| {
                let inside = |dot: &&DVec2| {
                    (x..x + 24).contains(&(dot.x as usize))
                        && (y..y + 24).contains(&(dot.y as usize))
                };
                dots.iter().filter(inside).count()
            });
            assert_eq!(counts, [7, 2, 15, 40]);
        }
    }
}

#[test]
fn bad_starts_end_as_even_as_good_ones() {
    let ramp: Vec<f32> = (0..60 * 60).map(|i| 0.2 + (i % 60) as f32 / 60.0).collect();
    let unevenness = |start: &[DVec2]| {
        let mut dots = start.to_vec();
        refine(&mut dots, 60, 60, &ramp, 10).unwrap();
        // counts of sixteenths of the ramp, cut across, against their ink
        let ink = |k: usize| ramp[..60].iter().skip(k * 15).take(15).sum::<f32>() / 4.0;
        let total: f32 = ramp[..60].iter().sum();
        (0..16)
            .map(|k| {
                let (i, j) = (k % 4, k / 4);
                let here = |dot: &&DVec2| dot.x as usize / 15 == i && dot.y as usize / 15 == j;
                let count = dots.iter().filter(here).count() as f32;
                (count - 500.0 * ink(i) / total).abs()
            })
            .fold(0.0, f32::max)
    };
    for start in
        [scattered(500, 60.0, 60.0), scattered(500, 1.0, 1.0), vec![DVec2::new(59.5, 0.5); 500]]
    {
        let most = unevenness(&start);
        assert!(most < 3.0, "{most}");
    }
}

#[test]
fn crowds_take_no_squares_of_time() {
    // Two hot pixels at the ends of a slit: all dots in two cells of the grid, of which each would look at
    // half of all. Narrowed, each looks at hundreds.
    let mut pixels = vec![0.0_f32; 400 * 400];
    (pixels[0], pixels[400 * 400 - 1]) = (1.0, 1.0);
    let mut dots = vec![DVec2::ZERO; 30_000];
    let begin = std::time::Instant::now();
    best(&mut dots, 400, 400, &pixels, 2).unwrap();
    let seconds = begin.elapsed().as_secs_f64();
    assert!(on_ink(&dots, 400, 400, &pixels));
    assert_eq!(dots.iter().filter(|dot| dot.x < 1.0).count(), 15_000);
    // squares take 30 s here
    assert!(seconds < 5.0, "{seconds}");
}

#[test]
fn dots_keep_their_number_and_off_white() {
    for seed in 0..24 {
        let (width, height) = (9 + seed * 7 % 31, 8 + seed * 5 % 27);
        let pixels = mask(width, height, seed);
        let dots = scattered(3 + seed * 37 % 400, width as f64 + 9.0, height as f64);
        for iterations in [0, 1, 5] {
            let mut refined = dots.clone();
            refine(&mut refined, width, height, &pixels, iterations).unwrap();
            assert!(on_ink(&refined, width, height, &pixels), "{seed}");
            best(&mut refined, width, height, &pixels, iterations).unwrap();
            assert!(on_ink(&refined, width, height, &pixels), "{seed}");
            let mut places: Vec<[u64; 2]> =
                refined.iter().map(|dot| [dot.x.to_bits(), dot.y.to_bits()]).collect();
            places.sort_unstable();
            places.dedup();
            assert_eq!(places.len(), dots.len(), "two dots on one place, {seed}");
        }
    }
}

#[test]
fn parts_of_one_tone_keep_their_share() {
    // a dark disc on flat ground, whose edge, hard or smoothed, the pull sharpens
    let (side, n) = (160, 2500);
    let mut mean = 0.0;
    for (ground, soft) in [(0.3, 0.0), (0.3, 1.0), (0.5, 0.0), (0.5, 1.0), (0.7, 1.0)] {
        let depth = |i: usize| {
            let from_center = DVec2::new((i % side) as f64, (i / side) as f64) - 79.5;
            40.2 - from_center.length()
        };
        let tone = |i: usize| {
            let dark = if soft > 0.0 {
                (depth(i) + 0.5).clamp(0.0, 1.0)
            } else {
                f64::from(depth(i) > 0.0)
            };
            ground + (1.0 - ground) * dark
        };
        let pixels: Vec<f32> = (0..side * side).map(|i| tone(i) as f32).collect();
        let sum = |inside: bool| -> f64 {
            (0..side * side).filter(|i| !inside || depth(*i) > 0.0).map(tone).sum()
        };
        let share = sum(true) / sum(false);
        let mut points = scattered(n, side as f64, side as f64);
        refine(&mut points, side, side, &pixels, 10).unwrap();
        let inside = |p: &&DVec2| depth(p.y as usize * side + p.x as usize) > 0.0;
        let found = points.iter().filter(inside).count() as f64 / n as f64;
        let off = found / share - 1.0;
        assert!(off.abs() < 0.012, "{ground} {soft}: {off}");
        mean += off / 5.0;
    }
    // without a ceiling .011
    assert!(mean.abs() < 0.007, "{mean}");
}

#[test]
fn a_picture_turned_over_has_its_dots_turned_over() {
    let (width, height) = (40, 32);
    // blocks of 3 × 2 pixels in three tones, which the start is fair to on the whole
    let tone = |i: usize| (i % width / 3 + i / width / 2) % 3;
    let pixels: Vec<f32> = (0..width * height).map(|i| 0.3 + 0.4 * tone(i) as f32).collect();
    let mut start = scattered(300, 40.0, 32.0);
    refine(&mut start, width, height, &pixels, 10).unwrap();
    let mut dots = start.clone();
    best(&mut dots, width, height, &pixels, 4).unwrap();
    let mirrored: Vec<f32> =
        pixels.chunks(width).flat_map(|row| row.iter().rev().copied()).collect();
    let flip = |dot: &DVec2| DVec2::new(width as f64 - dot.x, dot.y);
    let mut flipped: Vec<DVec2> = start.iter().map(flip).collect();
    best(&mut flipped, width, height, &mirrored, 4).unwrap();
    let turned: Vec<f32> =
        (0..width * height).map(|i| pixels[i / height + i % height * width]).collect();
    let mut transposed: Vec<DVec2> = start.iter().map(|dot| dot.yx()).collect();
    best(&mut transposed, height, width, &turned, 4).unwrap();
    for ((dot, flipped), transposed) in dots.iter().zip(&flipped).zip(&transposed) {
        assert!(dot.distance(flip(flipped)) < 0.1, "{dot} {}", flip(flipped));
        assert!(dot.distance(transposed.yx()) < 0.1, "{dot} {}", transposed.yx());
    }
}

#[test]
fn refined_dots_have_weights_that_make_all_cells_as_heavy() {
    let (width, height) = (64, 64);
    let pixels: Vec<f32> = (0..width * height).map(|i| 1.0 + (i % width) as f32 / 20.0).collect();
    let mut refiner = Refiner::new(width, height, &pixels, &scattered(300, 64.0, 64.0)).unwrap();
    (0..10).for_each(|_| refiner.step());
    let work = refiner.work.as_mut().unwrap();
    work.sort();
    let shares = balanced(&work.ink, &work.density, &work.cells, &work.dots).unwrap();
    let off: f64 = shares.iter().map(|share| (share.mass - 1.0).powi(2)).sum();
    assert!((off / 300.0).sqrt() < 0.02, "{off}");
}

#[test]
fn the_same_dots_everywhere() {
    // Bits of a small refined and polished set, the same on every machine and for any number of threads.
    let pixels: Vec<f32> = (0..48 * 40).map(|i| ((i % 48) * (i / 48) % 97) as f32).collect();
    let mut points = scattered(1300, 48.0, 40.0);
    best(&mut points, 48, 40, &pixels, 3).unwrap();
    let hash = points
        .iter()
        .flat_map(|p| [p.x.to_bits(), p.y.to_bits()])
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, bits| {
            (hash ^ bits).wrapping_mul(0x0100_0000_01b3).rotate_left(23)
        });
    assert_eq!(hash, GOLDEN, "{hash:#x}");
}

/// Of [`the_same_dots_everywhere`]; it changes when the method does, and with nothing else.
const GOLDEN: u64 = 0xa116_969a_db52_db2e;

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_places_the_same_dots() {
    let pixels = mask(90, 70, 3);
    let start = scattered(2500, 90.0, 70.0);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut dots = start.clone();
        pool.install(|| best(&mut dots, 90, 70, &pixels, 4)).unwrap();
        dots
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}
