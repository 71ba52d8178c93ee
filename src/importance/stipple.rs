//! An image prepared for relaxed points: what decides on acceptance, on the phase, on detail, and on
//! where a point may go. How its maps are made: see [`planes`](super::planes).
//!
//! Points read the maps bilinearly; acceptance, where an edge parts the four pixels around them, from the
//! nearest one. What a point may do is decided by the pixels themselves: it stays on its side of an
//! edge, unless its rank is wanted beyond, and off every pixel of importance 0.

use alloc::vec::Vec;

use glam::DVec2;

use super::planes::{Area, Layout, Planes, Scales};
use super::raster::{Grid, RUN, SAME_SIDE};
use super::{BilinearMap, ImageMap, Importance, InvalidPixels, MapError, Pixels, constrain_each};
use crate::domain::{Disc, Domain};
use crate::position::Scalar;

/// No box grows past this many spacings of the mean importance.
const LARGEST_SPACING: f64 = 1.5;

/// No point is moved by more than so many spacings of the mean importance, so that a part of the image knows
/// all points that may come into it. What would be moved farther by half its local spacing has an importance below
/// 1/256 of the mean.
const FARTHEST: f64 = 8.0;

/// The plane of details holds 0 … 255.
const FULL_DETAIL: f64 = 1.0 / 255.0;

/// An image of importance, made ready for a given number of relaxed points on it. Covers [0, width) ×
/// [0, height), x right, y down.
///
/// For [`Sampling::relaxed`](crate::Sampling::relaxed); as fixed points' importance it is the image, its
/// texture averaged over some spacings between edges, and the same sum. Keeps some 12 bytes a pixel.
#[derive(Clone, Debug)]
pub struct StippleMap {
    /// Over the part of the image that the map knows.
    acceptance: BilinearMap,
    phase: Vec<f32>,
    /// 0 … 255.
    detail: Vec<u8>,
    scales: Scales,
    /// All of the image.
    image: Domain,
    /// Of its pixels.
    mean: f64,
}

/// What a part of an image has to know of the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Whole {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Of the pixels, at least 0.
    pub(crate) mean: f64,
    /// About how many there are to be on the image.
    pub(crate) points: f64,
}

impl Whole {
    fn scales(&self, acceptance: f64) -> Scales {
        let points = if self.points > 1.0 { self.points } else { 1.0 };
        let mean_spacing = libm::sqrt(self.width as f64 * self.height as f64 / points);
        Scales {
            spacing_of_one: mean_spacing * libm::sqrt(self.mean),
            mean_spacing,
            largest: LARGEST_SPACING * mean_spacing,
            acceptance,
        }
    }

    /// The pixels from which a map is made that gives the points of this part of the image.
    pub(crate) fn needed(&self, part: &Area) -> Area {
        self.layout(part, &self.scales(StippleMap::ACCEPTANCE)).needed
    }

    fn layout(&self, part: &Area, scales: &Scales) -> Layout {
        // From a point's center to where it ends, and from its center to where it was moved to or may go; the pixels
        // around those.
        let margin = 2.0 * FARTHEST * scales.mean_spacing + 3.0;
        let size = (self.width, self.height);
        Layout::new(&part.grown(margin as usize, size), size, scales)
    }
}

impl StippleMap {
    /// Prepares pixels for about `points` points (a spacing of the whole image for fewer than one, and for
    /// NaN). O(pixels), some 0.3 µs each; with `parallel`, rayon's threads share the work.
    ///
    /// An all-zero image is allowed, and holds no points.
    ///
    /// # Errors
    /// [`MapError::Memory`] if there is no memory for the planes.
    ///
    /// ```
    /// use glam::Vec2;
    /// use twelvefold::{Amount, InvalidPixels, Pixels, Placement, Sampling, StippleMap};
    /// // A dark disc on white paper.
    /// let dark = |i: u32| {
    ///     let (x, y) = (i % 64, i / 64);
    ///     if x.abs_diff(32).pow(2) + y.abs_diff(32).pow(2) < 400 { 0.9 } else { 0.0 }
    /// };
    /// let pixels = Pixels::new(64, 64, (0..4096).map(dark).collect(), InvalidPixels::Reject)?;
    /// let map = StippleMap::new(pixels, 500.0)?;
    /// let placement = Placement::new(map.domain(), 1);
    /// let sampling = Sampling::new(&placement, &map, Amount::Points(500.0))?.relaxed()?;
    /// for sample in sampling.points::<Vec2>()? {
    ///     let [x, y] = sample?.position.to_array();
    ///     assert!(dark(y as u32 * 64 + x as u32) > 0.0); // no dot on white
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(pixels: Pixels, points: f64) -> Result<Self, MapError> {
        Self::accepting(pixels, points, Self::ACCEPTANCE)
    }

    /// Half-side, in spacings, of the box over which acceptance is averaged away from edges. Measured on the test image at
    /// 65,536 points: from 0.7 to 0.8 the variance of blocks falls from .0712 to .0694, and the
    /// first percentile of nearest distances rises from .499 to .502.
    pub const ACCEPTANCE: f64 = 0.8;

    /// The same for the trainer, which accepts by another box.
    #[doc(hidden)]
    pub fn accepting(pixels: Pixels, points: f64, acceptance: f64) -> Result<Self, MapError> {
        let (width, height) = pixels.size();
        let whole = Whole { width, height, mean: pixels.mean(), points };
        let scales = whole.scales(acceptance);
        let layout = Layout::new(&Area::whole((width, height)), (width, height), &scales);
        Self::of_layout(&pixels.values, &layout, &whole, scales)
    }

    /// The map of a part of an image: within it, and around it as far as points come into it, the map of the whole
    /// to the bit. `pixels` are those [`needed`](Whole::needed).
    pub(crate) fn of_part(pixels: &Pixels, part: &Area, whole: &Whole) -> Result<Self, MapError> {
        let scales = whole.scales(Self::ACCEPTANCE);
        let layout = whole.layout(part, &scales);
        let ((width, height), found) = (layout.needed.size(), pixels.values.len());
        if pixels.size() != (width, height) {
            return Err(MapError::Length { expected: layout.needed.len(), found });
        }
        Self::of_layout(&pixels.values, &layout, whole, scales)
    }

    fn of_layout(
        pixels: &[f32],
        layout: &Layout,
        whole: &Whole,
        scales: Scales,
    ) -> Result<Self, MapError> {
        let Planes { acceptance, phase, detail } = Planes::new(pixels, layout, &scales)?;
        let rectangle = |area: &Area| {
            let (width, height) = area.size();
            Domain::new(
                DVec2::new(area.x.start as f64, area.y.start as f64),
                DVec2::new(width as f64, height as f64),
            )
            .map_err(|_| MapError::Empty { width, height })
        };
        let (width, height) = layout.core.size();
        let acceptance = Pixels::new(width, height, acceptance, InvalidPixels::Reject)
            .and_then(ImageMap::new)?
            .over(rectangle(&layout.core)?);
        Ok(Self {
            acceptance: BilinearMap::new(acceptance),
            phase,
            detail,
            scales,
            image: rectangle(&Area::whole((whole.width, whole.height)))?,
            mean: whole.mean,
        })
    }

    /// The rectangle that the image covers.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.image
    }

    /// Where the planes' pixels lie.
    fn grid(&self) -> Grid {
        let (width, height) = self.acceptance.map().size();
        Grid { width, height, min: self.corner(), texel: DVec2::ONE, wraps: false }
    }

    /// The least corner of the planes.
    #[inline(always)]
    fn corner(&self) -> DVec2 {
        self.acceptance.map().domain().min()
    }

    /// The importance averaged at the scale of the points' spacing.
    fn phase_at(&self, at: DVec2) -> f64 {
        self.grid().value(&self.phase, at)
    }

    /// How much the importance varies at that scale, from 0 to 1.
    fn detail_at(&self, at: DVec2) -> f64 {
        self.grid().value(&self.detail, at) * FULL_DETAIL
    }

    /// The pixel under a point, the nearest one beyond the image: column and row.
    #[inline(always)]
    fn pixel(&self, at: DVec2) -> [usize; 2] {
        // Signed: the cheaper conversion, which also takes NaN to 0.
        let index = |t: f64, size: usize| (t as i64).clamp(0, size as i64 - 1) as usize;
        let (width, height) = self.acceptance.map().size();
        let at = at - self.corner();
        [index(at.x, width), index(at.y, height)]
    }

    /// The acceptance of the pixel under a point, not a mixture of pixels: edges are as sharp as the
    /// image's.
    #[inline(always)]
    fn accepted_at(&self, at: DVec2) -> f64 {
        let map = self.acceptance.map();
        let [x, y] = self.pixel(at);
        f64::from(map.pixels()[y * map.size().0 + x])
    }

    /// A place on the way to `moved` that is not too far from a point's center.
    #[inline(always)]
    fn near(&self, center: DVec2, moved: DVec2) -> DVec2 {
        let (step, most) = (moved - center, FARTHEST * self.scales.mean_spacing);
        let squared = step.x * step.x + step.y * step.y;
        if squared > most * most { center + step * (most / libm::sqrt(squared)) } else { moved }
    }

    /// Where a point that is not accepted at `moved` goes: nowhere if that is on its own side of an edge,
    /// else to the nearest place that is, or where its rank is wanted.
    fn back_across_the_edge(&self, center: DVec2, moved: DVec2, needed: f64) -> DVec2 {
        let tone = self.accepted_at(center);
        let may_lie = |there: f64| needed < there || (there > 0.0 && there >= SAME_SIDE * tone);
        if may_lie(self.accepted_at(moved)) {
            return moved;
        }
        self.acceptance.map().nearest_side(center, moved, may_lie)
    }
}

impl Importance for StippleMap {
    fn value(&self, at: DVec2) -> f64 {
        self.grid().value_of_side(self.acceptance.map().pixels(), at)
    }

    #[inline(always)]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64]) {
        let (grid, pixels) = (self.grid(), self.acceptance.map().pixels());
        for ((x, y), values) in x.chunks(RUN).zip(y.chunks(RUN)).zip(values.chunks_mut(RUN)) {
            let points =
                x.iter().zip(y).map(|(x, y)| [origin.x + x.to_f64(), origin.y + y.to_f64()]);
            match grid.cells(points.clone()) {
                Some(cells) => cells.read_side(pixels, values),
                None => {
                    for (value, at) in values.iter_mut().zip(points) {
                        *value = grid.value_of_side(pixels, DVec2::from(at));
                    }
                }
            }
        }
    }

    fn upper_bound(&self, region: &Disc) -> f64 {
        self.acceptance.upper_bound(region)
    }

    fn lower_bound(&self, region: &Disc) -> f64 {
        self.acceptance.lower_bound(region)
    }

    /// That of the pixels, known over the whole image only.
    fn integral(&self, domain: &Domain) -> Option<f64> {
        (*domain == self.image).then(|| self.mean * domain.area())
    }

    #[inline(always)]
    fn surroundings(&self, x: &[f64], y: &[f64], local: &mut [f64], detail: &mut [f64]) {
        let grid = self.grid();
        let runs = x.chunks(RUN).zip(y.chunks(RUN));
        for ((x, y), (local, detail)) in runs.zip(local.chunks_mut(RUN).zip(detail.chunks_mut(RUN)))
        {
            let points = x.iter().zip(y).map(|(x, y)| [*x, *y]);
            let mut phase = [0.0; RUN];
            let phase = &mut phase[..x.len()];
            match grid.cells(points.clone()) {
                Some(cells) => {
                    cells.read(&self.phase, phase);
                    cells.read(&self.detail, detail);
                    detail.iter_mut().for_each(|detail| *detail *= FULL_DETAIL);
                }
                None => {
                    for ((phase, detail), at) in phase.iter_mut().zip(detail).zip(points) {
                        let at = DVec2::from(at);
                        (*phase, *detail) = (self.phase_at(at), self.detail_at(at));
                    }
                }
            }
            // What lies across an edge, in the box or in the pixels around, makes points no sparser than
            // what accepted them.
            for (local, phase) in local.iter_mut().zip(phase) {
                *local = if *phase > *local { *phase } else { *local };
            }
        }
    }

    #[inline(always)]
    fn constrain(&self, centers: [&[f64]; 2], needed: &[f64], moved: [&mut [f64]; 2]) {
        constrain_each(centers, moved, |center, moved, i| {
            let moved = self.near(center, moved);
            if needed[i] < self.accepted_at(moved) {
                moved
            } else {
                self.back_across_the_edge(center, moved, needed[i])
            }
        });
    }

    fn constrains_everywhere(&self) -> bool {
        // Edges part grounds that are both above 0.
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    fn constrained(map: &StippleMap, center: DVec2, moved: DVec2, needed: f64) -> DVec2 {
        let ([mut x], [mut y]) = ([moved.x], [moved.y]);
        let to = [core::slice::from_mut(&mut x), core::slice::from_mut(&mut y)];
        map.constrain([&[center.x], &[center.y]], &[needed], to);
        DVec2::new(x, y)
    }

    #[test]
    fn many_at_once_are_the_single_ones() {
        let mut random = SplitMix64::new(5);
        let pixels: Vec<f32> =
            (0..40 * 30).map(|i| if i % 40 < 20 { random.unit() as f32 } else { 0.9 }).collect();
        let map = Pixels::new(40, 30, pixels, InvalidPixels::Reject)
            .and_then(|pixels| StippleMap::new(pixels, 400.0))
            .unwrap();
        // More than a run, a part of one at the end, and some points beyond the image.
        let mut coordinate = |size: f64| -> Vec<f64> {
            (0..200).map(|_| random.unit() * (size + 4.0) - 2.0).collect()
        };
        let (x, y, needed) = (coordinate(40.0), coordinate(30.0), coordinate(1.0));
        let (mut values, mut local) = ([0.0; 200], [0.5; 200]);
        let mut detail = [0.0; 200];
        let (mut to_x, mut to_y) = (x.clone(), y.clone());
        let centers = [&[20.0; 200][..], &[15.0; 200]];
        map.values(DVec2::ZERO, &x, &y, &mut values);
        map.surroundings(&x, &y, &mut local, &mut detail);
        map.constrain(centers, &needed, [&mut to_x, &mut to_y]);
        let mut moved = 0;
        for i in 0..200 {
            let at = DVec2::new(x[i], y[i]);
            assert_eq!(values[i], map.value(at));
            let (mut one_local, mut one_detail) = ([0.5], [0.0]);
            map.surroundings(&x[i..=i], &y[i..=i], &mut one_local, &mut one_detail);
            assert_eq!((local[i], detail[i]), (one_local[0], one_detail[0]));
            let settled = constrained(&map, DVec2::new(20.0, 15.0), at, needed[i]);
            assert_eq!(settled, DVec2::new(to_x[i], to_y[i]));
            let near = map.near(DVec2::new(20.0, 15.0), at);
            assert!(map.accepted_at(near) <= needed[i] || settled == near);
            moved += usize::from(settled != at);
        }
        assert!((20..180).contains(&moved), "{moved}");
    }

    /// Points accepted at places in and beyond the image and moved anywhere near.
    #[test]
    fn no_point_goes_where_the_image_is_0() {
        for seed in 0..40 {
            let mut random = SplitMix64::new(seed);
            let (width, height) = (1 + seed as usize % 23, 1 + seed as usize % 17);
            let white = [0.2, 0.5, 0.95][seed as usize % 3];
            let pixels: Vec<f32> = (0..width * height)
                .map(|_| if random.unit() < white { 0.0 } else { random.unit() as f32 })
                .collect();
            let count = 1.0 + 400.0 * random.unit();
            let map = Pixels::new(width, height, pixels.clone(), InvalidPixels::Reject)
                .and_then(|pixels| StippleMap::new(pixels, count));
            let map = map.unwrap();
            let mut place = |around: DVec2, reach: DVec2| {
                around + reach * (DVec2::new(random.unit(), random.unit()) - 0.5)
            };
            let size = DVec2::new(width as f64, height as f64);
            for _ in 0..400 {
                let center = place(0.5 * size, size + 3.0);
                let moved = place(center, DVec2::splat(8.0));
                let value = map.value(center);
                for needed in [0.0, 0.3 * value, value.next_down()] {
                    if value > 0.0 {
                        let [x, y] = map.pixel(constrained(&map, center, moved, needed));
                        assert!(pixels[y * width + x] > 0.0, "{center} {moved} {needed}");
                    }
                }
            }
        }
    }
}
