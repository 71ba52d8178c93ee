//! Mode: what a relaxed point must know of its ancestors.

use crate::bake::class::{Classes, MAX_GENERATIONS, class_count};
use crate::tables::Tables;
use crate::tiling::{FCode, TileType};
use crate::tree::node::Node;

/// A tile's classes, and how its parent and its grandparent are turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ancestry {
    classes: Classes,
    /// In units of 30°.
    ancestors: [u8; 2],
}

impl Ancestry {
    /// What an unused slot holds.
    pub(crate) const NONE: Self = Self { classes: Classes::root(TileType::A), ancestors: [0; 2] };

    /// The ancestors of a frontier tile follow from its rank.
    pub(crate) fn frontier(tables: &Tables<'_>, node: &Node) -> Self {
        let (mut kind, mut rotation, mut ancestors) = (TileType::A, 0, [0; 2]);
        let mut classes = Classes::root(kind);
        // The frontier's levels and ranks exist.
        if let Ok(code) = FCode::from_rank(TileType::A, node.level.into(), node.rank) {
            for digit in code.oldest_first() {
                let (child, turn) = tables.child_kinds(kind)[usize::from(digit)];
                ancestors = [rotation, ancestors[0]];
                (kind, rotation) = (child, (rotation + turn) % 12);
                classes = classes.child(digit, child);
            }
        }
        Self { classes, ancestors }
    }

    #[inline(always)]
    pub(crate) fn child(&self, parent: &Node, digit: usize, child: &Node) -> Self {
        Self {
            classes: self.classes.child(digit as u8, child.kind),
            ancestors: [parent.rotation, self.ancestors[0]],
        }
    }
}

/// The ancestry that entries of one block have at one level: the classes from their rank coefficients,
/// and the ancestors in whose frames vectors are given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClassFormula {
    /// For each number of generations: class = own + A·count − B·before.
    own: [u32; MAX_GENERATIONS + 1],
    count: [u32; MAX_GENERATIONS + 1],
    before: [u32; MAX_GENERATIONS + 1],
    /// The grandparent's rotation relative to the great-grandparent, and the latter's own, in units
    /// of 30°.
    pub(crate) turn: u8,
    pub(crate) rotation: u8,
}

impl ClassFormula {
    /// Of the entries of `node`'s block, `below` levels below it: 1 … 3. Three levels below, the turn and
    /// the class over two generations are the entries' own: see
    /// [`relax_keys`](crate::tables::BlockTable::relax_keys).
    ///
    /// Classes obey the recurrence of the ranks, n_G in place of N_m, so that an entry's coefficients
    /// give its class too: class_G = class_{G−j}(node) + A·n_{G−j} − B·n_{G−j−1}, j levels down.
    pub(crate) fn of_entries(ancestry: &Ancestry, node: &Node, below: usize) -> Self {
        let number = |g: usize| class_count(g).unwrap_or(0);
        // Slots have at least 2 generations; what is given for fewer is never asked for.
        let older = |g: usize| g.saturating_sub(below);
        let [parent, grandparent] = ancestry.ancestors;
        let (grand, great) = match below {
            3.. => (node.rotation, node.rotation),
            2 => (node.rotation, parent),
            _ => (parent, grandparent),
        };
        Self {
            own: core::array::from_fn(|g| ancestry.classes.over(older(g))),
            count: core::array::from_fn(|g| number(older(g))),
            before: core::array::from_fn(|g| if older(g) == 0 { 1 } else { number(older(g) - 1) }),
            turn: (grand + 12 - great) % 12,
            rotation: great,
        }
    }

    /// Of the entries of a block of the type with this index, three levels below its tile, for classes
    /// over three generations: the type is all there is to know.
    pub(crate) fn of_block(kind: usize) -> Self {
        let [own, count] = [kind as u32, class_count(0).unwrap_or(0)];
        Self {
            own: [own; MAX_GENERATIONS + 1],
            count: [count; MAX_GENERATIONS + 1],
            before: [1; MAX_GENERATIONS + 1],
            turn: 0,
            rotation: 0,
        }
    }

    /// Of the center of `node`, `below` levels below it: the end of a chain of center children.
    pub(crate) fn of_center(
        tables: &Tables<'_>,
        ancestry: &Ancestry,
        node: &Node,
        below: usize,
    ) -> Self {
        // How the tile is turned that is `down` levels below the node, or above it.
        let rotation = |down: isize| match down {
            ..=-2 => ancestry.ancestors[1],
            -1 => ancestry.ancestors[0],
            _ => {
                let mut tile = (node.kind, node.rotation);
                for _ in 0..down {
                    let (kind, turn) = tables.child_kinds(tile.0)[0];
                    tile = (kind, (tile.1 + turn) % 12);
                }
                tile.1
            }
        };
        let below = below as isize;
        let (grand, great) = (rotation(below - 2), rotation(below - 3));
        // A digit 0 adds nothing to a class; past the node, the oldest ancestor is an `a` tile.
        let own = |g: usize| match g.checked_sub(below as usize) {
            Some(rest) => ancestry.classes.over(rest),
            None => TileType::A as u32,
        };
        Self {
            own: core::array::from_fn(own),
            count: [0; MAX_GENERATIONS + 1],
            before: [0; MAX_GENERATIONS + 1],
            turn: (grand + 12 - great) % 12,
            rotation: great,
        }
    }

    /// The class over `generations` of an entry with rank coefficients (a, b).
    #[inline(always)]
    pub(crate) fn class(&self, generations: usize, (a, b): (u16, u16)) -> u32 {
        let g = generations.min(MAX_GENERATIONS);
        // No class leaves 32 bits; entries of other levels wrap to some class or none.
        self.own[g]
            .wrapping_add(u32::from(a).wrapping_mul(self.count[g]))
            .wrapping_sub(u32::from(b).wrapping_mul(self.before[g]))
    }
}
