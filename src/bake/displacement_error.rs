//! The limits of a file of displacements, and what can be wrong with one.

use core::fmt;

use super::class::MAX_GENERATIONS;

/// First bytes of the file.
pub const MAGIC: [u8; 8] = *b"12frelax";

/// Format version, raised by every change of layout or meaning.
pub const VERSION: u16 = 1;

/// The most bytes of a file that is looked at.
pub const MAX_BYTES: usize = 1 << 25;

/// The longest vector allowed, in edges of a point's level: some two spacings, which are from one edge
/// (τ = δ) to λ = 3.7 edges (τ = 1) long. Walks visit all tiles from which a point could move in, so
/// that their cost and the number of tiles at which they start grow with it.
pub const MAX_LENGTH: f64 = 8.0;

/// Why bytes are not a file of displacements, or its parts not a table. Offsets count bytes from the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DisplacementError {
    /// More than [`MAX_BYTES`].
    TooLong {
        /// Bytes given.
        length: usize,
    },
    /// The file does not begin with [`MAGIC`].
    NotDisplacements,
    /// The file has another version.
    Version {
        /// The version found.
        found: u16,
    },
    /// The checksum at the end is wrong: the file is damaged or cut.
    Checksum {
        /// The sum stored.
        stored: u32,
        /// The sum of the bytes before it.
        computed: u32,
    },
    /// The file ends inside a field.
    Truncated {
        /// Where the field begins.
        offset: usize,
    },
    /// Bytes are left over after the last field.
    Trailing {
        /// Where they begin.
        offset: usize,
    },
    /// The provenance is not UTF-8, or longer than 65,535 bytes.
    Provenance,
    /// There are neither one nor two layers.
    LayerCount {
        /// The number found.
        found: u8,
    },
    /// A layer needs from 2 to 65,535 slots.
    SlotCount {
        /// The layer: 0 smooth, 1 rough.
        layer: u8,
        /// The number found.
        found: usize,
    },
    /// A slot's τ is no number above the one before, the first is not 1, or the last is not δ.
    Tau {
        /// The layer.
        layer: u8,
        /// The slot.
        slot: usize,
    },
    /// A slot's classes span an impossible number of generations.
    Generations {
        /// The layer.
        layer: u8,
        /// The slot.
        slot: usize,
        /// The number found.
        found: u8,
    },
    /// A slot's scale is negative or no finite number.
    Scale {
        /// The layer.
        layer: u8,
        /// The slot.
        slot: usize,
    },
    /// A slot's longest vector is longer than [`MAX_LENGTH`].
    TooFar {
        /// The layer.
        layer: u8,
        /// The slot.
        slot: usize,
    },
    /// A slot has more vectors than there are classes, or the first or last slot has any, or a slot
    /// lacks a class that is born before the next slot.
    VectorCount {
        /// The layer.
        layer: u8,
        /// The slot.
        slot: usize,
        /// The number found.
        found: u32,
    },
}

impl fmt::Display for DisplacementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |layer: &u8| if *layer == 0 { "smooth" } else { "rough" };
        match self {
            Self::TooLong { length } => {
                write!(f, "{length} bytes, but a file of displacements has at most {MAX_BYTES}")
            }
            Self::NotDisplacements => {
                f.write_str("not a file of displacements: it begins otherwise")
            }
            Self::Version { found } => {
                write!(f, "format version {found}, but this program reads version {VERSION}")
            }
            Self::Checksum { stored, computed } => {
                write!(f, "damaged: checksum {computed:08x}, but {stored:08x} is stored")
            }
            Self::Truncated { offset } => {
                write!(f, "the file ends inside the field at byte {offset}")
            }
            Self::Trailing { offset } => write!(f, "bytes are left over from byte {offset}"),
            Self::Provenance => f.write_str("the provenance is no UTF-8 text of under 64 KiB"),
            Self::LayerCount { found } => write!(f, "{found} layers instead of 1 or 2"),
            Self::SlotCount { layer, found } => {
                write!(f, "{} layer: {found} slots instead of 2 to 65535", name(layer))
            }
            Self::Tau { layer, slot } => write!(
                f,
                "{} layer, slot {slot}: tau must rise from 1 to 7 + 4*sqrt(3)",
                name(layer)
            ),
            Self::Generations { layer, slot, found } => write!(
                f,
                "{} layer, slot {slot}: {found} generations instead of 2 to {MAX_GENERATIONS}",
                name(layer)
            ),
            Self::Scale { layer, slot } => {
                write!(f, "{} layer, slot {slot}: the scale is no number >= 0", name(layer))
            }
            Self::TooFar { layer, slot } => write!(
                f,
                "{} layer, slot {slot}: a vector is longer than {MAX_LENGTH} edges",
                name(layer)
            ),
            Self::VectorCount { layer, slot, found } => {
                write!(
                    f,
                    "{} layer, slot {slot}: {found} vectors are too few or too many",
                    name(layer)
                )
            }
        }
    }
}

impl core::error::Error for DisplacementError {}
