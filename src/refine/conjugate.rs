//! The flow that evens out a surplus on a grid: conjugate gradients.

use super::cells::LANES;
use super::error::{RefineError, filled};

/// The equation −∇·k∇φ + s φ = surplus on a grid, with no flow through the border: a flow k∇φ from where
/// there is too much to where there is too little; `s` lets some surplus stay, so that none is
/// pressed through necks where nothing should be.
///
/// Rows lie one after the other with a column of nothing between and a row of nothing before the first and
/// after the last, so that no border is a special case.
#[derive(Debug)]
pub(super) struct Flow {
    pub(super) across: usize,
    pub(super) down: usize,
    /// `across` + 1.
    pub(super) stride: usize,
    /// Conductance from a cell to the one on its right, and to the one below.
    pub(super) right: alloc::vec::Vec<f32>,
    pub(super) below: alloc::vec::Vec<f32>,
    diagonal: alloc::vec::Vec<f32>,
    /// One over the diagonal.
    inverse: alloc::vec::Vec<f32>,
    /// Surplus on entry of [`Flow::solve`], what is left of it after.
    pub(super) surplus: alloc::vec::Vec<f32>,
    pub(super) potential: alloc::vec::Vec<f32>,
    direction: alloc::vec::Vec<f32>,
    image: alloc::vec::Vec<f32>,
}

/// The squared residual, in the norm of the diagonal, that ends the rounds, as a share of the first. A
/// hundred times less changes no figure of a picture's.
const ENOUGH: f64 = 1e-3;
/// The most rounds; pictures need about thirty.
const ROUNDS: usize = 150;
/// Elements a partial sum.
const BLOCK: usize = 512;

impl Flow {
    pub(super) fn new(
        across: usize,
        down: usize,
        conductance: impl Fn(usize, usize) -> f32,
        screen: impl Fn(usize) -> f32,
    ) -> Result<Self, RefineError> {
        let stride = across + 1;
        let len = stride * (down + 2);
        let mut flow = Self {
            across,
            down,
            stride,
            right: filled(len, 0.0)?,
            below: filled(len, 0.0)?,
            diagonal: filled(len, 1.0)?,
            inverse: filled(len, 1.0)?,
            surplus: filled(len, 0.0)?,
            potential: filled(len, 0.0)?,
            direction: filled(len, 0.0)?,
            image: filled(len, 0.0)?,
        };
        for j in 0..down {
            for i in 0..across {
                let (at, from) = (flow.at(i, j), j * across + i);
                if i + 1 < across {
                    flow.right[at] = conductance(from, from + 1);
                }
                if j + 1 < down {
                    flow.below[at] = conductance(from, from + across);
                }
            }
        }
        for j in 0..down {
            for i in 0..across {
                let at = flow.at(i, j);
                let ways = (flow.right[at] + flow.right[at - 1])
                    + (flow.below[at] + flow.below[at - stride]);
                flow.diagonal[at] = ways + screen(j * across + i);
                flow.inverse[at] = 1.0 / flow.diagonal[at];
            }
        }
        Ok(flow)
    }

    /// Where a cell lies in the lists.
    #[inline(always)]
    pub(super) fn at(&self, i: usize, j: usize) -> usize {
        (j + 1) * self.stride + i
    }

    /// Solves for the potential; returns the number of rounds.
    #[inline(always)]
    pub(super) fn solve(&mut self) -> usize {
        self.potential.fill(0.0);
        for ((to, surplus), inverse) in
            self.direction.iter_mut().zip(&self.surplus).zip(&self.inverse)
        {
            *to = surplus * inverse;
        }
        let mut left = dot(&self.direction, &self.surplus);
        let enough = ENOUGH * left;
        let mut rounds = 0;
        while rounds < ROUNDS && left > enough && left > 0.0 {
            let along = self.apply();
            // Nothing more to gain.
            if along <= 0.0 || along.is_nan() {
                break;
            }
            let step = (left / along) as f32;
            let now = self.advance(step);
            let keep = (now / left) as f32;
            left = now;
            rounds += 1;
            for ((to, surplus), inverse) in
                self.direction.iter_mut().zip(&self.surplus).zip(&self.inverse)
            {
                *to = surplus * inverse + keep * *to;
            }
        }
        rounds
    }

    /// image = matrix · direction; returns direction · image.
    #[inline(always)]
    fn apply(&mut self) -> f64 {
        let (first, last) = (self.stride, self.stride * (self.down + 1));
        let mut total = 0.0;
        let mut start = first;
        while start < last {
            let len = BLOCK.min(last - start);
            let own = &self.direction[start..start + len];
            let east = &self.direction[start + 1..start + 1 + len];
            let west = &self.direction[start - 1..start - 1 + len];
            let south = &self.direction[start + self.stride..start + self.stride + len];
            let north = &self.direction[start - self.stride..start - self.stride + len];
            let to_east = &self.right[start..start + len];
            let to_west = &self.right[start - 1..start - 1 + len];
            let to_south = &self.below[start..start + len];
            let to_north = &self.below[start - self.stride..start - self.stride + len];
            let diagonal = &self.diagonal[start..start + len];
            let image = &mut self.image[start..start + len];
            for k in 0..len {
                image[k] = (diagonal[k] * own[k] - to_east[k] * east[k] - to_west[k] * west[k])
                    - (to_south[k] * south[k] + to_north[k] * north[k]);
            }
            total += f64::from(lanes(own, image));
            start += len;
        }
        total
    }

    /// One step along the direction; returns the new squared residual.
    #[inline(always)]
    fn advance(&mut self, step: f32) -> f64 {
        let mut total = 0.0;
        let blocks = self.potential.chunks_mut(BLOCK).zip(self.surplus.chunks_mut(BLOCK)).zip(
            self.direction
                .chunks(BLOCK)
                .zip(self.image.chunks(BLOCK))
                .zip(self.inverse.chunks(BLOCK)),
        );
        for ((potential, surplus), ((direction, image), inverse)) in blocks {
            let mut sums = [0.0_f32; LANES];
            let len = potential.len();
            let (surplus, direction) = (&mut surplus[..len], &direction[..len]);
            let (image, inverse) = (&image[..len], &inverse[..len]);
            for k in 0..len {
                potential[k] += step * direction[k];
                surplus[k] -= step * image[k];
            }
            let (surpluses, surplus_rest) = surplus.as_chunks::<LANES>();
            let (inverses, inverse_rest) = inverse.as_chunks::<LANES>();
            for (surplus, inverse) in surpluses.iter().zip(inverses) {
                for lane in 0..LANES {
                    sums[lane] += surplus[lane] * surplus[lane] * inverse[lane];
                }
            }
            for (lane, (surplus, inverse)) in surplus_rest.iter().zip(inverse_rest).enumerate() {
                sums[lane] += surplus * surplus * inverse;
            }
            total += f64::from(sums.iter().sum::<f32>());
        }
        total
    }
}

/// Σ a·b, by blocks.
#[inline(always)]
fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.chunks(BLOCK).zip(b.chunks(BLOCK)).map(|(a, b)| f64::from(lanes(a, b))).sum()
}

/// Σ a·b of one block, lane by lane.
#[inline(always)]
fn lanes(a: &[f32], b: &[f32]) -> f32 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0_f32; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    for (lane, (a, b)) in a_rest.iter().zip(b_rest).enumerate() {
        sums[lane] += a * b;
    }
    sums.iter().sum()
}
