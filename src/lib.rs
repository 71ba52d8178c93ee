//! twelvefold
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
#[cfg(test)]
extern crate std;

#[cfg(test)]
mod accuracy;
pub mod bake;
mod clip;
mod domain;
mod environment;
pub mod estimate;
pub mod importance;
#[cfg(test)]
mod oracle;
pub mod paper;
mod placement;
mod points;
mod sampling;
mod seed;
mod tables;
pub mod tiling;
mod walk;

pub use domain::{Domain, DomainError, Region};
pub use environment::{EnvironmentError, EnvironmentMap, EnvironmentSample};
pub use importance::{
    BilinearMap, Constant, Function, ImageMap, Importance, InvalidPixels, MapError,
};
pub use placement::Placement;
pub use points::{Filled, Points, Sample};
pub use sampling::{Amount, Limits, Sampling, SamplingError};
pub use tables::{BlockTable, Tables, TablesError};
pub use walk::scalar::{Position, Scalar};
