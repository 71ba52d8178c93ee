//! Baked tables: typed views of the bytes that `build.rs` or [`bake`](crate::bake::bake) wrote.

mod block;
pub(crate) mod displacement;
mod exact;

use core::fmt;

use crate::bake::displacement::{DisplacementError, Displacements};
use crate::bake::format::{self, Document};
use crate::bake::{self, MAX_DEPTH};
use crate::tiling::children::MAX_CHILDREN;
use crate::tiling::{Digits, DigitsError, MAX_LEVEL, Rules, TileType};

pub use block::BlockTable;
pub(crate) use block::Offsets;
pub use displacement::DisplacementTable;
pub(crate) use exact::{ExactPoint, QUARTERS};

/// The bytes baked when this crate was built. The only reader of `OUT_DIR`.
static BUILT_IN: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/tables.bin"));

/// Why bytes are not a table file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TablesError {
    /// Too short to hold even a checksum.
    Truncated {
        /// The number of bytes.
        length: usize,
    },
    /// The bytes do not begin as a table file does.
    NotATableFile,
    /// A version that this build does not read.
    Version {
        /// The version found.
        found: u16,
        /// The version expected.
        expected: u16,
    },
    /// The checksum does not match: a byte was changed, lost or added.
    Checksum,
    /// The checksum matches, but the bytes are not one whole document.
    Malformed,
    /// The depth is not in 1..=[`MAX_DEPTH`].
    Depth {
        /// The depth found.
        depth: u8,
    },
    /// The relaxed offsets break a rule.
    Displacements(DisplacementError),
    /// The digit assignment breaks a rule.
    Digits(DigitsError),
    /// The blocks of this type are not what the digits and the depth make.
    Block {
        /// The type.
        kind: TileType,
    },
}

impl fmt::Display for TablesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated { length } => write!(f, "{length} bytes are too few for a table file"),
            Self::NotATableFile => f.write_str("not a twelvefold table file"),
            Self::Version { found, expected } => {
                write!(f, "table format version {found}, this build reads {expected}")
            }
            Self::Checksum => f.write_str("checksum mismatch: the table file is damaged"),
            Self::Malformed => f.write_str("the table file is not one whole document"),
            Self::Depth { depth } => {
                write!(f, "baked depth {depth} is not between 1 and {MAX_DEPTH}")
            }
            Self::Displacements(error) => write!(f, "relaxed offsets: {error}"),
            Self::Digits(error) => write!(f, "digit assignment: {error}"),
            Self::Block { kind } => {
                write!(f, "the block of type {} does not follow from the rules", kind.letter())
            }
        }
    }
}

impl core::error::Error for TablesError {}

/// Tables ready for use: rules, and one [`BlockTable`] a tile type. Cheap to copy; borrows its bytes.
#[derive(Clone, Copy, Debug)]
pub struct Tables<'a> {
    bytes: &'a [u8],
    depth: u8,
    digits: Digits,
    displacements: Option<DisplacementTable<'a>>,
    /// Type and rotation of each child, by parent type and digit.
    child_kinds: [[(TileType, u8); MAX_CHILDREN]; 4],
    blocks: [BlockTable<'a>; 4],
}

impl Tables<'static> {
    /// The tables baked into this build. Under a microsecond; nothing is copied or checked again.
    #[must_use]
    pub fn built_in() -> Self {
        // build.rs wrote these bytes with the same encoder, and a test loads them the checked way.
        Self::view(BUILT_IN).unwrap_or_else(|_| unreachable!("the build baked unreadable tables"))
    }
}

impl<'a> Tables<'a> {
    /// Tables from the bytes of a table file, checked completely: the checksum, the layout, the rules,
    /// and that every entry is what the rules and the depth make.
    ///
    /// Costs as much as baking anew: below 1 ms at depth 3.
    ///
    /// # Errors
    /// [`TablesError`] for anything that [`bake`](crate::bake::bake) would not have written: a changed,
    /// missing or added byte included.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, TablesError> {
        let document = format::without_checksum(bytes)
            .ok_or(TablesError::Truncated { length: bytes.len() })?;
        if !document.starts_with(&format::MAGIC) {
            return Err(TablesError::NotATableFile);
        }
        if !format::is_intact(bytes) {
            return Err(TablesError::Checksum);
        }
        let tables = Self::view(bytes)?;
        let rules = Rules::new(&tables.digits).map_err(TablesError::Digits)?;
        let displacements = tables
            .displacements
            .map(|table| table.to_relaxation(tables.digits))
            .transpose()
            .map_err(TablesError::Displacements)?;
        let baked = bake::bake(&rules, tables.depth, displacements.as_ref())
            .map_err(|_| TablesError::Malformed)?;
        if baked != bytes {
            let expected = Tables::view(&baked)?;
            for kind in TileType::ALL {
                if expected.blocks[kind.index()].bytes != tables.blocks[kind.index()].bytes {
                    return Err(TablesError::Block { kind });
                }
            }
            return Err(TablesError::Malformed);
        }
        Ok(tables)
    }

    /// Everything but the checksum and the comparison with the rules.
    fn view(bytes: &'a [u8]) -> Result<Self, TablesError> {
        let document = format::without_checksum(bytes)
            .ok_or(TablesError::Truncated { length: bytes.len() })?;
        let Document { magic: _, version, depth, digits, children, blocks, provenance, layers } =
            format::decode(document).ok_or(TablesError::Malformed)?;
        if version != format::VERSION {
            return Err(TablesError::Version { found: version, expected: format::VERSION });
        }
        if !(1..=MAX_DEPTH).contains(&depth) {
            return Err(TablesError::Depth { depth });
        }
        let [a, b, c, d] = TileType::ALL.map(|kind| {
            BlockTable::new(blocks[kind.index()], kind, depth).ok_or(TablesError::Block { kind })
        });
        let mut child_kinds = [[(TileType::A, 0); MAX_CHILDREN]; 4];
        for (kinds, row) in child_kinds.iter_mut().zip(children) {
            for (kind, (index, rotation)) in kinds.iter_mut().zip(row) {
                let child = TileType::ALL.get(usize::from(index)).ok_or(TablesError::Malformed)?;
                *kind = (*child, rotation % 12);
            }
        }
        let digits = Digits::from_derivation_order(digits);
        let displacements = DisplacementTable::new(provenance, &layers)?;
        Ok(Self { bytes, depth, digits, displacements, child_kinds, blocks: [a?, b?, c?, d?] })
    }

    /// The bytes of the table file.
    #[must_use]
    pub fn as_bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// How many levels a block holds, 1..=4.
    #[must_use]
    pub fn depth(&self) -> u8 {
        self.depth
    }

    /// The deepest level whose ranks exist, counted from the root.
    #[must_use]
    pub fn levels(&self) -> usize {
        MAX_LEVEL
    }

    /// The production rules with their digits. Derived anew, some microseconds.
    #[must_use]
    pub fn rules(&self) -> Rules {
        // `from_bytes` and build.rs have checked the digits.
        Rules::new(&self.digits).unwrap_or_else(|_| unreachable!("tables with unchecked digits"))
    }

    /// Type and relative rotation of each child, by digit.
    pub(crate) fn child_kinds(&self, parent: TileType) -> &[(TileType, u8)] {
        &self.child_kinds[parent.index()][..parent.child_count()]
    }

    /// The relaxed offsets, if these tables have any.
    #[must_use]
    pub fn displacements(&self) -> Option<&DisplacementTable<'a>> {
        self.displacements.as_ref()
    }

    /// The relaxed offsets decoded, as [`bake`](crate::bake::bake) takes them for tables of another
    /// depth. `None` if these tables have none.
    #[must_use]
    pub fn to_relaxation(&self) -> Option<Displacements> {
        // `from_bytes` and build.rs have checked the offsets.
        self.displacements?.to_relaxation(self.digits).ok()
    }

    /// The block of a type.
    #[must_use]
    pub fn block(&self, kind: TileType) -> &BlockTable<'a> {
        &self.blocks[kind.index()]
    }
}
