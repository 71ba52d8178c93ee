//! Four maps of 1024 × 1024 pixels, from arithmetic: smooth, noise, hard edges, high dynamic range.

use twelvefold::{ImageMap, InvalidPixels};

/// Pixels a side.
pub const SIDE: usize = 1024;

/// A map and what it is called.
pub struct Map {
    /// As the table shows it.
    pub name: &'static str,
    /// Ready to sample.
    pub importance: ImageMap,
}

impl Map {
    fn new(name: &'static str, pixel: impl Fn(f32, f32, usize) -> f32) -> Self {
        let coordinate = |i: usize| i as f32 / SIDE as f32;
        let pixels = (0..SIDE * SIDE)
            .map(|i| pixel(coordinate(i % SIDE), coordinate(i / SIDE), i))
            .collect();
        let importance = ImageMap::new(SIDE, SIDE, pixels, InvalidPixels::Reject);
        Self { name, importance: importance.expect("finite pixels, not negative") }
    }

    /// The largest pixel over the mean.
    pub fn contrast(&self) -> f64 {
        let largest = self.importance.pixels().iter().copied().fold(0.0, f32::max);
        f64::from(largest) / self.importance.mean()
    }
}

/// White noise in [0, 1) from an index.
fn noise(i: usize) -> f32 {
    let n = (i as u64 ^ 0x9e37_79b9).wrapping_mul(0xd129_42f0_5ea9_2b2d);
    (((n ^ (n >> 31)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 40) & 0xffff) as f32 / 65536.0
}

/// All maps. The sun of the last is 3,000 times the mean, ten texels wide.
pub fn all() -> [Map; 4] {
    [
        Map::new("smooth", |x, y, _| 0.2 + (x * (1.0 - x) * 3.0) * (0.3 + y * y)),
        Map::new("textured", |x, y, i| (0.1 + x) * noise(i) * (1.2 - y)),
        Map::new("hard-edged", |x, y, _| {
            let (a, b) = (x - 0.5, y - 0.45);
            let stripe = ((x * 7.3 + y * 2.1) as u32).is_multiple_of(3);
            if a * a + b * b < 0.1 || stripe { 1.0 } else { 0.02 }
        }),
        Map::new("high dynamic range", |x, y, _| {
            let (a, b) = ((x - 0.613) * SIDE as f32, (y - 0.377) * SIDE as f32);
            let squared = a * a + b * b;
            let sun = if squared < 25.0 { 2300.0 } else { 0.0 };
            0.3 + x * y + 20.0 / (1.0 + squared) + sun
        }),
    ]
}
