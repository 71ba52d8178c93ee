//! Digit assignments: which child of a tile carries which of the digits 0..D.
//!
//! The paper's equation 1 fixes the digits of each child *type*; the positions are data
//! (`tables/digits.txt`).

use core::fmt;

use super::children::{Child, MAX_CHILDREN, children_in_derivation_order};
use super::tile::TileType;

/// Equation 1: `(child type, digits)` for each parent `a`, `b`, `c`, `d`.
const EQUATION_1: [[(TileType, &[u8]); 4]; 4] = [
    [
        (TileType::A, &[0]),
        (TileType::C, &[4, 5, 6, 10, 11, 12]),
        (TileType::B, &[1, 2, 3, 7, 8, 9]),
        (TileType::D, &[]),
    ],
    [
        (TileType::A, &[0]),
        (TileType::C, &[4, 5, 6, 10, 11, 12]),
        (TileType::B, &[3]),
        (TileType::D, &[1, 2, 7, 8, 9, 13]),
    ],
    [
        (TileType::A, &[0]),
        (TileType::C, &[5, 6, 7, 11, 12, 13]),
        (TileType::B, &[1, 3, 8]),
        (TileType::D, &[2, 4, 9, 10]),
    ],
    [
        (TileType::A, &[0]),
        (TileType::C, &[4, 5, 6, 10, 11, 12]),
        (TileType::B, &[3, 9]),
        (TileType::D, &[1, 2, 7, 8, 13]),
    ],
];

/// The digits that equation 1 allows for children of type `child` under `parent`.
#[must_use]
pub fn allowed_digits(parent: TileType, child: TileType) -> &'static [u8] {
    EQUATION_1[parent.index()]
        .iter()
        .find(|(kind, _)| *kind == child)
        .map_or(&[], |(_, digits)| digits)
}

/// A digit for each child of each type, in the derivation order of
/// [`children_in_derivation_order`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digits([[u8; MAX_CHILDREN]; 4]);

/// What is wrong with a digit assignment, and where. Lines count from 1; line 0 stands for an
/// assignment that did not come from a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DigitsError {
    /// A line does not begin with one of `a:`, `b:`, `c:`, `d:`.
    UnknownParent {
        /// The line.
        line: usize,
    },
    /// A parent has two lines.
    RepeatedParent {
        /// The second line.
        line: usize,
        /// The parent.
        parent: TileType,
    },
    /// A parent has no line.
    MissingParent {
        /// The parent.
        parent: TileType,
    },
    /// Something other than a digit 0-9, A-D stands where a digit should.
    NotADigit {
        /// The line.
        line: usize,
        /// The column, from 1.
        column: usize,
    },
    /// A group between bars has too few or too many digits.
    GroupLength {
        /// The line.
        line: usize,
        /// The group, from 0: center, inner hexagon, star edges, square corners.
        group: usize,
        /// How many digits the geometry asks for.
        expected: usize,
        /// How many were there.
        found: usize,
    },
    /// Two children of one parent have the same digit.
    RepeatedDigit {
        /// The line.
        line: usize,
        /// The parent.
        parent: TileType,
        /// The digit, 0..14.
        digit: u8,
    },
    /// Equation 1 gives this digit to another type of child.
    WrongType {
        /// The line.
        line: usize,
        /// The parent.
        parent: TileType,
        /// The digit, 0..14.
        digit: u8,
        /// The type of the child that carries it here.
        child: TileType,
    },
}

impl fmt::Display for DigitsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hex = |digit: &u8| {
            char::from_digit(u32::from(*digit), 16).unwrap_or('?').to_ascii_uppercase()
        };
        match self {
            Self::UnknownParent { line } => {
                write!(
                    f,
                    "line {line}: a rule begins with a tile type and a colon, as in `a: 0 | …`"
                )
            }
            Self::RepeatedParent { line, parent } => {
                write!(f, "line {line}: tile type {} has a second rule", parent.letter())
            }
            Self::MissingParent { parent } => {
                write!(f, "tile type {} has no rule", parent.letter())
            }
            Self::NotADigit { line, column } => {
                write!(f, "line {line}, column {column}: not a digit 0-9 or A-D")
            }
            Self::GroupLength { line, group, expected, found } => {
                let name = ["center", "inner hexagon", "star edges", "square corners"]
                    .get(*group)
                    .unwrap_or(&"past the square corners");
                write!(
                    f,
                    "line {line}: group {} ({name}) needs {expected} digits, found {found}",
                    group + 1
                )
            }
            Self::RepeatedDigit { line, parent, digit } => {
                write!(
                    f,
                    "line {line}: digit {} stands twice under tile type {}",
                    hex(digit),
                    parent.letter()
                )
            }
            Self::WrongType { line, parent, digit, child } => write!(
                f,
                "line {line}: equation 1 does not give digit {} of parent {} to a child of type {}",
                hex(digit),
                parent.letter(),
                child.letter()
            ),
        }
    }
}

impl core::error::Error for DigitsError {}

impl Digits {
    /// From digits in derivation order, `digits[parent]`; entries past a type's child count are taken
    /// as 0. Checked when [`Rules`](super::Rules) are made from it.
    #[must_use]
    pub fn from_derivation_order(mut digits: [[u8; MAX_CHILDREN]; 4]) -> Self {
        for parent in TileType::ALL {
            digits[parent.index()][parent.child_count()..].fill(0);
        }
        Self(digits)
    }

    /// A row a parent, in derivation order; entries past a type's child count are 0.
    #[must_use]
    pub const fn derivation_order(&self) -> [[u8; MAX_CHILDREN]; 4] {
        self.0
    }

    /// The digits of the children of `parent`, in derivation order.
    #[must_use]
    pub fn of(&self, parent: TileType) -> &[u8] {
        &self.0[parent.index()][..parent.child_count()]
    }

    /// Reads the format of `tables/digits.txt`: a line a parent, `a: 0 | … | … | …`; `#` begins a
    /// comment.
    ///
    /// # Errors
    /// [`DigitsError`], with the line, for anything that is not a complete assignment in agreement
    /// with equation 1.
    pub fn parse(text: &str) -> Result<Self, DigitsError> {
        let mut digits = [[0; MAX_CHILDREN]; 4];
        let mut line_of = [0usize; 4];
        for (index, full_line) in text.lines().enumerate() {
            let line = index + 1;
            let rule = full_line.split('#').next().unwrap_or_default();
            if rule.trim().is_empty() {
                continue;
            }
            let (name, groups) = rule.split_once(':').ok_or(DigitsError::UnknownParent { line })?;
            let mut letters = name.trim().chars();
            let parent = letters
                .next()
                .filter(|_| letters.next().is_none())
                .and_then(TileType::from_letter)
                .ok_or(DigitsError::UnknownParent { line })?;
            if line_of[parent.index()] != 0 {
                return Err(DigitsError::RepeatedParent { line, parent });
            }
            line_of[parent.index()] = line;
            digits[parent.index()] = parse_groups(parent, line, name.chars().count() + 2, groups)?;
        }
        let digits = Self(digits);
        for parent in TileType::ALL {
            let line = line_of[parent.index()];
            if line == 0 {
                return Err(DigitsError::MissingParent { parent });
            }
            let (children, count) = children_in_derivation_order(parent);
            digits.check_at(line, parent, &children[..count])?;
        }
        Ok(digits)
    }

    /// Whether the digits of `parent` are distinct and agree with equation 1.
    pub(super) fn check(&self, parent: TileType, children: &[Child]) -> Result<(), DigitsError> {
        self.check_at(0, parent, children)
    }

    fn check_at(
        &self,
        line: usize,
        parent: TileType,
        children: &[Child],
    ) -> Result<(), DigitsError> {
        let mut seen = [false; MAX_CHILDREN];
        for (child, &digit) in children.iter().zip(self.of(parent)) {
            if !allowed_digits(parent, child.kind).contains(&digit) {
                return Err(DigitsError::WrongType { line, parent, digit, child: child.kind });
            }
            if core::mem::replace(&mut seen[usize::from(digit)], true) {
                return Err(DigitsError::RepeatedDigit { line, parent, digit });
            }
        }
        Ok(())
    }
}

/// The four groups of one line; `first_column` is the column of the first character after the colon.
fn parse_groups(
    parent: TileType,
    line: usize,
    first_column: usize,
    groups: &str,
) -> Result<[u8; MAX_CHILDREN], DigitsError> {
    let star_edges = parent.star().len();
    let square_corners = parent.child_count() - 1 - 6 - star_edges;
    let lengths = [1, 6, star_edges, square_corners];
    let mut digits = [0; MAX_CHILDREN];
    let mut count = 0;
    let mut column = first_column;
    let mut groups_found = 0;
    for (group, part) in groups.split('|').enumerate() {
        let expected = lengths.get(group).copied().unwrap_or(0);
        let found = part.chars().filter(|c| !c.is_whitespace()).count();
        for c in part.chars() {
            if !c.is_whitespace() {
                let digit = c.to_digit(16).filter(|digit| *digit < 14);
                let digit = digit.ok_or(DigitsError::NotADigit { line, column })?;
                if found == expected {
                    digits[count] = digit as u8;
                    count += 1;
                }
            }
            column += 1;
        }
        if found != expected {
            return Err(DigitsError::GroupLength { line, group, expected, found });
        }
        column += 1; // the bar
        groups_found = group + 1;
    }
    // The last group may be left out with its bar where the type has no square corners.
    match lengths.iter().enumerate().skip(groups_found).find(|(_, length)| **length != 0) {
        Some((group, &expected)) => {
            Err(DigitsError::GroupLength { line, group, expected, found: 0 })
        }
        None => Ok(digits),
    }
}
