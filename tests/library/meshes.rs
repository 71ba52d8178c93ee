//! Points on meshes: counts by area and density, errors that name the triangle, and evenness.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};
use twelvefold::mesh::{Mesh, MeshError, SurfacePoint};
use twelvefold::{Domain, ImageMap, InvalidPixels, Pixels};

type Triangles = (Vec<Vec3>, Vec<[u32; 3]>);

/// A sphere of 20·4^n triangles.
fn sphere(subdivisions: usize) -> Triangles {
    let t = 0.5 * (1.0 + 5.0f32.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [(1.0, t), (-1.0, t), (1.0, -t), (-1.0, -t)] {
        corners.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    let mut corners: Vec<Vec3> = corners.into_iter().map(Vec3::normalize).collect();
    // Faces: triples of nearest neighbors, turned outwards.
    let edge = 2.0 / (t * t + 1.0).sqrt() * 1.01;
    let near = |a: usize, b: usize, c: &[Vec3]| c[a].distance(c[b]) < edge;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b, &corners) && near(b, c, &corners) && near(a, c, &corners) {
                    let normal = (corners[b] - corners[a]).cross(corners[c] - corners[a]);
                    let out = normal.dot(corners[a]) > 0.0;
                    faces.push(
                        [a, if out { b } else { c }, if out { c } else { b }].map(|i| i as u32),
                    );
                }
            }
        }
    }
    assert_eq!(faces.len(), 20);
    for _ in 0..subdivisions {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    corners.push((corners[i as usize] + corners[j as usize]).normalize());
                    corners.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (corners, faces)
}

/// A tube of these numbers of quads around and along a circle, with vertices twice where it closes.
fn torus(around: u32, along: u32) -> Triangles {
    let corner = |i: u32, j: u32| {
        let (a, b) = (
            TAU * f64::from(i % around) / f64::from(around),
            TAU * f64::from(j % along) / f64::from(along),
        );
        let ring = 1.0 + 0.4 * a.cos();
        DVec3::new(ring * b.cos(), ring * b.sin(), 0.4 * a.sin()).as_vec3()
    };
    let corners = (0..=along).flat_map(|j| (0..=around).map(move |i| corner(i, j))).collect();
    let at = |i: u32, j: u32| j * (around + 1) + i;
    let quads = (0..along).flat_map(|j| (0..around).map(move |i| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        [[a, b, c], [a, c, d]]
    });
    (corners, triangles.collect())
}

fn mesh((corners, triangles): &Triangles) -> Mesh {
    Mesh::new(corners, triangles).unwrap()
}

/// Distances to the nearest other point, in parts of the greatest that all could have on so large a plane.
fn nearest(mesh: &Mesh, points: &[SurfacePoint]) -> Vec<f64> {
    let hexagonal = (2.0 * mesh.area() / (3.0f64.sqrt() * points.len() as f64)).sqrt();
    let of = |(i, a): (usize, &SurfacePoint)| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, b)| a.position.distance(b.position)).fold(f64::INFINITY, f64::min)
            / hexagonal
    };
    points.iter().enumerate().map(of).collect()
}

fn is_on(mesh: &Mesh, triangles: &Triangles, points: &[SurfacePoint]) {
    for point in points {
        assert!((point.weights.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{point:?}");
        assert!(point.weights.iter().all(|weight| *weight >= 0.0));
        let corners =
            triangles.1[point.triangle as usize].map(|i| triangles.0[i as usize].as_dvec3());
        let at: DVec3 = corners.iter().zip(point.weights).map(|(c, w)| *c * w).sum();
        assert!(at.distance(point.position) < 1e-9 * mesh.area());
    }
}

#[test]
fn every_triangle_gets_its_share_to_within_a_point() {
    let triangles = torus(12, 40);
    let mesh = mesh(&triangles);
    for (n, seed) in [(1, 1), (1000, 2), (20_000, 3)] {
        let points = mesh.points(n, seed).unwrap();
        assert_eq!(points.len(), n);
        is_on(&mesh, &triangles, &points);
        let mut counts = vec![0.0; triangles.1.len()];
        for point in &points {
            counts[point.triangle as usize] += 1.0;
        }
        for (corners, count) in triangles.1.iter().zip(counts) {
            let [a, b, c] = corners.map(|i| triangles.0[i as usize].as_dvec3());
            let expected = 0.5 * (b - a).cross(c - a).length() / mesh.area() * n as f64;
            assert!((count - expected).abs() < 1.0 + 1e-6, "{count} {expected}");
        }
    }
    assert_eq!(mesh.points(500, 9).unwrap(), mesh.points(500, 9).unwrap());
    assert_ne!(mesh.points(500, 9).unwrap(), mesh.points(500, 8).unwrap());
    assert_eq!(mesh.points(0, 9).unwrap(), []);
}

#[test]
fn places_are_unbiased_over_seeds() {
    // A single triangle with densities 0, 1, 4 at its corners: mean weights (5 + d)/20.
    let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.3, 2.0, 1.0)];
    let mesh = Mesh::new(&corners, &[[0, 1, 2]]).unwrap().with_densities(&[0.0, 1.0, 4.0]).unwrap();
    let mut mean = [0.0; 3];
    for seed in 0..4000 {
        for point in mesh.points(3, seed).unwrap() {
            for (mean, weight) in mean.iter_mut().zip(point.weights) {
                *mean += weight / 12_000.0;
            }
        }
    }
    for (mean, density) in mean.into_iter().zip([0.0, 1.0, 4.0]) {
        assert!((mean - (5.0 + density) / 20.0).abs() < 0.004, "{mean} {density}");
    }
}

#[test]
fn densities_by_vertex_and_by_texture_agree() {
    // A square of 16 × 16 quads whose density is x, as numbers and as a picture.
    let n = 16u32;
    let at = |i: u32| i as f32 / n as f32;
    let corners: Vec<Vec3> =
        (0..=n).flat_map(|j| (0..=n).map(move |i| Vec3::new(at(i), at(j), 0.0))).collect();
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .flat_map(|k| {
            let a = k / n * (n + 1) + k % n;
            [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
        })
        .collect();
    let mesh = Mesh::new(&corners, &triangles).unwrap();
    let x: Vec<f32> = corners.iter().map(|corner| corner.x).collect();
    let by_vertex = mesh.clone().with_densities(&x).unwrap();
    let pixels = (0..256 * 4).map(|i| ((i % 256) as f32 + 0.5) / 256.0).collect();
    let texture = Pixels::new(256, 4, pixels, InvalidPixels::Reject)
        .and_then(ImageMap::new)
        .unwrap()
        .over(Domain::UNIT);
    let coordinates: Vec<[Vec2; 3]> = triangles
        .iter()
        .map(|corners_of| corners_of.map(|i| corners[i as usize].truncate()))
        .collect();
    let by_texture = mesh.clone().with_texture(texture, &coordinates).unwrap();
    for mesh in [by_vertex, by_texture] {
        assert!((mesh.integral() - 0.5).abs() < 1e-3, "{}", mesh.integral());
        let mut points = mesh.points(4000, 5).unwrap();
        for relaxed in [false, true] {
            if relaxed {
                mesh.relax(&mut points, 5).unwrap();
            }
            for column in 0..8 {
                let of = |p: &&SurfacePoint| (p.position.x * 8.0) as usize == column;
                let count = points.iter().filter(of).count() as f64;
                let expected = 4000.0 * f64::from(2 * column as u32 + 1) / 64.0;
                let most = if relaxed { 20.0 } else { 12.0 };
                assert!((count - expected).abs() < most, "{relaxed} {column}: {count} {expected}");
            }
        }
        let point = SurfacePoint { weights: [0.0, 1.0, 0.0], ..points[0] };
        let corner = corners[triangles[point.triangle as usize][1] as usize];
        assert!((mesh.density_at(&point) - f64::from(corner.x)).abs() < 0.004);
    }
}

#[test]
fn relaxed_points_are_even_over_edges_seams_and_small_triangles() {
    // Triangles larger than a spacing, about as large, and much smaller; one with doubled vertices.
    let cases = [sphere(1), sphere(3), sphere(5), torus(24, 60)];
    for triangles in cases {
        let mesh = mesh(&triangles);
        let mut points = mesh.points(500, 3).unwrap();
        mesh.relax(&mut points, 20).unwrap();
        is_on(&mesh, &triangles, &points);
        let mut in_runs = mesh.points(500, 3).unwrap();
        mesh.relax(&mut in_runs, 13).unwrap();
        mesh.relax(&mut in_runs, 7).unwrap();
        assert_eq!(in_runs, points);
        let distances = nearest(&mesh, &points);
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = distances.iter().sum::<f64>() / 500.0;
        println!("{} triangles: least {least:.3}, mean {mean:.3}", triangles.1.len());
        assert!(least > 0.6 && mean > 0.8, "{}: {least} {mean}", triangles.1.len());
    }
}

#[test]
fn broken_meshes_are_errors_that_name_the_triangle() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(f32::NAN, 0.0, 0.0)];
    let error = |triangles: &[[u32; 3]]| Mesh::new(&corners, triangles).unwrap_err();
    let named = error(&[[0, 1, 2], [2, 1, 9]]);
    assert_eq!(named, MeshError::NoSuchVertex { triangle: 1, vertex: 9, of: 4 });
    assert_eq!(error(&[[0, 1, 2], [0, 1, 3]]), MeshError::NotFinite { triangle: 1, vertex: 3 });
    assert_eq!(error(&[]), MeshError::Nothing);
    assert_eq!(error(&[[0, 0, 1], [1, 1, 1]]), MeshError::Nothing);
    // What no triangle names may be anything.
    let mesh = Mesh::new(&corners, &[[0, 1, 2], [0, 1, 1]]).unwrap();
    assert_eq!(mesh.area(), 0.5);
    assert!(mesh.points(100, 1).unwrap().iter().all(|point| point.triangle == 0));

    let densities = |d: [f32; 4]| mesh.clone().with_densities(&d);
    for bad in [f32::NAN, -1.0, f32::INFINITY] {
        let error = densities([0.0, bad, 1.0, 0.0]).unwrap_err();
        assert!(matches!(error, MeshError::Density { triangle: 0, vertex: 1, .. }));
        assert!(densities([0.0, 1.0, 1.0, bad]).is_ok());
    }
    assert_eq!(densities([0.0; 4]).unwrap_err(), MeshError::Nothing);
    let short = mesh.clone().with_densities(&[1.0]).unwrap_err();
    assert_eq!(short, MeshError::Length { expected: 4, found: 1 });

    let texture =
        || Pixels::new(1, 1, vec![1.0], InvalidPixels::Reject).and_then(ImageMap::new).unwrap();
    let uv = [Vec2::ZERO, Vec2::X, Vec2::Y];
    let error = mesh.clone().with_texture(texture(), &[uv]).unwrap_err();
    assert_eq!(error, MeshError::Length { expected: 2, found: 1 });
    let broken = [Vec2::NAN; 3];
    let error = mesh.clone().with_texture(texture(), &[uv, broken]).unwrap_err();
    assert_eq!(error, MeshError::TextureCoordinate { triangle: 1 });
    // Huge coordinates are many pixels, but not many pieces.
    let far = [Vec2::ZERO, Vec2::splat(1e30), Vec2::Y];
    assert_eq!(
        mesh.clone().with_texture(texture(), &[far, uv]).unwrap().points(5, 1).unwrap().len(),
        5
    );

    let mut points = mesh.points(10, 1).unwrap();
    points[4].triangle = 2;
    assert_eq!(mesh.relax(&mut points, 3).unwrap_err(), MeshError::NotOnMesh { point: 4 });
    points[4] = SurfacePoint { weights: [f64::NAN; 3], ..points[3] };
    assert_eq!(mesh.relax(&mut points, 3).unwrap_err(), MeshError::NotOnMesh { point: 4 });
}

#[test]
fn slivers_borders_folds_and_doubled_points_do_no_harm() {
    // A fan of slivers, three triangles on one edge, one triangle without area, and another far away.
    let mut corners =
        vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, -Vec3::Y, Vec3::new(1e-20, 0.0, 1.0)];
    let mut triangles = vec![[0, 1, 2], [0, 1, 3], [0, 4, 1], [0, 1, 1], [0, 3, 5]];
    for i in 0..40u32 {
        let angle = f64::from(i) / 40.0 * PI;
        corners.push(DVec3::new(2.0 + angle.cos() * 1e-3, angle.sin() * 1e4, 0.0).as_vec3());
        corners.push(DVec3::new(2.0, 0.0, f64::from(i) * 1e-6).as_vec3());
        let at = corners.len() as u32;
        triangles.push([at - 2, at - 1, (at - 3).max(6)]);
    }
    corners.extend([1e6, 2e6, 3e6].map(|x| Vec3::new(x, x * x * 1e-6, 0.0)));
    let at = corners.len() as u32;
    triangles.push([at - 3, at - 2, at - 1]);
    let triangles = (corners, triangles);
    let mesh = mesh(&triangles);
    let mut points = mesh.points(300, 2).unwrap();
    let doubled = points[7];
    points[8..20].fill(doubled);
    mesh.relax(&mut points, 8).unwrap();
    for point in &points {
        assert!(point.position.is_finite() && point.weights.iter().all(|w| *w >= 0.0));
        let normal = mesh.normal(point.triangle);
        assert!(normal.is_finite());
    }
}
