//! For those who study twelvefold or retrain its tables: the paper's own numbers, measures of point
//! sets, and the trainer of the displacements that the library bakes.

#[cfg(feature = "program")]
pub mod classic;
pub mod measure;
pub mod paper;
pub mod random;
#[cfg(feature = "program")]
pub mod render;
#[cfg(feature = "program")]
pub mod train;
