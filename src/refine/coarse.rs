//! The low frequencies: what is too much or too little over several spacings flows away at once.

use super::cells::Dot;
use super::conjugate::Flow;
use super::density::Density;
use super::error::{RefineError, filled, reserve};
use super::ink::Ink;
use crate::threads::{PART, for_parts};

/// Side of a cell, in mean spacings. At 1 the grid follows the dots' own noise.
const SIDE: f64 = 1.5;
/// Share of the target that may stay where it is too much, so that no dots are pressed through white. Tone over
/// four spacings is off by .0022 of the mean at .05, .0012 at .02, .0007 at .01; but at .01 dots in small
/// text are pushed onto each other.
const SCREEN: f32 = 0.02;
/// Where a cell has less than this share of the mean, flows are counted as if it had as much: a dot on
/// its way through white has no speed limit otherwise.
const LEAST: f32 = 0.1;

/// A grid over the picture: what it should hold and the flow on it. 52 bytes a cell, about 23 a dot.
#[derive(Debug)]
pub(super) struct Coarse {
    flow: Flow,
    target: alloc::vec::Vec<f32>,
    /// Displacement through the left side of each cell and the right one of the last, and through the
    /// upper sides, in pixels.
    through_x: alloc::vec::Vec<f32>,
    through_y: alloc::vec::Vec<f32>,
    cells_per_pixel: [f32; 2],
    mean: f32,
}

/// The two cells that share a mass at a place, along one axis, and the second one's share. Centers of cells
/// are at halves; beyond the outermost centers all is theirs.
#[inline(always)]
fn halves(place: f32, cells: usize) -> (usize, usize, f32) {
    let from_center = place - 0.5;
    if from_center <= 0.0 {
        return (0, 0, 0.0);
    }
    let first = from_center as usize;
    if first + 1 >= cells {
        return (cells - 1, cells - 1, 0.0);
    }
    (first, first + 1, from_center - first as f32)
}

impl Coarse {
    pub(super) fn new(ink: &Ink<'_>, density: &Density, dots: usize) -> Result<Self, RefineError> {
        let (width, height) = (ink.width, ink.height);
        let side = SIDE * density.mean_spacing;
        let across = ((width as f64 / side).round() as usize).max(2);
        let down = ((height as f64 / side).round() as usize).max(2);
        let per_pixel = [across as f32 / width as f32, down as f32 / height as f32];
        let target = target(ink, [across, down], dots)?;
        let mean = (dots as f64 / (across as f64 * down as f64)) as f32;
        let some = |mass: f32| mass.max(1e-3 * mean);
        let conductance = |a: usize, b: usize| {
            let (a, b) = (some(target[a]), some(target[b]));
            2.0 * a * b / (a + b)
        };
        let screen = |cell: usize| SCREEN * some(target[cell]);
        let flow = Flow::new(across, down, conductance, screen)?;
        Ok(Self {
            through_x: filled((across + 1) * down, 0.0)?,
            through_y: filled(across * (down + 1), 0.0)?,
            flow,
            target,
            cells_per_pixel: per_pixel,
            mean,
        })
    }

    /// Moves every dot with the flow from where there are too many to where there are too few.
    #[inline(always)]
    pub(super) fn drift(&mut self, ink: &Ink<'_>, dots: &mut [Dot]) {
        self.measure(dots);
        self.flow.solve();
        self.displacements();
        let this = &*self;
        for_parts(dots, PART, |_, dots| {
            for dot in dots {
                let (u, v) = (dot.x * this.cells_per_pixel[0], dot.y * this.cells_per_pixel[1]);
                let (across, down) = (this.flow.across, this.flow.down);
                let dx = sample(&this.through_x, across + 1, down, u, v - 0.5);
                let dy = sample(&this.through_y, across, down + 1, u - 0.5, v);
                (dot.x, dot.y) = ink.slide(dot.x, dot.y, dx, dy);
            }
        });
    }

    /// Surplus: dots less target. One thread, in the dots' order: sums must not depend on who adds.
    #[inline(always)]
    pub(super) fn measure(&mut self, dots: &[Dot]) {
        let flow = &mut self.flow;
        let stride = flow.stride;
        let surplus = &mut flow.surplus;
        surplus.fill(0.0);
        for (row, target) in
            surplus[stride..].chunks_mut(stride).zip(self.target.chunks(flow.across))
        {
            for (to, target) in row.iter_mut().zip(target) {
                *to = -target;
            }
        }
        for dot in dots {
            let (i0, i1, fx) = halves(dot.x * self.cells_per_pixel[0], flow.across);
            let (j0, j1, fy) = halves(dot.y * self.cells_per_pixel[1], flow.down);
            let (above, below) = ((j0 + 1) * stride, (j1 + 1) * stride);
            surplus[above + i0] += (1.0 - fx) * (1.0 - fy);
            surplus[above + i1] += fx * (1.0 - fy);
            surplus[below + i0] += (1.0 - fx) * fy;
            surplus[below + i1] += fx * fy;
        }
    }

    /// The sum of all squared surpluses, as measured. Dots of independent random places have about .4 a dot.
    pub(super) fn unevenness(&self) -> f64 {
        self.flow.surplus.iter().map(|surplus| f64::from(*surplus) * f64::from(*surplus)).sum()
    }

    #[inline(always)]
    fn displacements(&mut self) {
        let (flow, mean) = (&self.flow, self.mean);
        let (across, down) = (flow.across, flow.down);
        let [cells_x, cells_y] = self.cells_per_pixel;
        for j in 0..down {
            for i in 1..across {
                let (at, cell) = (flow.at(i - 1, j), j * across + i - 1);
                let most = self.target[cell].max(self.target[cell + 1]).max(LEAST * mean);
                let flux = flow.right[at] * (flow.potential[at] - flow.potential[at + 1]);
                self.through_x[j * (across + 1) + i] = flux / (most * cells_x);
            }
        }
        for j in 1..down {
            for i in 0..across {
                let (at, cell) = (flow.at(i, j - 1), (j - 1) * across + i);
                let most = self.target[cell].max(self.target[cell + across]).max(LEAST * mean);
                let flux = flow.below[at] * (flow.potential[at] - flow.potential[at + flow.stride]);
                self.through_y[j * across + i] = flux / (most * cells_y);
            }
        }
    }
}

/// Bilinear interpolation of values at whole places, held at the borders.
#[inline(always)]
fn sample(values: &[f32], across: usize, down: usize, u: f32, v: f32) -> f32 {
    let (u, v) = (u.clamp(0.0, (across - 1) as f32), v.clamp(0.0, (down - 1) as f32));
    let (i, j) = ((u as usize).min(across - 2), (v as usize).min(down - 2));
    let (fx, fy) = (u - i as f32, v - j as f32);
    let at = j * across + i;
    let (above, below) = (&values[at..at + 2], &values[at + across..at + across + 2]);
    (above[0] * (1.0 - fx) + above[1] * fx) * (1.0 - fy)
        + (below[0] * (1.0 - fx) + below[1] * fx) * fy
}

/// What each cell should hold: every pixel shared out as a dot would be, by samples across it; as
/// many as there are halves of cells in a pixel, and no fewer than two.
fn target(
    ink: &Ink<'_>,
    [across, down]: [usize; 2],
    dots: usize,
) -> Result<alloc::vec::Vec<f32>, RefineError> {
    let samples = |cells: usize, pixels: usize| (2 * cells).div_ceil(pixels).max(2);
    let place = |k: usize, samples: usize, cells: usize, pixels: usize| {
        ((k as f64 + 0.5) / samples as f64 * cells as f64 / pixels as f64) as f32
    };
    let per_pixel = samples(across, ink.width);
    let mut columns = reserve::<(u32, f32)>(ink.width * per_pixel)?;
    for k in 0..ink.width * per_pixel {
        let (first, _, share) = halves(place(k, per_pixel, across, ink.width), across);
        columns.push((first as u32, share / per_pixel as f32));
    }
    let rows_per_pixel = samples(down, ink.height);
    let mut target = filled(across * down, 0.0_f32)?;
    let mut line = filled(across + 1, 0.0_f32)?;
    let scale = dots as f64 / ink.total;
    let whole = 1.0 / per_pixel as f32;
    for (y, row) in ink.pixels.chunks_exact(ink.width).enumerate() {
        line.fill(0.0);
        for (value, columns) in row.iter().zip(columns.chunks_exact(per_pixel)) {
            if *value > 0.0 {
                let mass = (f64::from(*value) * scale) as f32;
                for (first, share) in columns {
                    line[*first as usize] += mass * (whole - share);
                    line[*first as usize + 1] += mass * share;
                }
            }
        }
        for k in y * rows_per_pixel..(y + 1) * rows_per_pixel {
            let (above, below, share) = halves(place(k, rows_per_pixel, down, ink.height), down);
            let part = 1.0 / rows_per_pixel as f32;
            for (i, mass) in line[..across].iter().enumerate() {
                target[above * across + i] += mass * ((1.0 - share) * part);
                target[below * across + i] += mass * (share * part);
            }
        }
    }
    Ok(target)
}
