//! What is integrated: functions of the square, and light on surfaces.

use glam::{DVec2, DVec3};
use twelvefold::{EnvironmentError, EnvironmentMap, InvalidPixels};

use twelvefold_lab::random::Random;

/// A function of the unit square and its integral.
pub(crate) type Instance = (Box<dyn Fn(DVec2) -> f64>, f64);

/// A family of functions of the unit square: a function and its integral for each seed.
pub(crate) struct Plane {
    pub(crate) name: &'static str,
    pub(crate) instance: fn(seed: u64) -> Instance,
}

/// Scenes of constant importance.
pub(crate) const PLANES: [Plane; 4] = [
    Plane {
        name: "smooth bump",
        instance: |seed| {
            // Sixteen standard deviations fit: the rest is below rounding.
            let center = DVec2::splat(0.5) + 0.02 * Random::new(seed, &[]).point();
            let width = 0.06;
            let bump = move |p: DVec2| (-p.distance_squared(center) / (2.0 * width * width)).exp();
            (Box::new(bump), std::f64::consts::TAU * width * width)
        },
    },
    Plane {
        name: "disc",
        instance: |seed| {
            let center = DVec2::splat(0.4) + 0.2 * Random::new(seed, &[]).point();
            let radius = 0.3;
            let disc = move |p: DVec2| f64::from(p.distance(center) < radius);
            (Box::new(disc), std::f64::consts::PI * radius * radius)
        },
    },
    Plane {
        name: "half-plane",
        instance: |seed| {
            // Through the center at any angle: half of the square.
            let angle = std::f64::consts::TAU * Random::new(seed, &[]).unit();
            let normal = DVec2::from_angle(angle);
            let half = move |p: DVec2| f64::from(normal.dot(p - 0.5) < 0.0);
            (Box::new(half), 0.5)
        },
    },
    Plane {
        name: "zone plate",
        instance: |seed| {
            let shift = Random::new(seed, &[]).unit();
            let wave = move |r2: f64| std::f64::consts::TAU * (40.0 * r2 + shift);
            let plate = move |p: DVec2| 1.0 + wave(p.length_squared()).cos();
            // The midpoint rule at a fine step: the fastest wave is 160 periods a unit.
            let side = 2000;
            let mut sum = 0.0;
            for j in 0..side {
                for i in 0..side {
                    sum += plate((DVec2::new(f64::from(i), f64::from(j)) + 0.5) / f64::from(side));
                }
            }
            (Box::new(plate), sum / f64::from(side * side))
        },
    },
];

/// An environment and what it lights.
pub(crate) struct Lighting {
    pub(crate) name: String,
    pub(crate) map: EnvironmentMap,
    surfaces: Vec<Surface>,
}

/// A surface that faces `normal`, from which the cone around `occluder` is dark.
struct Surface {
    normal: DVec3,
    occluder: DVec3,
    open: f64,
    occluded: f64,
}

/// Cosine of half the opening of the occluding cone: 40°.
const OCCLUDER: f64 = 0.766;

impl Lighting {
    pub(crate) fn new(name: String, map: EnvironmentMap) -> Self {
        let mut random = Random::new(12, &[]);
        let mut direction = || {
            let (z, turn) = (2.0 * random.unit() - 1.0, std::f64::consts::TAU * random.unit());
            let sine = (1.0 - z * z).sqrt();
            DVec3::new(sine * turn.cos(), sine * turn.sin(), z)
        };
        let mut surfaces: Vec<Surface> = (0..8)
            .map(|_| {
                let normal = direction();
                let occluder = (normal + 0.8 * direction()).normalize();
                Surface { normal, occluder, open: 0.0, occluded: 0.0 }
            })
            .collect();
        // Every pixel by 4 × 4 points: exact but for the cosine within a sixteenth of a pixel and the
        // pixels on the cone's border.
        let (width, height) = map.size();
        for y in 0..4 * height {
            let share = map.solid_angle(y / 4) / 16.0;
            for x in 0..4 * width {
                let light = map.sample((DVec2::new(x as f64, y as f64) + 0.5) / 4.0);
                let green = f64::from(light.radiance[1]) * share;
                for surface in &mut surfaces {
                    let received = green * light.direction.dot(surface.normal).max(0.0);
                    surface.open += received;
                    surface.occluded += received * surface.visible(light.direction);
                }
            }
        }
        Self { name, map, surfaces }
    }

    /// The mean light of all surfaces: without occluders, and with.
    pub(crate) fn means(&self) -> [f64; 2] {
        let mean = |f: fn(&Surface) -> f64| {
            self.surfaces.iter().map(f).sum::<f64>() / self.surfaces.len() as f64
        };
        [mean(|s| s.open), mean(|s| s.occluded)]
    }

    /// Errors of the estimates of green light on each surface: without its occluder, and with.
    pub(crate) fn errors(&self, set: &[(DVec2, f64)]) -> Vec<[f64; 2]> {
        let (_, height) = self.map.size();
        let mut errors: Vec<[f64; 2]> =
            self.surfaces.iter().map(|surface| [-surface.open, -surface.occluded]).collect();
        for (position, weight) in set {
            let light = self.map.sample(*position);
            let row = (position.y as usize).min(height - 1);
            let green = weight * self.map.solid_angle(row) * f64::from(light.radiance[1]);
            for (surface, [open, occluded]) in self.surfaces.iter().zip(&mut errors) {
                let received = green * light.direction.dot(surface.normal).max(0.0);
                *open += received;
                *occluded += received * surface.visible(light.direction);
            }
        }
        errors
    }
}

impl Surface {
    fn visible(&self, direction: DVec3) -> f64 {
        f64::from(direction.dot(self.occluder) < OCCLUDER)
    }
}

/// Three skies of 512 × 256: smooth, lit by small lamps, lit by a sun of a few pixels.
pub(crate) fn skies() -> Result<Vec<(&'static str, EnvironmentMap)>, EnvironmentError> {
    let (width, height) = (512, 256);
    let make = |light: &dyn Fn(f64, f64) -> f64| {
        let pixels = (0..width * height)
            .map(|i| {
                let (u, v) =
                    ((i % width) as f64 / width as f64, (i / width) as f64 / height as f64);
                let base = 0.25 + 0.6 * (1.0 - v) + 0.2 * (12.0 * u + 3.0 * (9.0 * v).sin()).sin();
                [light(u, v) * base.max(0.02); 3].map(|c| c as f32)
            })
            .collect();
        EnvironmentMap::new(width, height, pixels, InvalidPixels::Reject)
    };
    let near = |u: f64, v: f64, x: f64, y: f64, r: f64| f64::from((2.0 * (u - x)).hypot(v - y) < r);
    Ok(vec![
        ("smooth sky", make(&|_, _| 1.0)?),
        (
            "lamps",
            make(&|u, v| {
                let lamps = [(0.2, 0.3, 0.02), (0.55, 0.45, 0.03), (0.8, 0.2, 0.015)];
                1.0 + lamps.iter().map(|(x, y, r)| 300.0 * near(u, v, *x, *y, *r)).sum::<f64>()
            })?,
        ),
        ("sun", make(&|u, v| 1.0 + 30_000.0 * near(u, v, 0.37, 0.28, 0.006))?),
    ])
}
