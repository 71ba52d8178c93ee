//! Filling a caller's buffer: the fast way, with nothing between the tables and the buffer where no
//! test is needed.

use super::chunk::Chunk;
use super::scalar::Position;
use crate::clip::{Clip, ToCaller};
use crate::importance::Importance;
use crate::points::{AnyLeaf, AnyTraversal, Filled};
use crate::sampling::{Sampling, SamplingError};

/// Writes the sampling's points to `buffer` until either ends.
pub(crate) fn fill<I: Importance, P: Position>(
    sampling: &Sampling<'_, I>,
    buffer: &mut [P],
) -> Result<Filled, SamplingError> {
    let placement = sampling.placement();
    let domain = placement.domain();
    let to_caller = ToCaller::<P::Scalar>::new(&domain)?;
    let mut traversal = AnyTraversal::new(sampling, Clip::domain(&domain));
    let mut chunk = Chunk::new();
    let mut written = 0;
    while let Some(leaf) = traversal.next_leaf(sampling)? {
        let rest = &mut buffer[written..];
        if let AnyLeaf::Fixed(leaf) = leaf
            && leaf.inside
            && leaf.all_accepted
            && leaf.candidates <= rest.len()
        {
            leaf.write_positions(placement, rest);
            to_caller.place_all(&mut rest[..leaf.candidates]);
            written += leaf.candidates;
            continue;
        }
        let mut candidate = 0;
        while candidate < leaf.candidates() {
            candidate = leaf.fill_accepted(sampling, candidate, &mut chunk)?;
            let rest = &mut buffer[written..];
            let fitting = chunk.len.min(rest.len());
            for ((slot, x), y) in rest[..fitting].iter_mut().zip(&chunk.x).zip(&chunk.y) {
                *slot = to_caller.place(*x, *y);
            }
            written += fitting;
            if fitting < chunk.len {
                return Ok(Filled { written, complete: false });
            }
        }
    }
    Ok(Filled { written, complete: true })
}
