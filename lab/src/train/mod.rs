//! The trainer of relaxed offsets, and the slow reference of how they are read.
//!
//! The reference, which is the oracle of the sampler's relaxed mode (it enumerates and looks up point by
//! point, with nothing baked):
//!
//! - [`ground`]: tiles of a random place in a deep root, with exact integers;
//! - [`field`]: thresholds over the plane; [`image`]: those of an image;
//! - [`site`]: the points of a field on a ground, their classes and phases, fixed and relaxed.
//!
//! The trainer:
//!
//! - [`patch`], [`motif`]: what is trained on, ramps of the density and procedural images;
//! - [`force`]: how points push each other, and how that is gathered into table entries;
//! - [`table`], [`train`], [`schedule`]: the table in training, a pass over it, and the recipe.
//!
//! [`report`] measures tables on places that training never saw.

pub mod field;
pub mod force;
pub mod ground;
pub mod image;
pub mod motif;
pub mod patch;
pub mod report;
pub mod schedule;
pub mod site;
pub mod table;
pub mod train;

pub use field::Field;
pub use ground::{Ground, Region};
pub use schedule::Recipe;
pub use site::Site;
