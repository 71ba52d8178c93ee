//! The dodecagonal tiling in exact integers: coordinates, stars, production rules, numbers.
//!
//! This folder is a leaf: it uses `core` and its own siblings only, so that `build.rs` compiles the
//! very same files (`#[path = "src/tiling/mod.rs"]`) and the rules have one home.
//!
//! Source: V. Ostromoukhov, *Building 2D Low-Discrepancy Sequences for Hierarchical Importance
//! Sampling Using Dodecagonal Aperiodic Tiling*. The paper's Figure 3 holds the geometry; here it is
//! derived from vertex stars (see [`children`]).

pub mod children;
pub mod counts;
pub mod cyclotomic;
pub mod digits;
pub mod fcode;
pub mod numbers;
pub mod rank;
pub mod rules;
pub mod snub_square;
pub mod tile;

pub use children::{Child, MAX_CHILDREN};
pub use counts::{MAX_LEVEL, RankError, TileCounts};
pub use cyclotomic::{Cyclotomic, OutOfRange, Surd};
pub use digits::{Digits, DigitsError};
pub use fcode::{FCode, FCodeError};
pub use rules::Rules;
pub use tile::{Tile, TileType};
