//! Points on triangle meshes: exactly n, area-true, under a density a vertex or a texture.
//!
//! ```text
//! triangles   in the order of a Hilbert curve through their middles
//!   │           each with its share: area · mean density
//! n strata    of the sum of all shares; point i at (i + u)/n of it
//!   │           u from the seed, the same for all: exactly n, each place as likely as its density
//! a triangle  the rest of the share is a place on Sierpiński's curve through it
//!   │
//! relax       points push each other along the surface, over edges, until they are even
//! ```
//!
//! The tiling has no part in it: a mesh has no plane to lay it on.

mod curve;
mod density;
mod error;
mod hilbert;
mod relax;
mod surface;

pub use error::MeshError;

use alloc::boxed::Box;
use alloc::vec::Vec;

use glam::{DVec3, Vec2, Vec3};

use crate::importance::ImageMap;
use crate::random::SplitMix64;
use density::Density;

/// A triangle mesh with a density: what points are put on.
///
/// Triangles without area are allowed, and get no points; vertices that no triangle names may be anything.
/// Vertices at the same place count as one where points move from triangle to triangle.
#[derive(Clone, Debug)]
pub struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    density: Density,
    /// In their order on the curve: a triangle, the corner at which it is entered, and the sum of the
    /// shares up to its own.
    shares: Vec<Share>,
}

/// A triangle's part of the whole.
#[derive(Clone, Copy, Debug)]
struct Share {
    triangle: u32,
    first: u8,
    /// The sum up to and with this one.
    until: f64,
}

/// A point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: DVec3,
    /// The triangle it is on.
    pub triangle: u32,
    /// Weights of the triangle's corners, none negative, 1 in all: what interpolates anything that is
    /// given at corners, normals or texture coordinates.
    pub weights: [f64; 3],
}

impl Mesh {
    /// A mesh of constant density. O(triangles · log triangles).
    ///
    /// ```
    /// use glam::Vec3;
    /// use twelvefold::mesh::Mesh;
    /// // A square of two triangles, the second with a fifth vertex that is not there.
    /// let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    /// let error = Mesh::new(&corners, &[[0, 1, 2], [0, 2, 4]]).unwrap_err();
    /// assert_eq!(error.to_string(), "triangle 1 names vertex 4 of 4 (both from 0)");
    ///
    /// let mesh = Mesh::new(&corners, &[[0, 1, 2], [0, 2, 3]])?;
    /// let mut points = mesh.points(100, 7)?;
    /// mesh.relax(&mut points, 10)?;
    /// assert_eq!((points.len(), mesh.area()), (100, 1.0));
    /// # Ok::<(), twelvefold::mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError::NoSuchVertex`] and [`MeshError::NotFinite`] for the first triangle of which they are
    /// true, [`MeshError::Nothing`] without any area.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        for (triangle, corners) in triangles.iter().enumerate() {
            for &vertex in corners {
                let of = positions.len();
                let position = positions.get(vertex as usize);
                let position = position.ok_or(MeshError::NoSuchVertex { triangle, vertex, of })?;
                if !position.is_finite() {
                    return Err(MeshError::NotFinite { triangle, vertex });
                }
            }
        }
        let mut mesh = Self {
            positions: with_room(positions.len())?,
            triangles: with_room(triangles.len())?,
            density: Density::Constant,
            shares: with_room(triangles.len())?,
        };
        mesh.positions.extend(positions.iter().map(|position| position.as_dvec3()));
        mesh.triangles.extend_from_slice(triangles);
        mesh.shares = mesh.in_order()?;
        mesh.sum_shares()?;
        Ok(mesh)
    }

    /// With a density at each vertex, relative, linear over each triangle.
    ///
    /// # Errors
    /// [`MeshError::Length`] unless there is one a vertex, [`MeshError::Density`] for the first triangle
    /// with a corner whose density is no number from 0 up, [`MeshError::Nothing`] if all is 0.
    pub fn with_densities(mut self, densities: &[f32]) -> Result<Self, MeshError> {
        let (expected, found) = (self.positions.len(), densities.len());
        if expected != found {
            return Err(MeshError::Length { expected, found });
        }
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for &vertex in corners {
                let density = densities[vertex as usize];
                if !(density >= 0.0 && density.is_finite()) {
                    return Err(MeshError::Density { triangle, vertex, density });
                }
            }
        }
        let mut own = with_room(found)?;
        own.extend_from_slice(densities);
        self.density = Density::Vertices(own);
        self.sum_shares()?;
        Ok(self)
    }

    /// With a density from a texture: `coordinates` are those of each triangle's corners, in the units of
    /// the texture's [domain](ImageMap::domain). glTF's have row 0 at v = 0: `texture.over(Domain::UNIT)`.
    ///
    /// A triangle is cut into equal pieces no larger than a pixel, at most 256 a side, and has over each
    /// the texture's value at its middle. Outside of the domain the nearest pixel counts.
    ///
    /// # Errors
    /// [`MeshError::Length`] unless there are coordinates for each triangle,
    /// [`MeshError::TextureCoordinate`] for the first one that is not finite, [`MeshError::Nothing`] if
    /// all is 0.
    pub fn with_texture(
        mut self,
        texture: ImageMap,
        coordinates: &[[Vec2; 3]],
    ) -> Result<Self, MeshError> {
        let (expected, found) = (self.triangles.len(), coordinates.len());
        if expected != found {
            return Err(MeshError::Length { expected, found });
        }
        let broken = coordinates.iter().position(|uv| !uv.iter().all(|uv| uv.is_finite()));
        if let Some(triangle) = broken {
            return Err(MeshError::TextureCoordinate { triangle });
        }
        let mut own = with_room(found)?;
        own.extend_from_slice(coordinates);
        self.density = Density::Texture(Box::new(texture), own);
        self.sum_shares()?;
        Ok(self)
    }

    /// The area of all triangles, in squared units of the positions.
    #[must_use]
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|triangle| self.area_of(triangle)).sum()
    }

    /// The density's integral over the area.
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.shares.last().map_or(0.0, |share| share.until)
    }

    /// Exactly `n` points: any part of the surface expects n times its part of the
    /// [integral](Self::integral), over all seeds, and gets that to within a point for each time that the curve
    /// enters it. The same mesh, number and seed give the same points on every machine.
    ///
    /// Some 0.3 µs a point, more where a texture is large. Even by strata only: [`relax`](Self::relax).
    ///
    /// # Errors
    /// [`MeshError::Memory`].
    pub fn points(&self, n: usize, seed: u64) -> Result<Vec<SurfacePoint>, MeshError> {
        let mut points = with_room(n)?;
        let u = SplitMix64::new(seed).unit();
        let (total, mut shares) = (self.integral(), self.shares.iter());
        let (mut share, mut before) = (shares.next(), 0.0);
        for i in 0..n {
            let target = (i as f64 + u) / n as f64 * total;
            while let Some(this) = share
                && this.until <= target
                && this.until < total
            {
                (before, share) = (this.until, shares.next());
            }
            let Some(&Share { triangle, first, until }) = share else { break };
            let along = ((target - before) / (until - before)).clamp(0.0, 1.0 - f64::EPSILON);
            let corners = self.triangles[triangle as usize];
            let weights = self.density.place(triangle as usize, corners, first.into(), along);
            let position = self.position(triangle, weights);
            points.push(SurfacePoint { position, triangle, weights });
        }
        Ok(points)
    }

    /// The density at a point, relative; 0 at one that is on no triangle.
    #[must_use]
    pub fn density_at(&self, point: &SurfacePoint) -> f64 {
        let triangle = point.triangle as usize;
        match self.triangles.get(triangle) {
            Some(corners) => self.density.at(triangle, *corners, point.weights),
            None => 0.0,
        }
    }

    /// The normal of a triangle's plane, of length 1, towards where its corners go counter-clockwise; 0 for
    /// one without area, or that is not there.
    #[must_use]
    pub fn normal(&self, triangle: u32) -> DVec3 {
        match self.triangles.get(triangle as usize) {
            Some(_) => self.doubled_area(triangle as usize).normalize_or_zero(),
            None => DVec3::ZERO,
        }
    }

    /// The corners of a triangle that is there.
    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    fn position(&self, triangle: u32, weights: [f64; 3]) -> DVec3 {
        let [a, b, c] = self.corners(triangle as usize);
        a * weights[0] + b * weights[1] + c * weights[2]
    }

    /// Twice the area, along the normal.
    fn doubled_area(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    fn area_of(&self, triangle: usize) -> f64 {
        0.5 * self.doubled_area(triangle).length()
    }

    /// All triangles along the curve, each entered at the corner nearest to the middle of the one before.
    fn in_order(&self) -> Result<Vec<Share>, MeshError> {
        let corners = || self.triangles.iter().flatten().map(|i| self.positions[*i as usize]);
        let least = corners().fold(DVec3::INFINITY, DVec3::min);
        let greatest = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let side = (greatest - least).max_element();
        let middle = |triangle: usize| self.corners(triangle).iter().sum::<DVec3>() / 3.0;
        let mut order = with_room(self.triangles.len())?;
        order.extend(
            (0..self.triangles.len()).map(|triangle| {
                (hilbert::place((middle(triangle) - least) / side), triangle as u32)
            }),
        );
        order.sort_unstable();
        let mut before = least;
        let mut shares = with_room(order.len())?;
        for (_, triangle) in order {
            let far = self.corners(triangle as usize).map(|corner| corner.distance_squared(before));
            let first = (0..3u8).fold(0, |best, corner| {
                if far[usize::from(corner)] < far[usize::from(best)] { corner } else { best }
            });
            before = middle(triangle as usize);
            shares.push(Share { triangle, first, until: 0.0 });
        }
        Ok(shares)
    }

    fn sum_shares(&mut self) -> Result<(), MeshError> {
        let mut sum = 0.0;
        for i in 0..self.shares.len() {
            let triangle = self.shares[i].triangle as usize;
            sum += self.area_of(triangle) * self.density.mean(triangle, self.triangles[triangle]);
            self.shares[i].until = sum;
        }
        if sum > 0.0 && sum.is_finite() { Ok(()) } else { Err(MeshError::Nothing) }
    }
}

/// An empty list with room for so many.
fn with_room<T>(n: usize) -> Result<Vec<T>, MeshError> {
    let mut list = Vec::new();
    let bytes = n.saturating_mul(size_of::<T>());
    list.try_reserve_exact(n).map_err(|_| MeshError::Memory { bytes })?;
    Ok(list)
}
