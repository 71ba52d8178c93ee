//! Where the dots go: a sampling of the picture, refined unless it must stream.

use std::fmt;

use glam::DVec2;
use twelvefold::estimate::{ExactError, exactly, exactly_relaxed};
use twelvefold::refine::{ClassRefiner, Classes, ITERATIONS, RefineError, Refiner};
use twelvefold::{
    Amount, ImageMap, Importance, InvalidPixels, Limits, MapError, Pixels, Placement, Sample,
    Sampling, SamplingError, StippleMap, Tables,
};
use twelvefold_files::picture::Picture;

/// From this many dots on, they are drawn as they come, unless refinement is asked for: a list of them all,
/// and what refining needs beside it, would take a hundred bytes a dot.
pub const STREAMED: f64 = 2_000_000.0;

/// What is wanted of the dots.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    pub count: Count,
    pub centers: Centers,
    pub seed: u64,
    /// Iterations.
    pub refine: usize,
    /// Polished after them.
    pub best: bool,
    /// In an order of which each beginning is itself a good set.
    pub ranked: bool,
    /// What the dots are read from.
    pub tables: Tables<'static>,
}

impl Wish {
    /// How the dots were made, in plain text.
    pub fn description(&self) -> String {
        let dots = match self.count {
            Count::About(count) => format!("about {count}"),
            Count::Exactly(count) => count.to_string(),
        };
        let (version, seed) = (env!("CARGO_PKG_VERSION"), self.seed);
        format!("Stippled with {dots} dots by twelvefold {version}, seed {seed}")
    }
}

/// Where dots lie before they are refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Centers {
    /// Moved aside, evenly spread.
    Relaxed,
    /// At the centers of tiles.
    Fixed,
}

/// A number of dots.
#[derive(Clone, Copy, Debug)]
pub enum Count {
    About(f64),
    Exactly(usize),
}

impl Count {
    pub fn number(self) -> f64 {
        match self {
            Self::About(count) => count,
            Self::Exactly(count) => count as f64,
        }
    }
}

/// The iterations for so many dots, if nobody says; `best` dots are always refined.
pub fn default_iterations(count: f64, best: bool) -> usize {
    if count < STREAMED || best { ITERATIONS } else { 0 }
}

/// Why there are no dots, or no more of them.
#[derive(Debug)]
pub enum DotsError<E> {
    Map(MapError),
    Sampling(SamplingError),
    Exact(ExactError),
    Refine(RefineError),
    /// There is no memory for a list of so many dots.
    Memory(usize),
    /// Whoever takes the dots failed.
    Taker(E),
}

impl<E: fmt::Display> fmt::Display for DotsError<E> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(out),
            Self::Sampling(error) => error.fmt(out),
            Self::Exact(error) => error.fmt(out),
            Self::Refine(error) => error.fmt(out),
            Self::Memory(count) => {
                write!(
                    out,
                    "there is no memory for {} MiB of dots",
                    (count * size_of::<DVec2>()) >> 20
                )
            }
            Self::Taker(error) => error.fmt(out),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for DotsError<E> {}

/// Hands every dot of a picture, in pixels, to `take`; says after each iteration of refinement that it is
/// done. Keeps no list if they are neither refined nor ranked.
///
/// # Errors
/// [`DotsError`], and what `take` fails with.
pub fn place<E>(
    picture: Picture,
    wish: Wish,
    iteration: impl FnMut(),
    mut take: impl FnMut(DVec2) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    if wish.refine == 0 && !wish.ranked {
        return raw(picture, wish, |dot, _| take(dot));
    }
    let dots = list(picture, wish, iteration)?;
    dots.into_iter().try_for_each(|dot| take(dot).map_err(DotsError::Taker))
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
    raw(picture, wish, |dot, key| {
        dots.try_reserve(1).map_err(|_| dots.len() + 1)?;
        dots.push(dot);
        if wish.ranked {
            keys.try_reserve(1).map_err(|_| dots.len())?;
            keys.push(key);
        }
        Ok(())
    })
    .map_err(|error| match error {
        DotsError::Taker(count) => DotsError::Memory(count),
        DotsError::Map(error) => DotsError::Map(error),
        DotsError::Sampling(error) => DotsError::Sampling(error),
        DotsError::Exact(error) => DotsError::Exact(error),
        DotsError::Refine(error) => DotsError::Refine(error),
        DotsError::Memory(count) => DotsError::Memory(count),
    })?;
    if wish.ranked {
        let mut order: Vec<usize> = (0..dots.len()).collect();
        order.sort_by(|&one, &other| keys[one].total_cmp(&keys[other]));
        dots = order.into_iter().map(|index| dots[index]).collect();
    }
    Ok(dots)
}

/// Refines dots where they are.
fn refined(
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

/// The dots as the sampling gives them, each with a key by which they are ranked if that is wished.
fn raw<E>(
    Picture { width, height, importance, .. }: Picture,
    wish: Wish,
    mut take: impl FnMut(DVec2, f64) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    let invalid = InvalidPixels::Reject;
    match (wish.count, wish.centers) {
        (Count::Exactly(count), Centers::Relaxed) => {
            let map = Pixels::new(width, height, importance, invalid)
                .and_then(|pixels| StippleMap::new(pixels, count as f64))
                .map_err(DotsError::Map)?;
            let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
            let dots = exactly_relaxed(&placement, &map, count, Limits::default())
                .map_err(DotsError::Exact)?;
            dots.iter().try_for_each(|dot| {
                take(dot.position, key(dot, &map, wish.ranked)).map_err(DotsError::Taker)
            })
        }
        (Count::Exactly(count), Centers::Fixed) => {
            let map = Pixels::new(width, height, importance, invalid)
                .and_then(ImageMap::new)
                .map_err(DotsError::Map)?;
            let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
            let dots =
                exactly(&placement, &map, count, Limits::default()).map_err(DotsError::Exact)?;
            let mut keys = (0u32..).map(f64::from);
            dots.iter().try_for_each(|dot| {
                take(dot.position, keys.next().unwrap_or(f64::MAX)).map_err(DotsError::Taker)
            })
        }
        (Count::About(count), Centers::Fixed) => {
            let map = Pixels::new(width, height, importance, invalid)
                .and_then(ImageMap::new)
                .map_err(DotsError::Map)?;
            let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
            let sampling = Sampling::new(&placement, &map, Amount::Points(count));
            stream(&sampling.map_err(DotsError::Sampling)?, &map, wish.ranked, take)
        }
        (Count::About(count), Centers::Relaxed) => {
            let map = Pixels::new(width, height, importance, invalid)
                .and_then(|pixels| StippleMap::new(pixels, count))
                .map_err(DotsError::Map)?;
            let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
            let sampling = Sampling::new(&placement, &map, Amount::Points(count))
                .and_then(Sampling::relaxed)
                .map_err(DotsError::Sampling)?;
            stream(&sampling, &map, wish.ranked, take)
        }
    }
}

/// Every point of a sampling.
fn stream<I: Importance, E>(
    sampling: &Sampling<'_, I>,
    map: &I,
    ranked: bool,
    mut take: impl FnMut(DVec2, f64) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    // In 64 bits because 32 would be too few in a picture with sides of very different length.
    for point in sampling.points().map_err(DotsError::Sampling)? {
        let point = point.map_err(DotsError::Sampling)?;
        take(point.position, key(&point, map, ranked)).map_err(DotsError::Taker)?;
    }
    Ok(())
}

/// The density at which a point appears, if points are ranked.
fn key<I: Importance>(point: &Sample<DVec2>, map: &I, ranked: bool) -> f64 {
    // A relaxed point may have left what it was accepted by.
    let value = || map.value(point.position).max(f64::MIN_POSITIVE);
    if ranked { point.rank as f64 / value() } else { 0.0 }
}
