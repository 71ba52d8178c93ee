//! Seams: what a walk does at the border of a seamless domain, which is none.
//!
//! The domain is a torus, and the tiles of the frontier are all there are, each once. A tile that sticks out
//! on one side is met by what lies at the other: its points are wrapped into the domain one by one, and its
//! disc stands for all its images, shifted by the domain's sides, as far as they touch the domain.

use glam::DVec2;

use super::chunk::Chunk;
use crate::domain::{Disc, Domain};
use crate::importance::Importance;
use crate::placement::Placement;
use crate::position::Scalar;
use crate::sampling::Clip;

/// The border of a seamless domain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seam {
    domain: Domain,
}

impl Seam {
    /// The placement's, if it is seamless.
    #[inline(always)]
    pub(crate) fn of(placement: &Placement<'_>) -> Option<Self> {
        placement.is_seamless().then(|| Self::around(placement.domain()))
    }

    /// A seamless domain's.
    pub(crate) fn around(domain: Domain) -> Self {
        Self { domain }
    }

    /// Whether an image of the disc may hold a point of the clip.
    #[cold]
    pub(crate) fn touches(&self, clip: &Clip, region: &Disc) -> bool {
        self.domain.images(region).any(|image| clip.touches(&image))
    }

    /// An upper bound of the importance in the disc, wrapped.
    #[cold]
    pub(crate) fn upper_bound(&self, importance: &impl Importance, region: &Disc) -> f64 {
        let bounds = self.domain.images(region).map(|image| importance.upper_bound(&image));
        // NaN stays, to be reported.
        bounds.fold(f64::NEG_INFINITY, |most, bound| if most >= bound { most } else { bound })
    }

    /// Whether the importance is the same at all places of the domain, and so on all sides of the seam.
    #[cold]
    pub(crate) fn is_constant(&self, importance: &impl Importance) -> bool {
        importance.is_constant(&self.domain.disc())
    }

    /// Whether the disc lies in the domain.
    pub(crate) fn is_clear_of(&self, region: &Disc) -> bool {
        let (low, high) = (region.center - region.radius, region.center + region.radius);
        low.cmpge(self.domain.min()).all() && high.cmplt(self.domain.max()).all()
    }

    /// The place of the domain that is meant by one less than a side outside.
    pub(crate) fn wrapped(&self, at: DVec2) -> DVec2 {
        let (low, high, size) = (self.domain.min(), self.domain.max(), self.domain.size());
        let [x, y] = [0, 1].map(|i| {
            let at = match at[i] {
                at if at < low[i] => at + size[i],
                at if at >= high[i] => at - size[i],
                at => at,
            };
            at.clamp(low[i], high[i].next_down())
        });
        DVec2::new(x, y)
    }

    /// The same for a position relative to the domain's least corner.
    pub(crate) fn place<S: Scalar>(&self, x: S, y: S) -> DVec2 {
        self.wrapped(self.domain.min() + DVec2::new(x.to_f64(), y.to_f64()))
    }

    /// Whether two places, less than a side outside, are on different sides of the seam.
    pub(crate) fn is_between(&self, a: DVec2, b: DVec2) -> bool {
        let sides = |at: DVec2| ((at - self.domain.min()) / self.domain.size()).floor();
        sides(a) != sides(b)
    }
}

impl<S: Scalar> Chunk<S> {
    /// Takes every candidate into the half-open domain, by a side at the most.
    #[inline(never)]
    pub(super) fn wrap(&mut self, placement: &Placement<'_>) {
        let size = placement.domain().size();
        let len = self.len;
        let columns = [(&mut self.x[..len], size.x), (&mut self.y[..len], size.y)];
        for (column, size) in columns {
            let (side, back) = (S::from_f64(size), S::from_f64(-size));
            let (zero, last) = (S::default(), side.next_down());
            for at in column {
                let ahead = if *at < zero { *at + side } else { *at };
                let wrapped = if ahead >= side && *at >= side { ahead + back } else { ahead };
                // The sum may round to the border.
                *at = if wrapped > last {
                    last
                } else if wrapped < zero {
                    zero
                } else {
                    wrapped
                };
            }
        }
    }
}
