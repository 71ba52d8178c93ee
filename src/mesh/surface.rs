//! Ways over a surface: from triangle to triangle, straight on where two are unfolded into one plane.

use alloc::vec::Vec;

use glam::DVec3;

use super::{Mesh, MeshError, SurfacePoint, with_room};

/// No neighbor: a border of the mesh, or an edge of three triangles and more.
const NONE: u32 = u32::MAX;

/// Edges crossed on one way, at the most.
const MOST_EDGES: usize = 64;

/// Which triangle lies across each edge.
pub(super) struct Surface<'m> {
    mesh: &'m Mesh,
    /// By triangle and corner: the triangle across the edge opposite to the corner, and its corner there.
    across: Vec<[(u32, u8); 3]>,
    normals: Vec<DVec3>,
}

impl<'m> Surface<'m> {
    pub(super) fn new(mesh: &'m Mesh) -> Result<Self, MeshError> {
        // Vertices at one place are one: meshes with texture seams have them twice.
        let mut by_place: Vec<u32> = with_room(mesh.positions.len())?;
        by_place.extend(0..mesh.positions.len() as u32);
        // + 0.0: −0 and 0 are one place.
        let key = |i: u32| (mesh.positions[i as usize] + 0.0).to_array().map(f64::to_bits);
        by_place.sort_unstable_by_key(|i| (key(*i), *i));
        let mut welded: Vec<u32> = with_room(by_place.len())?;
        welded.resize(by_place.len(), 0);
        let mut first = 0;
        for (k, &i) in by_place.iter().enumerate() {
            if k == 0 || key(i) != key(first) {
                first = i;
            }
            welded[i as usize] = first;
        }

        let mut edges = with_room(3 * mesh.triangles.len())?;
        for (triangle, corners) in (0..).zip(&mesh.triangles) {
            let corners = corners.map(|i| welded[i as usize]);
            for corner in 0..3u8 {
                let ends = [1, 2].map(|k| corners[(usize::from(corner) + k) % 3]);
                let edge = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                edges.push((edge, triangle, corner));
            }
        }
        edges.sort_unstable();
        let mut across = with_room(mesh.triangles.len())?;
        across.resize(mesh.triangles.len(), [(NONE, 0); 3]);
        for same in edges.chunk_by(|a, b| a.0 == b.0) {
            if let [(_, a, corner_a), (_, b, corner_b)] = *same {
                across[a as usize][usize::from(corner_a)] = (b, corner_b);
                across[b as usize][usize::from(corner_b)] = (a, corner_a);
            }
        }
        let mut normals = with_room(mesh.triangles.len())?;
        normals.extend((0..mesh.triangles.len() as u32).map(|triangle| mesh.normal(triangle)));
        Ok(Self { mesh, across, normals })
    }

    pub(super) fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// The point that is reached from another by a step, of which the part along the surface counts. Straight
    /// on over edges; halfway to a border, and to triangles without area.
    pub(super) fn moved(&self, from: SurfacePoint, step: DVec3) -> SurfacePoint {
        let mut point = from;
        let mut step = step;
        for _ in 0..MOST_EDGES {
            let corners = self.mesh.corners(point.triangle as usize);
            let normal = self.normals[point.triangle as usize];
            step -= normal * step.dot(normal);
            // How fast weights change: across the opposite edge in one height.
            let doubled = self.mesh.doubled_area(point.triangle as usize).length();
            let rates: [f64; 3] = core::array::from_fn(|k| {
                let edge = corners[(k + 2) % 3] - corners[(k + 1) % 3];
                normal.cross(edge).dot(step) / doubled
            });
            let mut part = 1.0;
            let mut through = None;
            for (k, (weight, rate)) in point.weights.iter().zip(rates).enumerate() {
                if weight + part * rate < 0.0 {
                    part = (weight / -rate).clamp(0.0, 1.0);
                    through = Some(k);
                }
            }
            let ahead = |part: f64| {
                let weights: [f64; 3] =
                    core::array::from_fn(|k| (point.weights[k] + part * rates[k]).max(0.0));
                let sum: f64 = weights.iter().sum();
                weights.map(|weight| weight / sum)
            };
            let next = through.map_or((NONE, 0), |k| self.across[point.triangle as usize][k]);
            let (triangle, corner) = (next.0, usize::from(next.1));
            if triangle == NONE || self.normals[triangle as usize] == DVec3::ZERO {
                let part = if through.is_some() { 0.5 * part } else { part };
                let weights = ahead(part);
                // Not a number only where triangles are next to nothing.
                if !weights.iter().all(|weight| weight.is_finite()) {
                    return from;
                }
                let position = self.mesh.position(point.triangle, weights);
                return SurfacePoint { position, weights, ..point };
            }
            let Some(k) = through else { return from };
            // Over the edge: the same ends, in whichever order the other triangle has them.
            let at = ahead(part);
            let [start, end] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
            let others = self.mesh.corners(triangle as usize);
            let mut weights = [0.0; 3];
            let same = others[(corner + 1) % 3] == start;
            let ends = if same { [1, 2] } else { [2, 1] };
            weights[(corner + ends[0]) % 3] = at[(k + 1) % 3];
            weights[(corner + ends[1]) % 3] = at[(k + 2) % 3];
            // What is left of the step, turned about the edge into the other plane.
            let rest = step * (1.0 - part);
            let edge = (end - start).normalize_or_zero();
            let inwards = |corner: DVec3| {
                let away = corner - start;
                (away - edge * away.dot(edge)).normalize_or_zero()
            };
            let (back, on) = (inwards(corners[k]), inwards(others[corner]));
            step = edge * rest.dot(edge) - on * rest.dot(back);
            point = SurfacePoint { position: point.position, triangle, weights };
        }
        from
    }
}
