//! The figures of a table, on places that training never saw.

use glam::DVec2;
use rayon::prelude::*;

use super::field::{Constant, Field, spacing, threshold_of_phase};
use super::image::Image;
use super::place::{Place, Region};
use super::site::sites;
use crate::measure::fidelity::{self, Fidelity, Raster};
use crate::measure::{Evenness, Window, evenness};
use crate::random::Random;
use twelvefold::bake::displacement::{DELTA, Displacements};
use twelvefold::tiling::{OutOfRange, Rules};

/// Points of uniform phase `tau` in a square window of about `count` of them, at a random place and
/// angle, with a border of neighbors; relaxed by `table` or fixed. `None` for a count that is not
/// positive and finite.
///
/// # Errors
/// [`OutOfRange`] cannot happen for phases in [1, δ].
pub fn uniform_window(
    rules: &Rules,
    table: Option<&Displacements>,
    tau: f64,
    count: f64,
    random: &mut Random,
) -> Result<Option<(Vec<DVec2>, Window)>, OutOfRange> {
    let field = Constant(threshold_of_phase(tau));
    let side = libm::sqrt(count) * spacing(field.0);
    let Ok(window) = Window::new(DVec2::splat(-0.5 * side), DVec2::splat(side)) else {
        return Ok(None);
    };
    // Neighbors within 4 spacings, and 4 edges from which points may move in.
    let radius = side * core::f64::consts::FRAC_1_SQRT_2 + 4.0 * spacing(field.0) + 4.0;
    let ground = Place::random(rules, radius, random)?;
    let (s, c) = libm::sincos(random.unit() * core::f64::consts::TAU);
    let points = sites(&ground, &field, Region::Disc(radius))?
        .iter()
        .map(|site| table.map_or(site.center, |table| site.relaxed(table)))
        .map(|p| DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y))
        .collect();
    Ok(Some((points, window)))
}

/// Measures uniform phases. `None` for fewer points than [`evenness`] measures.
///
/// # Errors
/// As [`uniform_window`].
pub fn uniform(
    rules: &Rules,
    table: Option<&Displacements>,
    tau: f64,
    count: f64,
    random: &mut Random,
) -> Result<Option<Evenness>, OutOfRange> {
    let points = uniform_window(rules, table, tau, count, random)?;
    Ok(points.and_then(|(points, window)| evenness(&points, window).ok()))
}

/// The k-th of n phases, evenly spread in ln τ over a whole level: δ^((k + ½)/n).
#[must_use]
pub fn phase(k: usize, n: usize) -> f64 {
    libm::pow(f64::from(DELTA), (k as f64 + 0.5) / n as f64)
}

/// The points of an image in pixels, with neighbors from a border around it.
///
/// # Errors
/// [`OutOfRange`] for an image whose maximum is past some 10⁵ times its mean.
pub fn image_points<I: twelvefold::Importance + Sync>(
    rules: &Rules,
    table: Option<&Displacements>,
    image: &Image<I>,
    random: &mut Random,
) -> Result<Vec<DVec2>, OutOfRange> {
    let margin =
        DVec2::splat(16.0 * spacing(image.threshold(DVec2::ZERO).max(threshold_of_phase(1.0))));
    let half = image.half_extent() + margin;
    let ground = Place::random(rules, half.length(), random)?;
    Ok(sites(&ground, image, Region::Rectangle(half))?
        .iter()
        .map(|site| table.map_or(site.center, |table| site.settled(table, image)))
        .map(|p| image.pixels(p))
        .collect())
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

/// The figures of uniform densities: phases spread over a whole level, several places each.
///
/// # Errors
/// As [`uniform_window`].
pub fn uniform_sweep(
    rules: &Rules,
    table: Option<&Displacements>,
    phases: usize,
    places: u64,
    seed: u64,
) -> Result<Vec<(f64, Vec<Evenness>)>, OutOfRange> {
    (0..phases)
        .into_par_iter()
        .map(|k| {
            let tau = phase(k, phases);
            let measured = (0..places)
                .map(|place| {
                    let mut random = Random::new(seed, &[k as u64, place]);
                    uniform(rules, table, tau, WINDOW_POINTS, &mut random)
                })
                .collect::<Result<Vec<_>, _>>()?;
            Ok((tau, measured.into_iter().flatten().collect()))
        })
        .collect()
}

/// Points of a window of [`uniform_sweep`].
pub const WINDOW_POINTS: f64 = 16384.0;

/// The worst of several measurements in each figure.
#[must_use]
pub fn worst<'a>(measured: impl IntoIterator<Item = &'a Evenness>) -> Option<Evenness> {
    measured.into_iter().copied().reduce(|a, b| Evenness {
        count: a.count.min(b.count),
        low_frequency: a.low_frequency.max(b.low_frequency),
        mean_distance: a.mean_distance.min(b.mean_distance),
        least_distance: a.least_distance.min(b.least_distance),
    })
}

/// The figures of an image of `count` points at phases spread over a whole level; each with the share of
/// dots on pixels of importance 0. None for pixels that are no image, or too few points.
///
/// # Errors
/// As [`image_points`].
pub fn image_sweep(
    rules: &Rules,
    table: Option<&Displacements>,
    values: &[f32],
    width: usize,
    count: f64,
    phases: usize,
    seed: u64,
) -> Result<Vec<(Fidelity, f64)>, OutOfRange> {
    let Ok(raster) = Raster::new(width, values) else { return Ok(Vec::new()) };
    let measured = (0..phases).into_par_iter().map(|k| {
        let tau = phase(k, phases);
        let mut random = Random::new(seed, &[k as u64]);
        let points = if table.is_some() {
            let image = Image::stippled(values.to_vec(), width, count, tau);
            image.map(|image| image_points(rules, table, &image, &mut random))
        } else {
            // Fixed centers are accepted by the bilinear importance at them.
            let image = Image::fixed(values.to_vec(), width, count, tau);
            image.map(|image| image_points(rules, None, &image, &mut random))
        };
        let Some(points) = points.transpose()? else { return Ok(None) };
        Ok(fidelity::fidelity(&points, &raster)
            .ok()
            .map(|measured| (measured, fidelity::share_on_zero(&points, &raster))))
    });
    Ok(measured.collect::<Result<Vec<_>, OutOfRange>>()?.into_iter().flatten().collect())
}

/// Blocks of importance 1 and 0, 32 × 64 pixels: nothing but hard edges.
#[must_use]
pub fn edge_image() -> Vec<f32> {
    let side = TEST_IMAGE_SIDE;
    let is_one = |i: usize| ((i % side) / 32 + i / side / 64).is_multiple_of(2);
    (0..side * side).map(|i| f32::from(u8::from(is_one(i)))).collect()
}
