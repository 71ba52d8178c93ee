//! Shared by the test files: points as a list, and seeded maps.

use glam::DVec2;
use twelvefold::{ImageMap, Importance, InvalidPixels, Sampling, SamplingError};

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
    ImageMap::new(width, height, pixels, InvalidPixels::Reject).unwrap()
}

/// A hash of two numbers, as a number in [0, 1).
#[allow(dead_code, reason = "not every test file needs it")]
pub(crate) fn noise(x: usize, y: usize) -> f32 {
    let mut z = (x as u64) << 32 | y as u64;
    z = (z ^ (z >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    z = (z ^ (z >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    ((z ^ (z >> 33)) >> 40) as f32 / (1u32 << 24) as f32
}
