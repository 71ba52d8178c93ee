//! Moving pictures: where their frames come from, and where they go.
//!
//! `pattern`: names of numbered files. `input` and `output`: those, or a stream. `plan`: what all frames share.

pub(crate) mod input;
pub(crate) mod options;
pub(crate) mod output;
pub(crate) mod pattern;
pub(crate) mod plan;
