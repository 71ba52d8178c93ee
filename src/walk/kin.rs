//! Kinship: what a relaxed point must know of its ancestors.

use super::frame::Frame;
use super::node::{ExactPoint, Node};
use super::scalar::Scalar;
use crate::bake::class::{Classes, class_count};
use crate::placement::Placement;
use crate::tables::Tables;
use crate::tiling::{FCode, TileType};

/// A tile of the walk with its kinship.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kin {
    pub(crate) node: Node,
    /// The tile's classes.
    classes: Classes,
    /// Rotations of its parent and grandparent.
    ancestors: [u8; 2],
    /// The same of the tile at which this tile's centre was born.
    birth: Birth,
}

/// A tile at the level at which its centre was born, but not before the frontier.
#[derive(Clone, Copy, Debug)]
struct Birth {
    level: u8,
    /// Its centre in edges of that level. A point is always computed from here, so that its bits do
    /// not depend on the level at which it is met.
    centre: ExactPoint,
    kind: TileType,
    /// Its rotation, its parent's and its grandparent's.
    rotations: [u8; 3],
    classes: Classes,
}

/// Where the vector of a point is found: its classes at its own level, and the rotation of the frame
/// in which the vector is given, its grandparent's.
pub(crate) struct Relation<C> {
    /// The class over a number of generations.
    pub(crate) class: C,
    /// In units of 30°.
    pub(crate) rotation: u8,
}

impl Kin {
    /// A frontier tile: its ancestors follow from its rank. Its centre counts as born here.
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
        let rotations = [node.rotation, ancestors[0], ancestors[1]];
        let birth = Birth { level: node.level, centre: node.centre, kind, rotations, classes };
        Self { node: *node, classes, ancestors, birth }
    }

    /// As [`Node::child`].
    pub(crate) fn child(
        &self,
        tables: &Tables<'_>,
        digit: usize,
        tiles: u64,
        tiles_before: u64,
    ) -> Option<Self> {
        let node = self.node.child(tables, digit, tiles, tiles_before)?;
        let classes = self.classes.child(digit as u8, node.kind);
        let ancestors = [self.node.rotation, self.ancestors[0]];
        let birth = if digit == 0 {
            self.birth
        } else {
            let rotations = [node.rotation, ancestors[0], ancestors[1]];
            let (level, centre) = (node.level, node.centre);
            Birth { level, centre, kind: node.kind, rotations, classes }
        };
        Some(Self { node, classes, ancestors, birth })
    }

    /// The level at which the node's centre was born, but not before the frontier.
    pub(crate) fn born(&self) -> u8 {
        self.birth.level
    }

    /// The node's own centre, relative to the domain's least corner.
    pub(crate) fn own_centre<S: Scalar>(&self, placement: &Placement<'_>) -> [S; 2] {
        let half_edge = placement.half_edge(self.birth.level);
        Frame::new(half_edge, placement.origin(), 0).position(self.birth.centre)
    }

    /// The relation at `level` of the node's own centre, born at or above that level.
    pub(crate) fn of_own_centre(
        &self,
        tables: &Tables<'_>,
        level: u8,
    ) -> Relation<impl Fn(u32) -> u32> {
        let birth = self.birth;
        let zeros = level.saturating_sub(birth.level);
        let rotation = if zeros < 2 {
            birth.rotations[usize::from(2 - zeros)]
        } else {
            // The grandparent is on the chain of centre children.
            let mut tile = (birth.kind, birth.rotations[0]);
            for _ in 2..zeros {
                let (kind, turn) = tables.child_kinds(tile.0)[0];
                tile = (kind, (tile.1 + turn) % 12);
            }
            tile.1
        };
        // A digit 0 adds nothing to a class; past the birth, the oldest ancestor is an `a` tile.
        let class = move |generations: u32| match generations.checked_sub(zeros.into()) {
            Some(rest) => birth.classes.over(rest as usize),
            None => TileType::A as u32,
        };
        Relation { class, rotation }
    }

    /// The relation of another entry of the node's block, with rank coefficients (a, b), at `level`,
    /// one or two levels below the node.
    ///
    /// Classes obey the recurrence of the ranks, n_G in place of N_m, so the entry's coefficients give
    /// its class too: class_G = class_{G−j}(node) + A·n_{G−j} − B·n_{G−j−1}, j levels down.
    pub(crate) fn of_entry(&self, (a, b): (u16, u16), level: u8) -> Relation<impl Fn(u32) -> u32> {
        let below = u32::from(level.saturating_sub(self.node.level));
        let classes = self.classes;
        let class = move |generations: u32| {
            // Layers have at least 2 generations, and `below` is 1 or 2.
            let older = generations.saturating_sub(below) as usize;
            let count = |g: usize| class_count(g).unwrap_or(0);
            let before = if older == 0 { 1 } else { count(older - 1) };
            classes.over(older) + u32::from(a) * count(older) - u32::from(b) * before
        };
        let rotation = if below >= 2 { self.node.rotation } else { self.ancestors[0] };
        Relation { class, rotation }
    }
}
