//! Tile types and the stars that define them.

use super::cyclotomic::Cyclotomic;

/// The four tile types, each the dual cell of a vertex of the square-triangle tiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum TileType {
    /// Hexagon, vertex configuration 3⁶.
    A = 0,
    /// Pentagon, vertex configuration 3³·4².
    B = 1,
    /// Pentagon, vertex configuration 3²·4·3·4, parity 0.
    C = 2,
    /// Pentagon, vertex configuration 3²·4·3·4, parity 1.
    D = 3,
}

impl TileType {
    /// All types, in the order of their discriminants.
    pub const ALL: [Self; 4] = [Self::A, Self::B, Self::C, Self::D];

    /// 0 for `a` … 3 for `d`.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The paper's letter, `'a'` … `'d'`.
    #[must_use]
    pub const fn letter(self) -> char {
        ['a', 'b', 'c', 'd'][self as usize]
    }

    /// The type with this letter.
    #[must_use]
    pub const fn from_letter(letter: char) -> Option<Self> {
        Some(match letter {
            'a' => Self::A,
            'b' => Self::B,
            'c' => Self::C,
            'd' => Self::D,
            _ => return None,
        })
    }

    /// Directions k·30° of the edges of the square-triangle tiling at this vertex, ascending, in the
    /// tile's own frame. Neighboring directions 2 apart span a triangle, 3 apart a square.
    #[must_use]
    pub const fn star(self) -> &'static [u8] {
        match self {
            Self::A => &[0, 2, 4, 6, 8, 10],
            Self::B => &[0, 2, 4, 6, 9],
            Self::C | Self::D => &[0, 2, 4, 7, 9],
        }
    }

    /// The parity of the tile's frame. At one level every tile's `parity + rotation` agrees modulo 2,
    /// and it flips at each subdivision.
    #[must_use]
    pub const fn parity(self) -> u8 {
        match self {
            Self::A | Self::C => 0,
            Self::B | Self::D => 1,
        }
    }

    /// Number of children: 13 for `a`, 14 for the pentagons.
    #[must_use]
    pub const fn child_count(self) -> usize {
        match self {
            Self::A => 13,
            _ => 14,
        }
    }

    /// The area of the tile's cell in squared edges, as (p, q) with area = (p + q√3)/4: √3/2 for the
    /// hexagon, (2 + √3)/4 for each pentagon.
    #[must_use]
    pub const fn area(self) -> (i64, i64) {
        match self {
            Self::A => (0, 2),
            _ => (2, 1),
        }
    }
}

/// A tile of one level: type, rotation in multiples of 30° (0..12), and exact center in edges of its
/// own level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tile {
    /// The type.
    pub kind: TileType,
    /// Counter-clockwise rotation of the tile's frame, in units of 30°, 0..12.
    pub rotation: u8,
    /// The center, in edges of the tile's level, relative to the root's center.
    pub center: Cyclotomic,
}

impl Tile {
    /// The root tile of the given type: unrotated, at the origin.
    #[must_use]
    pub const fn root(kind: TileType) -> Self {
        Self { kind, rotation: 0, center: Cyclotomic::ZERO }
    }
}
