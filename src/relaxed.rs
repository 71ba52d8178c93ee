//! Relaxed offsets as they are baked: the lookup of a point's vector, with nothing decoded beforehand.

use alloc::string::ToString;
use alloc::vec::Vec;

use crate::bake::relaxation::{Layer, Relaxation, RelaxationError, Slot};
use crate::bake::wire::{LayerBytes, SLOT_BYTES};
use crate::tiling::Digits;

/// Relaxed offsets: vectors by structural class and density phase, that turn the fixed centres of any
/// density into an even set. See [`Relaxation`] for what they mean; this is the same, read in place.
#[derive(Clone, Copy, Debug)]
pub struct RelaxationTable<'a> {
    provenance: &'a str,
    smooth: LayerTable<'a>,
    rough: Option<LayerTable<'a>>,
}

impl<'a> RelaxationTable<'a> {
    /// `Some(None)` when there are no offsets; `None` for columns that do not fit each other.
    pub(crate) fn new(provenance: &'a str, layers: &[LayerBytes<'a>; 2]) -> Option<Option<Self>> {
        let [smooth, rough] = layers;
        if smooth.slots.is_empty() {
            return Some(None);
        }
        let rough = match rough.slots.is_empty() {
            true => None,
            false => Some(LayerTable::new(rough)?),
        };
        Some(Some(Self { provenance, smooth: LayerTable::new(smooth)?, rough }))
    }

    /// How the offsets were made.
    #[must_use]
    pub fn provenance(&self) -> &'a str {
        self.provenance
    }

    /// The number of phase slots of the smooth and of the rough layer.
    #[must_use]
    pub fn slots(&self) -> (usize, usize) {
        (self.smooth.slots.len(), self.rough.map_or(0, |rough| rough.slots.len()))
    }

    /// Whether there is a layer for detail.
    pub(crate) fn has_rough(&self) -> bool {
        self.rough.is_some()
    }

    /// A bound on the length of every vector, in edges of a point's level.
    pub(crate) fn longest(&self) -> f64 {
        self.rough.map_or(self.smooth.longest, |rough| rough.longest.max(self.smooth.longest))
    }

    /// As [`Relaxation::vector`], of a point whose class over G generations is `class(G)`.
    pub(crate) fn vector(&self, class: impl Fn(u32) -> u32, tau: f64, detail: f64) -> [f64; 2] {
        let smooth = self.smooth.vector(&class, tau);
        match &self.rough {
            Some(layer) if detail > 0.0 => {
                let w = if detail < 1.0 { detail } else { 1.0 };
                let rough = layer.vector(&class, tau);
                [smooth[0] + (rough[0] - smooth[0]) * w, smooth[1] + (rough[1] - smooth[1]) * w]
            }
            _ => smooth,
        }
    }

    /// Everything decoded, for checking and for baking anew.
    pub(crate) fn to_relaxation(self, digits: Digits) -> Result<Relaxation, RelaxationError> {
        Ok(Relaxation {
            digits: digits.derivation_order(),
            provenance: self.provenance.to_string(),
            smooth: self.smooth.to_layer(0)?,
            rough: self.rough.map(|rough| rough.to_layer(1)).transpose()?,
        })
    }
}

/// One layer: slots in ascending order of τ.
#[derive(Clone, Copy, Debug)]
struct LayerTable<'a> {
    slots: &'a [[u8; SLOT_BYTES]],
    vectors: &'a [[u8; 2]],
    longest: f64,
}

/// A slot's record, decoded.
#[derive(Clone, Copy)]
struct SlotRecord {
    scale: f32,
    start: usize,
    generations: u32,
    count: u32,
}

impl<'a> LayerTable<'a> {
    fn new(bytes: &LayerBytes<'a>) -> Option<Self> {
        let (slots, rest) = bytes.slots.as_chunks::<SLOT_BYTES>();
        let (vectors, odd) = bytes.vectors.as_chunks::<2>();
        let sensible = bytes.longest >= 0.0 && bytes.longest < 1e6;
        (rest.is_empty() && odd.is_empty() && sensible).then_some(Self {
            slots,
            vectors,
            longest: bytes.longest,
        })
    }

    fn tau(&self, slot: usize) -> f64 {
        let [a, b, c, d, ..] = self.slots[slot];
        f64::from(f32::from_le_bytes([a, b, c, d]))
    }

    fn record(&self, slot: usize) -> SlotRecord {
        let (fields, _) = self.slots[slot].as_chunks::<4>();
        let packed = u32::from_le_bytes(fields[3]);
        SlotRecord {
            scale: f32::from_le_bytes(fields[1]),
            start: u32::from_le_bytes(fields[2]) as usize,
            generations: packed >> 24,
            count: packed & 0xff_ffff,
        }
    }

    /// As [`Layer::vector`].
    fn vector(&self, class: &impl Fn(u32) -> u32, tau: f64) -> [f64; 2] {
        // The number of slots with τ_slot ≤ τ.
        let (mut after, mut high) = (0, self.slots.len());
        while after < high {
            let middle = after + (high - after) / 2;
            if self.tau(middle) <= tau { after = middle + 1 } else { high = middle }
        }
        if after == 0 || after == self.slots.len() {
            return [0.0; 2];
        }
        let (low, high) = (self.tau(after - 1), self.tau(after));
        let w = (tau - low) / (high - low);
        let (a, b) = (self.entry(class, after - 1), self.entry(class, after));
        [a[0] + (b[0] - a[0]) * w, a[1] + (b[1] - a[1]) * w]
    }

    /// As [`Layer::entry`].
    fn entry(&self, class: &impl Fn(u32) -> u32, first: usize) -> [f64; 2] {
        if first == 0 {
            return [0.0; 2];
        }
        for slot in first..self.slots.len() {
            let SlotRecord { scale, start, generations, count } = self.record(slot);
            let class = class(generations);
            if class < count {
                let vector = self.vectors.get(start + class as usize).copied().unwrap_or_default();
                return vector.map(|v| f64::from(v as i8) * f64::from(scale));
            }
        }
        [0.0; 2]
    }

    fn to_layer(self, layer: u8) -> Result<Layer, RelaxationError> {
        let slots = (0..self.slots.len()).map(|i| {
            let SlotRecord { scale, start, generations, count } = self.record(i);
            let found = count;
            let vectors = self
                .vectors
                .get(start..start.saturating_add(count as usize))
                .ok_or(RelaxationError::VectorCount { layer, slot: i, found })?;
            Ok(Slot {
                tau: self.tau(i) as f32,
                generations: generations as u8,
                scale,
                vectors: vectors.iter().map(|v| v.map(|component| component as i8)).collect(),
            })
        });
        Layer::new(layer, slots.collect::<Result<Vec<_>, _>>()?)
    }
}
