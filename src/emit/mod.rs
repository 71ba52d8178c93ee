//! Ways to receive the points of a sampling: a buffer, an iterator, parts, several threads, only the cost, or how it is done.
//!
//! A [`Sampling`](crate::Sampling) says what is wanted and knows no walk; here it gets the methods that walk.

mod division;
mod effort;
mod fill;
mod opened;
mod points;
#[cfg(feature = "parallel")]
mod shards;

pub use division::{Division, Part};
pub use effort::Effort;
pub use fill::Filled;
pub use opened::PlacedTile;
pub use points::{Points, Sample};
#[cfg(feature = "parallel")]
pub use shards::Shards;
