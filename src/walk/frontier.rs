//! The tiles at which a walk begins, one after the other.
//!
//! An ordinary domain has at most 24 of them. A seamless one has 56 for each of its cells, 8,064 at 16 : 9, of which
//! few points need few: the importance's bound over the whole domain tells the ranks that can be admitted
//! anywhere, its bound over a root those that can be admitted among the root's children. Tiles of other ranks
//! are passed over.

use super::mode::Mode;
use super::seam::Seam;
use crate::domain::Disc;
use crate::importance::Importance;
use crate::placement::FRONTIER_LEVEL;
use crate::sampling::{Clip, Sampling};
use crate::tiling::MAX_CHILDREN;
use crate::tree::node::Node;

/// Where a walk is in the frontier.
#[derive(Clone, Debug)]
pub(super) struct Frontier {
    /// The next tile that may be walked.
    next: usize,
    /// The least rank that is admitted nowhere.
    ranks: u64,
    /// Whether roots are looked at before their children.
    by_roots: bool,
    /// The first tile of the next root, and the least rank that is admitted nowhere in this one.
    root_end: usize,
    root_ranks: u64,
}

impl Frontier {
    pub(super) fn new<I: Importance>(sampling: &Sampling<'_, I>) -> Self {
        let (placement, importance) = (sampling.placement(), sampling.importance());
        let (mut ranks, mut by_roots) = (u64::MAX, false);
        // A bound that need not hold may be higher over a part than over the whole.
        if placement.is_seamless() && importance.bounds_hold() {
            let all = placement.domain().disc();
            ranks = ranks_below(sampling, importance.upper_bound(&all), &all);
            by_roots = placement.has_many_roots() && !importance.is_constant(&all);
        }
        Self { next: 0, ranks, by_roots, root_end: 0, root_ranks: u64::MAX }
    }

    /// The next tile.
    #[inline(always)]
    pub(super) fn next<K: Mode>(
        &mut self,
        sampling: &Sampling<'_, impl Importance>,
        clip: &Clip,
    ) -> Option<Node> {
        loop {
            let (i, node) = sampling.placement().frontier_below(self.next, self.ranks)?;
            if self.by_roots && i >= self.root_end {
                self.root_end = i - i % MAX_CHILDREN + MAX_CHILDREN;
                self.root_ranks = ranks_of_root::<K>(sampling, clip, i);
            }
            if node.rank < self.root_ranks {
                self.next = i + 1;
                return Some(node);
            }
            self.next = self.root_end;
        }
    }
}

/// The least rank that is admitted nowhere in the root of tile `i` of a seamless domain.
#[cold]
fn ranks_of_root<K: Mode>(sampling: &Sampling<'_, impl Importance>, clip: &Clip, i: usize) -> u64 {
    let placement = sampling.placement();
    let Some(root) = placement.root_of(i) else { return u64::MAX };
    let seam = Seam::around(placement.domain());
    let center = placement.domain().min() + placement.center(&root);
    let region = Disc { center, radius: placement.reach(root.level, usize::MAX) };
    let radius = region.radius + K::margin(sampling, FRONTIER_LEVEL);
    if !seam.touches(clip, &Disc { radius, ..region }) {
        return 0;
    }
    ranks_below(sampling, seam.upper_bound(sampling.importance(), &region), &region)
}

/// The least rank that a bound does not admit. What is wrong with it is said where the walk meets it.
fn ranks_below(sampling: &Sampling<'_, impl Importance>, bound: f64, region: &Disc) -> u64 {
    sampling.rank_limit_of_bound(bound, region).unwrap_or(u64::MAX)
}
