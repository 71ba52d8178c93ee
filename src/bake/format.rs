//! The bytes of a table file.
//!
//! A bincode 2 document (fixed-width integers, little-endian) followed by its CRC-32. Numbers that the
//! walk reads in bulk are byte strings of little-endian values, one array a field, so that they are
//! used where they lie: nothing is decoded or copied when a program starts.

use alloc::vec::Vec;

use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use serde::{Deserialize, Serialize};

use super::block::Block;
use super::displacement::{Displacements, Layer, Slot};
use super::error::BakeError;
use crate::tiling::{Rules, TileType};

/// First bytes of every table file.
pub(crate) const MAGIC: [u8; 8] = *b"12fold\r\n";

/// Format version, raised by every change of layout or meaning.
pub(crate) const VERSION: u16 = 4;

/// Largest document that is looked at: depth 4 needs 5.3 MB, and room is left for relaxed offsets.
const MAX_BYTES: usize = 1 << 26;

/// Length of the checksum at the end.
const CRC_BYTES: usize = 4;

fn config() -> Configuration<LittleEndian, Fixint, Limit<MAX_BYTES>> {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<MAX_BYTES>()
}

/// The document.
#[derive(Serialize, Deserialize, Debug, PartialEq)]
pub(crate) struct Document<'a> {
    pub(crate) magic: [u8; 8],
    pub(crate) version: u16,
    pub(crate) depth: u8,
    /// The digit assignment, a row a parent type, in derivation order.
    pub(crate) digits: [[u8; 14]; 4],
    /// (type, rotation in units of 30°) of each child, a row a parent type, by digit; 0 past the last.
    pub(crate) children: [[(u8, u8); 14]; 4],
    #[serde(borrow)]
    pub(crate) blocks: [BlockBytes<'a>; 4],
    /// How the relaxed offsets were made; empty when there are none.
    pub(crate) provenance: &'a str,
    /// The smooth and the rough layer of relaxed offsets. A layer without slots is absent.
    #[serde(borrow)]
    pub(crate) layers: [LayerBytes<'a>; 2],
}

/// One layer of relaxed offsets.
#[derive(Serialize, Deserialize, Debug, PartialEq, Clone, Copy, Default)]
pub(crate) struct LayerBytes<'a> {
    /// A bound on the length of every vector, in edges of a point's level.
    pub(crate) longest: f64,
    /// A record a slot of the density phase, see [`slot_record`].
    pub(crate) slots: &'a [u8],
    /// All slots' vectors, i8 pairs, in the order of their classes.
    pub(crate) vectors: &'a [u8],
    /// Where the search for a phase's slot starts, u16, see [`Layer::phases`].
    pub(crate) phases: &'a [u8],
}

/// Bytes of a slot's record.
pub(crate) const SLOT_BYTES: usize = 20;

/// τ (f32), 1/(τ of the next slot − τ) (f32), scale (f32), index of the first vector (u32), generations ·
/// 2²⁴ + number of vectors (u32).
fn slot_record(slot: &Slot, per_phase: f32, start: usize) -> Result<[u8; SLOT_BYTES], BakeError> {
    let number = |n: usize| u32::try_from(n).map_err(|_| BakeError::Range);
    let count = number(slot.vectors.len())?;
    if count >> 24 != 0 {
        return Err(BakeError::Range);
    }
    let fields = [
        slot.tau.to_le_bytes(),
        per_phase.to_le_bytes(),
        slot.scale.to_le_bytes(),
        number(start)?.to_le_bytes(),
        (u32::from(slot.generations) << 24 | count).to_le_bytes(),
    ];
    let mut record = [0; SLOT_BYTES];
    for (bytes, field) in record.chunks_exact_mut(4).zip(fields) {
        bytes.copy_from_slice(&field);
    }
    Ok(record)
}

/// Owned arrays from which a layer's bytes borrow.
struct LayerColumns {
    longest: f64,
    slots: Vec<u8>,
    vectors: Vec<u8>,
    phases: Vec<u8>,
}

impl LayerColumns {
    fn new(layer: &Layer) -> Result<Self, BakeError> {
        let (mut slots, mut vectors, mut longest) = (Vec::new(), Vec::new(), 0.0f64);
        for (i, slot) in layer.slots().iter().enumerate() {
            slots.extend(slot_record(slot, layer.per_phase(i), vectors.len() / 2)?);
            vectors.extend(slot.vectors.iter().flatten().map(|component| *component as u8));
            longest = longest.max(slot.longest());
        }
        let phases = layer.phases().flat_map(u16::to_le_bytes).collect();
        Ok(Self { longest, slots, vectors, phases })
    }

    fn as_bytes(&self) -> LayerBytes<'_> {
        let Self { longest, slots, vectors, phases } = self;
        LayerBytes { longest: *longest, slots, vectors, phases }
    }
}

/// One type's block. Each field is an array of little-endian values, one an entry.
#[derive(Serialize, Deserialize, Debug, PartialEq, Eq, Clone, Copy)]
pub(crate) struct BlockBytes<'a> {
    /// A of the rank, u16.
    pub(crate) rank_a: &'a [u8],
    /// B of the rank, u16.
    pub(crate) rank_b: &'a [u8],
    /// Normalized thresholds, f32.
    pub(crate) thresholds: &'a [u8],
    /// At depth 3 and more, of the entries born at most three levels down, as they are there: how
    /// their ancestor one level down is turned, in units of 30°, and their class over two generations,
    /// u16.
    pub(crate) turns: &'a [u8],
    pub(crate) classes: &'a [u8],
    /// Offsets turned by 0°, 30° and 60° (quarter turns are applied exactly at run time): for each
    /// the four fields u, v, p, q of (u + v√3)/2, (p + q√3)/2, i16, one array a field.
    #[serde(borrow)]
    pub(crate) offsets: [[&'a [u8]; 4]; 3],
}

/// Owned arrays from which the document borrows.
struct BlockColumns {
    rank_a: Vec<u8>,
    rank_b: Vec<u8>,
    thresholds: Vec<u8>,
    turns: Vec<u8>,
    classes: Vec<u8>,
    offsets: [[Vec<u8>; 4]; 3],
}

impl BlockColumns {
    fn new(block: &Block, depth: u8) -> Result<Self, BakeError> {
        let entries = block.entries();
        let mut offsets: [[Vec<u8>; 4]; 3] = Default::default();
        for (rotation, columns) in (0..3).zip(&mut offsets) {
            for entry in entries {
                for (column, field) in columns.iter_mut().zip(entry.turned(rotation)?) {
                    column.extend(field.to_le_bytes());
                }
            }
        }
        Ok(Self {
            rank_a: entries.iter().flat_map(|e| e.rank_a.to_le_bytes()).collect(),
            rank_b: entries.iter().flat_map(|e| e.rank_b.to_le_bytes()).collect(),
            thresholds: entries.iter().flat_map(|e| e.threshold(depth).to_le_bytes()).collect(),
            turns: block.relax_keys().iter().map(|third| third.turn).collect(),
            classes: block
                .relax_keys()
                .iter()
                .flat_map(|third| third.class.to_le_bytes())
                .collect(),
            offsets,
        })
    }

    fn as_bytes(&self) -> BlockBytes<'_> {
        BlockBytes {
            rank_a: &self.rank_a,
            rank_b: &self.rank_b,
            thresholds: &self.thresholds,
            turns: &self.turns,
            classes: &self.classes,
            offsets: self.offsets.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice)),
        }
    }
}

/// Encodes the rules, their blocks of the given depth, and relaxed offsets.
pub(crate) fn encode(
    rules: &Rules,
    depth: u8,
    blocks: &[Block; 4],
    displacements: Option<&Displacements>,
) -> Result<Vec<u8>, BakeError> {
    let [a, b, c, d] = blocks.each_ref().map(|block| BlockColumns::new(block, depth));
    let columns = [a?, b?, c?, d?];
    let mut children = [[(0, 0); 14]; 4];
    for (row, parent) in children.iter_mut().zip(TileType::ALL) {
        for (slot, child) in row.iter_mut().zip(rules.children(parent)) {
            *slot = (child.kind as u8, child.rotation);
        }
    }
    let smooth =
        displacements.map(|displacements| LayerColumns::new(&displacements.smooth)).transpose()?;
    let rough = displacements.and_then(|r| r.rough.as_ref()).map(LayerColumns::new).transpose()?;
    let layers = [smooth, rough];
    let document = Document {
        magic: MAGIC,
        version: VERSION,
        depth,
        digits: rules.digits().derivation_order(),
        children,
        blocks: columns.each_ref().map(BlockColumns::as_bytes),
        provenance: displacements.map_or("", |displacements| &displacements.provenance),
        layers: layers
            .each_ref()
            .map(|layer| layer.as_ref().map_or_else(LayerBytes::default, LayerColumns::as_bytes)),
    };
    let mut bytes =
        bincode::serde::encode_to_vec(&document, config()).map_err(|_| BakeError::Range)?;
    bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
    Ok(bytes)
}

/// The document's bytes, without the checksum at the end.
pub(crate) fn without_checksum(bytes: &[u8]) -> Option<&[u8]> {
    bytes.get(..bytes.len().checked_sub(CRC_BYTES)?)
}

/// Whether the checksum at the end is that of the document before it.
pub(crate) fn is_intact(bytes: &[u8]) -> bool {
    without_checksum(bytes)
        .is_some_and(|document| bytes[document.len()..] == crc32fast::hash(document).to_le_bytes())
}

/// Decodes a document without its checksum, borrowing its arrays. `None` when the bytes are no
/// document or go on after it.
pub(crate) fn decode(document: &[u8]) -> Option<Document<'_>> {
    let (decoded, length) = bincode::serde::borrow_decode_from_slice(document, config()).ok()?;
    (length == document.len()).then_some(decoded)
}
