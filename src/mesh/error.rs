//! Why a mesh has no points.

use core::fmt;

/// Why a mesh is none, or has no points. Triangles and vertices count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// What it names.
        vertex: u32,
        /// How many vertices there are.
        of: usize,
    },
    /// A coordinate of a triangle's corner is NaN or infinite.
    NotFinite {
        /// The triangle.
        triangle: usize,
        /// The corner's vertex.
        vertex: u32,
    },
    /// A density of a triangle's corner is NaN, infinite or negative.
    Density {
        /// The triangle.
        triangle: usize,
        /// The corner's vertex.
        vertex: u32,
        /// The density.
        density: f32,
    },
    /// A triangle's texture coordinate is NaN or infinite.
    TextureCoordinate {
        /// The triangle.
        triangle: usize,
    },
    /// Another number of densities than vertices, or of texture coordinates than triangles.
    Length {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// Every triangle is without area or without density, or there is none.
    Nothing,
    /// A point to be moved is not on the mesh: its triangle is not there or its weights are no weights.
    NotOnMesh {
        /// The point.
        point: usize,
    },
    /// The memory is not to be had.
    Memory {
        /// How much was asked for.
        bytes: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoSuchVertex { triangle, vertex, of } => {
                write!(f, "triangle {triangle} names vertex {vertex} of {of} (both from 0)")
            }
            Self::NotFinite { triangle, vertex } => {
                write!(f, "triangle {triangle}: a coordinate of vertex {vertex} is not finite")
            }
            Self::Density { triangle, vertex, density } => write!(
                f,
                "triangle {triangle}: the density at vertex {vertex} is {density}, not finite and 0 or more"
            ),
            Self::TextureCoordinate { triangle } => {
                write!(f, "triangle {triangle}: a texture coordinate is not finite")
            }
            Self::Length { expected, found } => {
                write!(f, "{found} values where the mesh has {expected} to give them to")
            }
            Self::Nothing => f.write_str("the mesh has no triangle with both area and density"),
            Self::NotOnMesh { point } => write!(f, "point {point} is not on the mesh"),
            Self::Memory { bytes } => {
                write!(f, "the mesh or its points need {bytes} bytes of memory")
            }
        }
    }
}

impl core::error::Error for MeshError {}
