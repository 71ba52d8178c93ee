//! Shared by the modules: points as a list, and seeded maps.

use std::sync::OnceLock;

use glam::DVec2;
use twelvefold::{
    EnvironmentMap, ImageMap, Importance, InvalidPixels, Limits, Pixels, Sampling, SamplingError,
    Tables, bake,
};

/// All points as (rank, position), in the order of their ranks.
pub(crate) fn points<I: Importance>(
    sampling: &Sampling<'_, I>,
) -> Result<Vec<(u64, DVec2)>, SamplingError> {
    let mut points = sampling
        .points::<DVec2>()?
        .map(|sample| sample.map(|s| (s.rank, s.position)))
        .collect::<Result<Vec<_>, _>>()?;
    points.sort_by_key(|(rank, _)| *rank);
    Ok(points)
}

/// A map of these pixels, which are all allowed.
pub(crate) fn map(width: usize, height: usize, pixel: impl Fn(usize, usize) -> f32) -> ImageMap {
    let pixels = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
    Pixels::new(width, height, pixels, InvalidPixels::Reject).and_then(ImageMap::new).unwrap()
}

/// A hash of two numbers, as a number in [0, 1).
pub(crate) fn noise(x: usize, y: usize) -> f32 {
    let mut z = (x as u64) << 32 | y as u64;
    z = (z ^ (z >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    z = (z ^ (z >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    ((z ^ (z >> 33)) >> 40) as f32 / (1u32 << 24) as f32
}

/// The photograph in `data`, as darkness 0..=1.
pub(crate) fn photograph() -> ImageMap {
    let bytes = include_bytes!("data/camera-64.pgm");
    let pixels = bytes.strip_prefix(b"P5\n64 64\n255\n").unwrap();
    map(64, 64, |x, y| 1.0 - f32::from(pixels[y * 64 + x]) / 255.0)
}

/// The environment in `data`, row by row from the top, and its negative pixels as 0.
pub(crate) fn environment() -> EnvironmentMap {
    let bytes = include_bytes!("data/esplanade-64.pfm");
    let pixels = bytes.strip_prefix(b"PF\n64 32\n-1.0\n").unwrap();
    let (numbers, _) = pixels.as_chunks::<4>();
    let component = |i: usize| f32::from_le_bytes(numbers[i]);
    let pixels = (0..64 * 32)
        // Rows are stored from the bottom up.
        .map(|i| 3 * ((31 - i / 64) * 64 + i % 64))
        .map(|i| [component(i), component(i + 1), component(i + 2)])
        .collect();
    EnvironmentMap::new(64, 32, pixels, InvalidPixels::ZeroNegative).unwrap()
}

/// Tables of the built-in rules at every depth that can be baked. Made once: they are most of the time
/// of a property that asks for them.
pub(crate) fn every_depth() -> &'static [Tables<'static>] {
    static TABLES: OnceLock<Vec<Tables<'static>>> = OnceLock::new();
    TABLES.get_or_init(|| {
        let rules = Tables::built_in().rules();
        let bake =
            |depth| Tables::from_bytes(bake::bake(&rules, depth, None).unwrap().leak()).unwrap();
        (1..=bake::MAX_DEPTH).map(bake).collect()
    })
}

/// Limits that expect everything and allow few tiles.
pub(crate) fn few_tiles() -> Limits {
    Limits { points: u64::MAX, tiles: 20_000 }
}
