//! The trainer of relaxed offsets, and the slow reference of how they are read.
//!
//! The reference, which is the oracle of the sampler's relaxed mode (it enumerates and looks up point by
//! point, with nothing baked):
//!
//! - [`place`]: tiles of a random place in a deep root, with exact integers;
//! - [`field`]: thresholds over the plane; [`image`]: those of an image;
//! - [`site`]: the points of a field on a ground, their classes and phases, fixed and relaxed.
//!
//! The trainer:
//!
//! - [`ramp`], [`procedural`]: what is trained on, ramps of the density and procedural images;
//! - [`force`]: how points push each other, and how that is gathered into table entries;
//! - [`table`], [`pass`], [`recipe`]: the table in training, a pass over it, and the recipe.
//!
//! [`evaluate`] measures tables on places that training never saw.

pub mod evaluate;
pub mod field;
pub mod force;
pub mod image;
pub mod pass;
pub mod place;
pub mod procedural;
pub mod ramp;
pub mod recipe;
pub mod site;
pub mod table;

pub use field::Field;
pub use place::{Place, Region};
pub use recipe::Recipe;
pub use site::Site;
