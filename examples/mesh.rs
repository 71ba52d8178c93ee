//! Dots on a knot: exactly as many as asked, denser below than above, even along the surface. Writes them as
//! points with normals (PLY), and a picture (PNG).
//!
//! `cargo run --release --example mesh -- dots.ply dots.png`

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::time::Instant;

use glam::{DVec3, Vec3};
use twelvefold::mesh::{Mesh, SurfacePoint};

const DOTS: usize = 6000;
const STEPS: usize = 20;

/// Corners around the tube and along it.
const AROUND: u32 = 40;
const ALONG: u32 = 480;

/// The middle of the tube: a trefoil.
fn middle(turn: f64) -> DVec3 {
    let radius = 2.0 + (3.0 * turn).cos();
    DVec3::new(radius * (2.0 * turn).cos(), radius * (2.0 * turn).sin(), (3.0 * turn).sin())
}

fn knot() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corner = |k: u32| {
        let [along, around] = [k / AROUND, k % AROUND].map(f64::from);
        let turn = TAU * along / f64::from(ALONG);
        let here = middle(turn);
        let ahead = (middle(turn + 1e-4) - here).normalize();
        let side = ahead.cross(here).normalize();
        let up = ahead.cross(side);
        let (sine, cosine) = (TAU * around / f64::from(AROUND)).sin_cos();
        (here + 0.5 * (side * cosine + up * sine)).as_vec3()
    };
    let at = |along: u32, around: u32| along % ALONG * AROUND + around % AROUND;
    let quads = (0..ALONG * AROUND).map(|k| (k / AROUND, k % AROUND));
    let triangles = quads.flat_map(|(j, i)| {
        let [a, b, c, d] = [at(j, i), at(j + 1, i), at(j + 1, i + 1), at(j, i + 1)];
        [[a, b, c], [a, c, d]]
    });
    ((0..ALONG * AROUND).map(corner).collect(), triangles.collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [ply, png] = &arguments[..] else {
        return Err("which files? cargo run --release --example mesh -- dots.ply dots.png".into());
    };
    let (corners, triangles) = knot();
    let densities: Vec<f32> = corners.iter().map(|corner| 0.3 + (1.5 - corner.z)).collect();

    let start = Instant::now();
    let mesh = Mesh::new(&corners, &triangles)?.with_densities(&densities)?;
    let made = start.elapsed();
    let mut dots = mesh.points(DOTS, 4)?;
    let placed = start.elapsed();
    mesh.relax(&mut dots, STEPS)?;
    println!(
        "{DOTS} dots on {} triangles: mesh {made:.1?}, dots {:.1?}, {STEPS} steps {:.1?}",
        triangles.len(),
        placed - made,
        start.elapsed() - placed
    );

    std::fs::write(ply, to_ply(&mesh, &dots)?)?;
    write_picture(png, &mesh, &triangles, &corners, &dots)
}

fn to_ply(mesh: &Mesh, dots: &[SurfacePoint]) -> Result<String, std::fmt::Error> {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", dots.len());
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(text, "property float {name}")?;
    }
    text += "end_header\n";
    for dot in dots {
        let (at, normal) = (dot.position, mesh.normal(dot.triangle));
        let [x, y, z] = at.to_array();
        let [nx, ny, nz] = normal.to_array();
        writeln!(text, "{x:.5} {y:.5} {z:.5} {nx:.4} {ny:.4} {nz:.4}")?;
    }
    Ok(text)
}

/// Pixels a side, and a unit in pixels.
const SIDE: usize = 620;
const UNIT: f64 = 84.0;

/// Turned towards the viewer: x and y in pixels, and how near.
fn seen(at: DVec3) -> DVec3 {
    let (y, z) = (0.8 * at.y + 0.6 * at.z, 0.8 * at.z - 0.6 * at.y);
    DVec3::new(0.5 * SIDE as f64 + UNIT * at.x, 0.5 * SIDE as f64 - UNIT * y, UNIT * z)
}

/// The mesh from one side, in shades of white, and the dots that are in sight.
fn write_picture(
    path: &str,
    mesh: &Mesh,
    triangles: &[[u32; 3]],
    corners: &[Vec3],
    dots: &[SurfacePoint],
) -> Result<(), Box<dyn Error>> {
    let mut nearest = vec![f64::NEG_INFINITY; SIDE * SIDE];
    let mut shades = vec![255u8; SIDE * SIDE];
    for (index, triangle) in (0..).zip(triangles) {
        let [a, b, c] = triangle.map(|i| seen(corners[i as usize].as_dvec3()));
        let doubled = (b - a).truncate().perp_dot((c - a).truncate());
        let facing = (seen(mesh.normal(index)) - seen(DVec3::ZERO)).z.abs() / UNIT;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        for y in low.y as usize..=(high.y as usize).min(SIDE - 1) {
            for x in low.x as usize..=(high.x as usize).min(SIDE - 1) {
                let p = DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0);
                let part = |from: DVec3, to: DVec3| {
                    (to - from).truncate().perp_dot((p - from).truncate()) / doubled
                };
                let [of_a, of_b, of_c] = [part(b, c), part(c, a), part(a, b)];
                let z = a.z * of_a + b.z * of_b + c.z * of_c;
                if of_a.min(of_b).min(of_c) >= -1e-9 && z > nearest[y * SIDE + x] {
                    nearest[y * SIDE + x] = z;
                    shades[y * SIDE + x] = (205.0 + 45.0 * facing) as u8;
                }
            }
        }
    }
    for dot in dots {
        let at = seen(dot.position);
        let (x, y) = (at.x as usize, at.y as usize);
        // In sight: not behind the surface by more than the slope over a pixel or two.
        if at.z + 4.0 < nearest[y * SIDE + x] {
            continue;
        }
        for (dx, dy) in (0..9).map(|i| (i % 3, i / 3)) {
            let (px, py) = (x + dx - 1, y + dy - 1);
            let away = (px as f64 + 0.5 - at.x).hypot(py as f64 + 0.5 - at.y);
            let ink = (1.9 - away).clamp(0.0, 1.0);
            let shade = &mut shades[py * SIDE + px];
            *shade = (f64::from(*shade) * (1.0 - ink) + 25.0 * ink) as u8;
        }
    }
    let mut encoder = png::Encoder::new(std::fs::File::create(path)?, SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&shades)?;
    Ok(())
}
