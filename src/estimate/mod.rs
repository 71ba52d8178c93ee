//! Estimates: what a sample is worth, and the ways to samples that are worth more.
//!
//! Points of a [`Sampling`](crate::Sampling) estimate an integral over the domain as Σ f(pᵢ)·wᵢ. With the
//! weight 1/density the estimate is **unbiased** over seeds, for any number of points, small ones
//! included, *if the importance is above zero wherever f is not zero*: what lies where no point can fall
//! is never seen, and the estimate is then that of f restricted to where points can fall. Nothing is
//! clamped behind the caller's back.
//!
//! # Which weight
//!
//! | weight | bias | use |
//! |---|---|---|
//! | [`Weighting::Density`]: 1/density | none | running averages over many seeds; f that vanishes at the border |
//! | the same, [normalized](normalize) by the count | O(1/n) | **one-shot estimates** where f resembles the importance: 10–30 % less error on environment maps |
//! | [`Weighting::Smoothed`]: 2(1 − z)/density | none | smooth f: newest points count little, so that the edge of the set in rank is soft; free |
//! | [`post_stratify`] | small (below half of the error) | n ≥ 256 on a pixel map: 2–10 × less error at 16k |
//!
//! z = (rank + u)/T is a point's place between the first point there (0) and the last (1).
//!
//! # Which points
//!
//! | points | number | when |
//! |---|---|---|
//! | [`Sampling::weighted`](crate::Sampling::weighted) | random, expected n | progressive over densities, several frames, any importance |
//! | [`exactly`] | n | a fixed budget, each prefix a good set |
//! | [`exactly_relaxed`] | n | even points, for pictures and scattering: no weights |
//! | [`Warp`] | n | few accurate samples of a pixel map: the least error per sample, but no fixed sequence |
//! | [`Placement::aligned`](crate::Placement::aligned) | expected n | constant importance: a complete level, as accurate as the best known sets |
//!
//! Fixed centers only: relaxed points are moved after acceptance, and these weights would be biased by 4
//! to 36 % on them. Asked for [`weighted`](crate::Sampling::weighted) points, a
//! [relaxed](crate::Sampling::relaxed) sampling answers with
//! [`SamplingError::Relaxed`](crate::SamplingError::Relaxed); everything else here takes fixed
//! centers by itself. Under *constant* importance alone all points move by the same rule and stay
//! uniform: there equal weights, area/(expected number), are unbiased for relaxed points, too.

mod even;
mod exact;
mod order;
mod seamless;
mod stratified;
pub(crate) mod sums;
mod warp;
mod weighted;

pub use even::exactly_relaxed;
pub use exact::{ExactError, exactly};
pub use seamless::SeamlessSet;
pub use stratified::post_stratify;
pub use warp::Warp;
pub use weighted::{Weighted, WeightedPoints, Weighting, normalize};
