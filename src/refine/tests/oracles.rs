//! What refining computes fast, computed the slow way.

use alloc::vec;
use alloc::vec::Vec;

use glam::DVec2;

use super::super::cells::{Cells, dots};
use super::super::conjugate::Flow;
use super::super::density::Density;
use super::super::force::{FLAT_PULL, PULL, REACH, force};
use super::super::ink::Ink;
use super::super::power::{Cell, Power};
use super::super::share::{Other, Share};
use super::scattered;

/// Sorted dots on a picture without white, and what surrounds them.
fn scene(pixels: &[f32], width: usize, height: usize, n: usize) -> (Ink<'_>, Density, Cells) {
    let ink = Ink::new(width, height, pixels).unwrap().unwrap();
    let density = Density::new(&ink, n).unwrap();
    let places = scattered(n, width as f64, height as f64);
    let some = dots(places.iter().map(|place| place.to_array())).unwrap();
    let mut sorted = some.clone();
    let mut cells = Cells::new(&ink, n, density.usual_spacing).unwrap();
    cells.sort(&some, &mut sorted);
    (ink, density, cells)
}

#[test]
fn the_force_is_the_sum_over_all_dots_and_pixels() {
    let (width, height, n) = (36, 27, 90);
    // noise, and flat ground of two tones beside it
    let tone = |(i, noise): (usize, &DVec2)| match i % width {
        0..12 => 0.4,
        12 => 0.6,
        13..20 => 0.9,
        _ => noise.x as f32,
    };
    let noise = scattered(width * height, 1.0, 1.0);
    let pixels: Vec<f32> = noise.iter().enumerate().map(tone).collect();
    let (ink, density, cells) = scene(&pixels, width, height, n);
    let per_value = n as f64 / ink.total;
    let kernel = |dx: f64, dy: f64, reach: f64| {
        let near = (1.0 - (dx * dx + dy * dy) / (reach * reach)).max(0.0).powi(3);
        DVec2::new(dx, dy) * near
    };
    // the place itself and its eight mirror images
    let images = |x: f64, y: f64| {
        let across = [x, -x, 2.0 * width as f64 - x];
        let down = [y, -y, 2.0 * height as f64 - y];
        across.into_iter().flat_map(move |x| down.map(|y| (x, y)))
    };
    let mirrored =
        |at: i32, length: usize| (at.max(-1 - at)).min(2 * length as i32 - 1 - at) as usize;
    // what a pixel pulls with, at most, on a dot on this one
    let ceiling = |column: i32, row: i32| {
        let value = |i, j| pixels[mirrored(row + j, height) * width + mirrored(column + i, width)];
        let mut about: Vec<f32> =
            (-1..=1).flat_map(|j| (-1..=1).map(move |i| value(i, j))).collect();
        about.sort_by(f32::total_cmp);
        let [lightest, .., darkest] = about[..] else { panic!() };
        let between = about.iter().filter(|tone| (lightest..darkest).contains(tone));
        let between = between.filter(|tone| **tone != lightest).count();
        match value(0, 0) {
            _ if between > 3 => f32::INFINITY,
            own if own == darkest => FLAT_PULL * own,
            own => FLAT_PULL * 0.5 * (lightest + own),
        }
    };
    for at in 0..n {
        let (x, y) = (cells.x[at], cells.y[at]);
        let ceiling = ceiling(x as i32, y as i32);
        let spacing = density.spacing(x, y);
        let found = force(&cells, &density, [width as f32, height as f32], [x, y], spacing);
        let (x, y, spacing) = (f64::from(x), f64::from(y), f64::from(spacing));
        let (repulsion, pull) = (f64::from(REACH) * spacing, f64::from(PULL) * spacing);
        let mut expected = DVec2::ZERO;
        for other in 0..n {
            for (u, v) in images(f64::from(cells.x[other]), f64::from(cells.y[other])) {
                expected += kernel(x - u, y - v, repulsion);
            }
        }
        let gain = (repulsion / pull).powi(4) * per_value;
        for (i, value) in pixels.iter().enumerate() {
            // pixels in the parts that the density is kept in
            let parts = density.parts_per_pixel();
            let pieces = parts.round() as usize;
            for piece in 0..pieces * pieces {
                let (a, b) = ((piece % pieces) as f64 + 0.5, (piece / pieces) as f64 + 0.5);
                let (u, v) = ((i % width) as f64 + a / parts, (i / width) as f64 + b / parts);
                let mass = gain * f64::from(value.min(ceiling)) / (parts * parts);
                for (u, v) in images(u, v) {
                    expected -= mass * kernel(x - u, y - v, pull);
                }
            }
        }
        let found = DVec2::new(f64::from(found[0]), f64::from(found[1]));
        assert!(found.distance(expected) < 1e-4 * (1.0 + spacing), "{found} {expected}");
    }
}

#[test]
fn conjugate_gradients_solve_what_elimination_solves() {
    let (across, down) = (5, 4);
    let n = across * down;
    let conductance = |a: usize, b: usize| ((a * 7 + b * 3) % 11) as f32 * 0.3 + 0.1;
    let screen = |cell: usize| 0.02 + (cell % 3) as f32 * 0.1;
    let mut flow = Flow::new(across, down, conductance, screen).unwrap();
    let mut matrix = vec![vec![0.0_f64; n + 1]; n];
    for cell in 0..n {
        let (i, j) = (cell % across, cell / across);
        matrix[cell][cell] += f64::from(screen(cell));
        let right = (i + 1 < across).then_some(cell + 1);
        let below = (j + 1 < down).then_some(cell + across);
        for other in [right, below].into_iter().flatten() {
            let conductance = f64::from(conductance(cell, other));
            matrix[cell][cell] += conductance;
            matrix[other][other] += conductance;
            matrix[cell][other] -= conductance;
            matrix[other][cell] -= conductance;
        }
        let surplus = ((cell * 5) % 7) as f32 - 3.0;
        matrix[cell][n] = f64::from(surplus);
        let at = flow.at(i, j);
        flow.surplus[at] = surplus;
    }
    // Gauss and Jordan; the matrix needs no pivots
    for k in 0..n {
        let pivot = matrix[k].clone();
        for row in (0..n).filter(|row| *row != k) {
            let share = matrix[row][k] / pivot[k];
            for (to, from) in matrix[row].iter_mut().zip(&pivot) {
                *to -= share * from;
            }
        }
    }
    // Each call goes on until a thousandth of the square is left; what is left of the surplus is solved again.
    let mut solved = vec![0.0_f64; n];
    for _ in 0..6 {
        flow.solve();
        for (cell, sum) in solved.iter_mut().enumerate() {
            *sum += f64::from(flow.potential[flow.at(cell % across, cell / across)]);
        }
    }
    for (cell, solved) in solved.iter().enumerate() {
        let expected = matrix[cell][n] / matrix[cell][cell];
        assert!((solved - expected).abs() < 1e-3 * (1.0 + expected.abs()), "{solved} {expected}");
    }
}

#[test]
fn a_cell_is_what_is_nearest_by_weight() {
    let (width, height, n) = (30, 24, 60);
    let pixels: Vec<f32> =
        scattered(width * height, 1.0, 1.0).iter().map(|p| 0.2 + p.x as f32).collect();
    let (ink, density, cells) = scene(&pixels, width, height, n);
    let weights: Vec<f64> = scattered(n, 6.0, 1.0).iter().map(|place| place.x).collect();
    // every place of a fine grid belongs to the dot with the least squared distance less weight
    const FINE: usize = 12;
    let mut masses = vec![[0.0_f64; 3]; n];
    let per_sample = n as f64 / ink.total / (FINE * FINE) as f64;
    for j in 0..height * FINE {
        for i in 0..width * FINE {
            let place = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) / FINE as f64;
            let power = |at: &usize| {
                let dot = DVec2::new(f64::from(cells.x[*at]), f64::from(cells.y[*at]));
                dot.distance_squared(place) - weights[*at]
            };
            let owner = (0..n).min_by(|one, other| power(one).total_cmp(&power(other))).unwrap();
            let mass = per_sample * f64::from(pixels[j / FINE * width + i / FINE]);
            masses[owner][0] += mass;
            masses[owner][1] += mass * place.x;
            masses[owner][2] += mass * place.y;
        }
    }
    let power = Power::new(&ink, &cells, &weights).unwrap();
    let (mut cell, mut room) = (Cell::EMPTY, Cell::EMPTY);
    for (at, [mass, x, y]) in masses.into_iter().enumerate() {
        power.cell(at, 20.0, &mut cell, &mut room);
        let place = [f64::from(cells.x[at]), f64::from(cells.y[at])];
        let other = |_: u32| Other { distance: 1.0, floor: 0.0 };
        let share = Share::new(&density, &cell, at as u32, place, other);
        assert!((share.mass - mass).abs() < 0.03, "{} {mass}", share.mass);
        if mass > 0.2 {
            let center = DVec2::from(share.center) + DVec2::from(place);
            assert!(center.distance(DVec2::new(x, y) / mass) < 0.1, "{center}");
        }
    }
}
