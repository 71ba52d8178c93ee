//! A class for each dot, by error diffusion along a curve that stays near.

use alloc::vec::Vec;

use super::super::cells::Dot;
use super::super::error::{RefineError, reserve};
use super::planes::Classes;

/// Levels of the curve: finer than dots lie.
const LEVELS: u32 = 16;

/// A class for each dot, by index: along Hilbert's curve, each takes the class of which most is owing, of
/// those that its pixel wants. So any stretch of the curve, and any square of it, has its share of each.
pub(super) fn assign(classes: &Classes, dots: &[Dot]) -> Result<Vec<u8>, RefineError> {
    let mut order = reserve::<(u32, u32)>(dots.len())?;
    let longest = classes.width.max(classes.height) as f32;
    let scale = (1_u32 << LEVELS) as f32 / longest;
    order.extend(
        dots.iter()
            .zip(0_u32..)
            .map(|(dot, i)| (along([(dot.x * scale) as u32, (dot.y * scale) as u32]), i)),
    );
    order.sort_unstable();
    let mut class_of = reserve(dots.len())?;
    class_of.resize(dots.len(), 0);
    let mut owing = [0.0_f64; Classes::MOST];
    for (_, i) in order {
        let dot = &dots[i as usize];
        let pixel = dot.y as usize * classes.width + dot.x as usize;
        let total = f64::from(classes.total[pixel]);
        let mut best: Option<usize> = None;
        for (class, plane) in classes.planes.iter().enumerate() {
            let value = plane[pixel];
            owing[class] += f64::from(value) / total;
            if value > 0.0 && best.is_none_or(|best| owing[class] > owing[best]) {
                best = Some(class);
            }
        }
        let best = best.unwrap_or(0);
        owing[best] -= 1.0;
        class_of[dot.index as usize] = best as u8;
    }
    Ok(class_of)
}

/// How far along Hilbert's curve a place of the square of side 2^[`LEVELS`] is.
fn along([mut x, mut y]: [u32; 2]) -> u32 {
    let last = (1 << LEVELS) - 1;
    (x, y) = (x.min(last), y.min(last));
    let mut distance = 0;
    for level in (0..LEVELS).rev() {
        let (right, below) = (x >> level & 1, y >> level & 1);
        distance = distance << 2 | (3 * right) ^ below;
        // into the quarter's own coordinates
        if below == 0 {
            if right == 1 {
                (x, y) = (last - x, last - y);
            }
            (x, y) = (y, x);
        }
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_neighbors_one_after_the_other() {
        // the first and the last cells of the 64 × 64 grid that the upper bits are
        let cell = 1 << (LEVELS - 6);
        let mut places: Vec<(u32, [i32; 2])> = (0..64)
            .flat_map(|y| (0..64).map(move |x| (along([x * cell, y * cell]), [x as i32, y as i32])))
            .collect();
        places.sort_unstable();
        for pair in places.windows(2) {
            let ([a, b], [c, d]) = (pair[0].1, pair[1].1);
            assert_eq!((a - c).abs() + (b - d).abs(), 1);
        }
    }
}
