//! twelvefold
#![cfg_attr(not(feature = "std"), no_std)]
#![warn(missing_docs)]
pub mod paper;
pub mod tiling;
