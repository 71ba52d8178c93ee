//! Environment maps: light from all directions, as a latitude–longitude image.

use alloc::vec::Vec;
use core::f64::consts::{PI, TAU};
use core::fmt;

use glam::{DVec2, DVec3};

use super::frame::Frame;
use super::policy::RadiancePolicy;
use super::{ImageMap, InvalidPixels, MapError};

/// Why pixels are no environment map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The number of pixels is not width × height, or one of these is 0.
    Map(MapError),
    /// The first component, row by row, that the policy does not admit.
    InvalidPixel {
        /// Its column, from 0.
        x: usize,
        /// Its row, from 0.
        y: usize,
        /// 0 for red, 1 for green, 2 for blue.
        channel: usize,
        /// Its value.
        value: f32,
    },
}

impl fmt::Display for EnvironmentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(f),
            Self::InvalidPixel { x, y, channel, value } => {
                let name = ["red", "green", "blue"].get(*channel).copied().unwrap_or("component");
                write!(
                    f,
                    "{name} of pixel ({x}, {y}) is {value}: radiance must be finite and not negative"
                )
            }
        }
    }
}

impl core::error::Error for EnvironmentError {}

impl From<MapError> for EnvironmentError {
    fn from(error: MapError) -> Self {
        Self::Map(error)
    }
}

/// Light from a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentSample {
    /// The direction towards the light, of length 1 (to an ulp or two).
    pub direction: DVec3,
    /// The probability density of this direction per steradian. The number of samples expected in a
    /// steradian is this times the number of samples; 0 where the map is black.
    pub pdf: f64,
    /// Radiance (red, green, blue) of the pixel, in the map's units.
    pub radiance: [f32; 3],
}

/// A latitude–longitude image of radiance, and the importance that follows its luminance.
///
/// Column x and row y of the image, measured from the upper left corner in pixels, are the direction
///
/// φ = 2π·x/width, (sin θ cos φ, sin θ sin φ, cos θ),
///
/// where θ runs from 0 (the z axis, upper border) to π. Within a row of pixels **cos θ is linear in y**,
/// between its exact values at the row's borders: so every pixel is uniform on the sphere, its solid
/// angle is exact, and the pdf per steradian of a pixel is its luminance over the map's total, up to
/// the poles. The seam φ = 0 is like any other column border.
///
/// The importance of a pixel is luminance (Rec. 709) × the row's solid angle relative to the
/// equator's, close to sin θ. Sample [`importance`](Self::importance) in any way (thresholds,
/// [`exactly`](crate::estimate::exactly), [`Warp`](crate::estimate::Warp)) and turn positions into light with
/// [`sample`](Self::sample). Since importance is 0 only where all radiance is, estimates of what the map
/// lights are unbiased.
///
/// ```
/// use twelvefold::{EnvironmentMap, InvalidPixels, Limits, Placement, estimate::exactly};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let sky = EnvironmentMap::new(64, 32, vec![[0.2, 0.3, 0.9]; 64 * 32], InvalidPixels::Reject)?;
/// let placement = Placement::new(sky.importance().domain(), 1);
/// let points = exactly(&placement, sky.importance(), 256, Limits::default())?;
/// // Blue light that falls on a horizontal surface from above: π · 0.9 for a uniform sky.
/// let mut irradiance = 0.0;
/// for point in &points {
///     let light = sky.sample(point.position);
///     let cosine = light.direction.z.max(0.0);
///     irradiance += f64::from(light.radiance[2]) * cosine / (light.pdf * points.len() as f64);
/// }
/// assert!((irradiance / (core::f64::consts::PI * 0.9) - 1.0).abs() < 0.03);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    importance: ImageMap,
    radiance: Vec<[f32; 3]>,
    /// cos θ at the upper border of each row, and −1.
    cosines: Vec<f64>,
    /// ∫ luminance over the sphere.
    total: f64,
    frame: Frame,
}

impl EnvironmentMap {
    /// The map of these pixels (linear red, green, blue), row by row from the upper left. O(pixels).
    ///
    /// Components that are no radiance follow `invalid`, an [`InvalidPixels`] or a [`RadiancePolicy`]; an
    /// HDR image that was resampled often holds negative ones, which [`InvalidPixels::ZeroNegative`] takes
    /// as 0.
    ///
    /// # Errors
    /// [`EnvironmentError`]: sizes that do not match, and the first component that `invalid` does not
    /// admit.
    pub fn new(
        width: usize,
        height: usize,
        mut pixels: Vec<[f32; 3]>,
        invalid: impl Into<RadiancePolicy>,
    ) -> Result<Self, EnvironmentError> {
        if width == 0 || height == 0 {
            return Err(MapError::Empty { width, height }.into());
        }
        let expected = width.saturating_mul(height);
        if pixels.len() != expected {
            return Err(MapError::Length { expected, found: pixels.len() }.into());
        }
        let policy = invalid.into();
        for (i, pixel) in pixels.iter_mut().enumerate() {
            for (channel, component) in pixel.iter_mut().enumerate() {
                let value = *component;
                *component = policy.admit(value).ok_or(EnvironmentError::InvalidPixel {
                    x: i % width,
                    y: i / width,
                    channel,
                    value,
                })?;
            }
        }
        let cosines: Vec<f64> = (0..=height).map(|y| border_cosine(y, height)).collect();
        let at_equator = TAU / width as f64 * (PI / height as f64);
        let mut total = 0.0;
        let mut importance = super::pixels::with_room(expected)?;
        for (row, borders) in pixels.chunks_exact(width).zip(cosines.windows(2)) {
            let solid_angle = TAU / width as f64 * (borders[0] - borders[1]);
            for pixel in row {
                let luminance = luminance(*pixel);
                total += luminance * solid_angle;
                importance.push(importance_of(luminance * (solid_angle / at_equator)));
            }
        }
        let importance = ImageMap::new(width, height, importance, InvalidPixels::Reject)?;
        Ok(Self { importance, radiance: pixels, cosines, total, frame: Frame::default() })
    }

    /// The same light with directions in another frame.
    #[must_use]
    pub fn in_frame(self, frame: Frame) -> Self {
        Self { frame, ..self }
    }

    /// The frame of its directions, [`Frame::PBRT`] unless told otherwise.
    #[must_use]
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// The importance of the directions, over [0, width) × [0, height).
    #[must_use]
    pub fn importance(&self) -> &ImageMap {
        &self.importance
    }

    /// Pixels a row and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        self.importance.size()
    }

    /// ∫ luminance over the sphere.
    #[must_use]
    pub fn total_luminance(&self) -> f64 {
        self.total
    }

    /// The solid angle of a pixel of row `y`, in steradians; 0 past the last row. The sum over all
    /// pixels is 4π to rounding.
    #[must_use]
    pub fn solid_angle(&self, y: usize) -> f64 {
        match self.cosines.get(y..).and_then(|rest| rest.first_chunk()) {
            Some([upper, lower]) => TAU / self.size().0 as f64 * (upper - lower),
            None => 0.0,
        }
    }

    /// The light at a position in the image, in pixels from the upper left corner. Positions outside
    /// count as the nearest inside, NaN as 0.
    #[must_use]
    pub fn sample(&self, position: DVec2) -> EnvironmentSample {
        let (width, height) = self.size();
        // In this form, a comparison that is false for NaN.
        let inside = |c: f64, end: usize| if c > 0.0 { c.min(end as f64) } else { 0.0 };
        let position = DVec2::new(inside(position.x, width), inside(position.y, height));
        let (x, y) = self.importance.texel(position);
        let direction = self.direction(y, position.x, position.y - y as f64);
        EnvironmentSample {
            direction,
            pdf: self.pixel_pdf(x, y),
            radiance: self.radiance[y * width + x],
        }
    }

    /// The direction at x pixels from the left and, in row `row`, `down` pixels from its upper border.
    pub(crate) fn direction(&self, row: usize, x: f64, down: f64) -> DVec3 {
        let (upper, lower) = (self.cosines[row], self.cosines[row + 1]);
        let z = upper + down * (lower - upper);
        // sin² = (1 − cos)(1 + cos) keeps its digits near the poles.
        let sine = libm::sqrt(((1.0 - z) * (1.0 + z)).max(0.0));
        let azimuth = x * (TAU / self.size().0 as f64);
        self.frame.to_world(DVec3::new(sine * libm::cos(azimuth), sine * libm::sin(azimuth), z))
    }

    /// The position in the image, in pixels from the upper left corner, of a direction of any length
    /// above 0: in [0, width) × [0, height). `None` for the zero vector, NaN and infinities.
    #[must_use]
    pub fn position(&self, direction: DVec3) -> Option<DVec2> {
        let (width, height) = self.size();
        // Scaled first: lengths near the limits of f64 would overflow when squared.
        let scaled = direction / direction.abs().max_element();
        let length = libm::sqrt(scaled.dot(scaled));
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let scaled = self.frame.to_image(scaled);
        let z = (scaled.z / length).clamp(-1.0, 1.0);
        // Cosines fall from row to row.
        let row = self.cosines.partition_point(|border| *border >= z);
        let row = row.saturating_sub(1).min(height - 1);
        let (upper, lower) = (self.cosines[row], self.cosines[row + 1]);
        let down = ((upper - z) / (upper - lower)).clamp(0.0, 1.0);
        let turns = libm::atan2(scaled.y, scaled.x) / TAU;
        let x = if turns < 0.0 { turns + 1.0 } else { turns } * width as f64;
        let y = row as f64 + down;
        let below = |value: f64, limit: usize| value.min((limit as f64).next_down());
        Some(DVec2::new(below(x, width), below(y, height)))
    }

    /// The probability density per steradian with which sampling the importance picks a direction: what
    /// multiple importance sampling needs for directions that came from elsewhere. 0 where the map is
    /// black, and for a direction without length.
    #[must_use]
    pub fn pdf(&self, direction: DVec3) -> f64 {
        self.position(direction).map_or(0.0, |position| {
            let (x, y) = self.importance.texel(position);
            self.pixel_pdf(x, y)
        })
    }

    /// Radiance from a direction; black for a direction without length.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> [f32; 3] {
        self.position(direction).map_or([0.0; 3], |position| {
            let (x, y) = self.importance.texel(position);
            self.radiance[y * self.size().0 + x]
        })
    }

    /// All pixels, row by row.
    pub(crate) fn pixels(&self) -> &[[f32; 3]] {
        &self.radiance
    }

    /// Importance of the pixel over the total, over its solid angle: what the sampler really follows,
    /// `f32` rounding included.
    pub(crate) fn pixel_pdf(&self, x: usize, y: usize) -> f64 {
        let importance = f64::from(self.importance.pixels()[y * self.size().0 + x]);
        let sum = self.importance.mean() * self.importance.pixels().len() as f64;
        if sum > 0.0 { importance / (sum * self.solid_angle(y)) } else { 0.0 }
    }
}

/// cos θ at the upper border of row `y`: exactly 1, 0 and −1 at poles and equator, and odd about it.
fn border_cosine(y: usize, height: usize) -> f64 {
    match (2 * y).cmp(&height) {
        core::cmp::Ordering::Less => libm::cos(PI * (y as f64 / height as f64)),
        core::cmp::Ordering::Equal => 0.0,
        core::cmp::Ordering::Greater => -libm::cos(PI * ((height - y) as f64 / height as f64)),
    }
}

/// Rec. 709 luminance. Positive if a component is.
pub(crate) fn luminance([red, green, blue]: [f32; 3]) -> f64 {
    0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
}

/// As `f32`, but 0 only for 0 and never infinite: light that rounds to nothing would never be sampled.
pub(crate) fn importance_of(value: f64) -> f32 {
    let rounded = value as f32;
    if value > 0.0 { rounded.clamp(f32::from_bits(1), f32::MAX) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    fn sky(width: usize, height: usize) -> EnvironmentMap {
        let mut random = SplitMix64::new(9);
        let pixels = (0..width * height)
            .map(|i| if i % 7 == 3 { [0.0; 3] } else { [0; 3].map(|_| random.unit() as f32) })
            .collect();
        EnvironmentMap::new(width, height, pixels, InvalidPixels::Reject).unwrap()
    }

    #[test]
    fn solid_angles_are_the_sphere_and_the_pdf_integrates_to_one() {
        for (width, height) in [(1, 1), (2, 1), (64, 32), (7, 5), (512, 256)] {
            let sky = sky(width, height);
            let (mut sphere, mut probability, mut luminance_sum) = (0.0, 0.0, 0.0);
            for y in 0..height {
                for x in 0..width {
                    let middle = sky.sample(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
                    sphere += sky.solid_angle(y);
                    probability += sky.solid_angle(y) * middle.pdf;
                    luminance_sum += sky.solid_angle(y) * luminance(middle.radiance);
                    let proportional = luminance(middle.radiance) / sky.total_luminance();
                    assert!((middle.pdf - proportional).abs() <= 1e-6 * proportional);
                }
            }
            assert!((sphere - 2.0 * TAU).abs() < 1e-10);
            assert!((probability - 1.0).abs() < 1e-10);
            assert!((luminance_sum - sky.total_luminance()).abs() < 1e-9);
            assert_eq!(sky.solid_angle(height), 0.0);
        }
    }

    #[test]
    fn directions_and_positions_are_inverse_up_to_the_poles_and_the_seam() {
        let sky = sky(64, 32);
        let mut random = SplitMix64::new(4);
        for i in 0..20_000 {
            let mut at = DVec2::new(64.0 * random.unit(), 32.0 * random.unit());
            match i % 4 {
                0 => at.y *= 1e-4,
                1 => at.y = 32.0 - 1e-4 * at.y,
                2 => at.x *= 1e-6,
                _ => {}
            }
            let sample = sky.sample(at);
            assert!((sample.direction.length() - 1.0).abs() < 1e-15);
            let back = sky.position(3.7 * sample.direction).unwrap();
            // Near a pole, z keeps 16 digits of 1, which is half as many of θ.
            assert!((back.y - at.y).abs() < 1e-10, "{at} {back}");
            assert!((back.x - at.x).abs() < 1e-12, "{at} {back}");
            assert_eq!(sky.pdf(sample.direction), sample.pdf);
            assert_eq!(sky.radiance(sample.direction), sample.radiance);
        }
    }

    #[test]
    fn axes_lie_where_they_should() {
        let sky = sky(8, 4);
        let at = |direction| sky.position(direction).unwrap();
        assert_eq!(at(DVec3::X), DVec2::new(0.0, 2.0));
        assert_eq!(at(DVec3::Y), DVec2::new(2.0, 2.0));
        assert_eq!(at(DVec3::NEG_X), DVec2::new(4.0, 2.0));
        assert_eq!(at(DVec3::NEG_Y), DVec2::new(6.0, 2.0));
        assert_eq!(at(DVec3::Z).y, 0.0);
        assert_eq!(at(DVec3::NEG_Z).y, 4f64.next_down());
        // Just before the seam.
        assert_eq!(at(DVec3::new(1.0, -1e-30, 0.0)).x, 8f64.next_down());
        assert_eq!(at(DVec3::new(1e300, 1e300, 0.0)), DVec2::new(1.0, 2.0));
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(sky.position(none), None);
            assert_eq!((sky.pdf(none), sky.radiance(none)), (0.0, [0.0; 3]));
        }
    }

    #[test]
    fn light_too_weak_for_single_precision_is_still_sampled() {
        let mut pixels = alloc::vec![[0.0f32; 3]; 32];
        pixels[0][2] = f32::from_bits(1);
        let sky = EnvironmentMap::new(8, 4, pixels, InvalidPixels::Reject).unwrap();
        assert!(sky.importance().pixels()[0] > 0.0);
        assert!(sky.sample(DVec2::new(0.5, 0.5)).pdf > 0.0);
    }

    #[test]
    fn components_follow_the_policy_and_are_located() {
        let with = |value: f32, invalid| {
            let mut pixels = alloc::vec![[1.0f32; 3]; 6];
            pixels[4][1] = value;
            EnvironmentMap::new(3, 2, pixels, invalid)
        };
        let error = with(-0.5, InvalidPixels::Reject).unwrap_err();
        let expected = EnvironmentError::InvalidPixel { x: 1, y: 1, channel: 1, value: -0.5 };
        assert_eq!(error, expected);
        let zeroed = with(-0.5, InvalidPixels::ZeroNegative).unwrap();
        assert_eq!(zeroed.sample(DVec2::new(1.5, 1.5)).radiance, [1.0, 0.0, 1.0]);
        assert!(with(f32::NAN, InvalidPixels::ZeroNegative).is_err());
        assert!(with(f32::INFINITY, InvalidPixels::ZeroAll).is_ok());
        let none = EnvironmentMap::new(0, 2, Vec::new(), InvalidPixels::Reject).unwrap_err();
        assert_eq!(none, EnvironmentError::Map(MapError::Empty { width: 0, height: 2 }));
    }
}
