//! What a page is given from the boxes that reach into it.

use alloc::vec::Vec;

use super::area::Area;
use super::sums::Cut;
use crate::importance::pixels::{MapError, with_room};

/// Sums of boxes of constant height over one page, as the differences of their integral between corners.
#[derive(Debug)]
pub(super) struct Spread {
    differences: Vec<f64>,
    page: Area,
}

impl Spread {
    /// Nothing yet; for pages of at most this side.
    pub(super) fn new(side: usize) -> Result<Self, MapError> {
        let page = Area { x: 0..0, y: 0..0 };
        Ok(Self { differences: with_room((side + 2).saturating_mul(side + 2))?, page })
    }

    /// Begins a page.
    pub(super) fn begin(&mut self, page: Area) {
        let (width, height) = page.size();
        self.page = page;
        self.differences.clear();
        self.differences.resize((width + 2) * (height + 2), 0.0);
    }

    /// Adds `height` over what a box has in the page: of the adjoint of [`Sums::over`](super::sums::Sums::over), each pixel
    /// as much as the box has of it.
    #[inline]
    pub(super) fn add(&mut self, Cut { low, high }: &Cut, height: f64) {
        let Area { x, y } = &self.page;
        let within = |at: f64, range: &core::ops::Range<usize>| {
            at.clamp(range.start as f64, range.end as f64) - range.start as f64
        };
        let (left, right) = (within(low[0], x), within(high[0], x));
        let (top, bottom) = (within(low[1], y), within(high[1], y));
        if left < right && top < bottom {
            self.corner(left, top, height);
            self.corner(right, top, -height);
            self.corner(left, bottom, -height);
            self.corner(right, bottom, height);
        }
    }

    /// Adds `height` over all of the page that is right of x and below y.
    #[inline]
    fn corner(&mut self, x: f64, y: f64, height: f64) {
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f64, y - j as f64);
        let stride = self.page.x.len() + 2;
        let (above, below) = (height * (1.0 - fy), height * fy);
        let at = j * stride + i;
        self.differences[at] += above * (1.0 - fx);
        self.differences[at + 1] += above * fx;
        self.differences[at + stride] += below * (1.0 - fx);
        self.differences[at + stride + 1] += below * fx;
    }

    /// Multiplies the page's tones by 1 and what was added there. Leaves nothing.
    pub(super) fn finish(&mut self, tones: &mut [f32], area: &Area) {
        let width = self.page.x.len();
        let stride = width + 2;
        for (j, y) in self.page.y.clone().enumerate() {
            let (above, row) = self.differences.split_at_mut(j * stride);
            let above = j.checked_sub(1).map(|j| &above[j * stride..]);
            let tones = &mut tones[area.index(self.page.x.start, y)..][..width];
            let mut sum = 0.0;
            for (i, (difference, tone)) in row.iter_mut().zip(tones).enumerate() {
                sum += *difference;
                let share = sum + above.map_or(0.0, |above| above[i]);
                *difference = share;
                *tone = (f64::from(*tone) * (1.0 + share)).clamp(0.0, f32::MAX.into()) as f32;
            }
        }
        self.differences.clear();
    }
}
