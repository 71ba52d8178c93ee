//! How a star derives the children of its tile (the paper's missing Figure 3).
//!
//! A tile is a vertex of the square-triangle tiling; one subdivision multiplies its center by λ and
//! surrounds it with a dodecagon of new vertices. In the parent's frame, offsets in child edges, o the
//! parent's parity:
//!
//! 1. the center: type `a`, offset 0, rotation (o + 1) mod 2;
//! 2. the inner hexagon, for each j ≡ o + 1 (mod 2): type `c`, offset ζ^j, rotation j + 4;
//! 3. for each star edge k: the vertex ζ^k + ζ^(k+1); type `b`, rotation k, if k ≡ o (mod 2), otherwise
//!    type `d`, rotation k + 7. The other end of that dodecagon side, ζ^(k−1) + ζ^k, belongs to the
//!    neighbor across edge k: each tile keeps its left one, so every shared vertex has one owner;
//! 4. for each square corner (star edges k and k + 3): the vertex ζ^(k+1) + ζ^(k+2), type `d`,
//!    rotation k + 8 if k ≡ o (mod 2), otherwise k + 3.

use super::cyclotomic::Cyclotomic;
use super::tile::TileType;

/// The most children any type has.
pub const MAX_CHILDREN: usize = 14;

/// One child in its parent's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Child {
    /// The child's type.
    pub kind: TileType,
    /// Rotation relative to the parent's, in units of 30°, 0..12.
    pub rotation: u8,
    /// Center relative to λ times the parent's center, in child edges, for an unrotated parent.
    pub offset: Cyclotomic,
}

impl Child {
    /// What an unused slot holds.
    pub(super) const NONE: Self = Self { kind: TileType::A, rotation: 0, offset: Cyclotomic::ZERO };
}

/// The children of a type in derivation order: center; inner hexagon by ascending j; star edges by
/// ascending k; square corners by their first edge. The second value is how many there are.
#[must_use]
pub fn children_in_derivation_order(parent: TileType) -> ([Child; MAX_CHILDREN], usize) {
    let mut children = [Child::NONE; MAX_CHILDREN];
    let mut count = 0;
    let mut push = |kind, rotation: u8, offset| {
        children[count] = Child { kind, rotation: rotation % 12, offset };
        count += 1;
    };
    let star = parent.star();
    let parity = parent.parity();
    let sum = |j: u8, k: u8| {
        let (a, b) = (Cyclotomic::zeta_power(j.into()), Cyclotomic::zeta_power(k.into()));
        Cyclotomic(core::array::from_fn(|i| a.0[i] + b.0[i]))
    };

    push(TileType::A, (parity + 1) % 2, Cyclotomic::ZERO);
    for j in (0..12).filter(|j| j % 2 == (parity + 1) % 2) {
        push(TileType::C, j + 4, Cyclotomic::zeta_power(j.into()));
    }
    for &k in star {
        let (kind, rotation) =
            if k % 2 == parity { (TileType::B, k) } else { (TileType::D, k + 7) };
        push(kind, rotation, sum(k, k + 1));
    }
    for (i, &k) in star.iter().enumerate() {
        let next = star[(i + 1) % star.len()];
        if (next + 12 - k) % 12 == 3 {
            let rotation = if k % 2 == parity { k + 8 } else { k + 3 };
            push(TileType::D, rotation, sum(k + 1, k + 2));
        }
    }
    (children, count)
}
