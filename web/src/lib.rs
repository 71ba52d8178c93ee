//! The browser's door to twelvefold: bytes and pixels in, arrays and files out, and nothing of the sampling itself.
//!
//! `photograph`: from a file or a canvas to a picture. `camera`: from frames. `stipple`: its dots, step by step, so
//! that the worker hears a stop between two of them. `stippled`: dots as places, and as files. `descent`: the tiles
//! that a walk opens. `tables`: what all points are read from.

mod camera;
mod descent;
mod photograph;
mod stipple;
mod stippled;
mod tables;

pub use camera::Camera;
pub use descent::Descent;
pub use photograph::Photograph;
pub use stipple::Mode;
pub use stippled::Stippled;
