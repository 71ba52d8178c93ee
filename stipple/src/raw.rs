//! The dots as a sampling gives them, one by one; those of a large picture cell by cell.

use std::ops::Range;

use glam::DVec2;
use twelvefold::estimate::{exactly, exactly_relaxed};
use twelvefold::{
    Amount, Cell, ImageMap, Importance, InvalidPixels, Limits, MapError, Mosaic, Pixels, Placement,
    Sample, Sampling, StippleMap,
};
use twelvefold_files::picture::Picture;

use crate::error::DotsError;
use crate::wish::{Centers, Count, Wish};

/// What the dots' taker is told.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// A dot, in pixels.
    Dot(DVec2),
    /// What comes next depends on nothing that came before.
    Cut,
}

/// Hands the dots of a picture as the sampling gives them to `take`, each with a key by which they are ranked if that is
/// wished, and cuts between cells.
///
/// # Errors
/// [`DotsError`], and what `take` fails with.
pub(crate) fn place<E>(
    Picture { width, height, importance, .. }: Picture,
    wish: Wish,
    mut take: impl FnMut(Step, f64) -> Result<(), E>,
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
                take(Step::Dot(dot.position), key(dot, &map, wish.ranked)).map_err(DotsError::Taker)
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
                take(Step::Dot(dot.position), keys.next().unwrap_or(f64::MAX))
                    .map_err(DotsError::Taker)
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
            let pixels = Pixels::new(width, height, importance, invalid).map_err(DotsError::Map)?;
            let mosaic =
                Mosaic::new((width, height), pixels.mean(), count).map_err(DotsError::Map)?;
            if mosaic.cells().len() == 1 {
                let map = StippleMap::new(pixels, count).map_err(DotsError::Map)?;
                let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
                let sampling = Sampling::new(&placement, &map, Amount::Points(count))
                    .and_then(Sampling::relaxed)
                    .map_err(DotsError::Sampling)?;
                return stream(&sampling, &map, wish.ranked, take);
            }
            let read = |columns, rows| window(pixels.values(), width, columns, rows);
            cells(mosaic.cells(), wish, read, take)
        }
    }
}

/// The pixels of some columns and rows of a picture that is all there.
///
/// # Errors
/// [`DotsError::Map`] if there is no memory for them.
pub(crate) fn window<E>(
    pixels: &[f32],
    width: usize,
    columns: Range<usize>,
    rows: Range<usize>,
) -> Result<Vec<f32>, DotsError<E>> {
    let mut window = Vec::new();
    let bytes = columns.len() * rows.len() * size_of::<f32>();
    window
        .try_reserve_exact(columns.len() * rows.len())
        .map_err(|_| DotsError::Map(MapError::Memory { bytes }))?;
    for y in rows {
        window.extend_from_slice(&pixels[y * width..][columns.clone()]);
    }
    Ok(window)
}

/// Hands the relaxed dots of some cells of a picture to `take`, and cuts after each cell. `read` gives the pixels of
/// some columns and rows, as dots should have them.
///
/// # Errors
/// [`DotsError`], and what `read` and `take` fail with.
pub fn cells<E>(
    cells: impl Iterator<Item = Cell>,
    wish: Wish,
    mut read: impl FnMut(Range<usize>, Range<usize>) -> Result<Vec<f32>, DotsError<E>>,
    mut take: impl FnMut(Step, f64) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    for cell in cells {
        let (columns, rows) = (cell.columns(), cell.rows());
        let size = (columns.len(), rows.len());
        let map = Pixels::new(size.0, size.1, read(columns, rows)?, InvalidPixels::Reject)
            .and_then(|pixels| cell.map(pixels))
            .map_err(DotsError::Map)?;
        let placement = Placement::new_in(map.domain(), wish.seed, wish.tables);
        let sampling = Sampling::new(&placement, &map, Amount::Points(wish.count.number()))
            .and_then(Sampling::relaxed)
            .map_err(DotsError::Sampling)?;
        stream(&sampling.clipped(cell.domain()), &map, wish.ranked, &mut take)?;
        take(Step::Cut, 0.0).map_err(DotsError::Taker)?;
    }
    Ok(())
}

/// Every point of a sampling.
fn stream<I: Importance, E>(
    sampling: &Sampling<'_, I>,
    map: &I,
    ranked: bool,
    mut take: impl FnMut(Step, f64) -> Result<(), E>,
) -> Result<(), DotsError<E>> {
    // In 64 bits because 32 would be too few in a picture with sides of very different length.
    for point in sampling.points().map_err(DotsError::Sampling)? {
        let point = point.map_err(DotsError::Sampling)?;
        take(Step::Dot(point.position), key(&point, map, ranked)).map_err(DotsError::Taker)?;
    }
    Ok(())
}

/// The density at which a point appears, if points are ranked.
fn key<I: Importance>(point: &Sample<DVec2>, map: &I, ranked: bool) -> f64 {
    // A relaxed point may have left what it was accepted by.
    let value = || map.value(point.position).max(f64::MIN_POSITIVE);
    if ranked { point.rank as f64 / value() } else { 0.0 }
}
