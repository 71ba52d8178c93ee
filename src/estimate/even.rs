//! Exactly n relaxed points.

use alloc::vec::Vec;

use super::exact::{ExactError, admitted};
use crate::emit::Sample;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::position::Position;
use crate::sampling::{Amount, Limits, Sampling};

/// Amounts that are tried. Between one that gives too few and one that gives too many, the next is where a
/// straight line gives n: three or four are enough, unless several points come at once.
const TRIES: usize = 24;

/// Exactly `n` [relaxed](Sampling::relaxed) points: those of a sampling whose amount is chosen so that it
/// has n. In the order of the walk.
///
/// Where several points come at the same amount, those that would have come last are left out. Unlike
/// the points of [`exactly`](super::exactly), they carry no weights, and a smaller n gives other places, not
/// fewer of the same ones. The choice depends on placement and importance alone.
///
/// Some four walks that only count, and one that keeps.
///
/// # Errors
/// [`ExactError`]: all that [`Sampling::within`], [`Sampling::relaxed`] and the walk report, [`ExactError::TooFew`]
/// and [`ExactError::Memory`]. The importance must know its integral. `n` = 0 gives no points and no error.
///
/// ```
/// use glam::Vec2;
/// use twelvefold::estimate::exactly_relaxed;
/// use twelvefold::{InvalidPixels, Limits, Pixels, Placement, StippleMap};
/// let pixels = (0..64 * 64).map(|i| (i % 64) as f32).collect();
/// let map = StippleMap::new(Pixels::new(64, 64, pixels, InvalidPixels::Reject)?, 500.0)?;
/// let placement = Placement::new(map.domain(), 1);
/// let points = exactly_relaxed::<Vec2, _>(&placement, &map, 500, Limits::default())?;
/// assert_eq!(points.len(), 500);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn exactly_relaxed<P: Position, I: Importance>(
    placement: &Placement<'_>,
    importance: &I,
    n: usize,
    limits: Limits,
) -> Result<Vec<Sample<P>>, ExactError> {
    if n == 0 {
        return Ok(Vec::new());
    }
    let wanted = admitted(n, limits)?;
    let bytes = n.saturating_mul(size_of::<Sample<P>>());
    let mut points = Vec::new();
    points.try_reserve_exact(n).map_err(|_| ExactError::Memory { bytes })?;
    // Tries go beyond n before they come down to it.
    let limits = Limits { points: u64::MAX, ..limits };
    let sampling = |amount: f64| {
        Sampling::within(placement, importance, Amount::Points(amount), limits)?.relaxed()
    };

    // Amounts and how many points they give.
    let (mut below, mut above) = ((0.0, 0.0), None);
    let mut amount = wanted;
    for _ in 0..TRIES {
        let found = sampling(amount)?.effort()?.points as f64;
        if found < wanted {
            below = (amount, found);
        } else {
            above = Some((amount, found));
        }
        amount = match above {
            Some((_, found)) if found == wanted => break,
            Some((more, found)) => {
                let share = (wanted - below.1) / (found - below.1);
                below.0 + (more - below.0) * share.clamp(0.1, 0.9)
            }
            None => 1.25 * amount + (wanted - found),
        };
    }
    let Some((amount, _)) = above else {
        return Err(ExactError::TooFew { asked: n, found: below.1 as usize });
    };

    let sampling = sampling(amount)?;
    let memory = |_| ExactError::Memory { bytes };
    sampling.points::<P>()?.for_each_sample::<ExactError>(|point| {
        points.try_reserve(1).map_err(memory)?;
        points.push(point);
        Ok(())
    })?;
    leave_out(&mut points, n, importance).map_err(memory)?;
    Ok(points)
}

/// Leaves out the points that come last as the density rises, all but `n` of them; keeps the order of the others.
fn leave_out<P: Position, I: Importance>(
    points: &mut Vec<Sample<P>>,
    n: usize,
    importance: &I,
) -> Result<(), alloc::collections::TryReserveError> {
    if points.len() <= n {
        return Ok(());
    }
    let mut last = Vec::new();
    last.try_reserve_exact(points.len())?;
    last.extend((0..).zip(points.iter()).map(|(index, point)| {
        let [x, y] = point.position.xy().map(crate::position::Scalar::to_f64);
        let value = importance.value(glam::DVec2::new(x, y));
        // A relaxed point may have left what it was accepted by, but for where the importance is 0.
        (point.rank as f64 / value.max(f64::MIN_POSITIVE), index)
    }));
    last.sort_unstable_by(|one: &(f64, usize), other| {
        other.0.total_cmp(&one.0).then(other.1.cmp(&one.1))
    });
    last.truncate(points.len() - n);
    last.sort_unstable_by_key(|&(_, index)| index);
    let mut out = last.iter().map(|&(_, index)| index).peekable();
    let mut index = 0;
    points.retain(|_| {
        let keep = out.next_if_eq(&index).is_none();
        index += 1;
        keep
    });
    Ok(())
}
