//! The density over a triangle: the same everywhere, a number a vertex, or a texture.

use alloc::boxed::Box;
use alloc::vec::Vec;

use glam::{DVec2, Vec2};

use super::curve;
use crate::importance::{ImageMap, Importance as _};

/// Pieces that a side of a triangle is cut into for its texture, at the most.
const MOST_PIECES: usize = 256;

/// Points per area, relative.
#[derive(Clone, Debug)]
pub(super) enum Density {
    Constant,
    /// By vertex.
    Vertices(Vec<f32>),
    /// The texture, and by triangle the texture coordinates of its corners.
    Texture(Box<ImageMap>, Vec<[Vec2; 3]>),
}

impl Density {
    /// At the corners of a triangle, linear in between; of a texture, only where `texture` says so.
    fn corners(&self, corners: [u32; 3]) -> [f64; 3] {
        match self {
            Self::Vertices(densities) => {
                corners.map(|i| densities.get(i as usize).copied().unwrap_or(0.0).into())
            }
            _ => [1.0; 3],
        }
    }

    /// The mean over a triangle.
    pub(super) fn mean(&self, triangle: usize, corners: [u32; 3]) -> f64 {
        match self {
            Self::Texture(map, coordinates) => match coordinates.get(triangle) {
                Some(uv) => {
                    let side = pieces_of_side(map, uv);
                    let pieces = side * side;
                    let sum: f64 = (0..pieces).map(|i| piece(map, uv, side, i).1).sum();
                    sum / pieces as f64
                }
                None => 0.0,
            },
            _ => self.corners(corners).iter().sum::<f64>() / 3.0,
        }
    }

    /// At a place of a triangle.
    pub(super) fn at(&self, triangle: usize, corners: [u32; 3], weights: [f64; 3]) -> f64 {
        match self {
            Self::Texture(map, coordinates) => {
                coordinates.get(triangle).map_or(0.0, |uv| map.value(mixed(uv, weights)))
            }
            _ => self.corners(corners).iter().zip(weights).map(|(d, w)| d * w).sum(),
        }
    }

    /// The place in a triangle at `along` its share of the density, in [0, 1): weights of its corners.
    /// `first` is the corner at which to begin.
    pub(super) fn place(
        &self,
        triangle: usize,
        corners: [u32; 3],
        first: usize,
        along: f64,
    ) -> [f64; 3] {
        let turned = [first % 3, (first + 1) % 3, (first + 2) % 3];
        let back = |weights: [f64; 3]| {
            let mut of_corner = [0.0; 3];
            for (corner, weight) in turned.into_iter().zip(weights) {
                of_corner[corner] = weight;
            }
            of_corner
        };
        let Self::Texture(map, coordinates) = self else {
            let densities = self.corners(corners);
            return back(curve::weights(turned.map(|i| densities[i]), along));
        };
        let Some(uv) = coordinates.get(triangle) else { return [1.0 / 3.0; 3] };
        let uv = turned.map(|i| uv[i]);
        let side = pieces_of_side(map, &uv);
        let total: f64 = (0..side * side).map(|i| piece(map, &uv, side, i).1).sum();
        let mut left = along * total;
        let mut last = None;
        for i in 0..side * side {
            let (corners, value) = piece(map, &uv, side, i);
            if value > 0.0 {
                last = Some((corners, (left / value).min(1.0 - f64::EPSILON)));
                if left < value {
                    break;
                }
            }
            left -= value;
        }
        let Some((piece, along)) = last else { return [1.0 / 3.0; 3] };
        let within = curve::weights([1.0; 3], along);
        back(core::array::from_fn(|k| (0..3).map(|c| piece[c][k] * within[c]).sum()))
    }
}

fn mixed(uv: &[Vec2; 3], weights: [f64; 3]) -> DVec2 {
    uv.iter().zip(weights).map(|(uv, weight)| uv.as_dvec2() * weight).sum()
}

/// So many pieces a side that none is larger than a pixel.
fn pieces_of_side(map: &ImageMap, uv: &[Vec2; 3]) -> usize {
    let (width, height) = map.size();
    let texels = DVec2::new(width as f64, height as f64) / map.domain().size();
    let side = |i: usize| {
        let along = ((uv[(i + 1) % 3] - uv[i]).as_dvec2() * texels).abs();
        along.max_element()
    };
    // Truncation saturates.
    (libm::ceil(side(0).max(side(1)).max(side(2))) as usize).clamp(1, MOST_PIECES)
}

/// Piece `i` of the side² equal ones of a triangle, row by row: the weights at its corners, and the texture
/// at its middle.
fn piece(map: &ImageMap, uv: &[Vec2; 3], side: usize, i: usize) -> ([[f64; 3]; 3], f64) {
    // Row r, from the first corner on, has 2r + 1 pieces and begins at r².
    let row = isqrt(i);
    let (column, points_down) = ((i - row * row) / 2, (i - row * row) % 2 == 1);
    let node = |row: usize, column: usize| {
        let [row, column, side] = [row, column, side].map(|n| n as f64);
        [1.0 - row / side, (row - column) / side, column / side]
    };
    let corners = if points_down {
        [node(row, column), node(row + 1, column + 1), node(row, column + 1)]
    } else {
        [node(row, column), node(row + 1, column), node(row + 1, column + 1)]
    };
    let middle = core::array::from_fn(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0);
    (corners, map.value(mixed(uv, middle)))
}

/// ⌊√i⌋, for i below 2²⁰.
fn isqrt(i: usize) -> usize {
    let root = libm::sqrt(i as f64) as usize;
    if root * root > i { root - 1 } else { root }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;

    #[test]
    fn pieces_cover_the_triangle_without_overlap() {
        let map = ImageMap::new(
            crate::Pixels::new(1, 1, alloc::vec![1.0], crate::InvalidPixels::Reject).unwrap(),
        )
        .unwrap();
        let map = map.over(Domain::UNIT);
        let uv = [Vec2::ZERO, Vec2::X, Vec2::Y];
        for side in [1, 2, 7] {
            let mut area = 0.0;
            let mut middles = std::collections::HashSet::new();
            for i in 0..side * side {
                let (c, _) = piece(&map, &uv, side, i);
                let edge = |k: usize| DVec2::new(c[k][1] - c[0][1], c[k][2] - c[0][2]);
                area += edge(1).perp_dot(edge(2)).abs();
                let middle = |k: usize| (c[0][k] + c[1][k] + c[2][k]) / 3.0;
                assert!((0..3).all(|k| c.iter().all(|w| w[k] > -1e-12) && middle(k) > 0.0));
                middles.insert([middle(0), middle(1)].map(|m| (m * 1e6) as i64));
            }
            assert!((area - 1.0).abs() < 1e-12 && middles.len() == side * side);
        }
    }
}
