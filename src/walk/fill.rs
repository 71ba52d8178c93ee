//! Filling a caller's buffers: the fast way, with nothing between the tables and the buffer where no
//! test is needed.

use super::chunk::Chunk;
use super::either::AnyTraversal;
use super::frame::Segment;
use super::scalar::{Position, Scalar};
use super::vectors::Vectors;
use crate::clip::ToCaller;
use crate::importance::Importance;
use crate::points::Filled;
use crate::sampling::{Sampling, SamplingError};

/// Where positions go: a buffer of points, or one buffer a coordinate.
pub(crate) trait Output {
    type Position: Position;
    /// How many positions fit.
    fn room(&self) -> usize;
    /// Writes one position. `i` < room.
    fn set(&mut self, i: usize, position: Self::Position);
    /// Writes a run of candidates from `i` on; `i` + their number ≤ room.
    fn write(
        &mut self,
        i: usize,
        segment: &Segment<'_, <Self::Position as Position>::Scalar>,
        to_caller: &ToCaller<<Self::Position as Position>::Scalar>,
    );
}

impl<P: Position> Output for &mut [P] {
    type Position = P;

    fn room(&self) -> usize {
        self.len()
    }

    #[inline(always)]
    fn set(&mut self, i: usize, position: P) {
        self[i] = position;
    }

    #[inline(always)]
    fn write(
        &mut self,
        i: usize,
        segment: &Segment<'_, P::Scalar>,
        to_caller: &ToCaller<P::Scalar>,
    ) {
        let slots = &mut self[i..i + segment.len()];
        if to_caller.is_identity() {
            segment.write_positions(slots, P::from_xy);
        } else {
            segment.write_positions(slots, |x, y| to_caller.place(x, y));
        }
    }
}

/// x[] and y[], of one length.
pub(crate) struct Columns<'a, P: Position> {
    pub(crate) x: &'a mut [P::Scalar],
    pub(crate) y: &'a mut [P::Scalar],
}

impl<P: Position> Output for Columns<'_, P> {
    type Position = P;

    fn room(&self) -> usize {
        self.x.len().min(self.y.len())
    }

    #[inline(always)]
    fn set(&mut self, i: usize, position: P) {
        [self.x[i], self.y[i]] = position.xy();
    }

    #[inline(always)]
    fn write(
        &mut self,
        i: usize,
        segment: &Segment<'_, P::Scalar>,
        to_caller: &ToCaller<P::Scalar>,
    ) {
        let run = i..i + segment.len();
        let (x, y) = (&mut self.x[run.clone()], &mut self.y[run]);
        segment.write_columns(x, y);
        if !to_caller.is_identity() {
            for (x, y) in x.iter_mut().zip(y) {
                [*x, *y] = to_caller.place::<P>(*x, *y).xy();
            }
        }
    }
}

/// Writes the sampling's points to `output` until either ends.
pub(crate) fn fill<I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    mut output: O,
) -> Result<Filled, SamplingError> {
    let vectors = Vectors::detect();
    let to_caller = ToCaller::new(&sampling.placement().domain())?;
    let mut traversal = AnyTraversal::new(sampling);
    let mut chunk = Chunk::new();
    let mut written = 0;
    while traversal.advance(sampling)? {
        let complete = vectors.run(
            #[inline(always)]
            || emit(sampling, &traversal, &to_caller, &mut chunk, (&mut output, &mut written)),
        )?;
        if !complete {
            return Ok(Filled { written, complete });
        }
    }
    Ok(Filled { written, complete: true })
}

/// Writes the points of the current batch from index `written` on; `false` if there was no room for
/// all of them.
#[inline(always)]
fn emit<I: Importance, S: Scalar, O: Output<Position: Position<Scalar = S>>>(
    sampling: &Sampling<'_, I>,
    traversal: &AnyTraversal,
    to_caller: &ToCaller<S>,
    chunk: &mut Chunk<S>,
    (output, written): (&mut O, &mut usize),
) -> Result<bool, SamplingError> {
    let batch = traversal.batch();
    let mut next = batch.start;
    if batch.inside && batch.all_accepted && batch.end - next <= output.room() - *written {
        while next < batch.end {
            let (segment, end) = batch.segment(sampling.placement(), next, usize::MAX);
            output.write(*written, &segment, to_caller);
            *written += end - next;
            next = end;
        }
        return Ok(true);
    }
    while next < batch.end {
        next = traversal.select::<I, O::Position>(sampling, to_caller, next, chunk)?;
        if !append(chunk, output, written, to_caller) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Appends the chunk's points; `false` if there was no room for all of them.
#[inline(always)]
fn append<S: Scalar, O: Output<Position: Position<Scalar = S>>>(
    chunk: &Chunk<S>,
    output: &mut O,
    written: &mut usize,
    to_caller: &ToCaller<S>,
) -> bool {
    let kept = chunk.keep[..chunk.len].iter().zip(&chunk.x).zip(&chunk.y);
    let mut at = *written;
    if output.room() - at >= chunk.len {
        // A rejected candidate is overwritten by the next one: no branch depends on the data.
        for ((keep, x), y) in kept {
            output.set(at, to_caller.place(*x, *y));
            at += usize::from(*keep);
        }
        *written = at;
        return true;
    }
    for ((_, x), y) in kept.filter(|((keep, _), _)| **keep == 1) {
        if at == output.room() {
            *written = at;
            return false;
        }
        output.set(at, to_caller.place(*x, *y));
        at += 1;
    }
    *written = at;
    true
}
