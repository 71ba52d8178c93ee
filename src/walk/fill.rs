//! Filling a caller's buffers: the fast way, with nothing between the tables and the buffer where no
//! test is needed.

use super::chunk::Chunk;
use super::ground::{Ground, Steps};
use super::kin::{Kin, Kinship};
use super::scalar::{Position, Scalar};
use super::traverse::Traversal;
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
    /// Writes a run of `len` positions from `i` on, given relative to the domain's least corner;
    /// `i` + `len` ≤ room.
    fn write<S: Scalar>(
        &mut self,
        i: usize,
        len: usize,
        positions: impl Iterator<Item = [S; 2]>,
        to_caller: &ToCaller<S>,
    ) where
        Self::Position: Position<Scalar = S>;
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
    fn write<S: Scalar>(
        &mut self,
        i: usize,
        len: usize,
        positions: impl Iterator<Item = [S; 2]>,
        to_caller: &ToCaller<S>,
    ) where
        P: Position<Scalar = S>,
    {
        let slots = self[i..i + len].iter_mut().zip(positions);
        if to_caller.is_identity() {
            for (slot, [x, y]) in slots {
                *slot = P::from_xy(x, y);
            }
        } else {
            for (slot, [x, y]) in slots {
                *slot = to_caller.place(x, y);
            }
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
    fn write<S: Scalar>(
        &mut self,
        i: usize,
        len: usize,
        positions: impl Iterator<Item = [S; 2]>,
        to_caller: &ToCaller<S>,
    ) where
        P: Position<Scalar = S>,
    {
        let (x, y) = (&mut self.x[i..i + len], &mut self.y[i..i + len]);
        let columns = x.iter_mut().zip(y).zip(positions);
        if to_caller.is_identity() {
            for ((to_x, to_y), [x, y]) in columns {
                (*to_x, *to_y) = (x, y);
            }
        } else {
            for ((to_x, to_y), [x, y]) in columns {
                [*to_x, *to_y] = to_caller.place::<P>(x, y).xy();
            }
        }
    }
}

/// Writes the sampling's points to `output` until either ends.
pub(crate) fn fill<I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    output: O,
) -> Result<Filled, SamplingError> {
    match sampling.relaxation() {
        None => fill_from(sampling, Traversal::<()>::new(sampling), None, output),
        Some(_) => fill_relaxed(sampling, output),
    }
}

// A function of its own for the sake of its stack: `Ground` is 87 KB.
#[inline(never)]
fn fill_relaxed<I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    output: O,
) -> Result<Filled, SamplingError> {
    let traversal = Traversal::<Kin>::new(sampling);
    match Ground::of(sampling) {
        Some(mut ground) => fill_from(sampling, traversal, Some(&mut ground), output),
        None => fill_from(sampling, traversal, None, output),
    }
}

fn fill_from<K: Kinship, I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    mut traversal: Traversal<K>,
    mut ground: Option<&mut Ground<'_>>,
    mut output: O,
) -> Result<Filled, SamplingError> {
    let vectors = Vectors::detect();
    let to_caller = ToCaller::new(&sampling.placement().domain())?;
    let mut chunk = Chunk::new();
    let mut written = 0;
    vectors.run(
        #[inline(always)]
        || {
            while traversal.advance(sampling)? {
                let steps = match &mut ground {
                    Some(ground) => ground.steps(sampling.placement(), traversal.batch()),
                    None => None,
                };
                let output = (&mut output, &mut written);
                let complete = emit(sampling, &traversal, steps, &to_caller, &mut chunk, output)?;
                if !complete {
                    return Ok(Filled { written, complete });
                }
            }
            Ok(Filled { written, complete: true })
        },
    )
}

/// Writes the points of the current batch from index `written` on; `false` if there was no room for
/// all of them.
#[inline(always)]
fn emit<K: Kinship, I: Importance, S: Scalar, O: Output<Position: Position<Scalar = S>>>(
    sampling: &Sampling<'_, I>,
    traversal: &Traversal<K>,
    steps: Option<Steps<'_, S>>,
    to_caller: &ToCaller<S>,
    chunk: &mut Chunk<S>,
    (output, written): (&mut O, &mut usize),
) -> Result<bool, SamplingError> {
    let batch = traversal.batch();
    let mut next = batch.start;
    let room = output.room() - *written;
    // Nothing to test: straight from the tables into the buffer.
    let certain = batch.certain.min(batch.end);
    let all = batch.inside && certain.saturating_sub(next) <= room;
    if all && (!K::RELAXED || steps.is_some()) {
        while next < certain {
            let most = certain - next;
            let (segment, end) = batch.segment(sampling.placement(), next, most);
            let centres = segment.positions();
            match steps {
                None => output.write(*written, end - next, centres, to_caller),
                Some(steps) => {
                    output.write(*written, end - next, steps.moved(next, centres), to_caller);
                }
            }
            *written += end - next;
            next = end;
        }
    }
    while next < batch.end {
        next = match steps {
            Some(steps) => {
                traversal.select_moved::<I, O::Position>(sampling, to_caller, next, &steps, chunk)
            }
            None => traversal.select::<I, O::Position>(sampling, to_caller, next, chunk)?,
        };
        if !append(chunk, output, written, to_caller) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Appends the chunk's points; `false` if there was no room for all of them.
#[inline(always)]
fn append<S: Scalar, O: Output<Position: Position<Scalar = S>>>(
    chunk: &mut Chunk<S>,
    output: &mut O,
    written: &mut usize,
    to_caller: &ToCaller<S>,
) -> bool {
    let room = output.room() - *written;
    if room >= chunk.len {
        let mut at = *written;
        // A rejected candidate is overwritten by the next one: no branch depends on the data.
        let kept = chunk.keep[..chunk.len].iter().zip(&chunk.x).zip(&chunk.y);
        for ((keep, x), y) in kept {
            output.set(at, to_caller.place(*x, *y));
            at += usize::from(*keep);
        }
        *written = at;
        return true;
    }
    chunk.pack();
    let len = chunk.len.min(room);
    let points = chunk.x[..len].iter().zip(&chunk.y).map(|(x, y)| [*x, *y]);
    output.write(*written, len, points, to_caller);
    *written += len;
    chunk.len <= room
}
