//! Other ways to make points, each written once: what the report, the speed report and the benches
//! compare with.

mod distributions;
mod sequences;

pub use distributions::InverseCdf;
pub use sequences::{halton, poisson_disk, r2, r2_single, sobol};
