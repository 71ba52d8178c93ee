//! Points of a density: all of them by several threads, or a part of them.

use std::sync::Arc;

use numpy::Element;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::prelude::*;
use twelvefold::estimate::Weighting;
use twelvefold::{
    Amount, Filled, Importance, Part, Placement, Points, Position, Sampling, SamplingError,
};

use crate::work::{self, Stop};
use crate::{error, output};

/// Points that a thread makes in one go, about a millisecond's: between them it looks whether they are
/// still wanted.
const PIECE: f64 = 65_536.0;

/// Pieces that are made before they are put together.
const PIECES_AT_ONCE: usize = 256;

/// What is wanted of a sampling.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wish {
    pub(crate) amount: Amount,
    pub(crate) relaxed: bool,
    /// Positions in `f64`.
    pub(crate) double: bool,
    pub(crate) weights: bool,
    pub(crate) ranks: bool,
    /// Part i of n.
    pub(crate) part: Option<(usize, usize)>,
}

impl Wish {
    /// # Errors
    /// `ValueError` for wishes that contradict each other, and a part that there is not.
    pub(crate) fn check(self) -> PyResult<Self> {
        if self.weights && self.relaxed {
            return Err(error::value(
                "relaxed points have no unbiased weights: give relaxed=False",
            ));
        }
        if self.weights && !self.double {
            return Err(error::value("weights belong to positions of dtype float64"));
        }
        if self.weights && self.part.is_some() {
            return Err(error::value("weights are of the whole set: give no part"));
        }
        match self.part {
            Some((index, of)) if index >= of => {
                Err(error::sampling(SamplingError::Part { index, of }))
            }
            _ => Ok(self),
        }
    }
}

/// Points with what is wanted beside them.
struct Made<P> {
    points: Vec<P>,
    weights: Option<Vec<f64>>,
    ranks: Option<Vec<u64>>,
}

/// The points of a wish as an array, or as a tuple of arrays if weights or ranks are wished.
pub(crate) fn receive<'py, I: Importance + Sync>(
    py: Python<'py>,
    placement: Arc<Placement<'static>>,
    importance: impl FnOnce() -> PyResult<I> + Send + 'static,
    wish: Wish,
) -> PyResult<Bound<'py, PyAny>> {
    if wish.double {
        arrays(py, make::<I, f64>(py, placement, importance, wish)?)
    } else {
        arrays(py, make::<I, f32>(py, placement, importance, wish)?)
    }
}

fn arrays<S: Element>(py: Python<'_>, made: Made<[S; 2]>) -> PyResult<Bound<'_, PyAny>> {
    let points = output::rows(py, made.points)?;
    let weights = made.weights.map(|weights| output::column(py, weights));
    let ranks = made.ranks.map(|ranks| output::column(py, ranks));
    if weights.is_none() && ranks.is_none() {
        return Ok(points);
    }
    let all: Vec<_> = [Some(points), weights, ranks].into_iter().flatten().collect();
    Ok(PyTuple::new(py, all)?.into_any())
}

/// Makes the points with Python's lock released.
fn make<I: Importance + Sync, S: Send + 'static>(
    py: Python<'_>,
    placement: Arc<Placement<'static>>,
    importance: impl FnOnce() -> PyResult<I> + Send + 'static,
    wish: Wish,
) -> PyResult<Made<[S; 2]>>
where
    [S; 2]: Position,
{
    work::run(py, move |stop| {
        let importance = importance()?;
        let sampling =
            Sampling::new(&placement, &importance, wish.amount).map_err(error::sampling)?;
        if wish.weights {
            return weighted(&sampling, wish.ranks, stop);
        }
        let sampling =
            if wish.relaxed { sampling.relaxed().map_err(error::sampling)? } else { sampling };
        if wish.ranks {
            let samples = parts(&sampling, wish.part, stop, |source, _| {
                let mut samples = Vec::new();
                for sample in source.points::<[S; 2]>()? {
                    let sample = sample?;
                    push(&mut samples, (sample.position, sample.rank))?;
                }
                Ok(samples)
            })?;
            let (points, ranks) = samples.into_iter().unzip();
            return Ok(Made { points, weights: None, ranks: Some(ranks) });
        }
        let points = parts(&sampling, wish.part, stop, fill)?;
        Ok(Made { points, weights: None, ranks: None })
    })
}

/// A sampling, or a part of one.
enum Source<'a, I> {
    Whole(Sampling<'a, I>),
    Part(Part<'a, I>),
}

impl<'a, I: Importance> Source<'a, I> {
    fn fill<P: Position>(&self, buffer: &mut [P]) -> Result<Filled, SamplingError> {
        match self {
            Self::Whole(sampling) => sampling.fill(buffer),
            Self::Part(part) => part.fill(buffer),
        }
    }

    fn points<P: Position>(&self) -> Result<Points<'a, I, P>, SamplingError> {
        match self {
            Self::Whole(sampling) => sampling.points(),
            Self::Part(part) => part.points(),
        }
    }
}

/// What `receive` makes of a part of a sampling, or of all of it in pieces by all threads, one after the
/// other. A part is the library's own, so that it is the same through every door.
fn parts<'a, I: Importance + Sync, T: Send>(
    sampling: &Sampling<'a, I>,
    part: Option<(usize, usize)>,
    stop: &Stop,
    receive: impl Fn(&Source<'a, I>, usize) -> Result<Vec<T>, SamplingError> + Sync,
) -> PyResult<Vec<T>> {
    let expected = sampling.expected_points().unwrap_or(PIECE);
    if let Some((index, of)) = part {
        let division = sampling.divide(of).map_err(error::sampling)?;
        let part = Source::Part(division.part(index).map_err(error::sampling)?);
        return receive(&part, room(expected / of as f64)).map_err(error::sampling);
    }
    let pieces = (expected / PIECE).ceil().clamp(1.0, 65_536.0) as usize;
    if pieces == 1 {
        return receive(&Source::Whole(*sampling), room(expected)).map_err(error::sampling);
    }
    let division = sampling.divide(pieces).map_err(error::sampling)?;
    let mut all: Vec<T> = Vec::new();
    for first in (0..pieces).step_by(PIECES_AT_ONCE) {
        let made: Vec<Vec<T>> = (first..pieces.min(first + PIECES_AT_ONCE))
            .into_par_iter()
            .map(|piece| {
                if stop.wanted() {
                    return Ok(Vec::new());
                }
                receive(&Source::Part(division.part(piece)?), room(expected / pieces as f64))
            })
            .collect::<Result<_, _>>()
            .map_err(error::sampling)?;
        if stop.wanted() {
            break;
        }
        let more = made.iter().map(Vec::len).sum::<usize>();
        // At once for all that is still to come.
        let more = more.max(room(expected - all.len() as f64));
        let bytes = more.saturating_mul(size_of::<T>());
        all.try_reserve(more).map_err(|_| error::memory(bytes))?;
        made.into_iter().for_each(|piece| all.extend(piece));
    }
    Ok(all)
}

/// Room that is nearly always enough for so many points.
fn room(expected: f64) -> usize {
    let expected = expected.max(0.0);
    (expected + 3.0 * expected.sqrt()) as usize + 64
}

/// The points of a source of some `room` points.
fn fill<I: Importance, P: Position>(
    source: &Source<'_, I>,
    mut room: usize,
) -> Result<Vec<P>, SamplingError> {
    let mut points: Vec<P> = Vec::new();
    loop {
        points.clear();
        let bytes = room.saturating_mul(size_of::<P>());
        points.try_reserve_exact(room).map_err(|_| SamplingError::Memory { bytes })?;
        points.resize(room, P::default());
        let filled = source.fill(&mut points)?;
        if filled.complete {
            points.truncate(filled.written);
            return Ok(points);
        }
        room = room.saturating_mul(2);
    }
}

/// All points with their weights.
fn weighted<I: Importance, S>(
    sampling: &Sampling<'_, I>,
    ranks: bool,
    stop: &Stop,
) -> PyResult<Made<[S; 2]>>
where
    [S; 2]: Position,
{
    use twelvefold::Scalar as _;
    let mut made = Vec::new();
    for (i, point) in sampling.weighted(Weighting::Density).map_err(error::sampling)?.enumerate() {
        if i % 65_536 == 0 && stop.wanted() {
            break;
        }
        push(&mut made, point.map_err(error::sampling)?).map_err(error::sampling)?;
    }
    let position = |at: [f64; 2]| {
        let [x, y] = at.map(<[S; 2] as Position>::Scalar::from_f64);
        <[S; 2] as Position>::from_xy(x, y)
    };
    Ok(Made {
        points: made.iter().map(|point| position(point.position.to_array())).collect(),
        weights: Some(made.iter().map(|point| point.weight).collect()),
        ranks: ranks.then(|| made.iter().map(|point| point.rank).collect()),
    })
}

fn push<T>(items: &mut Vec<T>, item: T) -> Result<(), SamplingError> {
    let bytes = (items.len() + 1).saturating_mul(size_of::<T>());
    items.try_reserve(1).map_err(|_| SamplingError::Memory { bytes })?;
    items.push(item);
    Ok(())
}
