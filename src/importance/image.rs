//! Importance from pixels, constant over each pixel.

use alloc::vec::Vec;

use glam::DVec2;

use super::pixels::{InvalidPixels, MapError, Pixels};
use super::raster::{Extremes, Lattice, RUN, Texels};
use super::view::PixelView;
use super::{Importance, pixels};
use crate::domain::{Disc, Domain};
use crate::position::Scalar;
use crate::simd::Simd;

/// An image as importance: each pixel's value holds over the pixel's whole half-open square.
///
/// The image is stretched over a [`Domain`], by default [0, width) × [0, height): x to the right,
/// y down, row by row. Outside its domain the nearest pixel counts. Keeps pyramids of maxima and minima,
/// two thirds of the pixels' memory.
#[derive(Clone, Debug)]
pub struct ImageMap {
    pixels: Vec<f32>,
    extremes: Extremes,
    /// Σ of each row.
    row_sums: Vec<f64>,
    /// Σ of those.
    sum: f64,
    domain: Domain,
    lattice: Lattice,
}

impl ImageMap {
    /// A map of pixels, over [0, width) × [0, height). O(pixels).
    ///
    /// # Errors
    /// [`MapError::Memory`] if there is no memory for the pyramids.
    pub fn new(pixels: Pixels) -> Result<Self, MapError> {
        let Pixels { width, height, values: pixels, row_sums, sum } = pixels;
        let size = DVec2::new(width as f64, height as f64);
        let domain =
            Domain::new(DVec2::ZERO, size).map_err(|_| MapError::Empty { width, height })?;
        let extremes = Extremes::new(&pixels, width, height)?;
        let lattice = Lattice::new(width, height, DVec2::ZERO, DVec2::ONE);
        Ok(Self { pixels, extremes, row_sums, sum, domain, lattice })
    }

    /// The same pixels stretched over another rectangle.
    #[must_use]
    pub fn over(mut self, domain: Domain) -> Self {
        self.domain = domain;
        let Lattice { width, height, .. } = self.lattice;
        let texels_per_unit = DVec2::new(width as f64, height as f64) / domain.size();
        self.lattice = Lattice::new(width, height, domain.min(), texels_per_unit);
        self
    }

    /// Replaces all pixels by those of a view of the same size. Allocates nothing. O(pixels).
    ///
    /// # Errors
    /// [`MapError::OutsideMap`] for another size, [`MapError::InvalidPixel`] for the first pixel that
    /// `invalid` does not admit; the map is then unchanged.
    ///
    /// ```
    /// use glam::DVec2;
    /// use twelvefold::{ImageMap, Importance, InvalidPixels, MapError, PixelData, PixelView, Pixels};
    /// let black = Pixels::new(640, 360, vec![0.0; 640 * 360], InvalidPixels::Reject)?;
    /// let mut map = ImageMap::new(black)?;
    /// // Each frame, from a renderer's buffer whose rows begin 1,024 bytes apart.
    /// let buffer = vec![128u8; 360 * 1024];
    /// let frame = PixelView::strided(PixelData::U8(&buffer), 640, 360, 1024)?;
    /// map.update(&frame, InvalidPixels::Reject)?;
    /// // Or a patch of it alone: 2 × 2 pixels at column 10, row 20.
    /// let lamp = PixelView::new(PixelData::F32(&[9.0; 4]), 2, 2)?;
    /// map.update_at(10, 20, &lamp, InvalidPixels::Reject)?;
    /// assert_eq!(map.value(DVec2::new(11.5, 20.5)), 9.0);
    /// # Ok::<(), MapError>(())
    /// ```
    pub fn update(&mut self, view: &PixelView<'_>, invalid: InvalidPixels) -> Result<(), MapError> {
        if (view.width, view.height) != self.size() {
            return Err(MapError::OutsideMap);
        }
        self.update_at(0, 0, view, invalid)
    }

    /// Replaces the pixels of the rectangle at column `x` and row `y` by those of a view; `sum` and
    /// pyramid are repaired where they depend on them. The same map as one made anew, bit for bit.
    /// Allocates nothing. O(rows touched × width).
    ///
    /// # Errors
    /// [`MapError::OutsideMap`] if the view does not fit there, [`MapError::InvalidPixel`] (in the
    /// map's columns and rows) for the first pixel that `invalid` does not admit; the map is then
    /// unchanged.
    pub fn update_at(
        &mut self,
        x: usize,
        y: usize,
        view: &PixelView<'_>,
        invalid: InvalidPixels,
    ) -> Result<(), MapError> {
        let (width, height) = self.size();
        let fits = |at: usize, size: usize, of: usize| at <= of && size <= of - at;
        if !(fits(x, view.width, width) && fits(y, view.height, height)) {
            return Err(MapError::OutsideMap);
        }
        if view.width == 0 || view.height == 0 {
            return Ok(());
        }
        Simd::detect().run(
            #[inline(always)]
            || {
                for row in 0..view.height {
                    let Some(pixels) = view.unchecked_row(row) else { break };
                    if let Some((column, value)) = pixels::first_refused(pixels, invalid) {
                        return Err(MapError::InvalidPixel { x: x + column, y: y + row, value });
                    }
                }
                self.replace(x, y, view, invalid);
                Ok(())
            },
        )
    }

    /// [`update_at`](Self::update_at) when the view fits and no pixel is refused.
    #[inline(always)]
    fn replace(&mut self, x: usize, y: usize, view: &PixelView<'_>, invalid: InvalidPixels) {
        let (width, height) = self.size();
        let (columns, rows) = (x..x + view.width, y..y + view.height);
        // Two rows at a time, all that is to be done with them while they are in the cache.
        for pair in rows.start / 2..rows.end.div_ceil(2) {
            for row in (2 * pair).max(rows.start)..(2 * pair + 2).min(rows.end) {
                let whole = &mut self.pixels[row * width..][..width];
                let part = &mut whole[columns.clone()];
                view.copy_row(row - rows.start, part);
                if invalid != InvalidPixels::Reject {
                    pixels::replace(part);
                }
                self.row_sums[row] = pixels::sum(whole);
            }
            self.extremes.reduce_pixels(&self.pixels, (width, height), pair, &columns);
        }
        self.sum = pixels::sum(&self.row_sums);
        self.extremes.reduce_above(&columns, &rows);
    }

    /// The rectangle that the image covers.
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// Pixels a row and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.lattice.width, self.lattice.height)
    }

    /// The pixels, row by row, as they count (after [`InvalidPixels`]).
    #[must_use]
    pub fn pixels(&self) -> &[f32] {
        &self.pixels
    }

    /// The mean pixel.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum / self.pixels.len() as f64
    }

    /// Where a point goes that was to go to `moved`, a pixel where it may not be: to the nearest place of
    /// the pixels whose value `may_lie` admits; the center if all are farther from it than `moved` is.
    #[inline(never)]
    pub(super) fn nearest_side(
        &self,
        center: DVec2,
        moved: DVec2,
        may_lie: impl Fn(f64) -> bool,
    ) -> DVec2 {
        let Lattice { width, .. } = self.lattice;
        let may_lie = |x: usize, y: usize| may_lie(self.pixels[y * width + x].into());
        self.lattice.nearest(center, moved, may_lie).unwrap_or(center)
    }

    /// Column and row of the pixel under a point, clamped to the image.
    pub(crate) fn texel(&self, at: DVec2) -> (usize, usize) {
        self.lattice.texel(at)
    }
}

/// Discs whose bounds are looked up together: the children of a tile.
const DISCS: usize = 16;

impl Importance for ImageMap {
    fn value(&self, at: DVec2) -> f64 {
        let (x, y) = self.lattice.texel(at);
        f64::from(self.pixels[y * self.lattice.width + x])
    }

    #[inline]
    fn upper_bound(&self, region: &Disc) -> f64 {
        let (texels, low, high) = self.under(region);
        f64::from(texels.max(low, high))
    }

    #[inline]
    fn lower_bound(&self, region: &Disc) -> f64 {
        let (texels, low, high) = self.under(region);
        f64::from(texels.min(low, high))
    }

    #[inline(always)]
    fn upper_bounds(&self, origin: DVec2, x: &[f64], y: &[f64], radius: f64, bounds: &mut [f64]) {
        let (mut low, mut high) = ([[0u32; 2]; DISCS], [[0u32; 2]; DISCS]);
        let discs = bounds.chunks_mut(DISCS).zip(x.chunks(DISCS)).zip(y.chunks(DISCS));
        for ((bounds, x), y) in discs {
            let (low, high) = (&mut low[..x.len()], &mut high[..x.len()]);
            let shift = self.lattice.spans(origin, x, y, radius, low, high);
            let level = self.extremes.level(&self.pixels, self.lattice.width, shift);
            for ((bound, low), high) in bounds.iter_mut().zip(low).zip(high) {
                *bound = f64::from(level.max(*low, *high));
            }
        }
    }

    #[inline(always)]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64]) {
        self.lattice.values(&self.pixels, origin, x, y, values);
    }

    #[inline(always)]
    fn constrain(&self, centers: [&[f64]; 2], _needed: &[f64], [x, y]: [&mut [f64]; 2]) {
        let [center_x, center_y] = centers;
        let runs = x.chunks_mut(RUN).zip(y.chunks_mut(RUN));
        let centers = center_x.chunks(RUN).zip(center_y.chunks(RUN));
        for ((x, y), (center_x, center_y)) in runs.zip(centers) {
            let mut above = [0; RUN];
            self.lattice.are_above(&self.pixels, x, y, &mut above[..x.len()]);
            for i in (0..x.len()).filter(|i| above[*i] == 0) {
                let (center, moved) =
                    (DVec2::new(center_x[i], center_y[i]), DVec2::new(x[i], y[i]));
                [x[i], y[i]] = self.nearest_side(center, moved, |value| value > 0.0).to_array();
            }
        }
    }

    #[inline]
    fn is_constant(&self, region: &Disc) -> bool {
        let (texels, low, high) = self.under(region);
        texels.max(low, high) <= texels.min(low, high)
    }

    fn integral(&self, domain: &Domain) -> Option<f64> {
        if *domain == self.domain {
            return Some(self.mean() * domain.area());
        }
        Some(self.integral_over(domain))
    }
}

impl ImageMap {
    /// The pyramid's texels of a size with the region, first and last columns and rows.
    #[inline]
    fn under(&self, region: &Disc) -> (Texels<'_>, [u32; 2], [u32; 2]) {
        let (mut low, mut high) = ([[0; 2]], [[0; 2]]);
        let Disc { center: DVec2 { x, y }, radius } = *region;
        let shift = self.lattice.spans(DVec2::ZERO, &[x], &[y], radius, &mut low, &mut high);
        (self.extremes.level(&self.pixels, self.lattice.width, shift), low[0], high[0])
    }

    /// ∫ over any rectangle, pixel by pixel: O(pixels covered).
    fn integral_over(&self, domain: &Domain) -> f64 {
        // Edges of the pixels' cells along one axis; the border pixels reach to infinity.
        let lengths = |min: f64, max: f64, origin: f64, scale: f64, count: usize| {
            let (a, b) = ((min - origin) * scale, (max - origin) * scale);
            let first = (a as usize).min(count - 1);
            let last = (b as usize).min(count - 1);
            (first..=last).map(move |i| {
                let from = if i == first { a } else { i as f64 };
                let to = if i == last { b } else { (i + 1) as f64 };
                (i, (to - from) / scale)
            })
        };
        let (min, max, origin) = (domain.min(), domain.max(), self.domain.min());
        let Lattice { width, height, texels_per_unit: scale, .. } = self.lattice;
        lengths(min.y, max.y, origin.y, scale.y, height)
            .map(|(y, dy)| {
                let row = &self.pixels[y * width..][..width];
                let row_sum: f64 = lengths(min.x, max.x, origin.x, scale.x, width)
                    .map(|(x, dx)| f64::from(row[x]) * dx)
                    .sum();
                row_sum * dy
            })
            .sum()
    }
}
