//! A small renderer, to show how light from an environment is sampled: a glossy sphere on a plane, lit
//! directly, by samples of the light, of the surface, or both, weighted against each other.
//!
//! Every strategy estimates the same integral, L = ∫ f(ω)·L(ω)·V(ω)·cos θ dω, and converges to the same
//! picture. With n samples each of light and surface, a direction ω from either counts with the weight
//! p(ω) / (p_light(ω) + p_surface(ω)) (the balance heuristic of E. Veach and L. Guibas, *Optimally
//! Combining Sampling Techniques for Monte Carlo Rendering*, 1995), which needs the density of *any*
//! direction: [`LightSampler::evaluate`](twelvefold::light::LightSampler::evaluate).

mod scene;
mod sky;
mod source;
mod surface;

pub use scene::{Picture, Strategy, render};
pub use sky::{Sky, sky};
pub use source::{Source, SourceKind};
