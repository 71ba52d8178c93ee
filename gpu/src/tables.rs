//! The words of the table buffer: what placements share, and the texels' borders.

use twelvefold::bake::displacement::Layer;
use twelvefold::export;
use twelvefold::tiling::{TileCounts, TileType};
use twelvefold::{Placement, Tables};

use crate::error::GpuError;
use crate::tiles::turned_edges;

/// Levels that a block holds.
pub(crate) const LEVELS: u8 = 3;

/// Words before the entries: the first entry of each type, how many entries of each are born fewer than
/// 1, 2, 3, 4 levels down, and the children of each, type | rotation << 2.
const HEADER: usize = 4 + 16 + 56;

/// Intervals of the density phase at which the search for a slot starts: 1024 an octave of [1, 16).
const PHASES: u32 = 4096;

/// The buffer's words, and where its parts begin.
#[derive(Clone, Debug, Default)]
pub(crate) struct TableWords {
    pub(crate) words: Vec<u32>,
    /// A | B << 16 an entry.
    pub(crate) coefficients: u32,
    /// u | v << 16, p | q << 16 an entry.
    pub(crate) offsets: u32,
    /// The least coordinate of each column, then of each row, as bits.
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    /// Relaxed points: turn | class << 8 an entry.
    pub(crate) thirds: u32,
    /// (x, y) of an edge, by level and rotation.
    pub(crate) edges: u32,
    /// τ, 1/Δτ, scale, first vector, generations << 24 | count.
    pub(crate) slots: u32,
    pub(crate) slot_count: u32,
    /// For each interval, the slots at or below its beginning; two a word.
    pub(crate) phases: u32,
    /// i8 pairs, two a word.
    pub(crate) vectors: u32,
}

impl TableWords {
    /// Of a placement's tables and a lattice of texels over its domain.
    pub(crate) fn new(
        placement: &Placement<'_>,
        (width, height): (u32, u32),
        relaxed: bool,
    ) -> Result<Self, GpuError> {
        let tables = placement.tables();
        if tables.depth() < LEVELS {
            return Err(GpuError::Depth { depth: tables.depth() });
        }
        let mut all = Self::default();
        let blocks = TileType::ALL.map(|kind| export::entries(tables, kind, LEVELS));
        all.header(tables, blocks.each_ref().map(|block| block.len() as u32));
        all.coefficients = all.here();
        let entries = || blocks.iter().flatten();
        all.words.extend(entries().map(|e| u32::from(e.a) | u32::from(e.b) << 16));
        all.offsets = all.here();
        let pair = |a: i32, b: i32| u32::from(a as i16 as u16) | u32::from(b as i16 as u16) << 16;
        for [u, v, p, q] in entries().map(|entry| entry.offset) {
            all.words.extend([pair(u, v), pair(p, q)]);
        }
        let domain = placement.domain();
        let texels = glam::DVec2::new(width.into(), height.into()) / domain.size();
        all.columns = all.here();
        all.words.extend(borders(domain.min().x, domain.size().x, texels.x, width));
        all.rows = all.here();
        all.words.extend(borders(domain.min().y, domain.size().y, texels.y, height));
        if relaxed {
            let relaxation = tables.to_relaxation().ok_or(GpuError::NoRelaxation)?;
            all.thirds = all.here();
            all.words.extend(entries().map(|e| u32::from(e.turn) | u32::from(e.class) << 8));
            all.edges = all.here();
            all.words.extend(turned_edges(placement));
            all.layer(&relaxation.smooth);
        }
        Ok(all)
    }

    fn here(&self) -> u32 {
        self.words.len() as u32
    }

    fn header(&mut self, tables: &Tables<'_>, lengths: [u32; 4]) {
        let mut first = 0;
        for length in lengths {
            self.words.push(first);
            first += length;
        }
        for kind in TileType::ALL {
            let counts = TileCounts::of(kind).all();
            self.words.extend(counts.iter().take(4).map(|n| *n as u32));
        }
        let rules = tables.rules();
        for kind in TileType::ALL {
            let row = HEADER - 14 * (4 - kind.index());
            for child in rules.children(kind) {
                self.words.push(child.kind.index() as u32 | u32::from(child.rotation) << 2);
            }
            self.words.resize(row + 14, 0);
        }
    }

    fn layer(&mut self, layer: &Layer) {
        let slots = layer.slots();
        self.slots = self.here();
        self.slot_count = slots.len() as u32;
        let mut first = 0;
        for (i, slot) in slots.iter().enumerate() {
            let count = slot.vectors.len() as u32;
            let [tau, per_phase, scale] =
                [slot.tau, layer.per_phase(i), slot.scale].map(f32::to_bits);
            self.words.extend([tau, per_phase, scale, first]);
            self.words.push(u32::from(slot.generations) << 24 | count);
            first += count;
        }
        self.phases = self.here();
        let start = |interval: u32| {
            let begin = f32::from_bits((127 << 23) + (interval << 13));
            slots.partition_point(|slot| slot.tau <= begin) as u32
        };
        self.words.extend((0..PHASES / 2).map(|i| start(2 * i) | start(2 * i + 1) << 16));
        self.vectors = self.here();
        let bytes: Vec<u8> =
            slots.iter().flat_map(|slot| slot.vectors.iter().flatten()).map(|v| *v as u8).collect();
        self.words.extend(
            bytes
                .chunks(4)
                .map(|four| four.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))),
        );
    }
}

/// The bits of the least `f32` coordinate, relative to the domain's corner `min`, that the library takes
/// for texel 1, 2, … `count` − 1 of an axis: 0 before them, infinity after them. The library's rule is
/// ⌊((min + x) − min)·scale⌋ in `f64`, which rises with x.
fn borders(min: f64, size: f64, scale: f64, count: u32) -> Vec<u32> {
    let texel = |x: u32| ((min + f64::from(f32::from_bits(x))) - min) * scale;
    let most = (size as f32).to_bits() + 1;
    let border = |c: u32| {
        // Bits of positive numbers are in their order.
        let (mut low, mut high) = (0, most);
        while low < high {
            let middle = low + (high - low) / 2;
            if texel(middle) < f64::from(c) { low = middle + 1 } else { high = middle }
        }
        low
    };
    let inner = (1..count).map(border);
    std::iter::once(0).chain(inner).chain([f32::INFINITY.to_bits()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_are_where_the_library_changes_texels() {
        for (min, size, count) in [(0.0, 1.0, 1000), (-3.7, 0.3, 37), (1e9, 5.0, 64), (0.0, 7.0, 7)]
        {
            let scale = f64::from(count) / size;
            let borders = borders(min, size, scale, count);
            assert_eq!(borders.len(), count as usize + 1);
            let texel = |x: f32| ((min + f64::from(x)) - min) * scale;
            for (c, bits) in (1..count).zip(&borders[1..]) {
                let x = f32::from_bits(*bits);
                assert!(texel(x) >= f64::from(c) && texel(x.next_down()) < f64::from(c), "{c}");
            }
        }
    }
}
