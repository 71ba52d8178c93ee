//! The two modes of a walk: points at their tiles' centers, and relaxed points.

use super::ancestry::Ancestry;
use super::candidates::Candidates;
use super::chunk::Chunk;
use super::context::Context;
use super::ground::Ground;
use super::relaxed;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::position::Position;
use crate::sampling::Sampling;
use crate::tree::node::Node;

/// What a walk carries beside a tile: nothing for fixed centers, its [`Ancestry`] for relaxed points.
pub(crate) trait Mode: Copy + core::fmt::Debug {
    /// Whether points are moved.
    const RELAXED: bool;
    /// What an unused slot holds.
    const NONE: Self;
    /// Of a tile of the frontier.
    fn frontier(placement: &Placement<'_>, node: &Node) -> Self;
    /// Of the child with `digit` of `parent`, whose ancestry this is.
    fn child(&self, parent: &Node, digit: usize, child: &Node) -> Self;
    /// How far, in units, points born at `level` or later may be moved.
    fn margin(sampling: &Sampling<'_, impl Importance>, level: u8) -> f64;
    /// Takes entries of a batch of this ancestry from `start` on into a chunk, as many as fit, and marks
    /// the points among them. Returns the next entry.
    fn select<I: Importance, P: Position>(
        &self,
        walk: &Context<'_, '_, I, P::Scalar>,
        batch: &Candidates,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError>;
}

/// Points at their tiles' centers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed;

impl Mode for Fixed {
    const RELAXED: bool = false;
    const NONE: Self = Self;

    #[inline(always)]
    fn frontier(_: &Placement<'_>, _: &Node) -> Self {
        Self
    }

    #[inline(always)]
    fn child(&self, _: &Node, _: usize, _: &Node) -> Self {
        Self
    }

    #[inline(always)]
    fn margin(_: &Sampling<'_, impl Importance>, _: u8) -> f64 {
        0.0
    }

    #[inline(always)]
    fn select<I: Importance, P: Position>(
        &self,
        walk: &Context<'_, '_, I, P::Scalar>,
        batch: &Candidates,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        chunk.select::<I, P>(walk, batch, start)
    }
}

impl Mode for Ancestry {
    const RELAXED: bool = true;
    const NONE: Self = Self::NONE;

    fn frontier(placement: &Placement<'_>, node: &Node) -> Self {
        Self::frontier(placement, node)
    }

    #[inline(always)]
    fn child(&self, parent: &Node, digit: usize, child: &Node) -> Self {
        self.child(parent, digit, child)
    }

    #[inline(always)]
    fn margin(sampling: &Sampling<'_, impl Importance>, level: u8) -> f64 {
        relaxed::margin(sampling, level)
    }

    #[inline(always)]
    fn select<I: Importance, P: Position>(
        &self,
        walk: &Context<'_, '_, I, P::Scalar>,
        batch: &Candidates,
        start: usize,
        chunk: &mut Chunk<P::Scalar>,
    ) -> Result<usize, SamplingError> {
        match walk.sampling.displacements() {
            Some(displacements) => {
                if batch.constant
                    && let Some(ground) = Ground::of(walk.sampling, displacements, batch.bound)
                    && let Some(below) = ground.below(walk.sampling.placement(), batch)
                {
                    let ground = (&ground, below);
                    return Ok(chunk.select_constant::<I, P>(
                        walk,
                        displacements,
                        ground,
                        batch,
                        self,
                        start,
                    ));
                }
                chunk.select_relaxed::<I, P>(walk, displacements, batch, self, start)
            }
            // Ancestry is asked for only where there are offsets.
            None => Ok(batch.end),
        }
    }
}
