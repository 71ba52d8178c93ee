//! The production rules (the paper's equation 1): each type's children by digit.

use super::children::{Child, MAX_CHILDREN, children_in_derivation_order};
use super::cyclotomic::OutOfRange;
use super::digits::{Digits, DigitsError};
use super::tile::{Tile, TileType};

/// Production rules with digits: the 55 entries of the paper's equation 1, with their geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// `children[parent][digit]`.
    children: [[Child; MAX_CHILDREN]; 4],
    digits: Digits,
}

impl Rules {
    /// The rules under a digit assignment.
    ///
    /// # Errors
    /// [`DigitsError`] if the assignment gives a digit twice or to a type that equation 1 forbids.
    pub fn new(digits: &Digits) -> Result<Self, DigitsError> {
        let mut children = [[Child::NONE; MAX_CHILDREN]; 4];
        for parent in TileType::ALL {
            let (derived, count) = children_in_derivation_order(parent);
            digits.check(parent, &derived[..count])?;
            for (child, digit) in derived[..count].iter().zip(digits.of(parent)) {
                children[parent.index()][usize::from(*digit)] = *child;
            }
        }
        Ok(Self { children, digits: *digits })
    }

    /// The children of `parent`, indexed by digit.
    #[must_use]
    pub fn children(&self, parent: TileType) -> &[Child] {
        &self.children[parent.index()][..parent.child_count()]
    }

    /// The digit assignment these rules were made from.
    #[must_use]
    pub fn digits(&self) -> &Digits {
        &self.digits
    }

    /// The child of `tile` with this digit, or `None` if the type has no such child.
    ///
    /// # Errors
    /// [`OutOfRange`] when the child's coordinates leave `i64`.
    pub fn child_of(&self, tile: &Tile, digit: u8) -> Result<Option<Tile>, OutOfRange> {
        let Some(child) = self.children(tile.kind).get(usize::from(digit)) else {
            return Ok(None);
        };
        let offset = child.offset.checked_rotate(tile.rotation)?;
        Ok(Some(Tile {
            kind: child.kind,
            rotation: (tile.rotation % 12 + child.rotation) % 12,
            center: tile.center.checked_mul_lambda()?.checked_add(offset)?,
        }))
    }
}
