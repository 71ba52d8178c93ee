//! F-codes: the address of a tile, one digit 0-9, A-D a level, newest digit leftmost.

use core::fmt;

use super::counts::MAX_LEVEL;
use super::tile::TileType;

/// A possible word of digits under a root type, at most [`MAX_LEVEL`] long. Two codes are equal when
/// root and digits are: leading zeros count, for each is a level.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct FCode {
    root: TileType,
    length: u8,
    newest_first: [u8; MAX_LEVEL],
}

/// Why a text is no F-code. Positions count characters from the left, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FCodeError {
    /// A character is none of 0-9, A-D.
    NotADigit {
        /// Where.
        position: usize,
        /// What stands there.
        found: char,
    },
    /// A D directly left of a 0: the 0 made an `a` tile, which has no D child.
    NoSuchChild {
        /// Where the D stands.
        position: usize,
    },
    /// The oldest (rightmost) digit is D, but the root is an `a` tile, which has no D child.
    NoSuchChildOfRoot {
        /// Where the D stands.
        position: usize,
    },
    /// More digits than [`MAX_LEVEL`].
    TooLong {
        /// How many there are.
        length: usize,
    },
}

impl fmt::Display for FCodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotADigit { position, found } => {
                write!(f, "position {position}: {found:?} is not a digit 0-9 or A-D")
            }
            Self::NoSuchChild { position } => write!(
                f,
                "position {position}: D left of 0 is impossible, an `a` tile has no D child"
            ),
            Self::NoSuchChildOfRoot { position } => {
                write!(f, "position {position}: D is impossible here, the root `a` has no D child")
            }
            Self::TooLong { length } => {
                write!(f, "{length} digits, but ranks fit 64 bits only through {MAX_LEVEL}")
            }
        }
    }
}

impl core::error::Error for FCodeError {}

impl FCode {
    /// Reads digits 0-9, A-D (or a-d), newest first. The empty text is the root itself.
    ///
    /// # Errors
    /// [`FCodeError`]: a text that is too long is reported first, then the first character from the
    /// left that is no digit, then the first impossible D.
    pub fn parse(root: TileType, text: &str) -> Result<Self, FCodeError> {
        let length = text.chars().count();
        if length > MAX_LEVEL {
            return Err(FCodeError::TooLong { length });
        }
        let mut newest_first = [0; MAX_LEVEL];
        for (position, found) in text.chars().enumerate() {
            newest_first[position] = found
                .to_digit(16)
                .filter(|d| *d < 14)
                .ok_or(FCodeError::NotADigit { position, found })?
                as u8;
        }
        Self::from_newest_first(root, &newest_first[..length])
    }

    /// From digits 0..14, newest first.
    ///
    /// # Errors
    /// As [`parse`](Self::parse); a number past 13 is reported as the character it would be in base 36.
    pub fn from_newest_first(root: TileType, digits: &[u8]) -> Result<Self, FCodeError> {
        if digits.len() > MAX_LEVEL {
            return Err(FCodeError::TooLong { length: digits.len() });
        }
        for (position, &digit) in digits.iter().enumerate() {
            if digit > 13 {
                let found = char::from_digit(u32::from(digit), 36).unwrap_or('?');
                return Err(FCodeError::NotADigit { position, found });
            }
            if digit == 13 {
                match digits.get(position + 1) {
                    Some(0) => return Err(FCodeError::NoSuchChild { position }),
                    None if root == TileType::A => {
                        return Err(FCodeError::NoSuchChildOfRoot { position });
                    }
                    _ => {}
                }
            }
        }
        Ok(Self::from_valid_newest_first(root, digits))
    }

    /// The caller knows that `digits` is a possible word of at most [`MAX_LEVEL`] digits.
    pub(super) fn from_valid_newest_first(root: TileType, digits: &[u8]) -> Self {
        let mut newest_first = [0; MAX_LEVEL];
        newest_first[..digits.len()].copy_from_slice(digits);
        Self { root, length: digits.len() as u8, newest_first }
    }

    /// The type of the root tile.
    #[must_use]
    pub fn root(&self) -> TileType {
        self.root
    }

    /// The digits, newest first: as the code is written.
    #[must_use]
    pub fn newest_first(&self) -> &[u8] {
        &self.newest_first[..usize::from(self.length)]
    }

    /// The digits in the order in which subdivision made them.
    pub fn oldest_first(&self) -> impl ExactSizeIterator<Item = u8> + '_ {
        self.newest_first().iter().rev().copied()
    }

    /// The level of the tile: the number of digits.
    #[must_use]
    pub fn level(&self) -> usize {
        usize::from(self.length)
    }
}

impl fmt::Display for FCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = [b'0'; MAX_LEVEL];
        for (c, digit) in text.iter_mut().zip(self.newest_first()) {
            *c = b"0123456789ABCD"[usize::from(*digit)];
        }
        f.pad(core::str::from_utf8(&text[..self.level()]).map_err(|_| fmt::Error)?)
    }
}

impl fmt::Debug for FCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{self}", self.root.letter())
    }
}
