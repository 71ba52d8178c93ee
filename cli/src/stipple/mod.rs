//! From a picture's importance to dots: how many, where, and how large.

pub(crate) mod budget;
pub(crate) mod dots;
pub(crate) mod gain;
pub(crate) mod plan;
