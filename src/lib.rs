//! twelvefold
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

pub mod bake;
mod clip;
mod domain;
pub mod importance;
#[cfg(test)]
mod oracle;
pub mod paper;
#[cfg(feature = "parallel")]
mod parallel;
mod placement;
mod points;
mod sampling;
mod seed;
mod tables;
pub mod tiling;
mod walk;

pub use domain::{Domain, DomainError, Region};
pub use importance::{
    Constant, Function, ImageMap, Importance, InvalidPixels, MapError, PixelData, PixelView, Probed,
};
#[cfg(feature = "parallel")]
pub use parallel::Shards;
pub use placement::Placement;
pub use points::{Filled, Points, Sample};
pub use sampling::{Amount, Limits, Sampling, SamplingError};
pub use tables::{BlockTable, Tables, TablesError};
pub use walk::scalar::{Coordinate, Position, Scalar};
