//! Exactly n points, in progressive order.

use alloc::vec::Vec;
use core::fmt;

use super::Weighted;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::sampling::{Amount, Limits, Sampling, SamplingError};

/// Why there are no n points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExactError {
    /// The points cannot be made at all, or n is past the [`Limits`].
    Sampling(SamplingError),
    /// The importance is above 0 on so small a part of the domain that its n-th point lies past the
    /// deepest level, or on none of it.
    TooFew {
        /// The number of points asked for.
        asked: usize,
        /// The number found at the greatest density.
        found: usize,
    },
}

impl fmt::Display for ExactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sampling(error) => error.fmt(f),
            Self::TooFew { asked, found } => {
                write!(f, "the importance has room for {found} points, not {asked}")
            }
        }
    }
}

impl core::error::Error for ExactError {}

impl From<SamplingError> for ExactError {
    fn from(error: SamplingError) -> Self {
        Self::Sampling(error)
    }
}

/// A point's key: the magnification at which it appears. Keys decide, equal keys by rank, which is
/// unique.
#[derive(Clone, Copy)]
struct Candidate {
    key: f64,
    point: Weighted,
}

impl Candidate {
    fn order(&self, other: &Self) -> core::cmp::Ordering {
        // Keys are not NaN: importance of an accepted point is above 0 and finite.
        self.key.total_cmp(&other.key).then(self.point.rank.cmp(&other.point.rank))
    }
}

/// The `n` points that appear first as the density rises: those with the smallest
/// (rank + u)/importance, in this order.
///
/// Each prefix is the set for a smaller n: a good set itself. Ties, which only rounding can make, go to
/// the smaller rank. The choice depends on placement and importance alone.
///
/// Weights are for the whole set: density is n·importance/∫importance where the importance knows its
/// integral (the self-normalised weight), else importance × the density at which the next point would
/// appear. For the first k points multiply weights by n/k. Both are biased by O(1/n).
///
/// One walk that finds slightly more than n points, and one sort: some 60 ns a point more than
/// [`Sampling::points`], and 48 bytes a point of memory.
///
/// # Errors
/// [`ExactError`]: all that [`Sampling::with_limits`] and its walk report, and [`ExactError::TooFew`].
/// `n` = 0 gives no points and no error.
pub fn exactly<I: Importance>(
    placement: &Placement<'_>,
    importance: &I,
    n: usize,
    limits: Limits,
) -> Result<Vec<Weighted>, ExactError> {
    if n == 0 {
        return Ok(Vec::new());
    }
    let wanted = n as f64;
    if wanted > limits.points as f64 {
        let limit = limits.points;
        return Err(SamplingError::TooManyPoints { expected: wanted, limit }.into());
    }
    let domain = placement.domain();
    let integral = importance.integral(&domain);
    let bound = importance.upper_bound(&domain.region());
    if bound == 0.0 || integral == Some(0.0) {
        return Err(ExactError::TooFew { asked: n, found: 0 });
    }
    // More than n by some standard deviations of the count, so that one walk is nearly always enough.
    let margin = 3.0 * libm::sqrt(wanted) + 8.0;
    let mut density = (wanted + margin) / integral.unwrap_or(bound * domain.area());
    // A small set of an importance of unknown integral can be anywhere between nothing and the bound.
    let walk_limits = Limits { points: u64::MAX, ..limits };
    let mut greatest: Option<f64> = None;
    loop {
        let sampling = match Sampling::with_limits(
            placement,
            importance,
            Amount::Density(density),
            walk_limits,
        ) {
            Ok(sampling) => sampling,
            // The deepest level caps the density: try exactly that, once.
            Err(SamplingError::TooDense { near }) if greatest.is_none() => {
                density = placement.greatest_threshold() / (placement.ranks_per_density() * bound)
                    * (1.0 - 1e-12);
                greatest = Some(density);
                if !(density > 0.0 && density.is_finite()) {
                    return Err(SamplingError::TooDense { near }.into());
                }
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        let mut candidates = candidates(&sampling, limits)?;
        let found = candidates.len();
        if found > n || (found == n && greatest.is_some()) {
            let next = if found > n {
                candidates.select_nth_unstable_by(n, Candidate::order).1.key
            } else {
                placement.greatest_threshold() / bound
            };
            candidates.truncate(n);
            candidates.sort_unstable_by(Candidate::order);
            let per_value = match integral {
                Some(integral) => wanted / integral,
                None => next / placement.ranks_per_density(),
            };
            return Ok(candidates.into_iter().map(|c| c.weighted(per_value)).collect());
        }
        if greatest.is_some() {
            return Err(ExactError::TooFew { asked: n, found });
        }
        // Aim above n, and do not trust few points to tell the integral.
        let growth = (wanted + margin) / (found as f64 + 1.0);
        density *= growth.clamp(1.25, 64.0);
    }
}

/// All points of the sampling with their keys.
fn candidates<I: Importance>(
    sampling: &Sampling<'_, I>,
    limits: Limits,
) -> Result<Vec<Candidate>, SamplingError> {
    let mut candidates = Vec::new();
    for sample in sampling.points()? {
        let sample = sample?;
        if candidates.len() as u64 > 2 * limits.points.saturating_add(64) {
            let expected = candidates.len() as f64;
            return Err(SamplingError::TooManyPoints { expected, limit: limits.points });
        }
        let value = sampling.importance().value(sample.position);
        if value <= 0.0 || value.is_nan() {
            // Rounding carried the position over an edge of the importance: no finite density there.
            continue;
        }
        let key = sampling.scale().shifted(sample.rank) / value;
        let (position, rank) = (sample.position, sample.rank);
        let point = Weighted { position, rank, density: value, weight: 0.0 };
        candidates.push(Candidate { key, point });
    }
    Ok(candidates)
}

impl Candidate {
    /// The point with its density and weight; so far `density` held the importance.
    fn weighted(self, per_value: f64) -> Weighted {
        let density = self.point.density * per_value;
        Weighted { density, weight: 1.0 / density, ..self.point }
    }
}
