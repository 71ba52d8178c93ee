//! What the fuzz targets do with their bytes: shared by cargo-fuzz and by the stable test that replays
//! and mutates the corpus (`tests/fuzz_corpus.rs`).

use std::collections::BTreeSet;

use glam::{DVec2, Vec2};
use twelvefold::bake::{bake, displacement::Displacements};
use twelvefold::estimate::{Warp, Weighting, exactly, normalize, post_stratify};
use twelvefold::tiling::{Digits, FCode, TileCounts, TileType};
use twelvefold::{
    Amount, BilinearMap, Constant, Domain, EnvironmentMap, ImageMap, Importance, InvalidPixels,
    Limits, Placement, Points, Position, Sample, Sampling, SamplingError, Scalar as _, StippleMap,
    Tables,
};
use twelvefold_lab::paper;

/// Table files, relaxation files and digit files, as they are and with their checksum made right (of
/// what is no file of any kind, too): accepted only as they were written.
pub(crate) fn tables(data: &[u8]) {
    files(data);
    if let Some((document, _)) = data.split_last_chunk::<4>() {
        let mut repaired = document.to_vec();
        repaired.extend(crc32fast::hash(document).to_le_bytes());
        files(&repaired);
    }
    if let Ok(text) = std::str::from_utf8(data)
        && let Ok(digits) = Digits::parse(text)
    {
        assert!(twelvefold::tiling::Rules::new(&digits).is_ok());
    }
}

/// A table file or a relaxation file: what is accepted is what would be written, and gives points.
fn files(data: &[u8]) {
    if let Ok(tables) = Tables::from_bytes(data) {
        assert_eq!(tables.as_bytes(), data);
        use_tables(tables);
    }
    if let Ok(displacements) = Displacements::from_bytes(data) {
        assert_eq!(displacements.to_bytes().unwrap(), data);
        // Another digit assignment than the tables' is refused.
        if let Ok(baked) = bake(&Tables::built_in().rules(), 1, Some(&displacements)) {
            use_tables(Tables::from_bytes(&baked).unwrap());
        }
    }
}

/// Tables that passed all checks give sound sets, whatever offsets they hold.
fn use_tables(tables: Tables<'_>) {
    let placement = Placement::new_in(Domain::UNIT, 1, tables);
    let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(200.0)).unwrap();
    let part = Part { corner: DVec2::splat(0.3), size: DVec2::new(0.2, 0.6), shards: 2 };
    parts(&sampling, whole::<DVec2, _>(&sampling, Domain::UNIT), &part);
    if let Ok(relaxed) = sampling.relaxed() {
        assert!(tables.displacements().is_some());
        parts(&relaxed, whole::<DVec2, _>(&relaxed, Domain::UNIT), &part);
    }
}

/// F-codes: a text is a code that prints as itself and has a rank of its level, or an error.
pub(crate) fn fcodes(data: &[u8]) {
    let Some((first, rest)) = data.split_first() else { return };
    let root = TileType::ALL[usize::from(first % 4)];
    let counts = TileCounts::of(root);
    if let Ok(text) = std::str::from_utf8(rest)
        && let Ok(code) = FCode::parse(root, text)
    {
        assert_eq!(code.to_string(), text.to_uppercase());
        let rank = code.rank();
        assert!(rank < counts.at(code.level()).unwrap());
        assert_eq!(FCode::from_rank(root, code.level(), rank), Ok(code));
        assert!(code.tile(&Tables::built_in().rules()).is_ok());
        assert!(paper::dodecatodecimal(&code).is_ok());
        assert!((0.0..1.0).contains(&paper::normalized_threshold(&code)));
    }
    let _ = FCode::from_newest_first(root, rest);
    if let Some(bytes) = rest.first_chunk() {
        let rank = u64::from_le_bytes(*bytes);
        if let Ok(code) = FCode::from_rank(root, rest.len() % 20, rank) {
            assert_eq!(code.rank(), rank);
        }
    }
}

/// Reads numbers off the front of bytes.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let mut bytes = [0; N];
        let taken = self.0.len().min(N);
        let (front, rest) = self.0.split_at(taken);
        bytes[..taken].copy_from_slice(front);
        self.0 = rest;
        bytes
    }

    fn byte(&mut self) -> u8 {
        self.bytes::<1>()[0]
    }

    fn double(&mut self) -> f64 {
        f64::from_le_bytes(self.bytes())
    }
}

/// Maps of any pixels over any domain: errors, or points of the domain on pixels above 0.
pub(crate) fn maps(data: &[u8]) {
    let mut numbers = Numbers(data);
    let (width, height) = (usize::from(numbers.byte() % 40), usize::from(numbers.byte() % 40));
    let policy = match numbers.byte() % 3 {
        0 => InvalidPixels::Reject,
        1 => InvalidPixels::ZeroNegative,
        _ => InvalidPixels::ZeroAll,
    };
    let seed = u64::from_le_bytes(numbers.bytes());
    let min = DVec2::new(numbers.double(), numbers.double());
    let size = DVec2::new(numbers.double(), numbers.double());
    let amount = match numbers.byte() % 4 {
        0 => Amount::Density(numbers.double()),
        1 => Amount::Points(numbers.double()),
        _ => Amount::Points(f64::from(numbers.byte()) * 8.0),
    };
    let count = width * height;
    let pixels: Vec<f32> = (0..count).map(|_| f32::from_le_bytes(numbers.bytes())).collect();
    let colors = pixels.iter().map(|pixel| [*pixel, 0.5 * pixel, 1.0]).collect();
    if let Ok(sky) = EnvironmentMap::new(width, height, colors, policy) {
        let sample = sky.sample(min);
        assert!(sample.pdf >= 0.0 && sample.direction.is_finite());
        let direction = glam::DVec3::new(size.x, size.y, min.x);
        assert!(sky.pdf(direction) >= 0.0);
    }
    let stipple = StippleMap::new(width, height, pixels.clone(), policy, f64::from(numbers.byte()));
    let Ok(mut map) = ImageMap::new(width, height, pixels, policy) else {
        assert!(stipple.is_err());
        return;
    };
    if let Ok(domain) = Domain::new(min, size) {
        map = map.over(domain);
    }
    // A part of the domain, or what does not even touch it.
    let [x, y, w, h] = numbers.bytes().map(|byte| f64::from(byte) / 200.0 - 0.1);
    let part = Part { corner: DVec2::new(x, y), size: DVec2::new(w, h), shards: 1 + seed % 3 };
    sample(&map, map.domain(), seed, amount, &part);
    points_of_map(&map, seed);
    let domain = map.domain();
    sample(&BilinearMap::new(map), domain, seed, amount, &part);
    if let Ok(stipple) = stipple {
        sample(&stipple, stipple.domain(), seed, amount, &part);
    }
}

const LIMITS: Limits = limits();

const fn limits() -> Limits {
    Limits { points: 800, tiles: 5000 }
}

/// A rectangle in units of the domain, and a number of shards.
struct Part {
    corner: DVec2,
    size: DVec2,
    shards: u64,
}

/// Fixed and relaxed points in both precisions, whole, clipped and sharded.
fn sample<I: Importance>(importance: &I, domain: Domain, seed: u64, amount: Amount, part: &Part) {
    let placement = Placement::new(domain, seed);
    let Ok(fixed) = Sampling::within(&placement, importance, amount, LIMITS) else {
        return;
    };
    let relaxed = fixed.relaxed().unwrap();
    for sampling in [fixed, relaxed] {
        let points = whole::<DVec2, _>(&sampling, domain);
        parts(&sampling, points, part);
        let points = whole::<Vec2, _>(&sampling, domain);
        parts(&sampling, points, part);
    }
}

/// All points: in the domain, ranks unique, no broken promise of a map. `None` where limits or
/// precision forbid them.
fn whole<P: Position + PartialEq, I: Importance>(
    sampling: &Sampling<'_, I>,
    domain: Domain,
) -> Option<Vec<Sample<P>>> {
    all(sampling.points::<P>().ok()?, domain)
}

/// All points, which lie in the domain and are there once.
fn all<P: Position + PartialEq, I: Importance>(
    all: Points<'_, I, P>,
    domain: Domain,
) -> Option<Vec<Sample<P>>> {
    let mut ranks = BTreeSet::new();
    let mut points = Vec::new();
    for sample in all {
        match sample {
            Ok(sample) => {
                assert!(domain.contains(double(sample.position)));
                assert!(ranks.insert(sample.rank));
                points.push(sample);
            }
            Err(
                error @ (SamplingError::InvalidValue { .. } | SamplingError::InvalidBound { .. }),
            ) => {
                panic!("a map broke its promise: {error}")
            }
            Err(_) => return None,
        }
    }
    Some(points)
}

/// Clipped points are the whole's inside; shards one after the other, and a buffer, hold the whole.
fn parts<P: Position + PartialEq, I: Importance>(
    sampling: &Sampling<'_, I>,
    points: Option<Vec<Sample<P>>>,
    part: &Part,
) {
    let Some(points) = points else { return };
    let domain = sampling.placement().domain();
    let mut buffer = vec![P::default(); points.len()];
    let filled = sampling.fill(&mut buffer).unwrap();
    assert!(filled.complete && filled.written == points.len());
    assert!(points.iter().zip(&buffer).all(|(point, position)| point.position == *position));

    let corner = domain.min() + domain.size() * part.corner;
    if let Ok(rectangle) = Domain::new(corner, domain.size() * part.size)
        && let Some(mut clipped) = whole::<P, I>(&sampling.clipped(rectangle), domain)
    {
        // In another order: blocks across the clip's border are divided.
        let inside = points.iter().filter(|point| rectangle.contains(double(point.position)));
        let mut inside: Vec<_> = inside.copied().collect();
        inside.sort_by_key(|point| point.rank);
        clipped.sort_by_key(|point| point.rank);
        assert!(clipped == inside, "clip {rectangle:?}");
    }
    let mut union = Vec::new();
    let Ok(division) = sampling.divide(part.shards as usize) else { return };
    for index in 0..division.of() {
        let Ok(points) = division.part(index).and_then(|part| part.points::<P>()) else { return };
        let Some(points) = all(points, domain) else { return };
        union.extend(points);
    }
    assert!(union == points, "{} shards", part.shards);
}

fn double<P: Position>(position: P) -> DVec2 {
    let [x, y] = position.xy();
    DVec2::new(x.to_f64(), y.to_f64())
}

fn points_of_map(map: &ImageMap, seed: u64) {
    let domain = map.domain();
    let placement = Placement::new(domain, seed);
    let n = (seed % 200) as usize;
    if let Ok(points) = exactly(&placement, map, n, LIMITS) {
        assert_eq!(points.len(), n);
        assert!(points.iter().all(|point| domain.contains(point.position) && point.density > 0.0));
    }
    if let Some(warp) = Warp::new(map)
        && let Ok(points) = warp.level(n, seed, LIMITS)
    {
        assert_eq!(points.len(), n);
        for point in points {
            assert!(domain.contains(point.position) && point.density > 0.0);
        }
    }
    let amount = Amount::Points(n as f64);
    if let Ok(sampling) = Sampling::within(&placement, map, amount, LIMITS)
        && let Ok(points) = sampling.weighted(Weighting::Smoothed)
        && let Ok(mut points) = points.collect::<Result<Vec<_>, _>>()
    {
        post_stratify(&mut points, map, (seed % 10) as f64);
        normalize(&mut points, n as f64);
    }
}
