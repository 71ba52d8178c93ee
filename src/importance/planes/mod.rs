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
//! box or of the quadrant, and half of the most or more beside an edge. *Acceptance* is the tone, and what the
//! tone lacks or exceeds at each pixel is spread over that pixel's own box, in proportion to the tones there: so
//! the sum is the image's, and nothing comes where the image is 0.
//!
//! Sums begin anew in every page, a square of some reaches of a box, so that the maps of a part of an image are
//! those of the whole, to the bit.

mod area;
mod spread;
mod sums;
mod surroundings;

use alloc::vec::Vec;

pub(crate) use self::area::Area;
use self::area::Pages;
use self::spread::Spread;
use self::sums::{Cut, Sums};
pub(super) use self::surroundings::Scales;
use self::surroundings::surroundings;
use super::pixels::{MapError, filled, with_room};
use crate::threads;

/// The side of a page is at least so many reaches of a box: its sums, which reach beyond it, then have at most 2.25
/// times its pixels.
const PAGE_REACHES: usize = 4;

/// Twice as many up to this side: then they have at most 1.6 times its pixels, and fit in a processor's cache.
const SMALL_PAGE: usize = 64;

/// No more rows of pages than this are worked on at a time, for the sake of memory: 8 bytes a pixel.
const MOST_ROWS: usize = 16;

/// Sides of pages are multiples of so many pixels.
const LEAST_PAGE: usize = 16;

/// The maps that points read, row by row.
pub(super) struct Planes {
    pub(super) acceptance: Vec<f32>,
    pub(super) phase: Vec<f32>,
    /// 0 … 255.
    pub(super) detail: Vec<u8>,
}

impl Planes {
    /// The maps over the pages around `core`, from the pixels that they [`need`](Layout::needed).
    pub(super) fn new(image: &[f32], layout: &Layout, scales: &Scales) -> Result<Self, MapError> {
        let Layout { whole, pages, core, shared, toned, .. } = layout;
        let mut tones = filled(0.0f32, toned.len())?;
        let mut halves = filled(0.0f32, toned.len())?;
        let (mut phase, mut detail) = (filled(0.0f32, core.len())?, filled(0u8, core.len())?);
        let mut rows = with_room(pages.rows(toned).count())?;
        let (mut tones_below, mut halves_below) = (&mut tones[..], &mut halves[..]);
        let (mut phase_below, mut detail_below) = (&mut phase[..], &mut detail[..]);
        for area in pages.rows(toned) {
            let (area, inner) = (area.and(toned), area.and(core));
            rows.push(Row {
                tones: first(&mut tones_below, area.len()),
                halves: first(&mut halves_below, area.len()),
                phase: first(&mut phase_below, inner.len()),
                detail: first(&mut detail_below, inner.len()),
                area,
                inner,
            });
        }
        threads::for_each(&mut rows, |row| row.measure(image, layout, scales))?;

        // What each pixel gives to the tones in its box: found side by side, and added in the order of the pages.
        let mut spread = Spread::new(*pages, core)?;
        let mut rows = pages.rows(shared);
        loop {
            let most = threads::count().min(MOST_ROWS);
            let mut gifts = with_room(most)?;
            gifts.extend(rows.by_ref().take(most).map(|area| (area.and(shared), Vec::new())));
            if gifts.is_empty() {
                break;
            }
            threads::for_each(&mut gifts, |(area, gifts)| {
                *gifts = gifts_of(area, image, [&tones, &halves], layout)?;
                Ok(())
            })?;
            for (area, gifts) in &gifts {
                for page in pages.of(area) {
                    for_each_pixel(&page.and(area), |x, y| {
                        let gift = gifts[area.index(x, y)];
                        if gift != 0.0 {
                            let half = halves[toned.index(x, y)];
                            spread.add(&Cut::about([x, y], half.into(), *whole), gift);
                        }
                    });
                }
            }
        }
        spread.finish(&mut tones, toned);
        if core != toned {
            tones = cropped(&tones, toned, core)?;
        }
        Ok(Self { acceptance: tones, phase, detail })
    }
}

/// What each pixel of a row of pages gives: of the tone of every pixel in its box, in proportion to that.
fn gifts_of(
    row: &Area,
    image: &[f32],
    [tones, halves]: [&[f32]; 2],
    layout: &Layout,
) -> Result<Vec<f64>, MapError> {
    let Layout { whole, pages, reach, toned, needed, .. } = layout;
    let mut gifts = filled(0.0, row.len())?;
    let mut sums = Sums::default();
    for page in pages.of(row) {
        sums.measure((tones, toned), &page.grown(*reach, *whole), *whole)?;
        for_each_pixel(&page.and(row), |x, y| {
            let i = toned.index(x, y);
            let rest = f64::from(image[needed.index(x, y)]) - f64::from(tones[i]);
            if rest != 0.0 {
                let sum = sums.over(&Cut::about([x, y], halves[i].into(), *whole));
                gifts[row.index(x, y)] = if sum > 0.0 { rest / sum } else { 0.0 };
            }
        });
    }
    Ok(gifts)
}

/// Takes the first `len` elements of what is left of a plane.
fn first<'p, T>(plane: &mut &'p mut [T], len: usize) -> &'p mut [T] {
    let (first, rest) = core::mem::take(plane).split_at_mut(len);
    *plane = rest;
    first
}

/// A row of pages, and what the planes have there.
struct Row<'p> {
    /// Of the tones.
    area: Area,
    tones: &'p mut [f32],
    halves: &'p mut [f32],
    /// Of the core.
    inner: Area,
    phase: &'p mut [f32],
    detail: &'p mut [u8],
}

impl Row<'_> {
    /// All but what pixels give to others.
    fn measure(&mut self, image: &[f32], layout: &Layout, scales: &Scales) -> Result<(), MapError> {
        let Layout { whole, pages, reach, needed, .. } = layout;
        let Self { area, inner, .. } = self;
        let mut sums = Sums::default();
        for page in pages.of(area) {
            sums.measure((image, needed), &page.grown(*reach, *whole), *whole)?;
            for_each_pixel(&page.and(area), |x, y| {
                let value = image[needed.index(x, y)];
                let around = surroundings(&sums, [x, y], value.into(), scales);
                let i = area.index(x, y);
                // A tone of 0 is a pixel of 0, and the other way round.
                self.tones[i] =
                    if value > 0.0 { (around.tone as f32).max(f32::MIN_POSITIVE) } else { 0.0 };
                self.halves[i] = around.half as f32;
                if inner.x.contains(&x) && inner.y.contains(&y) {
                    self.phase[inner.index(x, y)] = around.phase as f32;
                    self.detail[inner.index(x, y)] = around.detail;
                }
            });
        }
        Ok(())
    }
}

fn for_each_pixel(area: &Area, mut pixel: impl FnMut(usize, usize)) {
    for y in area.y.clone() {
        for x in area.x.clone() {
            pixel(x, y);
        }
    }
}

/// The part of a plane over `from` that lies over `to`.
fn cropped(plane: &[f32], from: &Area, to: &Area) -> Result<Vec<f32>, MapError> {
    let mut part = with_room(to.len())?;
    for y in to.y.clone() {
        part.extend_from_slice(&plane[from.index(to.x.start, y)..][..to.x.len()]);
    }
    Ok(part)
}

/// What is made of what: pixels around tones around shares around the maps.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// The image's size.
    whole: (usize, usize),
    pages: Pages,
    /// No box reaches farther, in pixels.
    reach: usize,
    /// Whole pages, for which the maps are made.
    pub(super) core: Area,
    /// Pixels of which something may be spread over the core.
    shared: Area,
    /// Tones to which those give something, by the page.
    toned: Area,
    /// The pixels by which those are found, by the page.
    pub(super) needed: Area,
}

impl Layout {
    /// For maps that hold over this part of the image at least.
    pub(super) fn new(part: &Area, whole: (usize, usize), scales: &Scales) -> Self {
        let reach = libm::ceil(scales.largest.min(whole.0.max(whole.1) as f64)) as usize + 1;
        let side = (2 * PAGE_REACHES * reach).min(SMALL_PAGE).max(PAGE_REACHES * reach);
        let pages = Pages::new(side.next_multiple_of(LEAST_PAGE), whole);
        let core = pages.around(part);
        let shared = core.grown(reach, whole);
        let toned = pages.around(&shared).grown(reach, whole);
        let needed = pages.around(&toned).grown(reach, whole);
        Self { whole, pages, reach, core, shared, toned, needed }
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
        let scales = Scales { spacing_of_one, mean_spacing, largest, acceptance: 0.8 };
        let whole = (width, image.len() / width);
        Planes::new(image, &Layout::new(&Area::whole(whole), whole, &scales), &scales).unwrap()
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

    #[cfg(feature = "parallel")]
    #[test]
    fn any_number_of_threads_makes_the_same_maps() {
        let mut random = SplitMix64::new(7);
        let image: Vec<f32> = (0..300 * 210)
            .map(|i| if i % 300 < 90 { 0.6 } else { random.unit() as f32 - 0.2 })
            .map(|value| value.max(0.0))
            .collect();
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let made = pool.install(|| planes(&image, 300, 9000.0));
            (made.acceptance, made.phase, made.detail)
        };
        let one = run(1);
        for threads in [2, 3, 40] {
            assert!(run(threads) == one, "{threads}");
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
