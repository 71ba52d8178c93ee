//! For those who study twelvefold or retrain its tables: the paper's own numbers, measures of point
//! sets, other ways to make points and maps to compare on, and the trainer of the displacements that the
//! library bakes.

#[cfg(feature = "program")]
pub mod contenders;
#[cfg(feature = "program")]
pub mod maps;
pub mod measure;
pub mod paper;
pub mod random;
#[cfg(feature = "program")]
pub mod render;
#[cfg(feature = "program")]
pub mod rivals;
pub mod stipplers;
#[cfg(feature = "program")]
pub mod train;
