//! Filling a caller's buffers: the fast way, with nothing between the tables and the buffer where no
//! test is needed.

use crate::error::SamplingError;
use crate::importance::Importance;
use crate::position::{Coordinate, Position, Scalar};
use crate::sampling::{Sampling, ToWorld};
use crate::simd::Simd;
use crate::walk::ancestry::Ancestry;
use crate::walk::chunk::Chunk;
use crate::walk::displaced::Displaced;
use crate::walk::mode::{Fixed, Mode};
use crate::walk::shard::Shard;
use crate::walk::traverse::Traversal;
use crate::walk::uniform::UniformDisplacements;

/// How far a buffer was filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Filled {
    /// The number of positions written, from the buffer's start.
    pub written: usize,
    /// Whether these are all points; otherwise the buffer was too small.
    pub complete: bool,
}

/// Where positions go: a buffer of points, or one buffer a coordinate.
pub(super) trait Output {
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
        to_world: &ToWorld<S>,
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
        to_world: &ToWorld<S>,
    ) where
        P: Position<Scalar = S>,
    {
        let slots = self[i..i + len].iter_mut().zip(positions);
        if to_world.is_identity() {
            for (slot, [x, y]) in slots {
                *slot = P::from_xy(x, y);
            }
        } else {
            for (slot, [x, y]) in slots {
                *slot = to_world.place(x, y);
            }
        }
    }
}

/// x[] and y[], of one length.
pub(super) struct Columns<'a, P: Position> {
    x: &'a mut [P::Scalar],
    y: &'a mut [P::Scalar],
}

impl<'a, P: Position> Columns<'a, P> {
    /// As long as the shorter of the two.
    pub(super) fn new(x: &'a mut [P::Scalar], y: &'a mut [P::Scalar]) -> Self {
        let length = x.len().min(y.len());
        Self { x: &mut x[..length], y: &mut y[..length] }
    }
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
        to_world: &ToWorld<S>,
    ) where
        P: Position<Scalar = S>,
    {
        let (x, y) = (&mut self.x[i..i + len], &mut self.y[i..i + len]);
        let columns = x.iter_mut().zip(y).zip(positions);
        if to_world.is_identity() {
            for ((to_x, to_y), [x, y]) in columns {
                (*to_x, *to_y) = (x, y);
            }
        } else {
            for ((to_x, to_y), [x, y]) in columns {
                [*to_x, *to_y] = to_world.place::<P>(x, y).xy();
            }
        }
    }
}

impl<I: Importance> Sampling<'_, I> {
    /// Writes positions into the caller's buffer, in the order of the walk, until it is full.
    /// Allocates nothing.
    ///
    /// ```
    /// use glam::Vec2;
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(500.0))?;
    /// let mut buffer = [Vec2::ZERO; 600];
    /// let filled = sampling.fill(&mut buffer)?;
    /// assert!(filled.complete && filled.written.abs_diff(500) < 20);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    ///
    /// The fastest way: ground of constant importance is copied from the tables block by block. For relaxed
    /// points it takes 87 KB of stack, from some 8,000 of a constant importance on, or 65,536 of any.
    ///
    /// # Errors
    /// [`SamplingError`] when the importance breaks its own bounds, the walk its limits, or the precision
    /// cannot resolve the domain; the buffer may then hold some of the points.
    pub fn fill<P: Position>(&self, buffer: &mut [P]) -> Result<Filled, SamplingError> {
        fill(self, None, buffer)
    }

    /// The same with one buffer a coordinate; the shorter one's length counts.
    ///
    /// # Errors
    /// As [`fill`](Self::fill).
    pub fn fill_columns<S: Coordinate>(
        &self,
        x: &mut [S],
        y: &mut [S],
    ) -> Result<Filled, SamplingError> {
        fill(self, None, Columns::<S::Position>::new(x, y))
    }
}

/// Writes the sampling's points, or those of a shard of it, to `output` until either ends.
pub(super) fn fill<I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    shard: Option<Shard>,
    output: O,
) -> Result<Filled, SamplingError> {
    match sampling.displacements() {
        None => fill_from(sampling, Traversal::<Fixed>::new(sampling, shard), None, output),
        Some(_) => fill_relaxed(sampling, shard, output),
    }
}

// A function of its own for the sake of its stack: `BlockVectors` are 87 KB.
#[inline(never)]
fn fill_relaxed<I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    shard: Option<Shard>,
    output: O,
) -> Result<Filled, SamplingError> {
    let traversal = Traversal::<Ancestry>::new(sampling, shard);
    let mut vectors = None;
    match UniformDisplacements::of(sampling, &mut vectors) {
        Some(mut ground) => fill_from(sampling, traversal, Some(&mut ground), output),
        None => fill_from(sampling, traversal, None, output),
    }
}

fn fill_from<K: Mode, I: Importance, O: Output>(
    sampling: &Sampling<'_, I>,
    mut traversal: Traversal<K>,
    mut ground: Option<&mut UniformDisplacements<'_, '_>>,
    mut output: O,
) -> Result<Filled, SamplingError> {
    let vectors = Simd::detect();
    let to_world = ToWorld::new(&sampling.placement().domain())?;
    let mut chunk = Chunk::new();
    let mut written = 0;
    vectors.run(
        #[inline(always)]
        || {
            while traversal.advance(sampling)? {
                let steps = match &mut ground {
                    Some(ground) => ground.steps(sampling, traversal.batch()),
                    None => None,
                };
                let (output, written) = (&mut output, &mut written);
                let complete =
                    emit(sampling, &traversal, steps, &to_world, &mut chunk, output, written)?;
                if !complete {
                    return Ok(Filled { written: *written, complete });
                }
            }
            Ok(Filled { written, complete: true })
        },
    )
}

/// Writes the points of the current batch from index `written` on; `false` if there was no room for
/// all of them.
#[inline(always)]
fn emit<K: Mode, I: Importance, S: Scalar, O: Output<Position: Position<Scalar = S>>>(
    sampling: &Sampling<'_, I>,
    traversal: &Traversal<K>,
    steps: Option<Displaced<'_, S>>,
    to_world: &ToWorld<S>,
    chunk: &mut Chunk<S>,
    output: &mut O,
    written: &mut usize,
) -> Result<bool, SamplingError> {
    let batch = traversal.batch();
    let mut next = batch.start;
    let room = output.room() - *written;
    // Nothing to test: straight from the tables into the buffer.
    let sure = batch.sure;
    let all = batch.inside && sure.saturating_sub(next) <= room;
    if all && (!K::RELAXED || steps.is_some()) {
        while next < sure {
            let most = sure - next;
            let (segment, end) = batch.segment(sampling.placement(), next, most);
            let centers = segment.positions();
            match steps {
                None => output.write(*written, end - next, centers, to_world),
                Some(steps) => {
                    output.write(*written, end - next, steps.moved(next, centers), to_world);
                }
            }
            *written += end - next;
            next = end;
        }
    }
    while next < batch.end {
        next = match steps {
            Some(steps) => {
                traversal.select_moved::<I, O::Position>(sampling, to_world, next, &steps, chunk)
            }
            None => traversal.select::<I, O::Position>(sampling, to_world, next, chunk)?,
        };
        if !append(chunk, output, written, to_world) {
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
    to_world: &ToWorld<S>,
) -> bool {
    let room = output.room() - *written;
    if chunk.whole && room >= chunk.len {
        let points = chunk.x[..chunk.len].iter().zip(&chunk.y).map(|(x, y)| [*x, *y]);
        output.write(*written, chunk.len, points, to_world);
        *written += chunk.len;
        return true;
    }
    if room >= chunk.len {
        let mut at = *written;
        // A rejected candidate is overwritten by the next one: no branch depends on the data.
        let kept = chunk.keep[..chunk.len].iter().zip(&chunk.x).zip(&chunk.y);
        for ((keep, x), y) in kept {
            output.set(at, to_world.place(*x, *y));
            at += usize::from(*keep);
        }
        *written = at;
        return true;
    }
    chunk.pack();
    let len = chunk.len.min(room);
    let points = chunk.x[..len].iter().zip(&chunk.y).map(|(x, y)| [*x, *y]);
    output.write(*written, len, points, to_world);
    *written += len;
    chunk.len <= room
}
