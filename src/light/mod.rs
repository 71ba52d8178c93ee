//! Light from an environment as a renderer asks for it: one sample at a time, in its own coordinates.
//!
//! An [`EnvironmentMap`](crate::EnvironmentMap) holds the light; here is how a renderer's loop over pixels
//! and samples uses it.
//!
//! - [`Frame`]: which way the image faces, by the names of renderers.
//! - [`RadiancePolicy`]: what negative, infinite and undefined components count as.
//! - [`LightSampler`]: from two uniform numbers to a direction with its density and radiance, and back;
//!   the density of any direction; pixels as squares or interpolated ([`Filter`]).
//! - [`FacingSampler`]: the same for a surface with a known normal, with the cosine's bound in the density.
//! - [`Sobol`]: the numbers to use.
//!
//! ```
//! use glam::DVec3;
//! use twelvefold::light::{Filter, Frame, LightSampler};
//! use twelvefold::{EnvironmentMap, InvalidPixels};
//! // A sky with a sun, as Blender would show it.
//! let mut pixels = vec![[0.2, 0.3, 0.9]; 64 * 32];
//! pixels[8 * 64 + 20] = [9000.0; 3];
//! let sky = EnvironmentMap::new(64, 32, pixels, InvalidPixels::Reject)?.in_frame(Frame::BLENDER);
//! let lights = LightSampler::new(&sky, Filter::Nearest).ok_or("black")?;
//! // Blue light on a horizontal surface, from 1,024 samples of the sequence of seed 1.
//! let mut irradiance = 0.0;
//! for i in 0..1024 {
//!     let light = lights.nth(i, 1);
//!     irradiance += f64::from(light.radiance[2]) * light.direction.z.max(0.0) / (light.pdf * 1024.0);
//! }
//! // The sun is most of it: 9000 × its solid angle × its height above the horizon.
//! let sun = 9000.0 * sky.solid_angle(8) * (std::f64::consts::PI * 8.5 / 32.0).cos();
//! assert!((irradiance / (sun + std::f64::consts::PI * 0.9) - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bilinear;
mod facing;
mod sampler;
mod sobol;

pub use crate::importance::frame::Frame;
pub use crate::importance::policy::{
    InfiniteRadiance, NanRadiance, NegativeRadiance, RadiancePolicy,
};
pub use facing::FacingSampler;
pub use sampler::{Filter, LightSampler};
pub use sobol::Sobol;
