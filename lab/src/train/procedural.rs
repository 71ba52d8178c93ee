//! Procedural images to train on: what photographs are made of, from a seed.

use crate::random::Random;

/// Side of the images in pixels.
pub const SIDE: usize = 512;

/// A random image: smooth shading, then random shapes with hard edges, each filled with its own tone,
/// gradient, stripes, checks or grain. Values in [0.02, 1].
#[must_use]
pub fn image(random: &mut Random) -> Vec<f32> {
    let mut values = vec![0.0f32; SIDE * SIDE];
    let mut fill = Fill::random(random);
    paint(&mut values, random, &fill, |_, _| true);
    for _ in 0..30 {
        fill = Fill::random(random);
        let center = [random.unit(), random.unit()].map(|u| (u * SIDE as f64) as f32);
        let radius = 16.0 + 90.0 * random.unit() as f32;
        let (s, c) = libm::sincosf(core::f32::consts::TAU * random.unit() as f32);
        let stretch = 0.3 + 1.2 * random.unit() as f32;
        let is_disc = random.unit() < 0.5;
        paint(&mut values, random, &fill, |x, y| {
            let (dx, dy) = (x - center[0], y - center[1]);
            let (u, v) = ((c * dx + s * dy) / radius, (c * dy - s * dx) / (radius * stretch));
            if is_disc { u * u + v * v < 1.0 } else { u.abs().max(v.abs()) < 0.8 }
        });
    }
    values
}

/// A tone with variation.
struct Fill {
    tone: f32,
    /// Gradient of ln tone a pixel.
    gradient: [f32; 2],
    /// Stripes or checks: amplitude in ln tone, wave vector in radians a pixel, whether crossed.
    wave: (f32, [f32; 2], bool, bool),
    /// Grain: amplitude in ln tone, and its smoothing.
    grain: f32,
}

impl Fill {
    fn random(random: &mut Random) -> Self {
        let signed = |random: &mut Random| 2.0 * random.unit() as f32 - 1.0;
        let tone = libm::expf(-2.6 * random.unit() as f32);
        let gradient = [0.006 * signed(random), 0.006 * signed(random)];
        let is_waved = random.unit() < 0.35;
        // From waves of 3 pixels to waves of 40.
        let pixels = 3.0 * libm::expf(2.6 * random.unit() as f32);
        let (s, c) = libm::sincosf(core::f32::consts::TAU * random.unit() as f32);
        let k = core::f32::consts::TAU / pixels;
        let amplitude = if is_waved { 0.8 * random.unit() as f32 } else { 0.0 };
        let (is_crossed, is_square) = (random.unit() < 0.5, random.unit() < 0.5);
        let has_grain = random.unit() < 0.35;
        let grain = if has_grain { 0.7 * random.unit() as f32 } else { 0.0 };
        Self { tone, gradient, wave: (amplitude, [k * c, k * s], is_crossed, is_square), grain }
    }

    fn at(&self, x: f32, y: f32, noise: f32) -> f32 {
        let (amplitude, k, is_crossed, is_square) = self.wave;
        let mut wave = libm::sinf(k[0] * x + k[1] * y);
        if is_crossed {
            wave *= libm::sinf(k[0] * y - k[1] * x);
        }
        if is_square {
            wave = wave.signum();
        }
        let middle = 0.5 * SIDE as f32;
        let ln = self.gradient[0] * (x - middle)
            + self.gradient[1] * (y - middle)
            + amplitude * wave
            + self.grain * noise;
        (self.tone * libm::expf(ln)).clamp(0.02, 1.0)
    }
}

fn paint(values: &mut [f32], random: &mut Random, fill: &Fill, inside: impl Fn(f32, f32) -> bool) {
    for (i, value) in values.iter_mut().enumerate() {
        let (x, y) = ((i % SIDE) as f32, (i / SIDE) as f32);
        if inside(x, y) {
            let noise = 2.0 * random.unit() as f32 - 1.0;
            *value = fill.at(x, y, noise);
        }
    }
}
