//! Why tables could not be baked, and the limit on their depth.

use core::fmt;

/// The deepest blocks that can be baked: 35,113 and 37,829 entries a type. One level more and rank
/// coefficients leave 16 bits.
pub const MAX_DEPTH: u8 = 4;

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
