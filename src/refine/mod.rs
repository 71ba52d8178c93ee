//! Dots that draw a picture: any points, moved until they are even and have the picture's tone.
//!
//! [`refine`] does it, [`best`] takes longer and is right to the single dot, and a [`Refiner`] goes step by step.
//!
//! Needs the feature `std`; with `parallel`, rayon's threads share the work.
//!
//! Each of about ten iterations moves every dot twice. First by a force, the gradient of the difference
//! between dots and picture, both blurred by a small kernel as wide as the local spacing: dots push their
//! neighbors away and the picture's ink pulls them. Then by a flow on a coarse grid that evens out what is
//! too much or too little over several spacings. Dots never enter pixels that are 0.
//!
//! ```
//! use glam::DVec2;
//! use twelvefold::refine::Refiner;
//!
//! // Nothing on the left, a ramp on the right; a hundred dots on a regular grid.
//! let pixels: Vec<f32> = (0..64 * 64).map(|i| ((i % 64) as f32 - 16.0).max(0.0)).collect();
//! let mut dots: Vec<DVec2> =
//!     (0..100).map(|i| DVec2::new((i % 10) as f64, (i / 10) as f64) * 6.4 + 3.2).collect();
//!
//! let mut refiner = Refiner::new(64, 64, &pixels, &dots)?;
//! for _ in 0..10 {
//!     refiner.step(); // show progress, or stop, between any two
//! }
//! refiner.write(&mut dots)?; // dot i is where dot i went
//! assert!(dots.iter().all(|dot| dot.x >= 17.0 && dot.x < 64.0));
//! # Ok::<(), twelvefold::refine::RefineError>(())
//! ```
//!
//! Same points and picture, same dots, to the bit: on every machine, for any number of threads. Only +, −,
//! ×, ÷ and √ are used, in a fixed order. Positions are `f32` while they are refined: a picture
//! of 4,000 pixels has 4,096 places between two of them.
//!
//! # Stages
//!
//! `ink`: where dots may be. `density`: dots a pixel and spacing. `start` and `spread`: dots as they came, made fit.
//! `cells`: who is near. `force`, then `coarse` and `conjugate`: the two moves. `classes`: dots of several kinds.
//! `polish`, with `power` and `share`: the one move that [`Refiner::polish`] adds. `work`: what a
//! refiner keeps.

mod cells;
mod classes;
mod coarse;
mod conjugate;
mod density;
mod error;
mod force;
mod ink;
mod polish;
mod power;
mod share;
mod spread;
mod start;
#[cfg(test)]
mod tests;
mod work;

use crate::position::Position;
use crate::simd::Simd;

pub use classes::{ClassRefiner, Classes};
pub use error::RefineError;
use work::{Work, write};

/// Iterations after which more gain little: the default of the program.
pub const ITERATIONS: usize = 10;

/// Dots on their way.
///
/// Memory, beyond the borrowed picture: 60 bytes a dot for the dots and about 30 for the grids; 8 bytes a
/// pixel, and 8 more while it is made. Where the dots are so dense that pixels are divided, up to 100
/// more a dot; where they are so sparse that pixels are taken in groups, less a pixel.
#[derive(Debug)]
pub struct Refiner<'a> {
    /// Nothing to do without dots.
    work: Option<Work<'a>>,
}

impl<'a> Refiner<'a> {
    /// Dots at `points`, in pixels, x to the right and y down from the picture's upper left corner, to draw
    /// a picture of `width` × `height` pixels, row by row: importance, 0 where no dot may be.
    ///
    /// Points outside of the picture and on pixels that are 0 are brought to the nearest pixel above
    /// 0; points that lie on each other are parted. Each island of ink gets its share of the dots, and if they
    /// come badly spread, as random points do, they are handed out anew everywhere.
    ///
    /// # Errors
    /// Another number of pixels than width × height; a pixel that is NaN, infinite or negative; points but no
    /// pixel above 0; a point that is not finite; too little memory.
    pub fn new<P: Position>(
        width: usize,
        height: usize,
        pixels: &'a [f32],
        points: &[P],
    ) -> Result<Self, RefineError> {
        Ok(Self { work: Work::new(width, height, pixels, points, false)? })
    }

    /// One iteration.
    pub fn step(&mut self) {
        if let Some(work) = &mut self.work {
            work.relax();
            Simd::detect().run(
                #[inline(always)]
                || work.coarse.drift(&work.ink, &mut work.dots),
            );
        }
    }

    /// Parts the picture into one cell for each dot, all of the same mass as far as islands of ink allow, and
    /// moves every dot to the center of its cell: the tone about each dot is then right to half a percent. Best
    /// after ten [`Self::step`]s, which bring dots to where that is a small move; once is enough. As long as some
    /// twenty steps, with some 250 bytes a dot more while it runs.
    ///
    /// # Errors
    /// Too little memory. The dots are then as they were.
    pub fn polish(&mut self) -> Result<(), RefineError> {
        let Some(work) = &mut self.work else { return Ok(()) };
        work.sort();
        polish::polish(&work.ink, &work.density, &work.cells, &mut work.dots)
    }

    /// Writes where the dots are now, in the order of the points that they were.
    ///
    /// # Errors
    /// If `points` is not as long as the points that the dots were.
    pub fn write<P: Position>(&self, points: &mut [P]) -> Result<(), RefineError> {
        write(self.work.as_ref().map_or(&[][..], |work| &work.dots), points)
    }
}

/// Refines `points` by `iterations` steps of a [`Refiner`]; [`ITERATIONS`] are enough for most.
///
/// # Errors
/// As [`Refiner::new`]; the points are then as they were.
pub fn refine<P: Position>(
    points: &mut [P],
    width: usize,
    height: usize,
    pixels: &[f32],
    iterations: usize,
) -> Result<(), RefineError> {
    stepped(points, width, height, pixels, iterations)?.write(points)
}

/// A refiner of points after some steps.
fn stepped<'a, P: Position>(
    points: &[P],
    width: usize,
    height: usize,
    pixels: &'a [f32],
    iterations: usize,
) -> Result<Refiner<'a>, RefineError> {
    let mut refiner = Refiner::new(width, height, pixels, points)?;
    for _ in 0..iterations {
        refiner.step();
    }
    Ok(refiner)
}

/// [`refine`], and then [`Refiner::polish`]: the best that dots can draw a picture, in three times the time.
///
/// ```
/// use glam::DVec2;
/// use twelvefold::refine::best;
///
/// // Half of all ink lies in the upper left quarter, and with it half of the dots.
/// let ink = |i: usize| if i % 32 < 16 && i / 32 < 16 { 1.0 } else { 1.0 / 3.0 };
/// let pixels: Vec<f32> = (0..32 * 32).map(ink).collect();
/// let mut dots: Vec<DVec2> =
///     (0..144).map(|i| DVec2::new((i % 12) as f64, (i / 12) as f64) * 2.6 + 1.3).collect();
/// best(&mut dots, 32, 32, &pixels, twelvefold::refine::ITERATIONS)?;
/// let inside = dots.iter().filter(|dot| dot.max_element() < 16.0).count();
/// assert!(inside.abs_diff(72) <= 3);
/// # Ok::<(), twelvefold::refine::RefineError>(())
/// ```
///
/// # Errors
/// As [`Refiner::new`] and [`Refiner::polish`]; the points are then as they were.
pub fn best<P: Position>(
    points: &mut [P],
    width: usize,
    height: usize,
    pixels: &[f32],
    iterations: usize,
) -> Result<(), RefineError> {
    let mut refiner = stepped(points, width, height, pixels, iterations)?;
    refiner.polish()?;
    refiner.write(points)
}
