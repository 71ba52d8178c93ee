//! A glossy sphere on a plane, and the light that a camera sees on them.

use glam::DVec3;

use super::source::Source;
use super::surface::Surface;

/// What is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strategy {
    /// Directions to the light, by the map.
    Light,
    /// Directions that the surface reflects.
    Surface,
    /// As many of each, weighted by the balance heuristic.
    Both,
}

impl Strategy {
    /// All.
    pub const ALL: [Self; 3] = [Self::Light, Self::Surface, Self::Both];

    /// As in a table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Surface => "surface",
            Self::Both => "both",
        }
    }
}

/// Linear radiance, row by row from the top.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green and blue.
    pub pixels: Vec<DVec3>,
}

/// A place on a surface.
struct Hit {
    position: DVec3,
    normal: DVec3,
    surface: Surface,
}

const CENTER: DVec3 = DVec3::new(0.0, 0.0, 1.0);
const EYE: DVec3 = DVec3::new(-5.2, -2.0, 2.1);

/// Half the height of the view at distance 1.
const HALF_VIEW: f64 = 0.32;

/// Renders the scene under the source's environment. Pictures of different `seed` are independent.
#[must_use]
pub fn render(source: &Source<'_>, strategy: Strategy, size: (usize, usize), seed: u64) -> Picture {
    render_polished(source, strategy, size, seed, 1.0)
}

/// The same with exponents times `polish`.
fn render_polished(
    source: &Source<'_>,
    strategy: Strategy,
    (width, height): (usize, usize),
    seed: u64,
    polish: f64,
) -> Picture {
    let forward = (CENTER - DVec3::new(0.0, 0.0, 0.25) - EYE).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let pixels = (0..width * height)
        .map(|i| {
            let across = 2.0 * ((i % width) as f64 + 0.5) - width as f64;
            let down = 2.0 * ((i / width) as f64 + 0.5) - height as f64;
            let scale = HALF_VIEW / height as f64;
            let view = (forward + scale * (across * right - down * up)).normalize();
            match hit(view) {
                Some(mut hit) => {
                    hit.surface.exponent *= polish;
                    let pixel = seed.wrapping_mul((width * height) as u64) + i as u64;
                    shade(source, strategy, &hit, view, pixel)
                }
                None => color(source.evaluate(view).radiance),
            }
        })
        .collect();
    Picture { width, height, pixels }
}

/// The nearest surface along a ray from the eye.
fn hit(view: DVec3) -> Option<Hit> {
    let to_sphere = sphere(EYE, view);
    let to_plane = if view.z < 0.0 { -EYE.z / view.z } else { f64::INFINITY };
    if to_sphere < to_plane {
        let position = EYE + to_sphere * view;
        let surface =
            Surface { diffuse: DVec3::new(0.02, 0.02, 0.03), glossy: 0.8, exponent: 400.0 };
        return Some(Hit { position, normal: position - CENTER, surface });
    }
    if to_plane >= 40.0 {
        return None;
    }
    let position = EYE + to_plane * view;
    // A chessboard, one color of which is glossy.
    let dark = ((position.x.floor() + position.y.floor()) as i64).rem_euclid(2) == 0;
    let surface = if dark {
        Surface { diffuse: DVec3::new(0.12, 0.06, 0.04), glossy: 0.4, exponent: 60.0 }
    } else {
        Surface { diffuse: DVec3::splat(0.6), glossy: 0.0, exponent: 1.0 }
    };
    Some(Hit { position, normal: DVec3::Z, surface })
}

/// The distance along a ray at which it enters the sphere, infinite if it does not.
fn sphere(from: DVec3, direction: DVec3) -> f64 {
    let to_center = CENTER - from;
    let along = to_center.dot(direction);
    let inside = along * along - to_center.length_squared() + 1.0;
    let distance = along - inside.max(0.0).sqrt();
    if inside > 0.0 && distance > 1e-9 { distance } else { f64::INFINITY }
}

/// Whether the sky is seen from a place: past the sphere from the plane, past the plane from the sphere.
fn is_open(hit: &Hit, direction: DVec3) -> bool {
    direction.z > 0.0
        && direction.dot(hit.normal) > 0.0
        && (hit.normal != DVec3::Z || sphere(hit.position, direction) == f64::INFINITY)
}

fn color(radiance: [f32; 3]) -> DVec3 {
    DVec3::from_array(radiance.map(f64::from))
}

/// The light that a place reflects to the eye: an estimate from the pixel's samples.
fn shade(source: &Source<'_>, strategy: Strategy, hit: &Hit, view: DVec3, pixel: u64) -> DVec3 {
    let Hit { normal, surface, .. } = hit;
    let mirror = view - 2.0 * view.dot(*normal) * normal;
    let mut sum = DVec3::ZERO;
    if strategy != Strategy::Surface {
        source.lights(pixel, |light| {
            if is_open(hit, light.direction) {
                let (reflected, density) = surface.reflect(*normal, mirror, light.direction);
                // The balance heuristic's weight over the density: 1 / (all densities).
                let densities =
                    if strategy == Strategy::Both { light.pdf + density } else { light.pdf };
                sum += reflected * color(light.radiance) / densities;
            }
        });
    }
    if strategy != Strategy::Light {
        source.pairs(pixel, |pair| {
            let direction = surface.sample(*normal, mirror, pair);
            if is_open(hit, direction) {
                let (reflected, density) = surface.reflect(*normal, mirror, direction);
                let light = source.evaluate(direction);
                let densities =
                    if strategy == Strategy::Both { light.pdf + density } else { density };
                sum += reflected * color(light.radiance) / densities;
            }
        });
    }
    sum / source.count() as f64
}

#[cfg(test)]
mod tests {
    use super::super::{Sky, SourceKind, sky};
    use super::*;

    /// Mean of every pixel's green, and the variance of the mean, over independent pictures.
    fn statistics(
        source: &Source<'_>,
        strategy: Strategy,
        pictures: u64,
        polish: f64,
    ) -> Vec<(f64, f64)> {
        let size = (10, 7);
        let mut sums = vec![(0.0, 0.0); size.0 * size.1];
        for seed in 0..pictures {
            for (sum, pixel) in
                sums.iter_mut().zip(render_polished(source, strategy, size, seed, polish).pixels)
            {
                *sum = (sum.0 + pixel.y, sum.1 + pixel.y * pixel.y);
            }
        }
        let n = pictures as f64;
        let finish = |(sum, squares): (f64, f64)| {
            let mean = sum / n;
            (mean, (squares / n - mean * mean).max(0.0) / (n - 1.0))
        };
        sums.into_iter().map(finish).collect()
    }

    /// Every way to sample converges to the same picture: z of each pixel's difference to white light
    /// samples weighted against white surface samples. Little polished, so that few pictures tell the
    /// variance.
    #[test]
    fn all_strategies_and_sources_converge_to_the_same_picture() {
        for kind in [Sky::Overcast, Sky::Sunny] {
            // Coarse: the sun must be found by surface samples in this many.
            let map = sky(kind, 16).unwrap();
            let source = |kind, count| Source::new(&map, kind, count).unwrap().unwrap();
            let truth = statistics(&source(SourceKind::Alias, 64), Strategy::Both, 60, 0.03);
            for source_kind in SourceKind::ALL {
                for strategy in Strategy::ALL {
                    let found = statistics(&source(source_kind, 8), strategy, 60, 0.03);
                    let mut squares: Vec<f64> = Vec::new();
                    for (a, b) in truth.iter().zip(&found) {
                        let variance = a.1 + b.1;
                        // Where no sample of either differs, there is nothing but the sky to see.
                        if variance > 1e-20 {
                            squares.push((a.0 - b.0) * (a.0 - b.0) / variance);
                        } else {
                            assert!((a.0 - b.0).abs() < 1e-9);
                        }
                    }
                    // All but two: pixels whose light comes from seldom samples do not tell their variance.
                    squares.sort_by(f64::total_cmp);
                    squares.truncate(squares.len() - 2);
                    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
                    let worst = squares.last().copied().unwrap_or(0.0).sqrt();
                    println!("{kind:?} {source_kind:?} {strategy:?}: {worst:.2} {mean:.2}");
                    assert!(squares.len() > 40);
                    assert!(worst < 5.0 && mean < 1.8, "{kind:?} {source_kind:?} {strategy:?}");
                }
            }
        }
    }

    #[test]
    fn both_has_the_least_error_of_the_strategies_where_each_alone_fails() {
        let map = sky(Sky::Sunny, 16).unwrap();
        let source = Source::new(&map, SourceKind::SobolWarp, 8).unwrap().unwrap();
        let noise = Strategy::ALL.map(|strategy| -> f64 {
            statistics(&source, strategy, 20, 1.0).iter().map(|(_, variance)| variance).sum()
        });
        assert!(noise[2] < noise[0] && noise[2] < noise[1], "{noise:?}");
    }
}
