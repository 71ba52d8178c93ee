//! What does not change during a walk.

use crate::sampling::{Clip, Sampling, ToWorld};

/// What every step of a walk is told.
pub(crate) struct Context<'w, 'a, I, S> {
    pub(crate) sampling: &'w Sampling<'a, I>,
    pub(crate) clip: &'w Clip,
    pub(crate) to_world: &'w ToWorld<S>,
}
