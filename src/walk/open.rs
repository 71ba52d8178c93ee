//! Opening a tile: which of its children need a visit, decided for all of them at once.

use glam::DVec2;

use super::count::levels_below;
use super::mode::Mode;
use super::seam::Seam;
use crate::domain::Disc;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::sampling::{Clip, Sampling};
use crate::tables::ExactPoint;
use crate::tiling::children::MAX_CHILDREN;
use crate::tree::frame::{Frame, Segment};
use crate::tree::node::Node;

/// A tile whose children are being visited.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OpenTile<K> {
    pub(crate) node: Node,
    pub(crate) ancestry: K,
    /// Bit `d`: the child with digit `d` is still to be visited.
    pub(crate) pending: u16,
    /// Bit `d`: the child's new descendants all lie in the clip.
    pub(crate) inside: u16,
    /// Bit `d`: the importance is its upper bound everywhere in the child.
    pub(crate) constant: u16,
    /// How many ranks the child's bound admits.
    pub(crate) limits: [u64; MAX_CHILDREN],
    /// The child's upper bound.
    pub(crate) bounds: [f64; MAX_CHILDREN],
    /// The mean of those.
    pub(crate) mean_bound: f64,
}

impl<K: Mode> OpenTile<K> {
    /// What an unused slot holds.
    pub(crate) const CLOSED: Self = Self {
        node: Node::root(),
        ancestry: K::NONE,
        pending: 0,
        inside: 0,
        constant: 0,
        limits: [0; MAX_CHILDREN],
        bounds: [0.0; MAX_CHILDREN],
        mean_bound: 0.0,
    };

    /// Opens `node`, of whose descendants those with a rank under `node_limit` can be accepted; where they are, the
    /// importance is `node_value`, if that is known.
    ///
    /// A child's own center belongs to `node`'s batch. What is left below a level-(m + 1) child with
    /// rank r has ranks from N_{m+1} + r on, and its points are born at most `levels` − 1 levels below
    /// it, so near that a smaller disc than the child's whole subtree's holds them.
    #[inline(always)]
    pub(crate) fn expand<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        clip: &Clip,
        (node, ancestry): (&Node, &K),
        node_limit: u64,
        node_inside: bool,
        node_value: Option<f64>,
    ) -> Result<(), SamplingError> {
        (self.node, self.ancestry) = (*node, *ancestry);
        (self.pending, self.inside, self.constant) = (0, 0, 0);
        let placement = sampling.placement();
        let importance = sampling.importance();
        let block = placement.tables().block(node.kind);
        let children = node.kind.child_count();
        let (mut x, mut y) = ([0.0; MAX_CHILDREN], [0.0; MAX_CHILDREN]);
        child_centers(sampling, node).write_columns(&mut x, &mut y);

        let corner = placement.domain().min();
        let levels = levels_below(placement.numbering(), node, node_limit);
        let radius = placement.reach(node.level + 1, levels.saturating_sub(1));
        // Where points are moved, these are born below the children.
        let wide = radius + K::margin(sampling, node.level + 2);
        let size = placement.domain().size();
        // What lies inside meets no seam.
        let seam = if node_inside { None } else { Seam::of(placement) };
        let mut digits = [0u8; MAX_CHILDREN];
        let mut touching = 0;
        for digit in 0..children {
            (digits[touching], x[touching], y[touching]) = (digit as u8, x[digit], y[digit]);
            let center = corner + DVec2::new(x[touching], y[touching]);
            let region = Disc { center, radius: wide };
            let touches = node_inside
                || match &seam {
                    None => clip.touches(&region),
                    Some(seam) => seam.touches(clip, &region),
                };
            if K::RELAXED && seam.is_none() {
                // Importance is read at the nearest place of the domain, which is never farther from
                // this one than the point from the center.
                x[touching] = x[touching].clamp(0.0, size.x);
                y[touching] = y[touching].clamp(0.0, size.y);
            }
            touching += usize::from(touches);
        }
        let mut bounds = [0.0; MAX_CHILDREN];
        let (x, y, bounds) = (&x[..touching], &y[..touching], &mut bounds[..touching]);
        importance.upper_bounds(corner, x, y, radius, bounds);
        if let Some(seam) = &seam {
            for (i, bound) in bounds.iter_mut().enumerate() {
                let region = Disc { center: corner + DVec2::new(x[i], y[i]), radius };
                if !seam.is_clear_of(&region) {
                    *bound = seam.upper_bound(importance, &region);
                }
            }
        }

        self.mean_bound = bounds.iter().sum::<f64>() / bounds.len() as f64;
        let numbering = placement.numbering();
        let (tiles_below, _) = numbering.counts().pair(node.level + 1);
        let scale = sampling.scale();
        for (i, bound) in bounds.iter().enumerate() {
            let digit = usize::from(digits[i]);
            let rank = node.rank_of(numbering, block.rank_coefficients(digit));
            let least = tiles_below.saturating_add(rank);
            // A sieve that costs little: rounding keeps the order, so that no child is lost, and NaN goes
            // on to be an error.
            if scale.limit_before_rounding(*bound) < least as i64 as f64 && *bound >= 0.0 {
                continue;
            }
            let region = Disc { center: corner + DVec2::new(x[i], y[i]), radius };
            // No child has more than its parent, even where a bound that need not hold says so: the
            // disc above is made for the parent's limit.
            let limit = sampling.rank_limit_of_bound(*bound, &region)?.min(node_limit);
            let bit = 1 << digit;
            if limit > least {
                self.pending |= bit;
                let region_of_points = Disc { radius: wide, ..region };
                self.inside |= if node_inside || clip.holds(&region_of_points) { bit } else { 0 };
                // What is constant in the tile is so in its part of each child's disc.
                let constant = node_value == Some(*bound);
                self.constant |= if constant { bit } else { 0 };
            }
            (self.limits[digit], self.bounds[digit]) = (limit, *bound);
        }
        Ok(())
    }
}

/// The centers of a node's children, by digit, relative to the domain's least corner.
#[inline(always)]
fn child_centers<'t, I: Importance>(sampling: &Sampling<'t, I>, node: &Node) -> Segment<'t, f64> {
    let placement = sampling.placement();
    let quarters = node.rotation / 3;
    let center: ExactPoint = node.center.finer();
    Segment::new(
        Frame::new(placement.half_edge(node.level + 1), placement.origin(), quarters),
        center.turned_back(quarters),
        placement.tables().block(node.kind).offsets(usize::from(node.rotation % 3)),
        0..node.kind.child_count(),
    )
}
