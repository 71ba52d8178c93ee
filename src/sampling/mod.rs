//! Samplings: a placement, an importance and an amount, checked, ready to emit points.

mod scale;

use core::fmt;
use core::ops::ControlFlow;

use glam::DVec2;

use crate::clip::Clip;
use crate::domain::{Domain, Region};
use crate::effort::Effort;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::points::{Filled, Points, Sample};
use crate::relaxed::RelaxationTable;
use crate::tiling::{MAX_LEVEL, TileCounts};
use crate::walk;
use crate::walk::either::AnyTraversal;
use crate::walk::scalar::{Coordinate, Position};
use crate::walk::share::Share;

pub(crate) use scale::RankScale;

/// How many points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Amount {
    /// About this many in all: the expected number over all seeds is exactly this, and a single
    /// seed's number is within a fraction of a percent for thousands of points. Needs an importance
    /// that knows its integral.
    Points(f64),
    /// This many a squared unit where the importance is 1.
    Density(f64),
}

/// Limits on the work of one sampling, checked before it starts where that is possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The most points that may be expected. Where the importance does not know its integral, its
    /// upper bound times the area counts.
    pub points: u64,
    /// The most tiles that one walk may visit; each visit can test a few hundred candidates.
    pub tiles: u64,
}

impl Default for Limits {
    /// Four billion points, a hundred billion tiles.
    fn default() -> Self {
        Self { points: 1 << 32, tiles: 100_000_000_000 }
    }
}

/// Why points could not be made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SamplingError {
    /// The amount is NaN, infinite or negative.
    Amount {
        /// The number.
        value: f64,
    },
    /// A count was asked for, but the importance does not know its integral.
    UnknownIntegral,
    /// A count was asked for, but the importance is 0 everywhere, or so close to it that no finite
    /// density makes up for it.
    NoImportance,
    /// More points are expected than [`Limits::points`].
    TooManyPoints {
        /// The number expected.
        expected: f64,
        /// The limit.
        limit: u64,
    },
    /// The density asked for is past the deepest level whose ranks fit 64 bits.
    TooDense {
        /// The centre of the region with that density.
        near: DVec2,
    },
    /// An upper bound is NaN, infinite or negative.
    InvalidBound {
        /// The centre of the region asked about.
        near: DVec2,
        /// The bound.
        bound: f64,
    },
    /// A value is NaN, negative, or above the bound of a region that holds its point.
    InvalidValue {
        /// The point.
        at: DVec2,
        /// The value.
        value: f64,
        /// The bound.
        bound: f64,
    },
    /// The walk visited more tiles than [`Limits::tiles`].
    TilesLimit {
        /// The limit.
        limit: u64,
    },
    /// The placement's tables have no relaxed offsets.
    NoRelaxation,
    /// Weights were asked for of relaxed points, which have none: estimates from them would be biased.
    Relaxed,
    /// There is no such part.
    Shard {
        /// Which part.
        index: usize,
        /// Of how many.
        of: usize,
    },
    /// The position type cannot tell the points of the domain apart: it is too far from the origin for
    /// any number of this precision to lie in it, or its sizes leave the precision's range (for `f32`,
    /// a diagonal outside of some 10⁻³⁰ … 10³⁷).
    Precision,
}

impl fmt::Display for SamplingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Amount { value } => write!(f, "{value} is no amount of points"),
            Self::UnknownIntegral => f.write_str(
                "a number of points needs an importance that knows its integral over the domain",
            ),
            Self::NoImportance => f.write_str("the importance is zero everywhere, or next to it"),
            Self::TooManyPoints { expected, limit } => {
                write!(f, "about {expected:.0} points are expected, the limit is {limit}")
            }
            Self::TooDense { near } => write!(
                f,
                "the density near ({}, {}) is past the deepest level, {MAX_LEVEL}",
                near.x, near.y
            ),
            Self::InvalidBound { near, bound } => {
                write!(f, "the upper bound near ({}, {}) is {bound}", near.x, near.y)
            }
            Self::InvalidValue { at, value, bound } => write!(
                f,
                "the importance at ({}, {}) is {value}, not between 0 and its bound {bound}",
                at.x, at.y
            ),
            Self::TilesLimit { limit } => write!(f, "the walk visited its limit of {limit} tiles"),
            Self::NoRelaxation => f.write_str("the tables have no relaxed offsets"),
            Self::Relaxed => f.write_str(
                "relaxed points have no unbiased weights: use the fixed centres for estimates",
            ),
            Self::Shard { index, of } => write!(f, "there is no part {index} (from 0) of {of}"),
            Self::Precision => {
                f.write_str("positions of this precision cannot resolve the domain; use DVec2")
            }
        }
    }
}

impl core::error::Error for SamplingError {}

/// A point set: fixed by tables, placement, importance and amount, and by nothing else.
///
/// A point of rank k (its fixed place in the placement's sequence) is in the set if and only if
/// k + u < T, where T is the importance at the point in rank units and u ∈ [0, 1) comes from the seed.
/// Fixed u: raising the importance anywhere only ever adds points there.
#[derive(Debug)]
pub struct Sampling<'a, I> {
    placement: &'a Placement<'a>,
    importance: &'a I,
    scale: RankScale,
    expected: Option<f64>,
    limits: Limits,
    relaxed: bool,
    clip: Clip,
    share: Option<Share>,
}

// Derived, these would ask the importance itself to be `Copy`.
impl<I> Copy for Sampling<'_, I> {}
impl<I> Clone for Sampling<'_, I> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, I: Importance> Sampling<'a, I> {
    /// The set of `amount` points under an importance, within the default [`Limits`].
    ///
    /// # Errors
    /// [`SamplingError`], before any work: see its variants.
    pub fn new(
        placement: &'a Placement<'a>,
        importance: &'a I,
        amount: Amount,
    ) -> Result<Self, SamplingError> {
        Self::with_limits(placement, importance, amount, Limits::default())
    }

    /// The same within the caller's limits.
    ///
    /// # Errors
    /// [`SamplingError`], before any work: see its variants.
    pub fn with_limits(
        placement: &'a Placement<'a>,
        importance: &'a I,
        amount: Amount,
        limits: Limits,
    ) -> Result<Self, SamplingError> {
        let domain = placement.domain();
        let (Amount::Points(value) | Amount::Density(value)) = amount;
        if !(value >= 0.0 && value.is_finite()) {
            return Err(SamplingError::Amount { value });
        }
        let integral = importance.integral(&domain);
        let density = match amount {
            Amount::Density(density) => density,
            Amount::Points(0.0) => 0.0,
            Amount::Points(points) => match integral {
                None => return Err(SamplingError::UnknownIntegral),
                Some(integral) if integral > 0.0 && (points / integral).is_finite() => {
                    points / integral
                }
                Some(_) => return Err(SamplingError::NoImportance),
            },
        };
        let expected = integral.map(|integral| integral * density);
        let sampling = Self {
            placement,
            importance,
            scale: RankScale::new(density * placement.ranks_per_density(), placement.rank_shift()),
            expected,
            limits,
            relaxed: false,
            clip: Clip::domain(&domain),
            share: None,
        };
        let region = domain.region();
        let bound = importance.upper_bound(&region);
        sampling.rank_limit_of_bound(bound, &region)?;
        let expected = expected.unwrap_or(bound * density * domain.area());
        // Finite: the bound and the amount are, and an overflow of their product is past any limit.
        if expected.is_nan() || expected > limits.points as f64 {
            return Err(SamplingError::TooManyPoints { expected, limit: limits.points });
        }
        Ok(sampling)
    }

    /// The same points, moved aside by the tables' relaxed offsets, so that they are even at every
    /// density.
    ///
    /// For pictures, scattering and the like. Not for integration: a point is accepted by the density
    /// at its fixed centre and then moved, so that 1/density at the moved point is a biased weight
    /// (by 4 % and more), which is why [`weighted`](Self::weighted) refuses. Not progressive either: a
    /// point's place depends on the density around it. Ranks stay what they are. Where fewer than some four points are expected in a whole domain,
    /// points stay at their centres.
    ///
    /// # Errors
    /// [`SamplingError::NoRelaxation`] if the placement's tables have no relaxed offsets.
    pub fn relaxed(self) -> Result<Self, SamplingError> {
        match self.placement.tables().relaxation() {
            Some(_) => Ok(Self { relaxed: true, ..self }),
            None => Err(SamplingError::NoRelaxation),
        }
    }

    /// Whether points are moved from their tiles' centres.
    pub(crate) fn is_relaxed(&self) -> bool {
        self.relaxed
    }

    /// The offsets by which points are moved, in relaxed mode.
    pub(crate) fn relaxation(&self) -> Option<&'a RelaxationTable<'a>> {
        if self.relaxed { self.placement.tables().relaxation() } else { None }
    }

    /// The points of this set that lie in a half-open rectangle of the caller's coordinates: exactly
    /// those, at a cost in proportion to their number and the rectangle's border. Clipping again
    /// replaces the rectangle. Parts of a walk ([`shard`](Self::shard)) are taken after clipping.
    #[must_use]
    pub fn clipped(self, rectangle: Domain) -> Self {
        let clip = Clip::rectangle_of(&self.placement.domain(), rectangle);
        Self { clip, share: None, ..self }
    }

    /// Part `index` (from 0) of `of` parts of about equal work. The points of all parts, one part
    /// after the other, are those of the whole in the same order; each point is in one part.
    ///
    /// Costs a walk over some twenty tiles a part, which every part's own walk repeats.
    ///
    /// # Errors
    /// [`SamplingError::Shard`] unless `index` < `of`; otherwise as [`visit`](Self::visit).
    pub fn shard(self, index: usize, of: usize) -> Result<Self, SamplingError> {
        if index >= of {
            return Err(SamplingError::Shard { index, of });
        }
        let (grain, total) = self.measure(of)?;
        Ok(self.part(grain, total, index, of))
    }

    /// The grain for so many parts, and the work of all pieces.
    pub(crate) fn measure(&self, parts: usize) -> Result<(u64, u64), SamplingError> {
        let domain = self.placement.domain();
        let expected = match self.expected {
            Some(expected) => expected,
            None => {
                let bound = self.importance.upper_bound(&domain.region());
                bound * self.density() * domain.area()
            }
        };
        let share = expected * self.clip.area() / domain.area() / (8.0 * parts as f64);
        let grain = (share as u64).max(256);
        let measuring = Self { share: Some(Share::nothing(grain)), ..*self };
        let mut traversal = AnyTraversal::new(&measuring);
        while traversal.advance(&measuring)? {}
        Ok((grain, traversal.passed()))
    }

    /// A part of the pieces that [`measure`](Self::measure) has measured.
    pub(crate) fn part(self, grain: u64, total: u64, index: usize, of: usize) -> Self {
        Self { share: Some(Share::part(grain, total, index, of)), ..self }
    }

    /// The part of the plane from which points are taken.
    pub(crate) fn clip(&self) -> Clip {
        self.clip
    }

    /// The part of the walk that is taken.
    pub(crate) fn share(&self) -> Option<Share> {
        self.share
    }

    /// The placement.
    #[must_use]
    pub fn placement(&self) -> &'a Placement<'a> {
        self.placement
    }

    /// The importance.
    #[must_use]
    pub fn importance(&self) -> &'a I {
        self.importance
    }

    /// The limits.
    #[must_use]
    pub fn limits(&self) -> Limits {
        self.limits
    }

    /// The number of points expected over all seeds, if the importance knows its integral. Of the
    /// whole set: clipping and sharing do not change it.
    #[must_use]
    pub fn expected_points(&self) -> Option<f64> {
        self.expected
    }

    /// Points expected in a squared unit where the importance is 1.
    #[must_use]
    pub fn density(&self) -> f64 {
        self.scale.magnification() / self.placement.ranks_per_density()
    }

    /// The same set with T = importance · `magnification` and this u, for tests that need T exact.
    #[cfg(test)]
    pub(crate) fn with_scale(self, magnification: f64, shift: f64) -> Self {
        Self { scale: RankScale::new(magnification, shift), ..self }
    }

    /// From importance to ranks.
    pub(crate) fn scale(&self) -> RankScale {
        self.scale
    }

    /// The number of ranks that an upper bound admits; it need not be one that the library computed.
    #[inline]
    pub(crate) fn rank_limit_of_bound(
        &self,
        bound: f64,
        region: &Region,
    ) -> Result<u64, SamplingError> {
        if !(bound >= 0.0 && bound.is_finite()) {
            return Err(SamplingError::InvalidBound { near: region.centre, bound });
        }
        let limit = self.scale.limit(bound);
        let deepest = TileCounts::HEXAGON.all()[MAX_LEVEL];
        if limit > deepest {
            return Err(SamplingError::TooDense { near: region.centre });
        }
        Ok(limit)
    }

    /// Calls `visit` for each point, in the order of the walk, until it breaks.
    ///
    /// Positions are glam's `Vec2` or `DVec2`, as `visit` takes them. Allocates nothing.
    ///
    /// # Errors
    /// [`SamplingError`] when the importance breaks its own bounds or the walk its limits. Points
    /// visited before that are points of the set.
    pub fn visit<P: Position>(
        &self,
        mut visit: impl FnMut(Sample<P>) -> ControlFlow<()>,
    ) -> Result<(), SamplingError> {
        for sample in self.points()? {
            if visit(sample?).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// Writes positions into the caller's buffer, in the order of the walk, until it is full.
    /// Allocates nothing.
    ///
    /// The fastest way: ground of constant importance is copied from the tables block by block. For
    /// relaxed points of a constant importance, from some 8,000 of them on, it takes 87 KB of stack.
    ///
    /// # Errors
    /// As [`visit`](Self::visit); the buffer then holds some of the points.
    pub fn fill<P: Position>(&self, buffer: &mut [P]) -> Result<Filled, SamplingError> {
        walk::fill::fill(self, buffer)
    }

    /// The same with one buffer a coordinate; the shorter one's length counts.
    ///
    /// # Errors
    /// As [`fill`](Self::fill).
    pub fn fill_columns<S: Coordinate>(
        &self,
        x: &mut [S],
        y: &mut [S],
    ) -> Result<Filled, SamplingError> {
        let length = x.len().min(y.len());
        let (x, y) = (&mut x[..length], &mut y[..length]);
        walk::fill::fill(self, walk::fill::Columns::<S::Position> { x, y })
    }

    /// Counts what the walk does: how many tiles it visits and how many candidates it tests for the
    /// points it makes. Costs a walk.
    ///
    /// # Errors
    /// As [`visit`](Self::visit).
    pub fn effort(&self) -> Result<Effort, SamplingError> {
        Effort::of(self)
    }

    /// An iterator over the points. It holds its state (some 10 KiB) itself and allocates nothing.
    ///
    /// # Errors
    /// [`SamplingError::Precision`] if the position type cannot represent any point of the domain.
    pub fn points<P: Position>(&self) -> Result<Points<'a, I, P>, SamplingError> {
        Points::new(*self)
    }
}
