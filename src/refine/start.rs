//! Dots as they came, made fit to be refined: on ink, where the picture asks for them, and not on each other.

use super::cells::Dot;
use super::coarse::Coarse;
use super::density::Density;
use super::error::{RefineError, reserve};
use super::ink::{Ink, NearestInk};
use super::spread::spread;

/// The mean square of a coarse cell's surplus, in shares of its dots, from which on they are handed out anew. Samplings
/// of this library have .02 to .07 on photographs, independent random dots .4, a corner full of dots thousands.
const UNFAIR: f64 = 0.2;

/// Brings dots on white, or outside, to the nearest ink, gives each island of ink its share of them, or all of the picture
/// if they come badly spread, and parts those that lie on each other.
pub(super) fn prepare(
    ink: &Ink<'_>,
    density: &Density,
    coarse: &mut Coarse,
    dots: &mut [Dot],
) -> Result<(), RefineError> {
    bring(ink, dots)?;
    coarse.measure(dots);
    let unfair = coarse.unevenness() > UNFAIR * dots.len() as f64;
    spread(ink, unfair, dots)?;
    part(ink, density, dots)
}

/// Of dots that are well spread, moves only those that cannot stay.
pub(super) fn admit(ink: &Ink<'_>, density: &Density, dots: &mut [Dot]) -> Result<(), RefineError> {
    bring(ink, dots)?;
    part(ink, density, dots)
}

/// Dots on white, or outside, go to the nearest ink.
fn bring(ink: &Ink<'_>, dots: &mut [Dot]) -> Result<(), RefineError> {
    let mut nearest = None;
    for dot in dots.iter_mut().filter(|dot| !ink.holds(dot.x, dot.y)) {
        if nearest.is_none() {
            nearest = Some(NearestInk::new(*ink)?);
        }
        if let Some(nearest) = &nearest {
            (dot.x, dot.y) = nearest.bring(dot.x, dot.y);
        }
    }
    Ok(())
}

/// cos and sin of the golden angle, π (3 − √5).
const GOLDEN: [f32; 2] = [-0.737_368_9, 0.675_490_3];

/// Dots on one place stay on it for ever, since all that moves one moves the others: the second, third, …
/// of them, by index, are put on a spiral about the first.
fn part(ink: &Ink<'_>, density: &Density, dots: &mut [Dot]) -> Result<(), RefineError> {
    let mut order = reserve::<(u64, u32)>(dots.len())?;
    // bits of numbers that are at least 0 are in their order
    let place = |dot: &Dot| u64::from(dot.y.to_bits()) << 32 | u64::from(dot.x.to_bits());
    order.extend(dots.iter().enumerate().map(|(at, dot)| (place(dot), at as u32)));
    order.sort_unstable();
    let [mut c, mut s] = [1.0_f32, 0.0];
    for pair in order.windows(2) {
        if pair[0].0 != pair[1].0 {
            [c, s] = [1.0, 0.0];
            continue;
        }
        [c, s] = [c * GOLDEN[0] - s * GOLDEN[1], c * GOLDEN[1] + s * GOLDEN[0]];
        let dot = &mut dots[pair[1].1 as usize];
        let radius = 0.1 * density.spacing(dot.x, dot.y);
        (dot.x, dot.y) = ink.slide(dot.x, dot.y, radius * c, radius * s);
    }
    Ok(())
}
