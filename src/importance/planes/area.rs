//! Rectangles of pixels, and the pages into which an image is cut.

use core::ops::Range;

/// Columns and rows of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) x: Range<usize>,
    pub(crate) y: Range<usize>,
}

impl Area {
    /// The whole image.
    pub(crate) fn whole((width, height): (usize, usize)) -> Self {
        Self { x: 0..width, y: 0..height }
    }

    pub(crate) fn size(&self) -> (usize, usize) {
        (self.x.len(), self.y.len())
    }

    /// The number of its pixels, saturating.
    pub(crate) fn len(&self) -> usize {
        self.x.len().saturating_mul(self.y.len())
    }

    /// The place of a pixel that lies in it, row by row.
    #[inline(always)]
    pub(super) fn index(&self, x: usize, y: usize) -> usize {
        (y - self.y.start) * self.x.len() + (x - self.x.start)
    }

    /// With so many pixels more on each side, where the image has them.
    pub(crate) fn grown(&self, by: usize, (width, height): (usize, usize)) -> Self {
        let grown = |range: &Range<usize>, size: usize| {
            range.start.saturating_sub(by)..range.end.saturating_add(by).min(size)
        };
        Self { x: grown(&self.x, width), y: grown(&self.y, height) }
    }

    /// What it has in common with another.
    pub(super) fn and(&self, other: &Self) -> Self {
        let common = |a: &Range<usize>, b: &Range<usize>| {
            let start = a.start.max(b.start);
            start..a.end.min(b.end).max(start)
        };
        Self { x: common(&self.x, &other.x), y: common(&self.y, &other.y) }
    }
}

/// The squares of which an image is made, those at its right and lower border cut off there. Whatever is
/// added up begins at the corner of a page, so that no number depends on what part of the image is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pages {
    side: usize,
    image: (usize, usize),
}

impl Pages {
    /// Pages of this side, at least 1.
    pub(super) fn new(side: usize, image: (usize, usize)) -> Self {
        Self { side: side.max(1), image }
    }

    pub(super) fn side(&self) -> usize {
        self.side
    }

    /// The pages that an area touches, as one area.
    pub(super) fn around(&self, area: &Area) -> Area {
        let outward = |range: &Range<usize>, size: usize| {
            let end = range.end.div_ceil(self.side).saturating_mul(self.side);
            range.start / self.side * self.side..end.min(size)
        };
        Area { x: outward(&area.x, self.image.0), y: outward(&area.y, self.image.1) }
    }

    /// Each row of the pages that an area touches, as one area.
    pub(super) fn rows(&self, area: &Area) -> impl Iterator<Item = Area> + use<> {
        let (side, height) = (self.side, self.image.1);
        let Area { x, y } = self.around(area);
        y.step_by(side).map(move |y| Area { x: x.clone(), y: y..(y + side).min(height) })
    }

    /// Each page that an area touches, row by row.
    pub(super) fn of(&self, area: &Area) -> impl Iterator<Item = Area> + use<> {
        let (side, width) = (self.side, self.image.0);
        self.rows(area).flat_map(move |Area { x, y }| {
            x.step_by(side).map(move |x| Area { x: x..(x + side).min(width), y: y.clone() })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec::Vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn pages_cover_an_area_once(
            (width, height) in (1usize..60, 1usize..60),
            side in 1usize..40,
            (left, top) in (0usize..60, 0usize..60),
            (across, down) in (1usize..60, 1usize..60),
        ) {
            let pages = Pages::new(side, (width, height));
            let (left, top) = (left % width, top % height);
            let area = Area { x: left..(left + across).min(width), y: top..(top + down).min(height) };
            let mut covered = alloc::vec![0; width * height];
            let all: Vec<Area> = pages.of(&area).collect();
            for page in &all {
                prop_assert!(page.x.start.is_multiple_of(side) && page.y.start.is_multiple_of(side));
                for y in page.y.clone() {
                    for x in page.x.clone() {
                        covered[y * width + x] += 1;
                    }
                }
            }
            let around = pages.around(&area);
            for y in 0..height {
                for x in 0..width {
                    let inside = around.x.contains(&x) && around.y.contains(&y);
                    prop_assert_eq!(covered[y * width + x], usize::from(inside));
                    prop_assert!(inside || !(area.x.contains(&x) && area.y.contains(&y)));
                }
            }
        }
    }
}
