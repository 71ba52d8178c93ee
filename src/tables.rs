//! Baked tables: typed views of the bytes that `build.rs` or [`bake`](crate::bake::bake) wrote.

use core::fmt;

use crate::bake::relaxation::{Relaxation, RelaxationError};
use crate::bake::wire::{self, BlockBytes, Document};
use crate::bake::{self, MAX_DEPTH};
use crate::relaxed::RelaxationTable;
use crate::tiling::subdivide::MAX_CHILDREN;
use crate::tiling::{Digits, DigitsError, MAX_LEVEL, Rules, TileType};
use crate::walk::node::ExactPoint;

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
    Relaxation(RelaxationError),
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
            Self::Relaxation(error) => write!(f, "relaxed offsets: {error}"),
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
    relaxation: Option<RelaxationTable<'a>>,
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
        let document =
            wire::without_checksum(bytes).ok_or(TablesError::Truncated { length: bytes.len() })?;
        if !document.starts_with(&wire::MAGIC) {
            return Err(TablesError::NotATableFile);
        }
        if !wire::is_intact(bytes) {
            return Err(TablesError::Checksum);
        }
        let tables = Self::view(bytes)?;
        let rules = Rules::new(&tables.digits).map_err(TablesError::Digits)?;
        let relaxation = tables
            .relaxation
            .map(|table| table.to_relaxation(tables.digits))
            .transpose()
            .map_err(TablesError::Relaxation)?;
        let baked = bake::bake(&rules, tables.depth, relaxation.as_ref())
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
        let document =
            wire::without_checksum(bytes).ok_or(TablesError::Truncated { length: bytes.len() })?;
        let Document { magic: _, version, depth, digits, children, blocks, provenance, layers } =
            wire::decode(document).ok_or(TablesError::Malformed)?;
        if version != wire::VERSION {
            return Err(TablesError::Version { found: version, expected: wire::VERSION });
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
        let relaxation = RelaxationTable::new(provenance, &layers).ok_or(TablesError::Malformed)?;
        Ok(Self { bytes, depth, digits, relaxation, child_kinds, blocks: [a?, b?, c?, d?] })
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
    pub fn relaxation(&self) -> Option<&RelaxationTable<'a>> {
        self.relaxation.as_ref()
    }

    /// The relaxed offsets decoded, as [`bake`](crate::bake::bake) takes them for tables of another
    /// depth. `None` if these tables have none.
    #[must_use]
    pub fn to_relaxation(&self) -> Option<Relaxation> {
        // `from_bytes` and build.rs have checked the offsets.
        self.relaxation?.to_relaxation(self.digits).ok()
    }

    /// The block of a type.
    #[must_use]
    pub fn block(&self, kind: TileType) -> &BlockTable<'a> {
        &self.blocks[kind.index()]
    }
}

/// Offsets of a block in one orientation: for each entry (u, v, p, q), meaning the point
/// ((u + v√3)/2, (p + q√3)/2) in edges of the level of its birth. Bytes are little-endian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offsets<'a> {
    pub(crate) u: &'a [[u8; 2]],
    pub(crate) v: &'a [[u8; 2]],
    pub(crate) p: &'a [[u8; 2]],
    pub(crate) q: &'a [[u8; 2]],
}

/// The baked descendants of one tile type, in the order of their ranks.
#[derive(Clone, Copy, Debug)]
pub struct BlockTable<'a> {
    bytes: BlockBytes<'a>,
    /// `born_before[j]`: how many entries are born fewer than j levels down.
    born_before: [u32; MAX_DEPTH as usize + 2],
    rank_a: &'a [[u8; 2]],
    rank_b: &'a [[u8; 2]],
    thresholds: &'a [[u8; 4]],
    /// Empty below depth 3.
    turns: &'a [u8],
    classes: &'a [[u8; 2]],
    offsets: [Offsets<'a>; 3],
}

impl<'a> BlockTable<'a> {
    fn new(bytes: BlockBytes<'a>, kind: TileType, depth: u8) -> Option<Self> {
        let counts = crate::tiling::TileCounts::of(kind);
        let mut born_before = [0; MAX_DEPTH as usize + 2];
        for j in 0..=usize::from(depth) {
            born_before[j + 1] = u32::try_from(counts.at(j).ok()?).ok()?;
        }
        let entries = born_before[usize::from(depth) + 1] as usize;
        let pairs = |column: &'a [u8]| {
            let (pairs, rest) = column.as_chunks::<2>();
            (rest.is_empty() && pairs.len() == entries).then_some(pairs)
        };
        let [Some(even), Some(turned_30), Some(turned_60)] = bytes.offsets.map(|[u, v, p, q]| {
            Some(Offsets { u: pairs(u)?, v: pairs(v)?, p: pairs(p)?, q: pairs(q)? })
        }) else {
            return None;
        };
        let (thresholds, rest) = bytes.thresholds.as_chunks::<4>();
        (rest.is_empty() && thresholds.len() == entries).then_some(())?;
        let (classes, rest) = bytes.classes.as_chunks::<2>();
        let thirds = if depth < 3 { 0 } else { born_before[4] as usize };
        let fitting = bytes.turns.len() == thirds && classes.len() == thirds && rest.is_empty();
        fitting.then_some(())?;
        Some(Self {
            bytes,
            born_before,
            rank_a: pairs(bytes.rank_a)?,
            rank_b: pairs(bytes.rank_b)?,
            thresholds,
            turns: bytes.turns,
            classes,
            offsets: [even, turned_30, turned_60],
        })
    }

    /// The number of entries: descendants down to the baked depth, the tile itself included.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a block is never empty")]
    pub fn len(&self) -> usize {
        self.rank_a.len()
    }

    /// How many entries are born fewer than `levels` levels down; `levels` ≤ depth + 1.
    #[must_use]
    pub(crate) fn born_before(&self, levels: usize) -> usize {
        self.born_before[levels] as usize
    }

    /// (A, B) of entry `i`: its rank is r + A·N_m − B·N_{m−1}. `i` < [`len`](Self::len).
    pub(crate) fn rank_coefficients(&self, i: usize) -> (u16, u16) {
        (u16::from_le_bytes(self.rank_a[i]), u16::from_le_bytes(self.rank_b[i]))
    }

    /// [`rank_coefficients`](Self::rank_coefficients) of a run of entries.
    pub(crate) fn rank_coefficients_of(
        &self,
        range: core::ops::Range<usize>,
    ) -> impl Iterator<Item = (u16, u16)> + 'a {
        let number = |bytes: &[u8; 2]| u16::from_le_bytes(*bytes);
        self.rank_a[range.clone()]
            .iter()
            .zip(&self.rank_b[range])
            .map(move |(a, b)| (number(a), number(b)))
    }

    /// Of the entries born at most three levels down, as they are there: the rotation of their ancestor
    /// one level down, relative to the block, and their class over two generations. None below
    /// depth 3.
    pub(crate) fn thirds(&self) -> impl ExactSizeIterator<Item = (u8, u16)> + 'a {
        self.turns.iter().zip(self.classes).map(|(turn, class)| (*turn, u16::from_le_bytes(*class)))
    }

    /// Of entry `i` among the [`thirds`](Self::thirds); zeros past them.
    #[inline(always)]
    pub(crate) fn third(&self, i: usize) -> (u8, u16) {
        match (self.turns.get(i), self.classes.get(i)) {
            (Some(turn), Some(class)) => (*turn, u16::from_le_bytes(*class)),
            _ => (0, 0),
        }
    }

    /// The offset of entry `i` < [`len`](Self::len), turned by `turn`·30°, `turn` in 0..3.
    pub(crate) fn offset(&self, turn: usize, i: usize) -> ExactPoint {
        let Offsets { u, v, p, q } = self.offsets[turn];
        let field = |column: &[[u8; 2]]| i32::from(i16::from_le_bytes(column[i]));
        ExactPoint { u: field(u), v: field(v), p: field(p), q: field(q) }
    }

    /// The normalized thresholds of the entries, ascending, in [0, 1): each entry's place among the
    /// points of the block.
    pub fn thresholds(&self) -> impl ExactSizeIterator<Item = f32> + 'a {
        self.thresholds.iter().map(|bytes| f32::from_le_bytes(*bytes))
    }

    /// Offsets turned by `turn`·30°, `turn` in 0..3.
    #[must_use]
    pub(crate) fn offsets(&self, turn: usize) -> &Offsets<'a> {
        &self.offsets[turn]
    }
}
