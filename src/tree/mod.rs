//! The tiling as the walk meets it: tiles with their ranks, and the frames that turn exact points into
//! coordinates.

pub(crate) mod frame;
pub(crate) mod node;
