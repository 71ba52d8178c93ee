//! Well-spread points with a density you control, from tables baked at build time.
//!
//! twelvefold places points by Ostromoukhov's dodecagonal tiling: four tile types subdivide into each
//! other endlessly; every tile gives one point and a rank; a point is accepted where the importance
//! reaches its rank. The result is a point set that is evenly spread at any density, follows an
//! importance map, and is the same, bit for bit, on every machine.
//!
//! ```
//! use glam::Vec2;
//! use twelvefold::{Amount, ImageMap, InvalidPixels, Pixels, Placement, Sampling};
//!
//! // A 3 × 2 importance map: nothing on the left, four times as much below as above on the right.
//! let pixels = vec![0.0, 1.0, 1.0, 0.0, 4.0, 4.0];
//! let map = ImageMap::new(Pixels::new(3, 2, pixels, InvalidPixels::Reject)?)?;
//! let placement = Placement::new(map.domain(), 42); // a domain and a seed; keep it across frames
//! let sampling = Sampling::new(&placement, &map, Amount::Points(1000.0))?;
//!
//! let mut buffer = [Vec2::ZERO; 1200]; // nothing is allocated
//! let filled = sampling.fill(&mut buffer)?;
//! assert!(filled.complete && filled.written.abs_diff(1000) < 30);
//! assert!(buffer[..filled.written].iter().all(|p| p.x >= 1.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The way of a point
//!
//! 1. [`tiling`]: exact integers only. Coordinates in `Z[ζ₁₂]`, production rules, ranks, F-codes.
//! 2. [`bake`]: `build.rs` subdivides each tile type to a fixed depth and bakes offsets and thresholds;
//!    [`Tables`] views them where they lie.
//! 3. [`Placement`]: a seed puts the [`Domain`] somewhere in a root tile at least 128 times as wide.
//! 4. [`Importance`]: value at a point, upper bound over a region. [`Constant`], [`ImageMap`],
//!    [`Function`], or your own.
//! 5. [`Sampling`]: descends only where a point can be accepted, and reads blocks of points from the
//!    tables. Received by [`fill`](Sampling::fill), by [`points`](Sampling::points), or in parts of a
//!    [`Division`](Sampling::divide).
//!
//! After that, [`estimate`] makes weights of fixed points, and `refine` (with `std`) moves points until
//! they draw a picture. `ARCHITECTURE.md` in the repository shows where each of these lives.
//!
//! # Promises
//!
//! The same crate version, tables, domain, seed, importance and amount give the same points on every
//! platform, whatever the baked depth. Decisions compare integers, or floating-point numbers that only
//! ever came from +, −, ×, ÷ and √.
//!
//! Numbers, sizes and bytes that do not fit are error values that say where they are, not panics. What a
//! caller's own importance or closure does is its own, and memory that runs out ends the program as it
//! does elsewhere in Rust. The library contains no `unsafe` code.
//!
//! # Features
//!
//! The default is `std` and `simd`. Without default features the library needs `alloc` only.
//!
//! - `std` (default): the module `refine`; glam and serde use `std`;
//! - `simd` (default): wider vector instructions, chosen when the program runs; the same points;
//! - `parallel`: `Shards`, and threads for `refine` and for making a `StippleMap`, with rayon; the same points
//!   in the same order;
//! - `serde`: `Serialize` and `Deserialize` for [`Domain`], [`Amount`], [`Limits`] and [`Sample`].
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
#[cfg(test)]
extern crate std;

/// The README's example, compiled and run with the other documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;

pub mod bake;
mod domain;
mod emit;
mod error;
pub mod estimate;
pub mod export;
pub mod importance;
pub mod light;
pub mod mesh;
mod mosaic;
mod placement;
mod position;
#[doc(hidden)]
pub mod random;
#[cfg(feature = "std")]
pub mod refine;
mod sampling;
mod simd;
mod tables;
#[cfg(test)]
mod tests;
mod threads;
pub mod tiling;
mod tree;
mod walk;

pub use domain::{Disc, Domain, DomainError};
#[cfg(feature = "parallel")]
pub use emit::Shards;
pub use emit::{Division, Effort, Filled, Part, PlacedTile, Points, Sample};
pub use error::SamplingError;
pub use importance::{
    BilinearMap, Constant, EnvironmentError, EnvironmentMap, EnvironmentSample, Function, ImageMap,
    Importance, InvalidPixels, MapError, PixelData, PixelView, Pixels, Probed, StippleMap,
};
pub use mosaic::{Cell, Mosaic};
pub use placement::Placement;
pub use position::{Coordinate, Position, Scalar};
pub use sampling::{Amount, Limits, Sampling};
pub use tables::{BlockTable, DisplacementTable, Tables, TablesError};
