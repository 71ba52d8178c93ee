//! What the options ask of a drawing.

pub(crate) mod plan;
