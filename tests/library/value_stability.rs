//! Same inputs, same points, bit for bit, in every version until the changelog says otherwise.
//!
//! Each line of the golden file is a case, its number of points, and the first 16 hex digits of the
//! SHA-256 of its points: rank and the bits of x and y, little-endian, sorted by rank; on meshes, see
//! `describe_mesh`. The inputs come from integer arithmetic alone.

use std::fmt::Write as _;

use glam::{DVec2, Vec2, Vec3};
use sha2::{Digest, Sha256};
use twelvefold::mesh::Mesh;
use twelvefold::{
    Amount, Constant, Disc, Domain, Function, ImageMap, Importance, InvalidPixels, Pixels,
    Placement, Sampling, StippleMap,
};

const GOLDEN: &str = include_str!("golden/points.txt");

/// A few bits that depend on all bits of `n`.
fn scramble(n: usize) -> u32 {
    let n = (n as u64 ^ 0x9e37_79b9).wrapping_mul(0xd129_42f0_5ea9_2b2d);
    ((n ^ (n >> 31)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 40) as u32
}

fn map(width: usize, height: usize, pixel: impl Fn(usize, usize) -> f32) -> ImageMap {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap()
}

fn ramp() -> ImageMap {
    map(300, 200, |x, y| (x * x / 64 + 3 * y) as f32 / 1024.0)
}

fn texture() -> ImageMap {
    map(256, 256, |x, y| (scramble(x + 256 * y) & 255) as f32 / 64.0)
}

fn edges() -> ImageMap {
    map(128, 96, |x, y| if (x / 16 + y / 16) % 2 == 0 { 1.0 } else { 0.0 })
}

fn hot_spot() -> ImageMap {
    map(512, 256, |x, y| if x == 300 && y == 77 { 30_000.0 } else { 1.0 + (x / 64) as f32 })
}

/// 12 × 9 squares of two triangles, corners up to 1.5 above the plane.
fn hills() -> Mesh {
    let corner = |i: usize| {
        let (x, y) = (i % 13, i / 13);
        Vec3::new(x as f32, y as f32, ((x * x + 3 * y) % 7) as f32 / 4.0)
    };
    let corners: Vec<Vec3> = (0..13 * 10).map(corner).collect();
    let squares = (0..12 * 9u32).map(|i| i / 12 * 13 + i % 12);
    let triangles: Vec<[u32; 3]> =
        squares.flat_map(|a| [[a, a + 1, a + 14], [a, a + 14, a + 13]]).collect();
    Mesh::new(&corners, &triangles).unwrap()
}

/// Two lines of the golden file: 1,000 points as they are placed, and evened out. Their hashes are those of
/// position, triangle and weights, in order.
fn describe_mesh(lines: &mut String, name: &str, mesh: &Mesh, seed: u64) {
    let mut points = mesh.points(1000, seed).unwrap();
    for steps in [0, 30] {
        mesh.relax(&mut points, steps).unwrap();
        let mut hash = Sha256::new();
        for point in &points {
            for coordinate in point.position.to_array() {
                hash.update(coordinate.to_bits().to_le_bytes());
            }
            hash.update(point.triangle.to_le_bytes());
            for weight in point.weights {
                hash.update(weight.to_bits().to_le_bytes());
            }
        }
        line(lines, &format!("{name}-relaxed-{steps}"), "f64", points.len(), hash);
    }
}

/// One line of the golden file for each precision.
fn describe<I: Importance>(lines: &mut String, name: &str, sampling: &Sampling<'_, I>) {
    let mut single: Vec<_> = sampling.points::<Vec2>().unwrap().map(Result::unwrap).collect();
    single.sort_by_key(|sample| sample.rank);
    let mut hash = Sha256::new();
    for sample in &single {
        hash.update(sample.rank.to_le_bytes());
        hash.update(sample.position.x.to_bits().to_le_bytes());
        hash.update(sample.position.y.to_bits().to_le_bytes());
    }
    line(lines, name, "f32", single.len(), hash);
    let mut double: Vec<_> = sampling.points::<DVec2>().unwrap().map(Result::unwrap).collect();
    double.sort_by_key(|sample| sample.rank);
    let mut hash = Sha256::new();
    for sample in &double {
        hash.update(sample.rank.to_le_bytes());
        hash.update(sample.position.x.to_bits().to_le_bytes());
        hash.update(sample.position.y.to_bits().to_le_bytes());
    }
    line(lines, name, "f64", double.len(), hash);

    // A buffer receives the same positions.
    let mut buffer = vec![Vec2::ZERO; single.len() + 1];
    let filled = sampling.fill(&mut buffer).unwrap();
    assert!(filled.complete && filled.written == single.len(), "{name}: {filled:?}");
    let bits = |p: &Vec2| (p.x.to_bits(), p.y.to_bits());
    let mut written: Vec<_> = buffer[..filled.written].iter().map(bits).collect();
    let mut expected: Vec<_> = single.iter().map(|sample| bits(&sample.position)).collect();
    written.sort_unstable();
    expected.sort_unstable();
    assert!(written == expected, "{name}");
}

fn line(lines: &mut String, name: &str, precision: &str, count: usize, hash: Sha256) {
    let hash: String = hash.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect();
    writeln!(lines, "{name} {precision} {count} {hash}").unwrap();
}

#[test]
fn points_are_those_of_the_golden_file() {
    let mut lines = String::new();
    let off_center = Domain::new(DVec2::new(-3.7, 5.1), DVec2::new(7.3, 2.9)).unwrap();
    let maps = [
        ("ramp", ramp()),
        ("texture", texture()),
        ("edges", edges()),
        ("hot-spot", hot_spot()),
        ("ramp-unit", ramp().over(Domain::UNIT)),
        ("texture-off-center", texture().over(off_center)),
        (
            "texture-power-of-two",
            texture().over(Domain::new(DVec2::ZERO, DVec2::splat(2.0)).unwrap()),
        ),
    ];
    for seed in [1, 2] {
        for count in [3.0, 50.0, 1_000.0, 40_000.0] {
            for (name, domain) in [("unit", Domain::UNIT), ("off-center", off_center)] {
                let placement = Placement::new(domain, seed);
                let sampling =
                    Sampling::new(&placement, &Constant::ONE, Amount::Points(count)).unwrap();
                describe(&mut lines, &format!("constant-{name}-{seed}-{count}"), &sampling);
            }
            for (name, map) in &maps {
                let placement = Placement::new(map.domain(), seed);
                let sampling = Sampling::new(&placement, map, Amount::Points(count)).unwrap();
                describe(&mut lines, &format!("{name}-{seed}-{count}"), &sampling);
            }
        }
        // The committed offsets, on constant ground of several phases and on maps.
        for count in [40.0, 3_000.0, 12_000.0, 40_000.0, 90_000.0] {
            for (name, domain) in [("unit", Domain::UNIT), ("off-center", off_center)] {
                let placement = Placement::new(domain, seed);
                let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(count));
                let sampling = sampling.unwrap().relaxed().unwrap();
                describe(&mut lines, &format!("relaxed-constant-{name}-{seed}-{count}"), &sampling);
            }
        }
        for (name, map) in &maps[..4] {
            let placement = Placement::new(map.domain(), seed);
            let amount = Amount::Points(20_000.0);
            let sampling = Sampling::new(&placement, map, amount).unwrap().relaxed().unwrap();
            describe(&mut lines, &format!("relaxed-{name}-{seed}"), &sampling);
            let pixels = map.pixels().to_vec();
            let (reject, size) = (InvalidPixels::Reject, map.domain().size());
            let (width, height) = (size.x as usize, size.y as usize);
            let stipple = Pixels::new(width, height, pixels, reject)
                .and_then(|pixels| StippleMap::new(pixels, 20_000.0))
                .unwrap();
            let sampling = Sampling::new(&placement, &stipple, amount).unwrap().relaxed().unwrap();
            describe(&mut lines, &format!("stipple-{name}-{seed}"), &sampling);
        }
        // A domain that is not the map's: the nearest pixel counts outside.
        let map = texture();
        let domain = Domain::new(DVec2::new(-50.0, 100.0), DVec2::new(200.0, 300.0)).unwrap();
        let placement = Placement::new(domain, seed);
        let sampling = Sampling::new(&placement, &map, Amount::Density(0.2)).unwrap();
        describe(&mut lines, &format!("beyond-the-map-{seed}"), &sampling);

        let bump = Function::new(
            |p: DVec2| p.x * (1.0 - p.y),
            |r: &Disc| {
                (r.center.x + r.radius).clamp(0.0, 1.0)
                    * (1.0 - r.center.y + r.radius).clamp(0.0, 1.0)
            },
        );
        let placement = Placement::new(Domain::UNIT, seed);
        let sampling = Sampling::new(&placement, &bump, Amount::Density(20_000.0)).unwrap();
        describe(&mut lines, &format!("closure-{seed}"), &sampling);
    }
    // Without a border: constant and on maps, fixed and relaxed.
    let wide = Domain::new(DVec2::new(-3.7, 5.1), DVec2::new(7.5, 5.0)).unwrap();
    for (name, domain) in [("unit", Domain::UNIT), ("3-2", wide)] {
        let placement = Placement::seamless(domain, 1).unwrap();
        for count in [50.0, 1_000.0, 40_000.0] {
            let constant =
                Sampling::new(&placement, &Constant::ONE, Amount::Points(count)).unwrap();
            describe(&mut lines, &format!("seamless-constant-{name}-{count}"), &constant);
            let relaxed = constant.relaxed().unwrap();
            describe(&mut lines, &format!("seamless-relaxed-{name}-{count}"), &relaxed);
        }
        let map = texture().over(domain);
        let mapped = Sampling::new(&placement, &map, Amount::Points(10_000.0)).unwrap();
        describe(&mut lines, &format!("seamless-texture-{name}"), &mapped);
        let relaxed = mapped.relaxed().unwrap();
        describe(&mut lines, &format!("seamless-texture-relaxed-{name}"), &relaxed);
    }
    for seed in [1, 2] {
        describe_mesh(&mut lines, &format!("mesh-constant-{seed}"), &hills(), seed);
        let densities: Vec<f32> = (0..13 * 10).map(|i| (i % 13 * (i / 13) % 5) as f32).collect();
        let mesh = hills().with_densities(&densities).unwrap();
        describe_mesh(&mut lines, &format!("mesh-density-{seed}"), &mesh, seed);
    }
    if std::env::var_os("TWELVEFOLD_BLESS").is_some() {
        let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/library/golden/points.txt");
        return std::fs::write(golden, lines).unwrap();
    }
    let different: Vec<_> =
        lines.lines().zip(GOLDEN.lines()).filter(|(now, golden)| now != golden).collect();
    assert!(
        different.is_empty() && lines.lines().count() == GOLDEN.lines().count(),
        "{} lines differ, first {:?}; if that is meant, it is a breaking change: say so in \
         CHANGELOG.md and write the file anew with TWELVEFOLD_BLESS=1",
        different.len(),
        different.first()
    );
}
