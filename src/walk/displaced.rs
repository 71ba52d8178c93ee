//! Displacements of a block's entries, looked up beforehand and added to the fixed centers.

use crate::position::Scalar;
use crate::tree::frame::EdgeFrame;

/// How far the entries of a block are moved.
#[derive(Clone, Copy)]
pub(crate) struct Displaced<'g, S> {
    /// By entry.
    pub(crate) x: &'g [f32],
    pub(crate) y: &'g [f32],
    pub(crate) frame: EdgeFrame<S>,
}

impl<S: Scalar> Displaced<'_, S> {
    /// The positions of the entries from `start` on, once they are moved.
    #[inline(always)]
    pub(crate) fn moved(
        &self,
        start: usize,
        centers: impl Iterator<Item = [S; 2]>,
    ) -> impl Iterator<Item = [S; 2]> {
        let frame = self.frame;
        let steps = self.x[start..].iter().zip(&self.y[start..]);
        centers.zip(steps).map(move |([x, y], (step_x, step_y))| {
            let step = frame.displacement([*step_x, *step_y]);
            [x + step[0], y + step[1]]
        })
    }
}
