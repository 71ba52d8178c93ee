//! What pixels give to the pixels in their boxes, summed page by page.

use alloc::vec::Vec;

use super::area::{Area, Pages};
use super::sums::Cut;
use crate::importance::pixels::{MapError, filled};

/// Sums of boxes of constant height, as the differences of their integral between corners. Each page has differences
/// of its own, to which a box adds what it has in the page: a page's sums depend on the boxes that touch it and on
/// their order, not on how many pages there are.
#[derive(Debug)]
pub(super) struct Spread {
    differences: Vec<f64>,
    pages: Pages,
    /// Whole pages.
    area: Area,
    /// Pages in a row of the area.
    across: usize,
    /// Numbers in a row of a page: its pixels and two more.
    stride: usize,
    page_len: usize,
}

impl Spread {
    /// Nothing yet, over the pages that make up an area.
    pub(super) fn new(pages: Pages, area: &Area) -> Result<Self, MapError> {
        let (width, height) = area.size();
        let side = pages.side();
        let (across, down) = (width.div_ceil(side), height.div_ceil(side));
        // Pages of an area that is smaller than a page are as wide or as high as it.
        let stride = side.min(width) + 2;
        let page_len = stride * (side.min(height) + 2);
        let len = across.saturating_mul(down).saturating_mul(page_len);
        let differences = filled(0.0, len)?;
        Ok(Self { differences, pages, area: area.clone(), across, stride, page_len })
    }

    /// Adds `height` over a box: of the adjoint of [`Sums::over`](super::sums::Sums::over), each pixel as much as the
    /// box has of it. What lies beyond the area is lost.
    #[inline]
    pub(super) fn add(&mut self, Cut { low, high }: &Cut, height: f64) {
        let Area { x, y } = &self.area;
        // Relative to the area, whose corner is a page's.
        let within = |at: f64, range: &core::ops::Range<usize>| {
            at.clamp(range.start as f64, range.end as f64) - range.start as f64
        };
        let (left, right) = (within(low[0], x), within(high[0], x));
        let (top, bottom) = (within(low[1], y), within(high[1], y));
        if left >= right || top >= bottom {
            return;
        }
        let side = self.pages.side();
        let pages = |from: f64, to: f64, length: usize| {
            let last = (to as usize).min(length - 1) / side;
            from as usize / side..=last
        };
        let columns = pages(left, right, x.len());
        for row in pages(top, bottom, y.len()) {
            let begin = (row * side) as f64;
            let (top, bottom) = ((top - begin).max(0.0), (bottom - begin).min(side as f64));
            for column in columns.clone() {
                let begin = (column * side) as f64;
                let (left, right) = ((left - begin).max(0.0), (right - begin).min(side as f64));
                let at = (row * self.across + column) * self.page_len;
                let page = &mut self.differences[at..][..self.page_len];
                add_corner(page, self.stride, [left, top], height);
                add_corner(page, self.stride, [right, top], -height);
                add_corner(page, self.stride, [left, bottom], -height);
                add_corner(page, self.stride, [right, bottom], height);
            }
        }
    }

    /// Multiplies the tones of the area, which lie in those of `toned`, by 1 and what was added there.
    pub(super) fn finish(mut self, tones: &mut [f32], toned: &Area) {
        let stride = self.stride;
        let pages = self.differences.chunks_exact_mut(self.page_len);
        for (page, differences) in self.pages.of(&self.area).zip(pages) {
            for (j, y) in page.y.clone().enumerate() {
                let (above, row) = differences.split_at_mut(j * stride);
                let above = j.checked_sub(1).map(|j| &above[j * stride..]);
                let tones = &mut tones[toned.index(page.x.start, y)..][..page.x.len()];
                let mut sum = 0.0;
                for (i, (difference, tone)) in row.iter_mut().zip(tones).enumerate() {
                    sum += *difference;
                    let share = sum + above.map_or(0.0, |above| above[i]);
                    *difference = share;
                    *tone = (f64::from(*tone) * (1.0 + share)).clamp(0.0, f32::MAX.into()) as f32;
                }
            }
        }
    }
}

/// Adds `height` over all of a page that is right of x and below y.
#[inline]
fn add_corner(page: &mut [f64], stride: usize, [x, y]: [f64; 2], height: f64) {
    // As for the sums, whose parts are larger than pages.
    let (i, j) = (x as u32 as usize, y as u32 as usize);
    let (fx, fy) = (x - i as f64, y - j as f64);
    let (above, below) = (height * (1.0 - fy), height * fy);
    let at = j * stride + i;
    page[at] += above * (1.0 - fx);
    page[at + 1] += above * fx;
    page[at + stride] += below * (1.0 - fx);
    page[at + stride + 1] += below * fx;
}
