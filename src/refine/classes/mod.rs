//! Dots of several classes, such as the pens of a drawing: all together they are even, and so are those of
//! each class.
//!
//! The method is that of [`refine`](super) with one energy more. A dot is pushed by all dots, whose density
//! should be the sum of the classes', and more widely by those of its own class, whose density should be
//! the class's; and neighbors exchange their classes where that makes either class evener. Moves alone
//! would have to carry a dot through its neighbors, and exchanges alone would have to do with the places
//! that there are. Multi-class blue noise: Wei 2010; both energies at once: Qin et al. 2017.
//!
//! `planes`: what is wanted. `class`, with `pyramid`: one class's dots and what they are drawn by. `assign`: a
//! class for each dot. `exchange`: neighbors that change theirs.

mod assign;
mod class;
mod exchange;
mod planes;
mod pyramid;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use super::error::{RefineError, filled, reserve};
use super::work::{self, FURTHEST, MOMENTUM, STEP, Work};
use super::{force, polish};
use crate::position::Position;
use crate::simd::Simd;
use crate::threads::{PART, for_parts};
use class::Class;
use exchange::Exchange;
pub use planes::Classes;

/// Weight of the force of a dot's own class beside that of all dots, both in spacings of their own. Of four equal
/// classes of 6,000 dots, mean nearest distance of all and of each: .920 and .81 at .15, .912 and .82 at .3,
/// .896 and .83 at .6, .876 and .85 at 1.
const CLASS_FORCE: f32 = 0.3;
/// Rounds of exchanges before the first move.
const FIRST_EXCHANGES: usize = 6;

/// Dots of several classes on their way.
///
/// Memory, beyond that of a [`Refiner`](super::Refiner): 60 bytes a dot, 8 more for each class; 15 bytes a pixel for each
/// class.
///
/// ```
/// use glam::DVec2;
/// use twelvefold::refine::{ClassRefiner, Classes};
///
/// // Twice as many of the first class as of the second, everywhere.
/// let classes = Classes::new(48, 48, vec![vec![0.6; 48 * 48], vec![0.3; 48 * 48]])?;
/// let mut dots: Vec<DVec2> =
///     (0..144).map(|i| DVec2::new((i % 12) as f64, (i / 12) as f64) * 4.0 + 2.0).collect();
/// let mut class = vec![0; dots.len()];
///
/// let mut refiner = ClassRefiner::new(&classes, &dots)?;
/// for _ in 0..10 {
///     refiner.step();
/// }
/// refiner.write(&mut dots, &mut class)?; // dot i is where dot i went
/// let first = class.iter().filter(|class| **class == 0).count();
/// assert!((95..=97).contains(&first));
/// # Ok::<(), twelvefold::refine::RefineError>(())
/// ```
#[derive(Debug)]
pub struct ClassRefiner<'a> {
    /// Nothing to do without dots.
    work: Option<ClassWork<'a>>,
}

#[derive(Debug)]
struct ClassWork<'a> {
    all: Work<'a>,
    /// `None` where no dot is of this class.
    classes: Vec<Option<Class<'a>>>,
    /// By the dots' indices.
    class_of: Vec<u8>,
    exchange: Exchange,
    /// Where dots were before a move that asks nothing about classes.
    before: Vec<[f32; 2]>,
}

impl<'a> ClassRefiner<'a> {
    /// Dots at `points`, in pixels, which should be even already, as those of a [`Refiner`](super::Refiner) of the classes'
    /// [`total`](Classes::total) are: classes are assigned, and exchanged while that is of use. Each class
    /// gets its share of the dots, to one or two.
    ///
    /// Points outside of the picture and on pixels that are 0 in all classes are brought to the nearest pixel
    /// above 0; points that lie on each other are parted.
    ///
    /// # Errors
    /// Points but no pixel above 0; a point that is not finite; too little memory.
    pub fn new<P: Position>(classes: &'a Classes, points: &[P]) -> Result<Self, RefineError> {
        let (width, height) = (classes.width, classes.height);
        let Some(mut all) = Work::new(width, height, &classes.total, points, true)? else {
            return Ok(Self { work: None });
        };
        let class_of = assign::assign(classes, &all.dots)?;
        let mut counts = [0; Classes::MOST];
        class_of.iter().for_each(|class| counts[usize::from(*class)] += 1);
        let mut some = reserve(classes.planes.len())?;
        for (plane, count) in counts.iter().enumerate().take(classes.planes.len()) {
            some.push(Class::new(classes, plane, *count)?);
        }
        all.sort();
        let dots = all.dots.len();
        let mut work = ClassWork {
            all,
            exchange: Exchange::new(dots, some.len())?,
            classes: some,
            class_of,
            before: filled(dots, [0.0; 2])?,
        };
        work.sort_classes();
        work.exchange(FIRST_EXCHANGES);
        Ok(Self { work: Some(work) })
    }

    /// One iteration: moves, then exchanges.
    pub fn step(&mut self) {
        if let Some(work) = &mut self.work {
            work.relax();
            work.drift();
            work.all.sort();
            work.sort_classes();
            work.exchange(1);
        }
    }

    /// Makes the tone about each dot right, as [`Refiner::polish`](super::Refiner::polish) does; those of a class come
    /// somewhat nearer to each other by it. For after the last [`step`](Self::step).
    ///
    /// # Errors
    /// Too little memory. The dots are then as they were.
    pub fn polish(&mut self) -> Result<(), RefineError> {
        let Some(work) = &mut self.work else { return Ok(()) };
        work.all.sort();
        work.note();
        let Work { ink, density, cells, dots, .. } = &mut work.all;
        polish::polish(ink, density, cells, dots)?;
        work.call_back();
        work.all.sort();
        work.sort_classes();
        work.exchange(FIRST_EXCHANGES);
        Ok(())
    }

    /// Writes where the dots are now and their classes, in the order of the points that they were.
    ///
    /// # Errors
    /// If `points` or `classes` is not as long as the points that the dots were.
    pub fn write<P: Position>(
        &self,
        points: &mut [P],
        classes: &mut [u8],
    ) -> Result<(), RefineError> {
        let class_of = self.work.as_ref().map_or(&[][..], |work| &work.class_of);
        if class_of.len() != classes.len() {
            return Err(RefineError::Length { expected: class_of.len(), found: classes.len() });
        }
        let dots = self.work.as_ref().map_or(&[][..], |work| &work.all.dots);
        work::write(dots, points)?;
        classes.copy_from_slice(class_of);
        Ok(())
    }
}

impl ClassWork<'_> {
    /// The cells of each class, from all dots in their order.
    fn sort_classes(&mut self) {
        for (class, number) in self.classes.iter_mut().zip(0_u8..) {
            let Some(class) = class else { continue };
            let own =
                self.all.dots.iter().filter(|dot| self.class_of[dot.index as usize] == number);
            class.dots.iter_mut().zip(own).for_each(|(to, dot)| *to = *dot);
            class.cells.sort(&class.dots, &mut class.sorted);
        }
    }

    fn exchange(&mut self, rounds: usize) {
        self.exchange.prepare(&self.all, &self.classes, &self.class_of);
        for _ in 0..rounds {
            if self.exchange.round(&self.all, &mut self.class_of) == 0 {
                break;
            }
        }
        self.sort_classes();
    }

    /// Moves every dot by both forces on it, all from where they were.
    fn relax(&mut self) {
        let Self { all, classes, class_of, .. } = self;
        let Work { ink, density, cells, dots, .. } = all;
        let (classes, class_of): (&[_], &[u8]) = (classes, class_of);
        let size = [ink.width as f32, ink.height as f32];
        for_parts(dots, PART, |_, dots| {
            Simd::detect().run(
                #[inline(always)]
                || {
                    for dot in dots {
                        let number = class_of[dot.index as usize];
                        let Some(Some(class)) = classes.get(usize::from(number)) else { continue };
                        let at = [dot.x, dot.y];
                        let spacing = density.spacing(dot.x, dot.y);
                        let own_spacing = class.density.spacing(dot.x, dot.y);
                        let [fx, fy] = force::force(cells, density, size, at, spacing);
                        let [gx, gy] =
                            force::force(&class.cells, &class.density, size, at, own_spacing);
                        // in spacings of its class, as the other is in spacings of all
                        let weight = CLASS_FORCE * spacing / own_spacing;
                        let dx = MOMENTUM * dot.vx + STEP * (fx + weight * gx);
                        let dy = MOMENTUM * dot.vy + STEP * (fy + weight * gy);
                        let length = (dx * dx + dy * dy).sqrt();
                        let most = FURTHEST * spacing;
                        let share = if length > most { most / length } else { 1.0 };
                        let (dx, dy) = (dx * share, dy * share);
                        let (x, y) = class.ink.slide(dot.x, dot.y, dx, dy);
                        let free = x == dot.x + dx && y == dot.y + dy;
                        (dot.vx, dot.vy) = if free { (dx, dy) } else { (0.0, 0.0) };
                        (dot.x, dot.y) = (x, y);
                    }
                },
            );
        });
    }

    /// Evens out what is too much or too little of all dots; none leaves the ink of its class.
    fn drift(&mut self) {
        self.note();
        let Work { ink, coarse, dots, .. } = &mut self.all;
        Simd::detect().run(
            #[inline(always)]
            || coarse.drift(ink, dots),
        );
        self.call_back();
    }

    /// Notes where the dots are.
    fn note(&mut self) {
        for (before, dot) in self.before.iter_mut().zip(&self.all.dots) {
            *before = [dot.x, dot.y];
        }
    }

    /// Brings dots that have left the ink of their class back to where they were noted.
    fn call_back(&mut self) {
        for (before, dot) in self.before.iter().zip(&mut self.all.dots) {
            let number = self.class_of[dot.index as usize];
            let class = self.classes.get(usize::from(number)).and_then(Option::as_ref);
            if !class.is_some_and(|class| class.ink.holds(dot.x, dot.y)) {
                [dot.x, dot.y] = *before;
            }
        }
    }
}
