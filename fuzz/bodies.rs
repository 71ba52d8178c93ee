//! What the fuzz targets do with their bytes: shared by cargo-fuzz and by the stable test that replays
//! and mutates the corpus (`tests/fuzz_corpus.rs`).

use std::ops::ControlFlow;

use glam::DVec2;
use twelvefold::estimate::{Warp, Weighting, exactly, normalise, post_stratify};
use twelvefold::tiling::{Digits, FCode, TileCounts, TileType};
use twelvefold::{
    Amount, BilinearMap, Domain, EnvironmentMap, ImageMap, Importance, InvalidPixels, Limits,
    Placement, Sampling, Tables, paper,
};

/// Table files and digit files: accepted only as they were written.
pub(crate) fn tables(data: &[u8]) {
    if let Ok(tables) = Tables::from_bytes(data) {
        assert_eq!(tables.as_bytes(), data);
        let placement = Placement::with_tables(Domain::unit(), 1, tables);
        let one = twelvefold::Constant::ONE;
        let sampling = Sampling::new(&placement, &one, Amount::Points(100.0)).unwrap();
        assert!(sampling.points::<DVec2>().unwrap().all(|sample| sample.is_ok()));
    }
    if let Ok(text) = std::str::from_utf8(data)
        && let Ok(digits) = Digits::parse(text)
    {
        assert!(twelvefold::tiling::Rules::new(&digits).is_ok());
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
    let Ok(mut map) = ImageMap::new(width, height, pixels, policy) else { return };
    if let Ok(domain) = Domain::new(min, size) {
        map = map.over(domain);
    }
    sample(&map, seed, amount);
    points_of_map(&map, seed);
    sample(&BilinearMap::new(map), seed, amount);
}

const LIMITS: Limits = limits();

const fn limits() -> Limits {
    Limits { points: 5000, tiles: 50_000 }
}

fn sample<I: Importance + Domained>(importance: &I, seed: u64, amount: Amount) {
    let domain = importance.domain();
    let placement = Placement::new(domain, seed);
    let Ok(sampling) = Sampling::with_limits(&placement, importance, amount, LIMITS) else {
        return;
    };
    let mut ranks = std::collections::BTreeSet::new();
    let result = sampling.visit(|sample: twelvefold::Sample<DVec2>| {
        assert!(domain.contains(sample.position));
        assert!(ranks.insert(sample.rank));
        ControlFlow::Continue(())
    });
    // Maps keep their promises.
    assert!(!matches!(
        result,
        Err(twelvefold::SamplingError::InvalidValue { .. }
            | twelvefold::SamplingError::InvalidBound { .. })
    ));
    let _ = sampling.visit(|sample: twelvefold::Sample<glam::Vec2>| {
        assert!(domain.contains(sample.position.as_dvec2()));
        ControlFlow::Continue(())
    });
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
            assert!(domain.contains(point.position) && map.value(point.position) > 0.0);
        }
    }
    let amount = Amount::Points(n as f64);
    if let Ok(sampling) = Sampling::with_limits(&placement, map, amount, LIMITS)
        && let Ok(points) = sampling.weighted(Weighting::Smoothed)
        && let Ok(mut points) = points.collect::<Result<Vec<_>, _>>()
    {
        post_stratify(&mut points, map, (seed % 10) as f64);
        normalise(&mut points, n as f64);
    }
}

/// An importance that covers a domain of its own.
trait Domained {
    fn domain(&self) -> Domain;
}

impl Domained for ImageMap {
    fn domain(&self) -> Domain {
        self.domain()
    }
}

impl Domained for BilinearMap {
    fn domain(&self) -> Domain {
        self.map().domain()
    }
}
