//! Dots on their way to where they draw the picture: what a refiner keeps, and its moves by force.

use alloc::vec::Vec;

use super::cells::{self, Cells, Dot};
use super::coarse::Coarse;
use super::density::Density;
use super::error::{RefineError, filled};
use super::ink::Ink;
use super::{force, start};
use crate::position::{Position, Scalar};
use crate::simd::Simd;
use crate::threads::{PART, for_parts};

/// Share of the last move that a dot keeps. Ten iterations with .4 leave the nearest dots nearer (first
/// percentile of distances .719 of hexagonal, .730 with .5); .7 overshoots.
pub(super) const MOMENTUM: f32 = 0.5;
/// Pixels a unit of force. The kernel's curvature is 12.73 / R⁴ for a spacing of 1. .15 is slower (structural
/// similarity .683 after ten iterations at 15,000 dots, .6855 with .2); steps above .2 clump.
pub(super) const STEP: f32 =
    0.2 * 12.732 / (force::REACH * force::REACH * force::REACH * force::REACH);
/// The furthest that the force moves a dot in one iteration, in spacings.
pub(super) const FURTHEST: f32 = 0.3;

#[derive(Debug)]
pub(super) struct Work<'a> {
    pub(super) ink: Ink<'a>,
    pub(super) density: Density,
    pub(super) coarse: Coarse,
    pub(super) cells: Cells,
    pub(super) dots: Vec<Dot>,
    pub(super) sorted: Vec<Dot>,
}

impl<'a> Work<'a> {
    /// See [`Refiner::new`](super::Refiner::new); points that are `spread` well stay where they are, if that is on ink. `None` without any.
    pub(super) fn new<P: Position>(
        width: usize,
        height: usize,
        pixels: &'a [f32],
        points: &[P],
        spread: bool,
    ) -> Result<Option<Self>, RefineError> {
        let ink = Simd::detect().run(
            #[inline(always)]
            || Ink::new(width, height, pixels),
        )?;
        if points.is_empty() {
            return Ok(None);
        }
        let xy = |point: &P| point.xy().map(Scalar::to_f64);
        let mut dots = cells::dots(points.iter().map(xy))?;
        let ink = ink.ok_or(RefineError::NoInk)?;
        let density = Simd::detect().run(
            #[inline(always)]
            || Density::new(&ink, dots.len()),
        )?;
        let cells = Cells::new(&ink, dots.len(), density.usual_spacing)?;
        let mut coarse = Simd::detect().run(
            #[inline(always)]
            || Coarse::new(&ink, &density, dots.len()),
        )?;
        if spread {
            start::admit(&ink, &density, &mut dots)?;
        } else {
            start::prepare(&ink, &density, &mut coarse, &mut dots)?;
        }
        let sorted = filled(dots.len(), Dot::default())?;
        Ok(Some(Self { ink, density, coarse, cells, dots, sorted }))
    }

    /// Puts the dots in the order of the cells.
    pub(super) fn sort(&mut self) {
        self.cells.sort(&self.dots, &mut self.sorted);
        core::mem::swap(&mut self.dots, &mut self.sorted);
    }

    /// Moves every dot by the force on it, all from where they were.
    pub(super) fn relax(&mut self) {
        self.sort();
        let (ink, density, cells) = (&self.ink, &self.density, &self.cells);
        let size = [ink.width as f32, ink.height as f32];
        for_parts(&mut self.dots, PART, |_, dots| {
            Simd::detect().run(
                #[inline(always)]
                || {
                    for dot in dots {
                        let spacing = density.spacing(dot.x, dot.y);
                        let [fx, fy] = force::force(cells, density, size, [dot.x, dot.y], spacing);
                        let dx = MOMENTUM * dot.vx + STEP * fx;
                        let dy = MOMENTUM * dot.vy + STEP * fy;
                        let length = (dx * dx + dy * dy).sqrt();
                        let most = FURTHEST * spacing;
                        let share = if length > most { most / length } else { 1.0 };
                        let (dx, dy) = (dx * share, dy * share);
                        let (x, y) = ink.slide(dot.x, dot.y, dx, dy);
                        let free = x == dot.x + dx && y == dot.y + dy;
                        (dot.vx, dot.vy) = if free { (dx, dy) } else { (0.0, 0.0) };
                        (dot.x, dot.y) = (x, y);
                    }
                },
            );
        });
    }
}

/// Writes each dot to the place of the point that it was.
pub(super) fn write<P: Position>(dots: &[Dot], points: &mut [P]) -> Result<(), RefineError> {
    if dots.len() != points.len() {
        return Err(RefineError::Length { expected: dots.len(), found: points.len() });
    }
    for dot in dots {
        let coordinate = |value: f32| P::Scalar::from_f64(f64::from(value));
        points[dot.index as usize] = P::from_xy(coordinate(dot.x), coordinate(dot.y));
    }
    Ok(())
}
