//! The picture as the dots see it: how many dots each pixel should have, and how far apart they are there.

use super::cells::LANES;
use super::error::{RefineError, filled, reserve};
use super::ink::Ink;
use crate::threads::for_parts;

/// Spacings below this many pixels make dots gather on pixel centers, so that pixels are divided until
/// the darkest has this spacing. 250,000 dots on 512² pixels are ruined without.
pub(super) const FINEST: f64 = 2.2;
/// Spacings above this many pixels are drawn as well from means of pixels, and sooner.
const COARSEST: f64 = 4.5;
/// Pixels are divided into no more than this many parts a dot in all; pixels that would have to be
/// smaller still, the hottest of a picture of few hot ones, are divided where they are read.
const PARTS_A_DOT: f64 = 24.0;
/// The widest spacing, in mean spacings: white has no density to tell it.
const WIDEST: f64 = 2.0;
/// Half the side of the box that tells a place's tone, in spacings.
const BOX: f32 = 0.9;

/// Density and spacing. Lengths are in pixels of the picture given unless they say otherwise.
#[derive(Debug)]
pub(super) struct Density {
    /// Dots a part of a pixel, or a group of pixels, with mirrored margins.
    pub(super) mass: alloc::vec::Vec<f32>,
    /// Elements a row of `mass`.
    pub(super) stride: usize,
    /// Columns and rows of margin of `mass`.
    pub(super) margin: [usize; 2],
    /// Parts a pixel, along an axis: above 1 for divided pixels, below for groups.
    pub(super) parts_per_pixel: f32,
    /// Spacing where the picture is darkest, in parts of pixels.
    pub(super) finest: f64,
    /// Spacing in pixels, on whole pixels or groups of them.
    spacing: alloc::vec::Vec<f32>,
    across: usize,
    down: usize,
    groups_per_pixel: f32,
    /// √(area / dots), in pixels.
    pub(super) mean_spacing: f64,
    /// √(mean of squared spacing over the dots), in pixels.
    pub(super) usual_spacing: f64,
}

/// `index` brought into 0..len by mirroring at the borders, or the border if one mirroring is not enough.
fn mirror(index: isize, len: usize) -> usize {
    let len = len as isize;
    let inside = if index < 0 {
        -1 - index
    } else if index >= len {
        2 * len - 1 - index
    } else {
        index
    };
    inside.clamp(0, len - 1) as usize
}

impl Density {
    pub(super) fn new(ink: &Ink<'_>, dots: usize) -> Result<Self, RefineError> {
        let (width, height) = (ink.width, ink.height);
        let area = width as f64 * height as f64;
        let per_value = dots as f64 / ink.total;
        let mean_spacing = (area / dots as f64).sqrt();
        // kernels reach 1.5 spacings: no further than a picture mirrored once
        let widest = (WIDEST * mean_spacing).min(width.min(height) as f64 / 1.5);
        let black = 1.0 / (f64::from(ink.darkest) * per_value).sqrt();
        let group = ((black / COARSEST) as usize).clamp(1, width.min(height));
        let most = (PARTS_A_DOT * dots as f64 / area).sqrt().max(1.0) as usize;
        let parts = ((FINEST / black).ceil() as usize).clamp(1, most);

        // whole pixels, or means of groups of them
        let (across, down) = (width.div_ceil(group), height.div_ceil(group));
        let share = (per_value, 1.0 / (group * group) as f64);
        let mut base = filled(across * down, 0.0_f32)?;
        for_parts(&mut base, across, |start, row| {
            let j = start / across;
            if group == 1 {
                let from = &ink.pixels[j * width..][..width];
                for (to, value) in row.iter_mut().zip(from) {
                    *to = (f64::from(*value) * share.0) as f32;
                }
                return;
            }
            for (i, to) in row.iter_mut().enumerate() {
                let mut sum = 0.0;
                for v in j * group..(j + 1) * group {
                    let row = mirror(v as isize, height) * width;
                    for u in i * group..(i + 1) * group {
                        sum += f64::from(ink.pixels[row + mirror(u as isize, width)]);
                    }
                }
                *to = (sum * share.0 * share.1) as f32;
            }
        });

        let spacing =
            spacing(&base, across, down, group as f32, mean_spacing as f32, widest as f32)?;
        let mut squares = 0.0;
        for (densities, spacings) in base.chunks(across).zip(spacing.chunks(across)) {
            let mut sums = [0.0_f32; LANES];
            for (density, spacing) in densities.chunks(LANES).zip(spacings.chunks(LANES)) {
                for ((sum, density), spacing) in sums.iter_mut().zip(density).zip(spacing) {
                    *sum += density * spacing * spacing;
                }
            }
            squares += f64::from(sums.iter().sum::<f32>());
        }
        let usual = (squares * (group * group) as f64 / dots as f64).sqrt();

        // divided, with margins
        let parts_per_pixel = parts as f64 / group as f64;
        let rim = (widest * parts_per_pixel).ceil() as usize + 2;
        let margin = [rim + LANES, rim];
        let (columns, rows) = (across * parts, down * parts);
        let stride = columns + 2 * margin[0];
        let scale = (group * group) as f32 / (parts * parts) as f32;
        // beyond the border lies the mirrored picture, not the mirrored group that the border cuts
        let limits = [width * parts / group.max(1), height * parts / group.max(1)];
        let mut mass = filled(stride * (rows + 2 * rim), 0.0_f32)?;
        for_parts(&mut mass, stride, |start, row| {
            let j = (start / stride) as isize - rim as isize;
            let from =
                &base[mirror(j, limits[1].max(1)).min(rows - 1) / parts * across..][..across];
            let (left, rest) = row.split_at_mut(margin[0]);
            let (middle, right) = rest.split_at_mut(columns);
            if parts == 1 {
                for (to, density) in middle.iter_mut().zip(from) {
                    *to = density * scale;
                }
            } else {
                for (to, density) in middle.chunks_mut(parts).zip(from) {
                    to.fill(density * scale);
                }
            }
            for (k, to) in left.iter_mut().enumerate() {
                *to = middle[mirror(k as isize - margin[0] as isize, columns)];
            }
            let inside = limits[0].clamp(1, columns);
            for (k, to) in right.iter_mut().enumerate() {
                *to = middle[mirror((columns + k) as isize, inside)];
            }
        });

        Ok(Self {
            mass,
            stride,
            margin,
            parts_per_pixel: parts_per_pixel as f32,
            finest: black * parts_per_pixel,
            spacing,
            across,
            down,
            groups_per_pixel: (1.0 / group as f64) as f32,
            mean_spacing,
            usual_spacing: usual,
        })
    }

    /// Columns and rows of `mass` that lie in the picture.
    pub(super) fn inside(&self) -> (usize, usize) {
        let rows = self.mass.len() / self.stride.max(1);
        (self.stride - 2 * self.margin[0], rows - 2 * self.margin[1])
    }

    /// Spacing at a place inside of the picture.
    #[inline(always)]
    pub(super) fn spacing(&self, x: f32, y: f32) -> f32 {
        let column = ((x * self.groups_per_pixel) as usize).min(self.across - 1);
        let row = ((y * self.groups_per_pixel) as usize).min(self.down - 1);
        self.spacing[row * self.across + column]
    }
}

impl Density {
    pub(super) fn parts_per_pixel(&self) -> f64 {
        f64::from(self.parts_per_pixel)
    }

    /// A place in parts of pixels from the corner of the margin.
    pub(super) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let parts = self.parts_per_pixel();
        [x * parts + self.margin[0] as f64, y * parts + self.margin[1] as f64]
    }

    /// A row of `mass`, if there is one.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> Option<&[f32]> {
        let start = row.checked_mul(self.stride)?;
        self.mass.get(start..start.checked_add(self.stride)?)
    }
}

/// 1/√density, where the density is that of the place, or the mean of a box about it if that is
/// more: never wider than the pixel's own tone allows, so that edges stay sharp. The box has the size that
/// the mean of a first box tells, of the mean spacing.
fn spacing(
    base: &[f32],
    across: usize,
    down: usize,
    pixel: f32,
    mean: f32,
    widest: f32,
) -> Result<alloc::vec::Vec<f32>, RefineError> {
    // sums over everything above and to the left
    let stride = across + 1;
    let mut sums = reserve::<f64>(stride * (down + 1))?;
    sums.resize(stride, 0.0);
    for row in base.chunks_exact(across) {
        let above = sums.len() - stride;
        let mut sum = 0.0;
        sums.push(0.0);
        for (i, density) in row.iter().enumerate() {
            sum += f64::from(*density);
            sums.push(sums[above + i + 1] + sum);
        }
    }
    let least = 1.0 / (widest * widest);
    let of_density = |density: f32| if density > least { 1.0 / density.sqrt() } else { widest };
    let first = (BOX * mean / pixel).round() as usize;
    let mut spacing = filled(base.len(), 0.0_f32)?;
    let half = |spacing: f32| (BOX * spacing / pixel + 0.5) as usize;
    for_parts(&mut spacing, across, |start, row| {
        let j = start / across;
        let mean = |i: usize, half: usize| {
            let (x0, x1) = (i.saturating_sub(half), (i + half + 1).min(across));
            let (y0, y1) = (j.saturating_sub(half) * stride, (j + half + 1).min(down) * stride);
            let sum = (sums[y1 + x1] - sums[y0 + x1]) - (sums[y1 + x0] - sums[y0 + x0]);
            (sum / ((x1 - x0) * ((y1 - y0) / stride)) as f64) as f32
        };
        for (i, to) in row.iter_mut().enumerate() {
            let own = base[start + i];
            let near = mean(i, half(of_density(mean(i, first))));
            *to = of_density(if near > own { near } else { own });
        }
    });
    Ok(spacing)
}
