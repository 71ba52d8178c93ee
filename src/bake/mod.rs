//! From rules to baked bytes: what `build.rs` runs, and what a program may run to make its own tables.
//!
//! Shared with `build.rs` by `#[path]`: it uses `core`, `alloc`, [`crate::tiling`] and the encoders
//! only.

pub mod block;
pub mod class;
pub mod displacement;
mod displacement_error;
pub mod format;

use alloc::vec::Vec;
use core::fmt;

use crate::tiling::{Rules, TileType};
use block::Block;
use displacement::Displacements;

/// The deepest blocks that can be baked: 35,113 and 37,829 entries a type. One level more and rank
/// coefficients leave 16 bits.
pub const MAX_DEPTH: u8 = 4;

/// The depth baked when nobody asks for another (`TWELVEFOLD_DEPTH`). Measured by
/// `examples/speed_report`: a million uniform points take 1.32 ns a point from blocks of depth 2, 0.69 of
/// depth 3, 0.73 of depth 4; maps, which stop at smaller blocks, hardly differ.
pub const DEFAULT_DEPTH: u8 = 3;

/// Why tables could not be baked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BakeError {
    /// The depth is not in 1..=[`MAX_DEPTH`].
    Depth {
        /// The depth asked for.
        depth: u8,
    },
    /// The relaxed offsets were trained for another digit assignment; retrain them.
    OtherDigits,
    /// A number left its baked width: rules of another shape than equation 1's.
    Range,
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Depth { depth } => {
                write!(f, "baked depth {depth} is not between 1 and {MAX_DEPTH}")
            }
            Self::OtherDigits => f.write_str(
                "the relaxed offsets were trained for other digits: train them again, or remove them",
            ),
            Self::Range => f.write_str("a baked number does not fit its field"),
        }
    }
}

impl core::error::Error for BakeError {}

/// Subdivides each tile type `depth` times and encodes the blocks, and relaxed offsets if there are
/// any: the bytes of a table file.
///
/// The same rules, depth and offsets give the same bytes on every platform.
///
/// # Errors
/// [`BakeError::Depth`] for a depth outside 1..=[`MAX_DEPTH`]; [`BakeError::OtherDigits`] for offsets
/// that belong to other rules.
pub fn bake(
    rules: &Rules,
    depth: u8,
    displacements: Option<&Displacements>,
) -> Result<Vec<u8>, BakeError> {
    if displacements.is_some_and(|displacements| !displacements.fits(rules.digits())) {
        return Err(BakeError::OtherDigits);
    }
    let blocks = blocks(rules, depth)?;
    format::encode(rules, depth, &blocks, displacements)
}

/// The blocks of all four types.
fn blocks(rules: &Rules, depth: u8) -> Result<[Block; 4], BakeError> {
    if !(1..=MAX_DEPTH).contains(&depth) {
        return Err(BakeError::Depth { depth });
    }
    let [a, b, c, d] = TileType::ALL.map(|kind| Block::subdivide(rules, kind, depth));
    Ok([a?, b?, c?, d?])
}
