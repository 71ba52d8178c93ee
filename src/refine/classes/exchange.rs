//! Neighbors that exchange their classes where that makes both classes evener.
//!
//! The energy of a class is that of its dots as charges that repel each other, in a field that draws
//! them where they should be:
//!
//! E = Σ pairs φ(|p − q| / R) − Σ dots ∫ density(m) φ(|p − m| / R),   φ(u) = (1 − u²)₊⁴,   R = REACH spacings
//!
//! so that a dot whose class at another's place would be under less of both gains by going there. What a
//! dot of each class would be under is kept for every dot, and changed by each exchange.

use alloc::vec::Vec;

use super::super::cells::{Cells, LANES};
use super::super::error::{RefineError, filled};
use super::super::work::Work;
use super::class::Class;
use super::pyramid::weight;
use crate::simd::Simd;
use crate::threads::{PART, for_parts};

/// Reach of a class's dots, in its spacings. Of four equal classes of 6,000 dots, mean nearest distance and power
/// at low frequency of each: .82 and .04 at 1.5, .69 and .03 at 2, .59 and .17 at 3.
const REACH: f32 = 1.5;
/// No farther than this, in spacings of all dots: one of a rare class would be felt by all there are. Beyond,
/// rare dots stay as even as they were assigned.
const FARTHEST: f32 = 16.0;
/// How far away a dot to exchange with may be, in spacings of all dots.
const NEAR: f32 = 2.0;
/// Gains below this are rounding.
const LEAST_GAIN: f32 = 1e-4;

/// What a dot of each class would be under at each dot's place.
#[derive(Debug)]
pub(super) struct Exchange {
    classes: usize,
    /// By the dots' places in cells, and class: Σ φ of the class's other dots less what the density draws.
    under: Vec<f32>,
    /// 1 / R², negative where the pixel wants nothing of the class.
    inverse: Vec<f32>,
}

/// The reach of which this is the square's inverse, with its sign.
#[inline(always)]
fn reach_of(inverse: f32) -> f32 {
    1.0 / inverse.abs().sqrt()
}

impl Exchange {
    pub(super) fn new(dots: usize, classes: usize) -> Result<Self, RefineError> {
        let numbers = dots.saturating_mul(classes);
        Ok(Self { classes, under: filled(numbers, 0.0)?, inverse: filled(numbers, 0.0)? })
    }

    /// Looks at where the dots are: all sorted into cells, and those of each class.
    pub(super) fn prepare(
        &mut self,
        all: &Work<'_>,
        classes: &[Option<Class<'_>>],
        class_of: &[u8],
    ) {
        let count = self.classes;
        for_parts(&mut self.inverse, PART * count, |start, inverse| {
            for (at, inverse) in inverse.chunks_mut(count).enumerate() {
                let dot = &all.dots[start / count + at];
                let farthest = FARTHEST * all.density.spacing(dot.x, dot.y);
                for (inverse, class) in inverse.iter_mut().zip(classes) {
                    *inverse = class.as_ref().map_or(-1.0, |class| {
                        let reach = REACH * class.density.spacing(dot.x, dot.y);
                        let reach = if reach < farthest { reach } else { farthest };
                        let sign = if class.ink.holds(dot.x, dot.y) { 1.0 } else { -1.0 };
                        sign / (reach * reach)
                    });
                }
            }
        });
        let inverse = self.inverse.as_slice();
        for_parts(&mut self.under, PART * count, |start, under| {
            Simd::detect().run(
                #[inline(always)]
                || {
                    for (at, under) in under.chunks_mut(count).enumerate() {
                        let dot = &all.dots[start / count + at];
                        let own = usize::from(class_of[dot.index as usize]);
                        let inverses = &inverse[start + at * count..][..count];
                        for (number, (under, class)) in under.iter_mut().zip(classes).enumerate() {
                            let Some(class) = class else { continue };
                            let reach = reach_of(inverses[number]);
                            let itself = if number == own { 1.0 } else { 0.0 };
                            *under = repelled(&class.cells, dot.x, dot.y, reach)
                                - itself
                                - class.pyramid.drawn(dot.x, dot.y, reach);
                        }
                    }
                },
            );
        });
    }

    /// Every dot exchanges with the neighbor with which that gains most, if any. Returns how many did. One
    /// thread, in the dots' order: each sees what the ones before it did.
    pub(super) fn round(&mut self, all: &Work<'_>, class_of: &mut [u8]) -> usize {
        let mut exchanges = 0;
        for i in 0..all.dots.len() {
            let one = &all.dots[i];
            let reach = NEAR * all.density.spacing(one.x, one.y);
            let a = usize::from(class_of[one.index as usize]);
            let mut best = (-LEAST_GAIN, usize::MAX);
            for run in all.cells.runs(one.x, one.y, reach) {
                for j in run {
                    let other = &all.dots[j];
                    let b = usize::from(class_of[other.index as usize]);
                    let (dx, dy) = (other.x - one.x, other.y - one.y);
                    let squared = dx * dx + dy * dy;
                    if b == a || squared > reach * reach {
                        continue;
                    }
                    let change = self.change(i, j, a, b, squared);
                    if change < best.0 {
                        best = (change, j);
                    }
                }
            }
            let (_, j) = best;
            if j == usize::MAX {
                continue;
            }
            let other = &all.dots[j];
            let b = usize::from(class_of[other.index as usize]);
            class_of[one.index as usize] = b as u8;
            class_of[other.index as usize] = a as u8;
            self.moved(all, a, i, j);
            self.moved(all, b, j, i);
            exchanges += 1;
        }
        exchanges
    }

    /// What energy an exchange of dot i of class a with dot j of class b would add; infinite where a pixel
    /// wants nothing of the class that it would get.
    #[inline(always)]
    fn change(&self, i: usize, j: usize, a: usize, b: usize, squared: f32) -> f32 {
        let (i, j) = (i * self.classes, j * self.classes);
        let (a_there, b_here) = (self.inverse[j + a], self.inverse[i + b]);
        if a_there < 0.0 || b_here < 0.0 {
            return f32::INFINITY;
        }
        let of_a = self.under[j + a] - weight(squared * a_there) - self.under[i + a];
        let of_b = self.under[i + b] - weight(squared * b_here) - self.under[j + b];
        of_a + of_b
    }

    /// A dot of this class is now at dot `to`, and no longer at dot `from`.
    fn moved(&mut self, all: &Work<'_>, class: usize, from: usize, to: usize) {
        for (place, sign) in [(from, -1.0_f32), (to, 1.0)] {
            let dot = &all.dots[place];
            // those somewhat farther may reach it where theirs is larger
            let reach = 1.25 * reach_of(self.inverse[place * self.classes + class]);
            for run in all.cells.runs(dot.x, dot.y, reach) {
                for m in run {
                    let other = &all.dots[m];
                    let (dx, dy) = (other.x - dot.x, other.y - dot.y);
                    let at = m * self.classes + class;
                    let change = weight((dx * dx + dy * dy) * self.inverse[at].abs());
                    if m != place {
                        self.under[at] += sign * change;
                    }
                }
            }
        }
    }
}

/// Σ φ of all dots in reach, the one at (x, y) too.
#[inline(always)]
fn repelled(cells: &Cells, x: f32, y: f32, reach: f32) -> f32 {
    let inverse = 1.0 / (reach * reach);
    let mut sums = [0.0_f32; LANES];
    for run in cells.runs(x, y, reach) {
        let mut left = run.len();
        // the last lanes may read past the run: the list ends with eight that are nowhere
        let xs = cells.x[run.start..run.end + LANES - 1].windows(LANES).step_by(LANES);
        let ys = cells.y[run.start..run.end + LANES - 1].windows(LANES).step_by(LANES);
        for (xs, ys) in xs.zip(ys) {
            for lane in 0..LANES {
                let (dx, dy) = (x - xs[lane], y - ys[lane]);
                let some = weight((dx * dx + dy * dy) * inverse);
                sums[lane] += if lane < left { some } else { 0.0 };
            }
            left = left.saturating_sub(LANES);
        }
    }
    sums.iter().sum()
}
