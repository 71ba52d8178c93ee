//! Other ways to make points.

use glam::Vec2;
use rand::distr::Distribution;
use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};
use rand_distr::weighted::WeightedAliasIndex;

use super::Contender;
use crate::maps::Map;
use crate::rivals::{InverseCdf, halton, poisson_disk, r2_single, sobol};

const TO_UNIT: f32 = 1.0 / 16_777_216.0;

/// The upper 24 bits as a number in [0, 1).
fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * TO_UNIT
}

/// Uniform density over the unit square.
pub(crate) fn uniform<'a>() -> Vec<Contender<'a>> {
    let sequence = |name: &str, point: fn(u32) -> Vec2| {
        Contender::new(name, move |n| {
            move |buffer: &mut [Vec2]| {
                for (i, slot) in buffer[..n].iter_mut().enumerate() {
                    *slot = point(i as u32);
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
                    *slot = r2_single(i as u32);
                }
                n
            }
        }),
        sequence("Halton", |i| halton(i).as_vec2()),
        // 2¹⁶ points is all that the crate's Sobol sequence has.
        sequence("Owen Sobol (sobol_burley)", |i| sobol(i, 7)).at_most(1 << 16),
        Contender::new("Bridson (fast_poisson)", |n| {
            let poisson = poisson_disk(n, 1);
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
    let inverse = InverseCdf::<f32>::new(map);
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
                    *slot = inverse.position(sobol(i as u32, 0).to_array()).into();
                }
                n
            }
        }),
        Contender::new("inverse CDF + R2", move |n| {
            let inverse = inverse_too.clone();
            move |buffer: &mut [Vec2]| {
                for (i, slot) in buffer[..n].iter_mut().enumerate() {
                    *slot = inverse.position(r2_single(i as u32).to_array()).into();
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
