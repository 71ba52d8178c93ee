//! The maps that relaxed points read, made from an image: each side of an edge by itself.
//!
//! Importance that varies from pixel to pixel thins the points irregularly if each is accepted by the
//! value under it, and averages that cross an edge give one side what is the other's. So each pixel gets
//! a *tone* first: with the local spacing s as the unit of length,
//!
//! 1. s₁ = spacing(mean over half-side s₀), s₀ the spacing of the image's mean importance; s = spacing(mean
//!    over half-side s₁). Neither exceeds 1.5·s₀;
//! 2. away from edges, the tone is the mean over a box around the pixel, of half-side 0.8·s;
//! 3. where the box of half-side s varies much more than the quietest of its quadrants, there is an edge,
//!    and the tone is that quadrant's mean (Kuwahara's filter): the pixel's own side;
//! 4. where even that quadrant is uneven, the picture is finer than the spacing: its pixel's own value,
//!    and nothing where the pixel is 0.
//!
//! The *phase* is that with the mean over s₁ in step 2, the *detail* the deviation over the mean, of the
//! box or of the quadrant. *Acceptance* is the tone, and what the tone lacks or exceeds at each pixel is
//! spread over that pixel's own box, in proportion to the tones there: so the sum is the image's, and
//! nothing comes where the image is 0.

use alloc::vec::Vec;
use core::ops::Range;

use super::pixels::{MapError, filled, with_room};

/// The relative deviations between which the share of the layer for detail grows from 0 to 1.
const DETAIL_RANGE: [f64; 2] = [0.03, 0.15];

/// By how much, of the mean, the box's deviation exceeds twice the quietest quadrant's where an edge
/// begins and where there surely is one. A slope's is twice its quadrants', texture's about theirs.
const EDGE_RANGE: [f64; 2] = [0.03, 0.10];

/// The relative deviations of a quadrant between which its mean gives way to the pixel itself.
const FINE_RANGE: [f64; 2] = [0.35, 0.6];

/// The relative deviations of the box between which texture without an edge counts as finer than the
/// spacing.
const TEXTURE_RANGE: [f64; 2] = [0.6, 0.9];

/// The part of the way from `low` to `high`, 0 … 1.
fn share([low, high]: [f64; 2], at: f64) -> f64 {
    ((at - low) / (high - low)).clamp(0.0, 1.0)
}

/// Lengths in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    pub(super) spacing_of_one: f64,
    pub(super) mean_spacing: f64,
    pub(super) largest: f64,
    /// In local spacings.
    pub(super) acceptance: f64,
}

impl Scales {
    /// The spacing of points where the importance is `importance`, in pixels, capped.
    pub(super) fn spacing(&self, importance: f64) -> f64 {
        if importance > 0.0 {
            (self.spacing_of_one / libm::sqrt(importance)).min(self.largest)
        } else {
            self.largest
        }
    }
}

/// The maps that points read, row by row.
pub(super) struct Planes {
    pub(super) acceptance: Vec<f32>,
    pub(super) phase: Vec<f32>,
    /// 0 … 255.
    pub(super) detail: Vec<u8>,
}

/// What is known of a pixel's surroundings.
struct Surroundings {
    tone: f64,
    phase: f64,
    detail: u8,
    /// Half-side of the pixel's box.
    half: f64,
}

impl Planes {
    pub(super) fn new(image: &[f32], width: usize, scales: &Scales) -> Result<Self, MapError> {
        let height = image.len().checked_div(width).unwrap_or(0);
        let plane = || with_room(image.len());
        let (mut tones, mut phase, mut halves) = (plane()?, plane()?, plane()?);
        let mut detail = with_room(image.len())?;
        in_bands(image, width, height, scales.largest, |sums, x, y| {
            let value = image[y * width + x];
            let around = surroundings(sums, [x, y], value.into(), scales);
            // A tone of 0 is a pixel of 0, and the other way round.
            tones.push(if value > 0.0 { (around.tone as f32).max(f32::MIN_POSITIVE) } else { 0.0 });
            phase.push(around.phase as f32);
            detail.push(around.detail);
            halves.push(around.half as f32);
        })?;
        let mut spread = Spread::new(width, height)?;
        in_bands(&tones, width, height, scales.largest, |sums, x, y| {
            let i = y * width + x;
            let rest = f64::from(image[i]) - f64::from(tones[i]);
            if rest != 0.0 {
                let cut = sums.cut([x, y], halves[i].into());
                let [sum, _] = sums.over(&cut);
                if sum > 0.0 {
                    spread.add(&cut, rest / sum);
                }
            }
        })?;
        spread.finish(&mut tones);
        Ok(Self { acceptance: tones, phase, detail })
    }
}

fn surroundings(sums: &Sums, at: [usize; 2], value: f64, scales: &Scales) -> Surroundings {
    let means = |half: f64| sums.means(&sums.cut(at, half));
    let [around, _] = means(scales.mean_spacing);
    let [by_box, square_by_box] = means(scales.spacing(around));
    let spacing = scales.spacing(by_box);
    let half = scales.acceptance * spacing;
    let [mut tone, _] = means(half);
    let [local, square] = means(spacing);
    let mut phase = by_box;
    let deviation = |[mean, square]: [f64; 2]| libm::sqrt((square - mean * mean).max(0.0));
    let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    let all = deviation([local, square]);
    let mut unevenness = ratio(all, local);
    if unevenness > EDGE_RANGE[0] {
        let quadrants = sums.quadrants(at, spacing).map(|means| (means[0], deviation(means)));
        let (mean, least) =
            quadrants.into_iter().reduce(|a, b| if b.1 < a.1 { b } else { a }).unwrap_or_default();
        let edge = share(EDGE_RANGE, ratio(all - 2.0 * least, local));
        let fine = share(FINE_RANGE, ratio(least, mean));
        let side = mean + fine * (value - mean);
        // Where there is texture but no edge, its pixels of 0 matter alone.
        let edge = edge.max(share(TEXTURE_RANGE, unevenness));
        tone += edge * (side - tone);
        // The importance at the points of the box, rather than at its pixels.
        let of_points = ratio(square_by_box, by_box);
        phase += edge * (of_points - phase);
        let across = ratio(libm::fabs(of_points - side), side) + ratio(least, mean);
        unevenness += edge * (across - unevenness);
    }
    let detail = (share(DETAIL_RANGE, unevenness) * 255.0 + 0.5) as u8;
    Surroundings { tone, phase, detail, half }
}

/// Calls `pixel` for each, row by row, with sums that hold all boxes about it of half-sides up to
/// `largest`: bands of rows share one table.
fn in_bands(
    image: &[f32],
    width: usize,
    height: usize,
    largest: f64,
    mut pixel: impl FnMut(&Sums, usize, usize),
) -> Result<(), MapError> {
    let reach = (libm::ceil(largest).min(height as f64) as usize) + 1;
    let band = reach.max(32);
    for first in (0..height).step_by(band) {
        let rows = first..(first + band).min(height);
        let from = rows.start.saturating_sub(reach);
        let until = (rows.end + reach).min(height);
        let sums = Sums::new(image, width, from..until)?;
        for y in rows {
            for x in 0..width {
                pixel(&sums, x, y);
            }
        }
    }
    Ok(())
}

/// A box in pixels.
struct Cut {
    low: [f64; 2],
    high: [f64; 2],
}

/// Integrals of some rows of the image, and of its square, from their corner.
struct Sums {
    sums: Vec<[f64; 2]>,
    width: usize,
    /// The rows' range.
    from: usize,
    until: usize,
}

impl Sums {
    fn new(pixels: &[f32], width: usize, rows: Range<usize>) -> Result<Self, MapError> {
        let stride = width + 1;
        let mut sums = with_room(stride * (rows.len() + 1))?;
        sums.resize(stride, [0.0; 2]);
        for (y, row) in pixels.chunks_exact(width).skip(rows.start).take(rows.len()).enumerate() {
            let mut sum = [0.0; 2];
            sums.push(sum);
            for (x, pixel) in row.iter().enumerate() {
                let value = f64::from(*pixel);
                sum = [sum[0] + value, sum[1] + value * value];
                let above = sums[y * stride + x + 1];
                sums.push([above[0] + sum[0], above[1] + sum[1]]);
            }
        }
        Ok(Self { sums, width, from: rows.start, until: rows.end })
    }

    /// The integrals over [0, x) and the rows up to y, a place inside them.
    #[inline]
    fn corner(&self, x: f64, y: f64) -> [f64; 2] {
        let y = y - self.from as f64;
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let (next_i, next_j) = ((i + 1).min(self.width), (j + 1).min(self.until - self.from));
        let at = |i: usize, j: usize| self.sums[j * (self.width + 1) + i];
        let (a, b, c, d) = (at(i, j), at(next_i, j), at(i, next_j), at(next_i, next_j));
        core::array::from_fn(|k| {
            (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy
        })
    }

    /// A box about a pixel's center, clipped to the rows, which hold it but for the image's border.
    #[inline]
    fn cut(&self, [x, y]: [usize; 2], half: f64) -> Cut {
        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
        Cut {
            low: [(x - half).max(0.0), (y - half).max(self.from as f64)],
            high: [(x + half).min(self.width as f64), (y + half).min(self.until as f64)],
        }
    }

    /// The integrals over a box.
    #[inline]
    fn over(&self, Cut { low, high }: &Cut) -> [f64; 2] {
        let (a, b) = (self.corner(high[0], high[1]), self.corner(low[0], high[1]));
        let (c, d) = (self.corner(high[0], low[1]), self.corner(low[0], low[1]));
        core::array::from_fn(|k| (a[k] - b[k] - c[k] + d[k]).max(0.0))
    }

    /// The means of the value and of its square over a box.
    #[inline]
    fn means(&self, cut: &Cut) -> [f64; 2] {
        let area = (cut.high[0] - cut.low[0]) * (cut.high[1] - cut.low[1]);
        self.over(cut).map(|sum| sum / area)
    }

    /// The means over the four boxes of which a pixel is the corner, and which reach `half` from its
    /// center.
    fn quadrants(&self, at: [usize; 2], half: f64) -> [[f64; 2]; 4] {
        let (pixel, all) = (self.cut(at, 0.5), self.cut(at, half.max(0.5)));
        core::array::from_fn(|k| {
            let pick = |axis: usize| match k >> axis & 1 {
                0 => (all.low[axis], pixel.high[axis]),
                _ => (pixel.low[axis], all.high[axis]),
            };
            let ((left, right), (top, bottom)) = (pick(0), pick(1));
            self.means(&Cut { low: [left, top], high: [right, bottom] })
        })
    }
}

/// Sums of boxes of constant height, as the differences of their integral between corners.
struct Spread {
    differences: Vec<f64>,
    width: usize,
}

impl Spread {
    fn new(width: usize, height: usize) -> Result<Self, MapError> {
        Ok(Self { differences: filled(0.0, (width + 2) * (height + 2))?, width })
    }

    /// Adds `height` over a box: the adjoint of [`Sums::over`], pixel by pixel what each has in the box.
    #[inline]
    fn add(&mut self, Cut { low, high }: &Cut, height: f64) {
        self.corner(low[0], low[1], height);
        self.corner(high[0], low[1], -height);
        self.corner(low[0], high[1], -height);
        self.corner(high[0], high[1], height);
    }

    /// Adds `height` over all that is right of x and below y.
    #[inline]
    fn corner(&mut self, x: f64, y: f64, height: f64) {
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let stride = self.width + 2;
        let (above, below) = (height * (1.0 - fy), height * fy);
        let at = j * stride + i;
        self.differences[at] += above * (1.0 - fx);
        self.differences[at + 1] += above * fx;
        self.differences[at + stride] += below * (1.0 - fx);
        self.differences[at + stride + 1] += below * fx;
    }

    /// Multiplies the tones by 1 and what is spread there.
    fn finish(self, tones: &mut [f32]) {
        let Self { differences, width } = self;
        let mut sums = alloc::vec![0.0; width + 2];
        for (row, tones) in differences.chunks_exact(width + 2).zip(tones.chunks_exact_mut(width)) {
            let mut sum = 0.0;
            for ((difference, above), tone) in row.iter().zip(&mut sums).zip(tones) {
                sum += *difference;
                *above += sum;
                *tone = (f64::from(*tone) * (1.0 + *above)).max(0.0) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use proptest::prelude::*;

    fn planes(image: &[f32], width: usize, count: f64) -> Planes {
        let mean = sum(image) / image.len() as f64;
        let mean_spacing = libm::sqrt(image.len() as f64 / count);
        let spacing_of_one = mean_spacing * libm::sqrt(mean);
        let largest = 1.5 * mean_spacing;
        Planes::new(
            image,
            width,
            &Scales { spacing_of_one, mean_spacing, largest, acceptance: 0.8 },
        )
        .unwrap()
    }

    fn sum(pixels: &[f32]) -> f64 {
        pixels.iter().map(|v| f64::from(*v)).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn acceptance_keeps_the_sum_and_every_pixel_of_0(
            seed: u64,
            (width, height) in (1usize..40, 1usize..40),
            white in prop_oneof![Just(0.0), Just(0.5), Just(0.97)],
            count in 1.0..2000.0f64,
        ) {
            let mut random = SplitMix64::new(seed);
            let image: Vec<f32> = (0..width * height)
                .map(|_| if random.unit() < white { 0.0 } else { random.unit() as f32 })
                .collect();
            prop_assume!(sum(&image) > 0.0);
            let acceptance = planes(&image, width, count).acceptance;
            let (wanted, given) = (sum(&image), sum(&acceptance));
            prop_assert!((given / wanted - 1.0).abs() < 1e-6, "{given} {wanted}");
            for (pixel, accepted) in image.iter().zip(&acceptance) {
                prop_assert!(*accepted >= 0.0 && (*pixel > 0.0 || *accepted == 0.0));
            }
        }
    }

    /// A dark disc in a gray square on white: what each is given.
    #[test]
    fn parts_keep_what_they_ask_for() {
        let side = 160;
        let tone = |i: usize| {
            let (x, y) = ((i % side) as f64 - 79.5, (i / side) as f64 - 79.5);
            match (x * x + y * y < 1225.0, x.abs().max(y.abs()) < 60.0) {
                (true, _) => 0.92f32,
                (false, true) => 0.37,
                _ => 0.0,
            }
        };
        let image: Vec<f32> = (0..side * side).map(tone).collect();
        for count in [300.0, 1000.0, 4000.0] {
            let acceptance = planes(&image, side, count).acceptance;
            for part in [0.92, 0.37] {
                let of = |pixels: &[f32]| -> f64 {
                    let pixels = pixels.iter().zip(&image).filter(|(_, tone)| **tone == part);
                    pixels.map(|(v, _)| f64::from(*v)).sum()
                };
                let bias = of(&acceptance) / of(&image) - 1.0;
                assert!(bias.abs() < 0.003, "{count} {part}: {bias}");
            }
        }
    }
}
