//! For those who study twelvefold or retrain its tables: the paper's own numbers, measures of point
//! sets, and the trainer of the displacements that the library bakes.

pub mod measure;
pub mod paper;
pub mod random;
pub mod stipplers;
#[cfg(feature = "program")]
pub mod train;
