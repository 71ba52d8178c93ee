//! Why points cannot be made on the GPU.

use std::fmt;

/// What is wrong with a plan or with what is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GpuError {
    /// The importance has no texels, more than 8192 a side, or more than 2²⁵ in all.
    Size {
        /// Texels a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Room for no points, or for more than 2²⁴: a storage buffer has 128 MiB by WebGPU's default.
    Capacity {
        /// The number of points.
        points: u32,
    },
    /// Room for no candidates, no opened tiles, or more than a storage buffer holds.
    Room,
    /// A domain whose diagonal is not within 10⁻²⁰ … 10²⁰, or that `f32` does not resolve.
    Domain {
        /// The diagonal.
        diagonal: f64,
    },
    /// A placement without a border ([`twelvefold::Placement::seamless`]): the shaders know borders only.
    Seamless,
    /// Tables of a smaller depth than 3.
    Depth {
        /// The depth.
        depth: u8,
    },
    /// Relaxed points were asked for, and the tables have no relaxed offsets.
    NoRelaxation,
    /// A density that is negative, NaN or infinite, or of which the ranks for importance 1 are not 0 nor
    /// within 10⁻³⁰ … 10³⁰.
    Density {
        /// The density.
        density: f64,
    },
    /// The importance handed over is not what was planned: another size or kind, or too short a buffer.
    Importance,
    /// The tiling's exact numbers left their range.
    Tiling,
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "an importance of {width} by {height} texels: up to 8192 a side and 2^25")
            }
            Self::Capacity { points } => write!(f, "room for {points} points: 1 to 2^24"),
            Self::Seamless => f.write_str("seamless placements have no sampler on the GPU"),
            Self::Room => f.write_str("room for candidates or opened tiles that no buffer has"),
            Self::Domain { diagonal } => {
                write!(
                    f,
                    "f32 does not resolve the domain, or its diagonal of {diagonal} is extreme"
                )
            }
            Self::Depth { depth } => write!(f, "tables of depth {depth}: at least 3 is needed"),
            Self::NoRelaxation => f.write_str("the tables have no relaxed offsets"),
            Self::Density { density } => write!(f, "{density} is no density, or an extreme one"),
            Self::Importance => {
                f.write_str("the importance is not of the size and kind that were planned")
            }
            Self::Tiling => f.write_str("the tiling's numbers left their range"),
        }
    }
}

impl std::error::Error for GpuError {}
