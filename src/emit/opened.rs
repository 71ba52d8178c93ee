//! The tiles that a walk opens, for those who want to see how it finds its points.

use glam::DVec2;

use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::sampling::Sampling;
use crate::tiling::{MAX_CHILDREN, TileType};
use crate::tree::node::Node;
use crate::walk::mode::Fixed;
use crate::walk::traverse::Traversal;

/// A tile where it lies in the caller's coordinates. Its level and rank tell it from all others.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlacedTile {
    /// The type.
    pub kind: TileType,
    /// Levels below the root.
    pub level: u8,
    /// The rank of its center, which its first child has too.
    pub rank: u64,
    /// The center.
    pub center: DVec2,
    /// An edge of the tiling at the tile, along the x axis of the tile's own frame
    /// ([`TileType::star`](crate::tiling::TileType::star)).
    pub edge: DVec2,
}

impl PlacedTile {
    fn of(placement: &Placement<'_>, node: &Node) -> Self {
        Self {
            kind: node.kind,
            level: node.level,
            rank: node.rank,
            center: placement.domain().min() + placement.center(node),
            edge: placement.turned_edge(node.level, node.rotation),
        }
    }
}

impl<I: Importance> Sampling<'_, I> {
    /// Shows the descent: first each tile at which it begins, without a parent; then each tile that is opened
    /// since the importance admits points in it besides its center, with its children. Every unmoved point is
    /// the center of one of the tiles that stay whole. Points themselves come sooner, from blocks of many
    /// levels; this takes every tile by itself, some hundred nanoseconds each.
    ///
    /// # Errors
    /// As [`fill`](Self::fill).
    ///
    /// ```
    /// use twelvefold::{Amount, Constant, Domain, Placement, Sampling};
    /// let placement = Placement::new(Domain::UNIT, 7);
    /// let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(100.0))?;
    /// let mut deepest = 0;
    /// sampling.opened(|_, children| deepest = children.iter().fold(deepest, |d, tile| d.max(tile.level)))?;
    /// assert!(deepest > 4);
    /// # Ok::<(), twelvefold::SamplingError>(())
    /// ```
    pub fn opened(
        &self,
        mut take: impl FnMut(Option<&PlacedTile>, &[PlacedTile]),
    ) -> Result<(), SamplingError> {
        let placement = self.placement();
        let (tables, numbering) = (placement.tables(), placement.numbering());
        let mut walk = Traversal::<Fixed>::new(self, None).without_blocks();
        while walk.advance(self)? {
            let batch = walk.batch();
            let tile = PlacedTile::of(placement, &batch.node);
            // A batch of the tile's own center begins it; one of its children's opens it.
            if batch.start == 0 {
                take(None, &[tile]);
                continue;
            }
            let mut children = [tile; MAX_CHILDREN];
            let mut count = 0;
            for digit in 0..tile.kind.child_count() {
                if let Some(child) = batch.node.child(tables, numbering, digit) {
                    children[count] = PlacedTile::of(placement, &child);
                    count += 1;
                }
            }
            take(Some(&tile), &children[..count]);
        }
        Ok(())
    }
}
