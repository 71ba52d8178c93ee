//! The last step: every dot to the center of a cell that holds as much of the picture as every other.
//!
//! After de Goes, Breeden, Ostromoukhov and Desbrun, "Blue Noise through Optimal Transport" (2012): a power diagram
//! whose weights give all cells the same mass, by Newton's method. Dots that are even already need one or two of
//! its steps.

use alloc::vec::Vec;

use super::cells::{Cells, Dot};
use super::density::Density;
use super::error::{RefineError, filled};
use super::ink::Ink;
use super::power::{Cell, Power};
use super::share::{Other, Share};
use crate::threads::{PART, for_parts};

/// Newton's steps. The masses of cells are off by 5 % before the first, by 1 % after it and by .6 % after the second;
/// more gain nothing.
const ROUNDS: usize = 2;
/// What a cell's own weight resists with, as a share of the density. At .003 tone over four spacings stays off by
/// .0012 of the mean, at .0005 by .0005.
const SCREEN: f64 = 0.0005;
/// The density that an edge is taken to have at least, as a share of its dots': an island of ink with room for 5.4 dots
/// must not reach over white for what it lacks. At .02 small text is torn apart; at .1 photographs lose nothing.
const FLOOR: f64 = 0.1;
/// The furthest that a dot moves, in spacings.
const FURTHEST: f64 = 1.0;
/// Dots in one cell of the grid from which on each stays as it is, and has no cell: to ask each of them for all others
/// would take the square of their number. Only pictures of few and hot pixels have so many.
const CROWD: usize = 512;
/// Rounds of conjugate gradients, and the share of the first residual's square that ends them.
const CONJUGATE_ROUNDS: usize = 100;
const ENOUGH: f64 = 1e-3;

/// Moves sorted `dots` to the centers of cells of mass 1.
pub(super) fn polish(
    ink: &Ink<'_>,
    density: &Density,
    cells: &Cells,
    dots: &mut [Dot],
) -> Result<(), RefineError> {
    let shares = balanced(ink, density, cells, dots)?;
    for (dot, share) in dots.iter_mut().zip(&shares) {
        let [dx, dy] = share.center;
        let (length, most) =
            ((dx * dx + dy * dy).sqrt(), FURTHEST * f64::from(density.spacing(dot.x, dot.y)));
        let less = if length > most { most / length } else { 1.0 };
        let (x, y) = ink.slide(dot.x, dot.y, (dx * less) as f32, (dy * less) as f32);
        (dot.x, dot.y, dot.vx, dot.vy) = (x, y, 0.0, 0.0);
    }
    Ok(())
}

/// What the cells of sorted dots hold, with weights that make it 1 for each, as far as islands of ink allow.
pub(super) fn balanced(
    ink: &Ink<'_>,
    density: &Density,
    cells: &Cells,
    dots: &[Dot],
) -> Result<Vec<Share>, RefineError> {
    let mut weights = filled(dots.len(), 0.0_f64)?;
    let mut shares = filled(dots.len(), Share::default())?;
    let mut newton = Newton::new(dots.len())?;
    for _ in 0..ROUNDS {
        measure(ink, density, cells, dots, &weights, &mut shares)?;
        newton.solve(density, dots, &shares);
        for (weight, change) in weights.iter_mut().zip(&newton.change) {
            *weight += if change.is_finite() { *change } else { 0.0 };
        }
    }
    measure(ink, density, cells, dots, &weights, &mut shares)?;
    Ok(shares)
}

fn squared_spacing(density: &Density, dot: &Dot) -> f64 {
    let spacing = f64::from(density.spacing(dot.x, dot.y));
    spacing * spacing
}

/// The share of every dot.
fn measure(
    ink: &Ink<'_>,
    density: &Density,
    cells: &Cells,
    dots: &[Dot],
    weights: &[f64],
    shares: &mut [Share],
) -> Result<(), RefineError> {
    let power = Power::new(ink, cells, weights)?;
    for_parts(shares, PART, |start, shares| {
        let (mut cell, mut room) = (Cell::EMPTY, Cell::EMPTY);
        for (at, share) in shares.iter_mut().enumerate() {
            let at = start + at;
            let Some(dot) = dots.get(at) else { continue };
            if cells.crowd(dot.x, dot.y) > CROWD {
                *share = Share { mass: 1.0, ..Share::default() };
                continue;
            }
            power.cell(at, f64::from(density.spacing(dot.x, dot.y)), &mut cell, &mut room);
            let square = squared_spacing(density, dot);
            let place = [f64::from(dot.x), f64::from(dot.y)];
            let other = |other: u32| {
                let other = &dots[other as usize];
                let (dx, dy) = (f64::from(other.x) - place[0], f64::from(other.y) - place[1]);
                let wider = square.max(squared_spacing(density, other));
                Other { distance: (dx * dx + dy * dy).sqrt(), floor: FLOOR / wider }
            };
            *share = Share::new(density, &cell, at as u32, place, other);
        }
    });
    Ok(())
}

/// The change of weights that makes all shares 1, as far as they follow it as they do at first:
///
/// ```text
/// Σ neighbors j   growth(i, j) (change(i) − change(j))  +  SCREEN · change(i) / spacing²  =  1 − mass(i)
/// ```
struct Newton {
    change: Vec<f64>,
    left: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    own: Vec<f64>,
    diagonal: Vec<f64>,
}

impl Newton {
    fn new(dots: usize) -> Result<Self, RefineError> {
        Ok(Self {
            change: filled(dots, 0.0)?,
            left: filled(dots, 0.0)?,
            direction: filled(dots, 0.0)?,
            image: filled(dots, 0.0)?,
            own: filled(dots, 0.0)?,
            diagonal: filled(dots, 0.0)?,
        })
    }

    /// Conjugate gradients, each row divided by its diagonal.
    fn solve(&mut self, density: &Density, dots: &[Dot], shares: &[Share]) {
        for (at, (dot, share)) in dots.iter().zip(shares).enumerate() {
            self.own[at] = SCREEN / squared_spacing(density, dot);
            self.diagonal[at] = self.own[at];
            self.left[at] = 1.0 - share.mass;
            self.change[at] = 0.0;
        }
        for (at, share) in shares.iter().enumerate() {
            for (other, growth) in share.growth {
                self.diagonal[at] += f64::from(growth);
                self.diagonal[other as usize] += f64::from(growth);
            }
        }
        for ((to, left), diagonal) in self.direction.iter_mut().zip(&self.left).zip(&self.diagonal)
        {
            *to = left / diagonal;
        }
        let mut residual = self.residual();
        let enough = ENOUGH * residual;
        for _ in 0..CONJUGATE_ROUNDS {
            if residual.is_nan() || residual <= enough {
                return;
            }
            self.apply(shares);
            let along: f64 = self.direction.iter().zip(&self.image).map(|(a, b)| a * b).sum();
            if along.is_nan() || along <= 0.0 {
                return;
            }
            let step = residual / along;
            for ((change, left), (direction, image)) in self
                .change
                .iter_mut()
                .zip(&mut self.left)
                .zip(self.direction.iter().zip(&self.image))
            {
                *change += step * direction;
                *left -= step * image;
            }
            let now = self.residual();
            let keep = now / residual;
            residual = now;
            for ((to, left), diagonal) in
                self.direction.iter_mut().zip(&self.left).zip(&self.diagonal)
            {
                *to = left / diagonal + keep * *to;
            }
        }
    }

    fn residual(&self) -> f64 {
        self.left.iter().zip(&self.diagonal).map(|(left, diagonal)| left * left / diagonal).sum()
    }

    /// image = matrix · direction.
    fn apply(&mut self, shares: &[Share]) {
        for ((image, own), direction) in self.image.iter_mut().zip(&self.own).zip(&self.direction) {
            *image = own * direction;
        }
        for (at, share) in shares.iter().enumerate() {
            for (other, growth) in share.growth {
                if growth == 0.0 {
                    break;
                }
                let flow =
                    f64::from(growth) * (self.direction[at] - self.direction[other as usize]);
                self.image[at] += flow;
                self.image[other as usize] -= flow;
            }
        }
    }
}
