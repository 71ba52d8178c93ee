//! What the options ask of a drawing, and the file that it becomes.

pub(crate) mod drawn;
pub(crate) mod plan;
pub(crate) mod tones;
