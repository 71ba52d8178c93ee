//! YUV4MPEG2 streams: uncompressed video, as programs hand it to each other.
//!
//! `header`: what the first line says. `reader`: frames as importance.

mod error;
mod header;
mod reader;

pub use error::Y4mError;
pub use header::Rate;
pub use reader::Reader;
