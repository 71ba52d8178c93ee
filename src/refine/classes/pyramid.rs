//! What draws the dots of a class: its density, in cells of all sizes.

use alloc::vec::Vec;

use super::super::cells::LANES;
use super::super::density::Density;
use super::super::error::{RefineError, filled, reserve};

/// Weight of a dot at a squared distance, in reaches.
#[inline(always)]
pub(super) fn weight(squared: f32) -> f32 {
    let near = 1.0 - squared;
    let near = if near > 0.0 { near } else { 0.0 };
    (near * near) * (near * near)
}

/// Cells that the density is summed over, on each side of a dot: of means of them, where it reaches farther.
const RADIUS: f32 = 5.0;

/// A class's density, and sums of 2 × 2 of its cells, of 4 × 4, … Beyond the picture's borders it is nothing,
/// as there are no dots.
#[derive(Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
    per_pixel: f32,
}

#[derive(Debug)]
struct Level {
    across: usize,
    mass: Vec<f32>,
}

impl Pyramid {
    pub(super) fn new(density: &Density) -> Result<Self, RefineError> {
        let [left, top] = density.margin;
        let (mut across, mut down) = density.inside();
        let mut mass = filled(across * down, 0.0_f32)?;
        let rows = density.mass.chunks_exact(density.stride).skip(top);
        for (to, from) in mass.chunks_exact_mut(across).zip(rows) {
            to.copy_from_slice(&from[left..left + across]);
        }
        let mut levels = reserve(usize::BITS as usize)?;
        levels.push(Level { across, mass });
        while across.max(down) > 1 {
            let (half_across, half_down) = (across.div_ceil(2), down.div_ceil(2));
            let mut mass = filled(half_across * half_down, 0.0_f32)?;
            if let Some(finer) = levels.last() {
                for (j, row) in finer.mass.chunks_exact(across).enumerate() {
                    let to = &mut mass[j / 2 * half_across..][..half_across];
                    for (to, pair) in to.iter_mut().zip(row.chunks(2)) {
                        *to += pair.iter().sum::<f32>();
                    }
                }
            }
            levels.push(Level { across: half_across, mass });
            (across, down) = (half_across, half_down);
        }
        Ok(Self { levels, per_pixel: density.parts_per_pixel })
    }

    /// ∫ density φ about (x, y).
    #[inline(always)]
    pub(super) fn drawn(&self, x: f32, y: f32, reach: f32) -> f32 {
        let mut per_pixel = self.per_pixel;
        let mut level = 0;
        while reach * per_pixel > RADIUS && level + 1 < self.levels.len() {
            per_pixel *= 0.5;
            level += 1;
        }
        let Level { across, mass } = &self.levels[level];
        let (u, v, radius) = (x * per_pixel, y * per_pixel, reach * per_pixel);
        // cells whose centers may be in reach
        let (u0, v0) = ((u - radius - 0.5).max(0.0) as usize, (v - radius - 0.5).max(0.0) as usize);
        let (u1, v1) = ((u + radius + 0.5) as usize, (v + radius + 0.5) as usize);
        let (u0, u1) = (u0.min(*across), u1.min(*across));
        let inverse = 1.0 / (radius * radius);
        let mut sums = [0.0_f32; LANES];
        for (row, masses) in mass.chunks_exact(*across).enumerate().take(v1).skip(v0) {
            let dy = v - row as f32 - 0.5;
            for (block, masses) in masses[u0..u1].chunks(LANES).enumerate() {
                let first = u - (u0 + block * LANES) as f32 - 0.5;
                for (lane, (sum, mass)) in sums.iter_mut().zip(masses).enumerate() {
                    let dx = first - lane as f32;
                    *sum += mass * weight((dx * dx + dy * dy) * inverse);
                }
            }
        }
        sums.iter().sum()
    }
}
