//! The trainer of relaxed offsets, and the slow reference of how they are read.
//!
//! - [`ground`]: tiles of a random place in a deep root, with exact integers;
//! - [`field`]: thresholds over the plane: constant, ramps, images;
//! - [`site`]: the points of a field on a ground, their classes and phases, fixed and relaxed. This is
//!   the oracle of the sampler's relaxed mode: it enumerates and looks up point by point, with nothing
//!   baked.

pub mod field;
pub mod force;
pub mod ground;
pub mod image;
pub mod motif;
pub mod patch;
pub mod random;
pub mod report;
pub mod schedule;
pub mod site;
pub mod table;
pub mod train;

pub use field::Field;
pub use ground::{Ground, Region};
pub use schedule::Recipe;
pub use site::Site;
