//! twelvefold's points made on the GPU, every frame: the same sampler, the same bits.
mod error;
mod keys;
mod plan;
#[cfg(feature = "wgpu")]
mod sampler;
mod shader;
mod status;
mod tables;
mod tiles;

pub use error::GpuError;
pub use keys::{Keys, NO_KEY};
pub use plan::{Binding, Capacity, Groups, Order, Pass, Plan, Points, RELAXED_ERROR};
#[cfg(feature = "wgpu")]
pub use sampler::{Importance, Sampler};
pub use shader::{Arithmetic, Source, wgsl};
pub use status::Status;
