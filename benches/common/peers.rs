//! Other ways to make points.

use fast_poisson::Poisson2D;
use glam::Vec2;
use rand::distr::Distribution;
use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};
use rand_distr::weighted::WeightedAliasIndex;
use twelvefold::ImageMap;

use super::Contender;
use super::maps::Map;

const TO_UNIT: f32 = 1.0 / 16_777_216.0;

/// The upper 24 bits as a number in [0, 1).
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * TO_UNIT
}

/// Martin Roberts' R2 in fixed point: a sum a coordinate.
#[derive(Clone, Copy)]
struct R2 {
    x: u32,
    y: u32,
}

impl R2 {
    fn new() -> Self {
        Self { x: 1 << 31, y: 1 << 31 }
    }

    fn next(&mut self) -> [f32; 2] {
        self.x = self.x.wrapping_add(3_242_174_889);
        self.y = self.y.wrapping_add(2_447_445_414);
        [unit(self.x), unit(self.y)]
    }
}

/// Radical inverses in bases 2 and 3.
fn halton(i: u32) -> [f32; 2] {
    let (mut rest, mut reversed, mut power) = (i, 0u64, 1u64);
    while rest > 0 {
        reversed = reversed * 3 + u64::from(rest % 3);
        rest /= 3;
        power *= 3;
    }
    [unit(i.reverse_bits()), reversed as f32 / power as f32]
}

/// Owen-scrambled Sobol points: one call makes two of a point's coordinates and two that are unused.
fn sobol(i: u32) -> [f32; 2] {
    let [x, y, ..] = sobol_burley::sample_4d(i, 0, 7);
    [x, y]
}

/// Uniform density over the unit square.
pub(crate) fn uniform<'a>() -> Vec<Contender<'a>> {
    let sequence = |name: &str, point: fn(u32) -> [f32; 2]| {
        Contender::new(name, move |n| {
            move |buffer: &mut [Vec2]| {
                for (i, slot) in buffer[..n].iter_mut().enumerate() {
                    *slot = point(i as u32).into();
                }
                n
            }
        })
    };
    vec![
        Contender::new("R2, fixed point", |n| {
            move |buffer: &mut [Vec2]| {
                // By index rather than by running sum: nothing waits for the point before.
                for (i, slot) in buffer[..n].iter_mut().enumerate() {
                    let i = i as u32;
                    let x = i.wrapping_mul(3_242_174_889).wrapping_add(1 << 31);
                    let y = i.wrapping_mul(2_447_445_414).wrapping_add(1 << 31);
                    *slot = Vec2::new(unit(x), unit(y));
                }
                n
            }
        }),
        sequence("Halton", halton),
        // 2¹⁶ points is all that the crate's Sobol sequence has.
        sequence("Owen Sobol (sobol_burley)", sobol).at_most(1 << 16),
        Contender::new("Bridson (fast_poisson)", |n| {
            // It takes a radius, not a number: a few tries find the one that makes about n points.
            let with_radius =
                |radius: f64| Poisson2D::new().with_dimensions([1.0, 1.0], radius).with_seed(1);
            let mut radius = (0.7 / n as f64).sqrt();
            for _ in 0..5 {
                radius *= (with_radius(radius).iter().count() as f64 / n as f64).sqrt();
            }
            let poisson = with_radius(radius);
            move |buffer: &mut [Vec2]| {
                let mut made = 0;
                for (slot, [x, y]) in buffer.iter_mut().zip(poisson.iter()) {
                    *slot = Vec2::new(x as f32, y as f32);
                    made += 1;
                }
                made
            }
        })
        .at_most(1 << 14),
    ]
}

/// Importance from a map.
pub(crate) fn image<'a>(map: &'a Map) -> Vec<Contender<'a>> {
    let map = &map.importance;
    let width = map.size().0;
    // Shared by the contenders; built once, not timed.
    let alias = WeightedAliasIndex::new(map.pixels().to_vec()).expect("weights");
    let inverse = InverseCdf::new(map);
    let inverse_too = inverse.clone();
    vec![
        Contender::new("alias table (rand_distr) + jitter", move |n| {
            let mut random = SmallRng::seed_from_u64(1);
            let alias = alias.clone();
            move |buffer: &mut [Vec2]| {
                for slot in &mut buffer[..n] {
                    let texel = alias.sample(&mut random);
                    let jitter: u64 = random.random();
                    *slot = Vec2::new(
                        (texel % width) as f32 + unit(jitter as u32),
                        (texel / width) as f32 + unit((jitter >> 32) as u32),
                    );
                }
                n
            }
        }),
        Contender::new("inverse CDF + Owen Sobol", move |n| {
            let inverse = inverse.clone();
            move |buffer: &mut [Vec2]| {
                for (i, slot) in buffer[..n].iter_mut().enumerate() {
                    // Past 2¹⁶ the sequence is taken again under another scrambling.
                    let [u, v, ..] = sobol_burley::sample_4d(i as u32 & 0xffff, 0, i as u32 >> 16);
                    *slot = inverse.point(u, v);
                }
                n
            }
        }),
        Contender::new("inverse CDF + R2", move |n| {
            let inverse = inverse_too.clone();
            move |buffer: &mut [Vec2]| {
                let mut r2 = R2::new();
                for slot in &mut buffer[..n] {
                    let [u, v] = r2.next();
                    *slot = inverse.point(u, v);
                }
                n
            }
        }),
        Contender::new("rejection", move |n| {
            let mut random = SmallRng::seed_from_u64(2);
            let largest = map.pixels().iter().copied().fold(0.0, f32::max);
            move |buffer: &mut [Vec2]| {
                for slot in &mut buffer[..n] {
                    loop {
                        let place: u64 = random.random();
                        let x = unit(place as u32) * width as f32;
                        let y = unit((place >> 32) as u32) * map.size().1 as f32;
                        let pixel = map.pixels()[y as usize * width + x as usize];
                        if random.random::<f32>() * largest < pixel {
                            *slot = Vec2::new(x, y);
                            break;
                        }
                    }
                }
                n
            }
        })
        .at_most(1 << 14),
    ]
}

/// A piecewise-constant distribution inverted as in pbrt: a row by the marginal distribution, a column
/// by the row's own, each by binary search over single-precision sums.
#[derive(Clone)]
struct InverseCdf {
    width: usize,
    marginal: Vec<f32>,
    /// width + 1 numbers a row.
    conditional: Vec<f32>,
}

impl InverseCdf {
    fn new(map: &ImageMap) -> Self {
        let (width, height) = map.size();
        let cdf = |weights: &mut dyn Iterator<Item = f64>| -> (Vec<f32>, f64) {
            let mut sums = vec![0.0];
            let mut total = 0.0;
            for weight in weights {
                total += weight;
                sums.push(total);
            }
            (sums.iter().map(|sum| (sum / total) as f32).collect(), total)
        };
        let mut conditional = Vec::with_capacity((width + 1) * height);
        let mut rows = Vec::with_capacity(height);
        for row in map.pixels().chunks(width) {
            let (sums, total) = cdf(&mut row.iter().map(|v| f64::from(*v)));
            conditional.extend(sums);
            rows.push(total);
        }
        let (marginal, _) = cdf(&mut rows.into_iter());
        Self { width, marginal, conditional }
    }

    fn point(&self, u: f32, v: f32) -> Vec2 {
        let invert = |cdf: &[f32], u: f32| {
            let i = cdf.partition_point(|sum| *sum <= u).clamp(1, cdf.len() - 1) - 1;
            let step = cdf[i + 1] - cdf[i];
            (i, if step > 0.0 { ((u - cdf[i]) / step).min(1.0) } else { 0.0 })
        };
        let (row, dy) = invert(&self.marginal, v);
        let columns = &self.conditional[row * (self.width + 1)..][..self.width + 1];
        let (column, dx) = invert(columns, u);
        Vec2::new(column as f32 + dx, row as f32 + dy)
    }
}
