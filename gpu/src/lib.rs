//! twelvefold's points made on the GPU, every frame: the same sampler, the same bits.
mod error;
mod golden;
mod keys;
mod plan;
#[cfg(feature = "wgpu")]
mod sampler;
#[cfg(feature = "wgpu")]
mod self_test;
mod shader;
mod status;
mod tables;
mod tiles;

pub use error::GpuError;
pub use golden::{Golden, golden};
pub use keys::{Keys, NO_KEY};
pub use plan::{Binding, Capacity, Groups, Order, Pass, Plan, Points, RELAXED_ERROR};
#[cfg(feature = "wgpu")]
pub use sampler::{Importance, Sampler};
#[cfg(feature = "wgpu")]
pub use self_test::{choose_arithmetic, is_exact};
pub use shader::{Arithmetic, Source, self_test_wgsl, wgsl};
pub use status::Status;
