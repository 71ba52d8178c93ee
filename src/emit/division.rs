//! Parts of a sampling: for several threads or processes, whose points one after the other are the whole.

use super::fill::{self, Columns, Filled};
use super::points::Points;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::position::{Coordinate, Position};
use crate::sampling::Sampling;
use crate::walk::Walk;
use crate::walk::shard::Shard;

/// A sampling divided into parts of about equal work: see [`Sampling::divide`].
#[derive(Debug)]
pub struct Division<'a, I> {
    sampling: Sampling<'a, I>,
    of: usize,
    /// A subtree of at most this much work is one piece.
    grain: u64,
    /// The work of all pieces.
    total: u64,
}

/// A part of a sampling: it can only be received. See [`Sampling::divide`].
#[derive(Debug)]
pub struct Part<'a, I> {
    sampling: Sampling<'a, I>,
    shard: Shard,
}

// Derived, these would ask the importance itself to be `Copy`.
impl<I> Copy for Division<'_, I> {}
impl<I> Clone for Division<'_, I> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<I> Copy for Part<'_, I> {}
impl<I> Clone for Part<'_, I> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, I: Importance> Sampling<'a, I> {
    /// Divides the set, as it is now (relaxed or not, clipped or not), into `of` parts of about equal
    /// work. The points of all parts, one part after the other, are those of the whole in the same order;
    /// each point is in one part.
    ///
    /// Costs a walk over some twenty tiles a part, which every part's own walk repeats.
    ///
    /// ```
    /// use glam::DVec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(3000.0))?.relaxed()?;
    /// let whole = sampling.points::<DVec2>()?.count();
    /// let division = sampling.divide(4)?;
    /// let mut parts = 0;
    /// for index in 0..division.of() {
    ///     parts += division.part(index)?.points::<DVec2>()?.count();
    /// }
    /// assert_eq!(parts, whole);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// # Errors
    /// [`SamplingError::Part`] for no parts; otherwise as [`fill`](Self::fill).
    pub fn divide(self, of: usize) -> Result<Division<'a, I>, SamplingError> {
        if of == 0 {
            return Err(SamplingError::Part { index: 0, of });
        }
        let domain = self.placement().domain();
        let expected = match self.expected_points() {
            Some(expected) => expected,
            None => {
                let bound = self.importance().upper_bound(&domain.disc());
                bound * self.density() * domain.area()
            }
        };
        let share = expected * self.clip().area() / domain.area() / (8.0 * of as f64);
        let grain = (share as u64).max(256);
        let mut walk = Walk::new(&self, Some(Shard::nothing(grain)));
        while walk.advance(&self)? {}
        Ok(Division { sampling: self, of, grain, total: walk.passed() })
    }
}

impl<'a, I: Importance> Division<'a, I> {
    /// The number of parts.
    #[must_use]
    pub fn of(&self) -> usize {
        self.of
    }

    /// Part `index`, from 0.
    ///
    /// # Errors
    /// [`SamplingError::Part`] unless `index` < [`of`](Self::of).
    pub fn part(&self, index: usize) -> Result<Part<'a, I>, SamplingError> {
        let Self { sampling, of, grain, total } = *self;
        if index >= of {
            return Err(SamplingError::Part { index, of });
        }
        Ok(Part { sampling, shard: Shard::part(grain, total, index, of) })
    }

    /// About how many points a part has.
    #[cfg(feature = "parallel")]
    pub(super) fn expected(&self) -> usize {
        (self.total / self.of as u64) as usize
    }
}

impl<'a, I: Importance> Part<'a, I> {
    /// As [`Sampling::fill`], of this part.
    ///
    /// # Errors
    /// As [`Sampling::fill`].
    pub fn fill<P: Position>(&self, buffer: &mut [P]) -> Result<Filled, SamplingError> {
        fill::fill(&self.sampling, Some(self.shard), buffer)
    }

    /// As [`Sampling::fill_columns`], of this part.
    ///
    /// # Errors
    /// As [`Sampling::fill`].
    pub fn fill_columns<S: Coordinate>(
        &self,
        x: &mut [S],
        y: &mut [S],
    ) -> Result<Filled, SamplingError> {
        fill::fill(&self.sampling, Some(self.shard), Columns::<S::Position>::new(x, y))
    }

    /// As [`Sampling::points`], of this part.
    ///
    /// # Errors
    /// As [`Sampling::points`].
    pub fn points<P: Position>(&self) -> Result<Points<'a, I, P>, SamplingError> {
        Points::new(self.sampling, Some(self.shard))
    }
}
