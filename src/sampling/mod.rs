//! Samplings: a placement, an importance and an amount, checked, ready to emit points.

mod clip;
mod scale;

use crate::domain::{Disc, Domain};
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::tables::DisplacementTable;

pub(crate) use clip::{Clip, ToWorld};
pub(crate) use scale::RankScale;

/// How many points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// By what points are moved, if they are.
    displacements: Option<&'a DisplacementTable<'a>>,
    /// Whether it is known that moved points may go anywhere in the domain.
    unconstrained: bool,
    clip: Clip,
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
        Self::within(placement, importance, amount, Limits::default())
    }

    /// The same within the caller's limits.
    ///
    /// # Errors
    /// [`SamplingError`], before any work: see its variants.
    pub fn within(
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
            displacements: None,
            unconstrained: false,
            clip: Clip::domain(&domain),
        };
        let region = domain.disc();
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
    /// at its fixed center and then moved, so that 1/density at the moved point is a biased weight
    /// (by 4 % and more), which is why [`weighted`](Self::weighted) refuses. Not progressive either: a
    /// point's place depends on the density around it. Ranks stay what they are. Where fewer than some four
    /// points are expected in a whole domain, points stay at their centers.
    ///
    /// # Errors
    /// [`SamplingError::NoDisplacements`] if the placement's tables have no relaxed offsets.
    ///
    /// ```
    /// use glam::Vec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let fixed = Sampling::new(&placement, &Constant::ONE, Amount::Points(1000.0))?;
    /// let even = fixed.relaxed()?;
    /// let least = |sampling: &Sampling<'_, Constant>| {
    ///     let mut points = [Vec2::ZERO; 1200];
    ///     let written = sampling.fill(&mut points)?.written;
    ///     let pairs = (0..written).flat_map(|i| (0..i).map(move |j| (i, j)));
    ///     Ok::<_, twelvefold::SamplingError>(
    ///         pairs.map(|(i, j)| points[i].distance(points[j])).fold(1.0, f32::min),
    ///     )
    /// };
    /// assert!(least(&even)? > 1.2 * least(&fixed)?);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    pub fn relaxed(self) -> Result<Self, SamplingError> {
        match self.placement.tables().displacements() {
            Some(displacements) => {
                let domain = self.placement.domain().disc();
                let unconstrained = !self.importance.constrains_everywhere()
                    && self.importance.lower_bound(&domain) > 0.0;
                Ok(Self { displacements: Some(displacements), unconstrained, ..self })
            }
            None => Err(SamplingError::NoDisplacements),
        }
    }

    /// Whether it is known that moved points may go anywhere in the domain: the importance is nowhere 0.
    #[inline]
    pub(crate) fn unconstrained(&self) -> bool {
        self.unconstrained
    }

    /// The displacements by which points are moved, in relaxed mode.
    #[inline(always)]
    pub(crate) fn displacements(&self) -> Option<&'a DisplacementTable<'a>> {
        self.displacements
    }

    /// The points of this set that lie in a half-open rectangle of the caller's coordinates: exactly
    /// those, at a cost in proportion to their number and the rectangle's border. Clipping again
    /// replaces the rectangle.
    ///
    /// ```
    /// use glam::{DVec2, Vec2};
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let quarter = Domain::new(DVec2::ZERO, DVec2::splat(0.5))?;
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(4000.0))?;
    /// let mut buffer = [Vec2::ZERO; 1200];
    /// let filled = sampling.clipped(quarter).fill(&mut buffer)?;
    /// assert!(filled.written.abs_diff(1000) < 40);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn clipped(self, rectangle: Domain) -> Self {
        Self { clip: Clip::rectangle_of(&self.placement.domain(), rectangle), ..self }
    }

    /// The part of the plane from which points are taken.
    pub(crate) fn clip(&self) -> Clip {
        self.clip
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
    /// whole set: clipping does not change it.
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
        region: &Disc,
    ) -> Result<u64, SamplingError> {
        if !(bound >= 0.0 && bound.is_finite()) {
            return Err(SamplingError::InvalidBound { near: region.center, bound });
        }
        let limit = self.scale.limit(bound);
        if limit > self.placement.deepest_count() {
            return Err(SamplingError::TooDense { near: region.center });
        }
        Ok(limit)
    }
}
