//! Where the dots go: a sampling of the picture, refined unless it must stream.

use glam::DVec2;
use twelvefold::refine::{ClassRefiner, Classes, RefineError, Refiner};
use twelvefold_files::picture::Picture;

use crate::error::DotsError;
use crate::raw::{self, Step};
use crate::wish::Wish;

/// Hands every dot of a picture to `take`, and cuts between the [cells](twelvefold::Mosaic) of a large one; says after
/// each iteration of refinement that it is done. Keeps no list if they are neither refined nor ranked.
///
/// # Errors
/// [`DotsError`], and what `take` fails with.
pub fn place<E>(
    picture: Picture,
    wish: Wish,
    iteration: impl FnMut(),
    mut take: impl FnMut(Step) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    if wish.refine == 0 && !wish.ranked {
        return raw::place(picture, wish, |step, _| take(step));
    }
    let dots = list(picture, wish, iteration)?;
    dots.into_iter().try_for_each(|dot| take(Step::Dot(dot)).map_err(DotsError::Taker))
}

/// Every dot of a picture, in pixels; says after each iteration of refinement that it is done.
///
/// # Errors
/// [`DotsError`].
pub fn list<E>(
    picture: Picture,
    wish: Wish,
    iteration: impl FnMut(),
) -> Result<Vec<DVec2>, DotsError<E>> {
    if wish.refine == 0 {
        return unrefined(picture, wish);
    }
    let mut dots = unrefined(copy(&picture)?, wish)?;
    refined(&picture, &mut dots, wish, iteration).map_err(DotsError::Refine)?;
    Ok(dots)
}

/// The list of the dots as the sampling gives them, ranked if that is wished.
///
/// # Errors
/// [`DotsError`].
pub fn unrefined<E>(picture: Picture, wish: Wish) -> Result<Vec<DVec2>, DotsError<E>> {
    let mut dots = Vec::new();
    let mut keys: Vec<f64> = Vec::new();
    raw::place(picture, wish, |step, key| {
        let Step::Dot(dot) = step else { return Ok(()) };
        dots.try_reserve(1).map_err(|_| dots.len() + 1)?;
        dots.push(dot);
        if wish.ranked {
            keys.try_reserve(1).map_err(|_| dots.len())?;
            keys.push(key);
        }
        Ok(())
    })
    .map_err(|error| error.map_taker(DotsError::Memory))?;
    if wish.ranked {
        let mut order: Vec<usize> = (0..dots.len()).collect();
        order.sort_by(|&one, &other| keys[one].total_cmp(&keys[other]));
        dots = order.into_iter().map(|index| dots[index]).collect();
    }
    Ok(dots)
}

/// Refines dots where they are.
///
/// # Errors
/// [`RefineError`].
pub(crate) fn refined(
    picture: &Picture,
    dots: &mut [DVec2],
    wish: Wish,
    mut iteration: impl FnMut(),
) -> Result<(), RefineError> {
    let mut refiner = Refiner::new(picture.width, picture.height, &picture.importance, dots)?;
    for _ in 0..wish.refine {
        refiner.step();
        iteration();
    }
    if wish.best {
        refiner.polish()?;
        iteration();
    }
    refiner.write(dots)
}

/// A class for each of the even dots of all classes; moves them so that those of each class are even too.
///
/// # Errors
/// [`RefineError`].
pub fn classified(
    classes: &Classes,
    dots: &mut [DVec2],
    wish: Wish,
) -> Result<Vec<u8>, RefineError> {
    let mut class_of = Vec::new();
    let bytes = dots.len();
    class_of.try_reserve_exact(bytes).map_err(|_| RefineError::Memory { bytes })?;
    class_of.resize(dots.len(), 0);
    if classes.planes().len() > 1 {
        let mut refiner = ClassRefiner::new(classes, dots)?;
        for _ in 0..wish.refine {
            refiner.step();
        }
        if wish.best {
            refiner.polish()?;
        }
        refiner.write(dots, &mut class_of)?;
    }
    Ok(class_of)
}

/// A picture for a map, which keeps its pixels.
fn copy<E>(picture: &Picture) -> Result<Picture, DotsError<E>> {
    let mut importance = Vec::new();
    let pixels = picture.importance.len();
    importance.try_reserve_exact(pixels).map_err(|_| DotsError::Memory(pixels))?;
    importance.extend_from_slice(&picture.importance);
    Ok(Picture { importance, warnings: Vec::new(), ..*picture })
}
