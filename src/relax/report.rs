//! The figures of a table, on places that training never saw.

use glam::DVec2;

use super::field::{Constant, Field, Image, spacing, threshold_of_phase};
use super::ground::{Ground, Region};
use super::random::Random;
use super::site::sites;
use crate::bake::relaxation::{DELTA, Relaxation};
use crate::measure::fidelity::{self, Fidelity, Importance};
use crate::measure::{Evenness, Window, evenness};
use crate::tiling::{OutOfRange, Rules};

/// Points of uniform phase `tau` in a square window of about `count` of them, at a random place and
/// angle, with a border of neighbours; relaxed by `table` or fixed.
///
/// # Errors
/// [`OutOfRange`] cannot happen for phases in [1, δ].
pub fn uniform_window(
    rules: &Rules,
    table: Option<&Relaxation>,
    tau: f64,
    count: f64,
    random: &mut Random,
) -> Result<(Vec<DVec2>, Window), OutOfRange> {
    let field = Constant(threshold_of_phase(tau));
    let side = libm::sqrt(count) * spacing(field.0);
    // Neighbours within 4 spacings, and 4 edges from which points may move in.
    let radius = side * core::f64::consts::FRAC_1_SQRT_2 + 4.0 * spacing(field.0) + 4.0;
    let ground = Ground::random(rules, radius, random)?;
    let (s, c) = libm::sincos(random.unit() * core::f64::consts::TAU);
    let points = sites(&ground, &field, Region::Disc(radius))?
        .iter()
        .map(|site| table.map_or(site.centre, |table| site.relaxed(table)))
        .map(|p| DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y))
        .collect();
    Ok((points, Window::new(DVec2::splat(-0.5 * side), DVec2::splat(side))))
}

/// Measures uniform phases.
///
/// # Errors
/// As [`uniform_window`].
pub fn uniform(
    rules: &Rules,
    table: Option<&Relaxation>,
    tau: f64,
    count: f64,
    random: &mut Random,
) -> Result<Option<Evenness>, OutOfRange> {
    let (points, window) = uniform_window(rules, table, tau, count, random)?;
    Ok(evenness(&points, window))
}

/// The k-th of n phases, evenly spread in ln τ over a whole level: δ^((k + ½)/n).
#[must_use]
pub fn phase(k: usize, n: usize) -> f64 {
    libm::pow(f64::from(DELTA), (k as f64 + 0.5) / n as f64)
}

/// The points of an image in pixels, with neighbours from a border around it.
///
/// # Errors
/// [`OutOfRange`] for an image whose maximum is past some 10⁵ times its mean.
pub fn image_points(
    rules: &Rules,
    table: Option<&Relaxation>,
    image: &Image,
    random: &mut Random,
) -> Result<Vec<DVec2>, OutOfRange> {
    let margin =
        DVec2::splat(16.0 * spacing(image.threshold(DVec2::ZERO).max(threshold_of_phase(1.0))));
    let half = image.half_extent() + margin;
    let ground = Ground::random(rules, half.length(), random)?;
    Ok(sites(&ground, image, Region::Rectangle(half))?
        .iter()
        .map(|site| table.map_or(site.centre, |table| site.relaxed(table)))
        .map(|p| image.pixels(p))
        .collect())
}

/// Measures a table on an image.
#[must_use]
pub fn image_fidelity(points: &[DVec2], values: &[f32], width: usize) -> Option<Fidelity> {
    fidelity::fidelity(points, &Importance { values, width })
}

/// The side of [`test_image`].
pub const TEST_IMAGE_SIDE: usize = 1024;

/// An image with everything that is hard: a gradient (upper half, over a whole level factor), hard
/// edges (discs), a checker of 10 pixels, and noise from pixel to pixel.
#[must_use]
pub fn test_image() -> Vec<f32> {
    let side = TEST_IMAGE_SIDE;
    let mut noise = Random::new(0, &[]);
    (0..side * side)
        .map(|i| {
            let (x, y) = ((i % side) as f32, (i / side) as f32);
            let noise = noise.unit() as f32;
            let gradient = 0.08 + 0.92 * x / side as f32;
            let disc = |cx: f32, cy: f32, r: f32| (x - cx) * (x - cx) + (y - cy) * (y - cy) < r * r;
            if y < 512.0 {
                gradient
            } else if x < 512.0 {
                if disc(256.0, 768.0, 220.0) != disc(320.0, 700.0, 90.0) { 1.0 } else { 0.25 }
            } else if x < 768.0 {
                if ((x / 10.0) as u32 + (y / 10.0) as u32).is_multiple_of(2) { 0.9 } else { 0.3 }
            } else {
                0.3 + 0.7 * noise
            }
        })
        .collect()
}
