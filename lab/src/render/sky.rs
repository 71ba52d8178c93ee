//! Two skies.

use glam::DVec3;
use twelvefold::light::Frame;
use twelvefold::{EnvironmentError, EnvironmentMap, InvalidPixels};

/// Weather.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sky {
    /// A blue sky with a sun of two by two pixels, some 10⁵ times as bright as the rest.
    Sunny,
    /// The standard overcast sky (CIE): three times as bright at the zenith as at the horizon.
    Overcast,
}

/// A latitude–longitude map of the sky, twice as wide as `height`, z up. The ground is dim.
///
/// # Errors
/// [`EnvironmentError`] for a height of 0.
pub fn sky(kind: Sky, height: usize) -> Result<EnvironmentMap, EnvironmentError> {
    let width = 2 * height;
    let row_angle = std::f64::consts::PI / height as f64;
    let pixels = (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            let up = ((y as f64 + 0.5) * row_angle).cos();
            let color = if up < 0.0 {
                DVec3::new(0.09, 0.08, 0.07)
            } else {
                match kind {
                    Sky::Overcast => DVec3::splat((1.0 + 2.0 * up) / 3.0),
                    Sky::Sunny => DVec3::new(0.25, 0.4, 0.8) * (1.2 - 0.7 * up),
                }
            };
            // 45° high, left of the middle.
            let sun = |at: usize, of: usize| at == of || at == of + 1;
            let is_sun = kind == Sky::Sunny && sun(y, height / 4) && sun(x, 2 * width / 5);
            // The same light from any number of pixels: three times what the overcast sky gives.
            let solid = 4.0 * row_angle * row_angle * std::f64::consts::FRAC_1_SQRT_2;
            let color = if is_sun { DVec3::new(1.0, 0.9, 0.75) * (7.0 / solid) } else { color };
            color.as_vec3().to_array()
        })
        .collect();
    Ok(EnvironmentMap::new(width, height, pixels, InvalidPixels::Reject)?.in_frame(Frame::BLENDER))
}
