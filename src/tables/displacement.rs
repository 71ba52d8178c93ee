//! Relaxed offsets as they are baked: the lookup of a point's vector, with nothing decoded beforehand.

use alloc::string::ToString;
use alloc::vec::Vec;

use crate::bake::displacement::{
    DisplacementError, Displacements, FIRST_PHASE, Layer, PHASE_SHIFT, PHASES, Slot,
};
use crate::bake::format::{LayerBytes, SLOT_BYTES};
use crate::tables::TablesError;
use crate::tiling::Digits;

/// Points whose vectors are looked up in one go.
pub(crate) const RUN: usize = 64;

/// Slots that are found by comparing with each.
const FEW_SLOTS: usize = 4;

/// Relaxed offsets: vectors by structural class and density phase, that turn the fixed centers of any
/// density into an even set. See [`Displacements`] for what they mean; this is the same, read in place.
#[derive(Clone, Copy, Debug)]
pub struct DisplacementTable<'a> {
    provenance: &'a str,
    smooth: LayerTable<'a>,
    rough: Option<LayerTable<'a>>,
}

impl<'a> DisplacementTable<'a> {
    /// `None` when there are no offsets.
    ///
    /// # Errors
    /// [`TablesError::Malformed`] for columns that do not fit each other.
    pub(crate) fn new(
        provenance: &'a str,
        layers: &[LayerBytes<'a>; 2],
    ) -> Result<Option<Self>, TablesError> {
        let [smooth, rough] = layers;
        if smooth.slots.is_empty() {
            return Ok(None);
        }
        let layer = |bytes| LayerTable::new(bytes).ok_or(TablesError::Malformed);
        let rough = if rough.slots.is_empty() { None } else { Some(layer(rough)?) };
        Ok(Some(Self { provenance, smooth: layer(smooth)?, rough }))
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

    /// What a point reads at phase `tau` where the importance has contrast `detail`, whatever its class.
    #[inline(always)]
    pub(crate) fn reading(&self, tau: f64, detail: f64) -> Reading {
        let rough = match &self.rough {
            Some(layer) if detail > 0.0 => {
                Some((layer.phase(tau), if detail < 1.0 { detail as f32 } else { 1.0 }))
            }
            _ => None,
        };
        Reading { smooth: self.smooth.phase(tau), rough }
    }

    /// As [`Displacements::vector`], of a point whose class over G generations is `class(G)`.
    #[inline(always)]
    pub(crate) fn vector(&self, reading: &Reading, class: impl Fn(u32) -> u32) -> [f32; 2] {
        let smooth = self.smooth.vector(reading.smooth, &class);
        match (&self.rough, reading.rough) {
            (Some(layer), Some((phase, share))) => {
                let rough = layer.vector(phase, &class);
                let mix = |a: f32, b: f32| a + (b - a) * share;
                [mix(smooth[0], rough[0]), mix(smooth[1], rough[1])]
            }
            _ => smooth,
        }
    }

    /// [`vector`](Self::vector) of the first `len` points of a run with the phases `tau` and the
    /// contrasts `detail`, the class of point `i` over G generations being `class(i, G)`.
    #[inline(always)]
    pub(crate) fn vectors(
        &self,
        len: usize,
        tau: &[f64; RUN],
        detail: &[f64; RUN],
        class: impl Fn(usize, u32) -> u32,
    ) -> [[f32; RUN]; 2] {
        let [mut x, mut y] = self.smooth.vectors(len, tau, &class);
        let rough = self.rough.filter(|_| detail.iter().take(len).any(|detail| *detail > 0.0));
        if let Some(layer) = rough {
            let [rough_x, rough_y] = layer.vectors(len, tau, &class);
            for i in 0..len.min(RUN) {
                let share = if detail[i] < 1.0 { detail[i] as f32 } else { 1.0 };
                let share = if detail[i] > 0.0 { share } else { 0.0 };
                x[i] += (rough_x[i] - x[i]) * share;
                y[i] += (rough_y[i] - y[i]) * share;
            }
        }
        [x, y]
    }

    /// The same where all read the same phase, without detail, the classes of all over G generations being
    /// `classes(G)`.
    #[inline(always)]
    pub(crate) fn vectors_at(
        &self,
        len: usize,
        reading: &Reading,
        classes: impl Fn(u32) -> [u32; RUN],
    ) -> [[f32; RUN]; 2] {
        self.smooth.vectors_at(len, reading.smooth, &classes)
    }

    /// The most generations that a class is asked for at the phase of a reading.
    pub(crate) fn generations(&self, reading: &Reading) -> u32 {
        let rough = match (&self.rough, reading.rough) {
            (Some(layer), Some((phase, _))) => layer.generations(phase),
            _ => 0,
        };
        self.smooth.generations(reading.smooth).max(rough)
    }

    /// Everything decoded, for checking and for baking anew.
    pub(crate) fn to_relaxation(self, digits: Digits) -> Result<Displacements, DisplacementError> {
        Ok(Displacements {
            digits: digits.derivation_order(),
            provenance: self.provenance.to_string(),
            smooth: self.smooth.to_layer(0)?,
            rough: self.rough.map(|rough| rough.to_layer(1)).transpose()?,
        })
    }
}

/// What a point reads, whatever its class.
#[derive(Clone, Copy)]
pub(crate) struct Reading {
    smooth: Option<Phase>,
    /// And the rough layer's share.
    rough: Option<(Option<Phase>, f32)>,
}

/// A phase between two slots of a layer.
#[derive(Clone, Copy)]
struct Phase {
    /// The slot at or below the phase; there is a next one.
    first: usize,
    /// How far from the first to the next, in [0, 1).
    share: f32,
}

/// The first `len` vectors between stored ones, in units of their scales, and the parts of the way.
#[inline(always)]
fn mixed(
    len: usize,
    (a, a_scale): (&[[u8; 2]; RUN], &[f32; RUN]),
    (b, b_scale): (&[[u8; 2]; RUN], &[f32; RUN]),
    shares: &[f32; RUN],
) -> [[f32; RUN]; 2] {
    let [mut x, mut y] = [[0.0; RUN]; 2];
    for i in 0..len {
        let mix = |a: f32, b: f32| a + (b - a) * shares[i];
        let [ax, ay] = a[i].map(|v| f32::from(v as i8) * a_scale[i]);
        let [bx, by] = b[i].map(|v| f32::from(v as i8) * b_scale[i]);
        (x[i], y[i]) = (mix(ax, bx), mix(ay, by));
    }
    [x, y]
}

/// One layer: slots in ascending order of τ.
#[derive(Clone, Copy, Debug)]
struct LayerTable<'a> {
    slots: &'a [[u8; SLOT_BYTES]],
    vectors: &'a [[u8; 2]],
    phases: &'a [[u8; 2]],
    longest: f64,
}

/// A vector as it is stored: i8 components in units of a scale.
#[derive(Clone, Copy)]
struct Entry {
    units: [u8; 2],
    scale: f32,
}

impl Entry {
    const ZERO: Self = Self { units: [0; 2], scale: 0.0 };

    #[inline(always)]
    fn vector(self) -> [f32; 2] {
        self.units.map(|v| f32::from(v as i8) * self.scale)
    }
}

/// A slot's record, decoded.
#[derive(Clone, Copy)]
struct SlotRecord {
    tau: f32,
    per_phase: f32,
    scale: f32,
    start: usize,
    generations: u32,
    count: u32,
}

impl<'a> LayerTable<'a> {
    fn new(bytes: &LayerBytes<'a>) -> Option<Self> {
        let (slots, rest) = bytes.slots.as_chunks::<SLOT_BYTES>();
        let (vectors, odd) = bytes.vectors.as_chunks::<2>();
        let (phases, uneven) = bytes.phases.as_chunks::<2>();
        let whole = rest.is_empty() && odd.is_empty() && uneven.is_empty();
        let sensible = bytes.longest >= 0.0 && bytes.longest < 1e6;
        (whole && sensible && phases.len() == PHASES).then_some(Self {
            slots,
            vectors,
            phases,
            longest: bytes.longest,
        })
    }

    #[inline(always)]
    fn tau(&self, slot: usize) -> f64 {
        let [a, b, c, d, ..] = self.slots[slot];
        f64::from(f32::from_le_bytes([a, b, c, d]))
    }

    #[inline(always)]
    fn record(&self, slot: usize) -> SlotRecord {
        let (fields, _) = self.slots[slot].as_chunks::<4>();
        let packed = u32::from_le_bytes(fields[4]);
        SlotRecord {
            tau: f32::from_le_bytes(fields[0]),
            per_phase: f32::from_le_bytes(fields[1]),
            scale: f32::from_le_bytes(fields[2]),
            start: u32::from_le_bytes(fields[3]) as usize,
            generations: packed >> 24,
            count: packed & 0xff_ffff,
        }
    }

    /// The slots on either side of a phase; `None` at and past the ends, where nothing moves.
    #[inline(always)]
    fn phase(&self, tau: f64) -> Option<Phase> {
        // Rising with τ from 1 on; what is below, or NaN, starts at one end or the other.
        let interval = (tau.to_bits() >> PHASE_SHIFT).saturating_sub(FIRST_PHASE);
        let start = self.phases[interval.min(PHASES as u64 - 1) as usize];
        let mut after = usize::from(u16::from_le_bytes(start));
        // Few intervals hold more than one slot: no branch depends on the first one.
        let last = self.slots.len() - 1;
        after += usize::from(self.tau(after.min(last)) <= tau);
        while after < self.slots.len() && self.tau(after) <= tau {
            after += 1;
        }
        if after >= self.slots.len() {
            return None;
        }
        let first = after.checked_sub(1)?;
        let SlotRecord { tau: low, per_phase, .. } = self.record(first);
        Some(Phase { first, share: (tau - f64::from(low)) as f32 * per_phase })
    }

    /// As [`Layer::vector`].
    #[inline(always)]
    fn vector(&self, phase: Option<Phase>, class: &impl Fn(u32) -> u32) -> [f32; 2] {
        let Some(phase) = phase else { return [0.0; 2] };
        let [a, b] = self.entries(phase.first, class);
        let mix = |a: f32, b: f32| a + (b - a) * phase.share;
        let ([ax, ay], [bx, by]) = (a.vector(), b.vector());
        [mix(ax, bx), mix(ay, by)]
    }

    /// [`vector`](Self::vector) of many: in one loop what must be looked up, in another, without
    /// branches, what is done with it.
    #[inline(always)]
    fn vectors(
        &self,
        len: usize,
        tau: &[f64; RUN],
        class: &impl Fn(usize, u32) -> u32,
    ) -> [[f32; RUN]; 2] {
        let (mut a, mut b) = ([[0u8; 2]; RUN], [[0u8; 2]; RUN]);
        let (mut a_scale, mut b_scale, mut shares) = ([0.0f32; RUN], [0.0f32; RUN], [0.0f32; RUN]);
        let len = len.min(RUN);
        if let Some(first) = self.few_slots(&tau[..len]) {
            // Where the density varies little, a few slots serve all: decoded once, and found by
            // comparing.
            let records: [SlotRecord; FEW_SLOTS + 1] =
                core::array::from_fn(|i| self.record((first + i).min(self.slots.len() - 1)));
            let mut slots = [0u64; RUN];
            for record in &records[1..FEW_SLOTS] {
                let begin = f64::from(record.tau);
                for (slot, tau) in slots.iter_mut().zip(tau) {
                    *slot += u64::from(begin <= *tau);
                }
            }
            for i in 0..len {
                let slot = (slots[i] as usize).min(FEW_SLOTS - 1);
                let (before, after) = (&records[slot], &records[slot + 1]);
                let entries = self.entries_of((before, after), first + slot, &|g| class(i, g));
                [(a[i], a_scale[i]), (b[i], b_scale[i])] = entries.map(|e| (e.units, e.scale));
                shares[i] = (tau[i] - f64::from(before.tau)) as f32 * before.per_phase;
            }
        } else {
            for i in 0..len {
                if let Some(Phase { first, share }) = self.phase(tau[i]) {
                    let entries = self.entries(first, &|generations| class(i, generations));
                    [(a[i], a_scale[i]), (b[i], b_scale[i])] = entries.map(|e| (e.units, e.scale));
                    shares[i] = share;
                }
            }
        }
        mixed(len, (&a, &a_scale), (&b, &b_scale), &shares)
    }

    /// The same where all read the same phase.
    #[inline(always)]
    fn vectors_at(
        &self,
        len: usize,
        phase: Option<Phase>,
        classes: &impl Fn(u32) -> [u32; RUN],
    ) -> [[f32; RUN]; 2] {
        let Some(Phase { first, share }) = phase else { return [[0.0; RUN]; 2] };
        let len = len.min(RUN);
        let (before, after) = (self.record(first), self.record(first + 1));
        let numbers = classes(before.generations);
        let (a, few) = self.units(&before, &numbers, len);
        let later = match after.generations == before.generations {
            true => numbers,
            false => classes(after.generations),
        };
        let (b, fewer) = self.units(&after, &later, len);
        if first == 0 || few || fewer {
            return self.vectors_of_later(len, (first, share), classes);
        }
        mixed(len, (&a, &[before.scale; RUN]), (&b, &[after.scale; RUN]), &[share; RUN])
    }

    /// What a slot holds of these classes, and whether it lacks one.
    #[inline(always)]
    fn units(
        &self,
        record: &SlotRecord,
        classes: &[u32; RUN],
        len: usize,
    ) -> ([[u8; 2]; RUN], bool) {
        let held = self.vectors.get(record.start..).unwrap_or_default();
        let held = held.get(..record.count as usize).unwrap_or(held);
        let mut units = [[0u8; 2]; RUN];
        let mut lacks = false;
        for (units, class) in units[..len].iter_mut().zip(classes) {
            let found = held.get(*class as usize);
            lacks |= found.is_none();
            *units = found.copied().unwrap_or_default();
        }
        (units, lacks)
    }

    /// The same where some of the classes are held by later slots only, or there is none before the phase.
    #[cold]
    #[inline(never)]
    fn vectors_of_later(
        &self,
        len: usize,
        (first, share): (usize, f32),
        classes: &impl Fn(u32) -> [u32; RUN],
    ) -> [[f32; RUN]; 2] {
        let [mut x, mut y] = [[0.0; RUN]; 2];
        let phase = Some(Phase { first, share });
        for (i, (x, y)) in x.iter_mut().zip(&mut y).enumerate().take(len) {
            [*x, *y] = self.vector(phase, &|generations| classes(generations)[i]);
        }
        [x, y]
    }

    /// The first slot that some of the phases read, if all of them lie between slots and read this one
    /// or one of the next [`FEW_SLOTS`] − 1.
    #[inline(always)]
    fn few_slots(&self, tau: &[f64]) -> Option<usize> {
        let [low, high] = tau.iter().fold([f64::MAX, 0.0], |[low, high], tau| {
            [if *tau < low { *tau } else { low }, if *tau > high { *tau } else { high }]
        });
        let (low, high) = (self.phase(low)?.first, self.phase(high)?.first);
        (high < low + FEW_SLOTS).then_some(low)
    }

    /// As [`Layer::entry`], of the slot `first` and the next one.
    #[inline(always)]
    fn entries(&self, first: usize, class: &impl Fn(u32) -> u32) -> [Entry; 2] {
        self.entries_of((&self.record(first), &self.record(first + 1)), first, class)
    }

    /// The same with the records of both slots at hand.
    #[inline(always)]
    fn entries_of(
        &self,
        (before, after): (&SlotRecord, &SlotRecord),
        first: usize,
        class: &impl Fn(u32) -> u32,
    ) -> [Entry; 2] {
        let number = class(before.generations);
        let a = match first {
            0 => Entry::ZERO,
            _ if number < before.count => self.entry(before, number),
            _ => self.entry_later(class, first + 1),
        };
        // Most often as many generations.
        let number =
            if after.generations == before.generations { number } else { class(after.generations) };
        let b = match number < after.count {
            true => self.entry(after, number),
            false => self.entry_later(class, first + 2),
        };
        [a, b]
    }

    fn generations(&self, phase: Option<Phase>) -> u32 {
        let first = phase.map_or(self.slots.len(), |phase| phase.first);
        let later = (first..self.slots.len()).map(|slot| self.record(slot).generations);
        later.max().unwrap_or(0)
    }

    /// Of the first slot from `from` on that holds the class.
    #[cold]
    #[inline(never)]
    fn entry_later(&self, class: &impl Fn(u32) -> u32, from: usize) -> Entry {
        let later = (from..self.slots.len()).map(|slot| self.record(slot));
        let mut holding = later.filter(|record| class(record.generations) < record.count);
        holding.next().map_or(Entry::ZERO, |record| self.entry(&record, class(record.generations)))
    }

    #[inline(always)]
    fn entry(&self, record: &SlotRecord, class: u32) -> Entry {
        let units = self.vectors.get(record.start + class as usize).copied().unwrap_or_default();
        Entry { units, scale: record.scale }
    }

    fn to_layer(self, layer: u8) -> Result<Layer, DisplacementError> {
        let slots = (0..self.slots.len()).map(|i| {
            let SlotRecord { tau, scale, start, generations, count, .. } = self.record(i);
            let found = count;
            let vectors = self
                .vectors
                .get(start..start.saturating_add(count as usize))
                .ok_or(DisplacementError::VectorCount { layer, slot: i, found })?;
            Ok(Slot {
                tau,
                generations: generations as u8,
                scale,
                vectors: vectors.iter().map(|v| v.map(|component| component as i8)).collect(),
            })
        });
        Layer::new(layer, slots.collect::<Result<Vec<_>, _>>()?)
    }
}
