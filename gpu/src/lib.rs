#![cfg_attr(feature = "wgpu", doc = include_str!("../README.md"))]
#![cfg_attr(
    not(feature = "wgpu"),
    doc = "twelvefold's points made on the GPU as plain data: WGSL, words and passes."
)]
//!
//! # The way of a frame
//!
//! 1. `pyramid.wgsl`: maxima of the importance over 2 × 2, 4 × 4 … texels.
//! 2. `classify.wgsl`: a thread a start tile, all of which reach the domain, bounds how many of its block's
//!    entries can be points. Where a peak needs more than a block holds, the tile is opened: all tiles one
//!    to three levels below it take its place. Sums make the candidates of all tiles one list.
//! 3. `points.wgsl`: a lane a candidate, whatever tile it is of: its tile by searching the sums, its exact
//!    center, its position, its texel, whether its rank is a point. Ordered, one pass marks a bit and
//!    counts, the next one writes.
mod error;
mod golden;
mod keys;
mod pass;
mod plan;
#[cfg(feature = "wgpu")]
mod sampler;
#[cfg(feature = "wgpu")]
mod self_test;
mod shader;
mod status;
mod tables;
mod tiles;
mod uniform;

pub use error::GpuError;
pub use golden::{Golden, golden};
pub use keys::{Keys, NO_KEY};
pub use pass::{Binding, Groups, Pass};
pub use plan::{Capacity, Order, Plan, Points, RELAXED_ERROR};
#[cfg(feature = "wgpu")]
pub use sampler::{Importance, Sampler};
#[cfg(feature = "wgpu")]
pub use self_test::{choose_arithmetic, is_exact};
pub use shader::{Arithmetic, Source, self_test_wgsl, wgsl};
pub use status::Status;
