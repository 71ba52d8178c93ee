//! Dots kept a pen's width apart.

use glam::DVec2;

use crate::order::Grid;
use twelvefold_stipple::page::sheet::{STEPS, Sheet};

/// The most rounds in which dots that are too near push each other away. At 0.8 of black, which nothing denser
/// is asked of, 17,842 dots on 40 x 40 mm need some 90.
const ROUNDS: usize = 400;

/// How much of what is missing each of two dots goes in a round. After 100 rounds, of the dots above there were
/// left out: 2,713 at 0.5, 804 at 0.7, none at 0.9; but 10,000 at 1.1, where they fly about.
const PUSH: f64 = 0.85;

/// Dots, rounded to the sheet's steps, at least `least` apart: those too near to each other are moved, and the
/// few that find no room are left out. Says of each whether it stayed.
pub(crate) fn keep_apart(dots: &mut Vec<DVec2>, least: f64, sheet: &Sheet) -> Vec<bool> {
    // Rounding may bring two dots nearer by a step and a half.
    let wanted = least + 2.0 / STEPS;
    // A photograph's rectangle is half-open.
    let [low, high] = sheet.picture();
    let high = if sheet.is_page() { high } else { high - 1.0 / STEPS };
    let mut restless = vec![true; dots.len()];
    for _ in 0..ROUNDS {
        let grid = Grid::with_cells_of(dots, wanted);
        let pushes: Vec<(usize, DVec2)> = (0..dots.len())
            .filter(|&i| restless[i])
            .map(|i| (i, push(dots, i, &grid, wanted)))
            .filter(|(_, push)| *push != DVec2::ZERO)
            .collect();
        if pushes.is_empty() {
            break;
        }
        restless.fill(false);
        for (i, push) in pushes {
            // Where one has moved, there may be a new neighbor.
            grid.around(dots[i], |j| restless[j as usize] = true);
            dots[i] = (dots[i] + push).min(high).max(low);
        }
    }
    for dot in dots.iter_mut() {
        *dot = sheet.rounded(*dot).min(high);
    }
    let grid = Grid::with_cells_of(dots, least);
    let mut kept = vec![true; dots.len()];
    for i in 0..dots.len() {
        // Of two that are too near, the one that comes first stays.
        let mut stays = true;
        grid.around(dots[i], |j| {
            let j = j as usize;
            stays &= !(j < i && kept[j] && dots[j].distance_squared(dots[i]) < least * least);
        });
        kept[i] = stays;
    }
    let mut stays = kept.iter();
    dots.retain(|_| stays.next().copied().unwrap_or(true));
    kept
}

/// What the neighbors nearer than `wanted` push dot `i` away.
fn push(dots: &[DVec2], i: usize, grid: &Grid, wanted: f64) -> DVec2 {
    let mut push = DVec2::ZERO;
    grid.around(dots[i], |j| {
        let j = j as usize;
        let away = dots[i] - dots[j];
        let squared = away.length_squared();
        if j == i || squared >= wanted * wanted {
            return;
        }
        let distance = squared.sqrt();
        // Two dots in one place part sideways.
        let direction = if distance > 0.0 {
            away / distance
        } else {
            DVec2::new(if i < j { -1.0 } else { 1.0 }, 0.0)
        };
        push += PUSH * (wanted - distance) * direction;
    });
    push
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use twelvefold_stipple::page::sheet::{DotWidth, Page};

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn no_two_dots_are_nearer_than_asked_and_most_stay(
            places in prop::collection::vec((0.0f64..40.0, 0.0f64..30.0), 0..250), least in 0.1f64..2.5,
        ) {
            let size = "50x40".parse().unwrap();
            let page = Page { size, margin: Some(2.0), landscape: false, dpi: 300 };
            let photograph = DVec2::new(40.0, 30.0);
            let sheet = Sheet::of_page(photograph, &page, DotWidth::Millimeters(least)).unwrap();
            let given: Vec<DVec2> =
                places.iter().map(|&(x, y)| sheet.place(DVec2::new(x, y))).collect();
            let mut dots = given.clone();
            let kept = keep_apart(&mut dots, least, &sheet);
            prop_assert_eq!(kept.iter().filter(|kept| **kept).count(), dots.len());
            prop_assert_eq!(kept.len(), given.len());
            let [low, high] = sheet.picture();
            for (i, dot) in dots.iter().enumerate() {
                prop_assert!(dot.cmpge(low).all() && dot.cmple(high).all());
                prop_assert!(dots[..i].iter().all(|other| other.distance(*dot) >= least));
            }
            let discs = given.len() as f64 * least * least;
            if discs < 0.3 * (high - low).element_product() {
                prop_assert!(dots.len() as f64 > 0.97 * given.len() as f64 - 1.0);
            }
        }
    }
}
