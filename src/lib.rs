//! twelvefold
#![cfg_attr(not(feature = "std"), no_std)]
#![warn(missing_docs)]
extern crate alloc;
pub mod bake;
#[cfg(feature = "measure")]
pub mod measure;
pub mod paper;
#[cfg(feature = "train")]
pub mod relax;
pub mod tiling;
