//! What a walk costs, counted instead of timed.

use glam::DVec2;

use crate::error::SamplingError;
use crate::importance::Importance;
use crate::sampling::{Sampling, ToWorld};
use crate::walk::Walk;
use crate::walk::candidates::Candidates;
use crate::walk::chunk::Chunk;

/// The work of one walk: the same on every machine. See [`Sampling::effort`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Tiles whose bound was looked at and that could hold a point, each visit of a tile counted;
    /// what [`Limits::tiles`](crate::Limits::tiles) limits.
    pub tiles: u64,
    /// Points read from the tables.
    pub candidates: u64,
    /// Those of them that the importance's bounds do not decide, so that its value had to be read.
    pub tested: u64,
    /// Points of the set among them.
    pub points: u64,
}

impl Effort {
    /// Walks once, in double precision, and counts.
    pub(crate) fn of<I: Importance>(sampling: &Sampling<'_, I>) -> Result<Self, SamplingError> {
        let mut traversal = Walk::new(sampling, None);
        let to_world = ToWorld::new(&sampling.placement().domain())?;
        let mut chunk = Chunk::new();
        let (mut candidates, mut tested, mut points) = (0, 0, 0);
        while traversal.advance(sampling)? {
            let Candidates { mut start, end, sure, .. } = *traversal.batch();
            candidates += (end - start) as u64;
            tested += (end - sure.clamp(start, end)) as u64;
            while start < end {
                start = traversal.select::<I, DVec2>(sampling, &to_world, start, &mut chunk)?;
                points += chunk.keep[..chunk.len].iter().map(|keep| u64::from(*keep)).sum::<u64>();
            }
        }
        let tiles = sampling.limits().tiles - traversal.tiles_left();
        Ok(Self { tiles, candidates, tested, points })
    }
}

impl<I: Importance> Sampling<'_, I> {
    /// Counts what the walk does: how many tiles it visits and how many candidates it tests for the
    /// points it makes. Costs a walk.
    ///
    /// # Errors
    /// As [`fill`](Self::fill).
    pub fn effort(&self) -> Result<Effort, SamplingError> {
        Effort::of(self)
    }
}
