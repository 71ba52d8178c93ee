//! Pictures in, files out: what the programs share. A photograph becomes importance, an environment map
//! radiance, a list points; a result becomes a file that appears whole or not at all.

#![allow(
    missing_docs,
    reason = "for the programs of this workspace only; what a name does not say is documented"
)]
#![cfg_attr(
    not(feature = "every-format"),
    allow(dead_code, reason = "a little of what all formats share is for the others only")
)]

pub mod failure;
#[cfg(feature = "program")]
mod interrupt;
#[cfg(feature = "program")]
pub mod output;
pub mod picture;
pub mod point_list;
#[cfg(feature = "program")]
pub mod progress;
pub mod y4m;
