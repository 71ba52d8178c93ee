//! Relaxed offsets: the data file, its validation, and the lookup that defines a relaxed point.
//!
//! A point accepted with threshold T has one level: N_m < T ≤ N_{m+1}. A point older than that is
//! followed down its center children to level m + 1, whose edge is the unit e; there it has classes
//! ([`Classes`]) and a grandparent, in whose frame its vector is given. Where the importance has the
//! local phase τ = T/N_m ∈ [1, δ], the vector is read from the *slots* either side of τ and
//! interpolated linearly. Layers are zero at both ends, so levels join.
//!
//! `tables/README.md` describes the bytes. This file uses `core`, `alloc`, [`crate::tiling`] and the
//! checksum only, so that `build.rs` compiles it too.

use alloc::string::String;
use alloc::vec::Vec;

use super::class::{Classes, MAX_GENERATIONS, class_count};
use crate::tiling::{Digits, TileType};

pub use super::displacement_error::{DisplacementError, MAGIC, MAX_BYTES, MAX_LENGTH, VERSION};

/// Bytes before the provenance text: magic, version, digits, length of the text.
const HEADER: usize = 8 + 2 + 4 * 14 + 2;

/// A trained table: one layer for smooth importance and, optionally, one for detail.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacements {
    /// The digit assignment that the vectors were trained for.
    pub digits: [[u8; 14]; 4],
    /// How the file was made: command, seed, version of the trainer.
    pub provenance: String,
    /// Vectors for smooth importance.
    pub smooth: Layer,
    /// Vectors for importance with detail at the scale of the spacing.
    pub rough: Option<Layer>,
}

/// Slots in ascending order of τ, the first at 1 and the last at δ, both empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    slots: Vec<Slot>,
}

/// The vectors of one τ.
#[derive(Clone, Debug, PartialEq)]
pub struct Slot {
    /// τ in [1, δ].
    pub tau: f32,
    /// Generations of ancestors that a class spans here, 2 ..= [`MAX_GENERATIONS`].
    pub generations: u8,
    /// Length of one unit of `vectors`, in edges of the point's level; finite, ≥ 0.
    pub scale: f32,
    /// Vectors in the grandparent's frame, in units of `scale`, indexed by class. Classes past the
    /// end are not yet born at the next slot's τ.
    pub vectors: Vec<[i8; 2]>,
}

/// Intervals of τ in which a search for slots may start: 1024 an octave of [1, 16), which the first bits
/// of an `f64` tell. Slots are farther apart, so that few intervals hold the beginning of more than one.
pub(crate) const PHASES: usize = 4096;

/// The bits of an `f64` that are not looked at, and those before them of τ = 1.
pub(crate) const PHASE_SHIFT: u32 = 42;
pub(crate) const FIRST_PHASE: u64 = 1023 << 10;

/// δ = 7 + 4√3 as the last slot stores it.
pub const DELTA: f32 = (7.0 + 4.0 * crate::tiling::numbers::SQRT_3) as f32;

/// How many classes over `generations` may have a member of rank below `tau`·N_m: the vectors that a
/// slot must hold when the next slot lies at `tau`.
///
/// The rank recurrence with δ for N_{m+1}/N_m gives the smallest rank of a class's members: a child's
/// is d + parent's/δ, or D + (parent's − 1)/δ. It is compared with τ, so a class is counted once its
/// first member is born. Classes are in that order. (Where N_{m+1}/N_m
/// differs from δ a member may be born a trifle earlier: it reads the next slot, as every unborn class does.)
#[must_use]
pub fn born_classes(generations: usize, tau: f64) -> u32 {
    let Some(count) = class_count(generations) else { return 0 };
    let delta = 7.0 + 4.0 * crate::tiling::numbers::SQRT_3;
    // Births ascend with the class number, so the first unborn one is found by halving.
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low + (high - low) / 2;
        let birth = super::class::parts(generations, middle).map_or(f64::INFINITY, |parts| {
            let digits = &parts.oldest_first[..generations];
            digits.iter().fold(0.0, |parent, digit| {
                let carry = f64::from(u8::from(*digit == 13));
                f64::from(*digit) + (parent - carry) / delta
            })
        });
        if birth < tau { low = middle + 1 } else { high = middle }
    }
    low
}

impl Layer {
    /// Checks and keeps the slots. `layer` (0 or 1) is named in errors.
    ///
    /// # Errors
    /// [`DisplacementError`] for slots that break a rule of [`Layer`] or [`Slot`].
    pub fn new(layer: u8, slots: Vec<Slot>) -> Result<Self, DisplacementError> {
        if !(2..=0xffff).contains(&slots.len()) {
            return Err(DisplacementError::SlotCount { layer, found: slots.len() });
        }
        let last = slots.len() - 1;
        for (i, slot) in slots.iter().enumerate() {
            let in_order = match i {
                0 => slot.tau == 1.0,
                _ => slot.tau > slots[i - 1].tau && (slot.tau == DELTA) == (i == last),
            };
            if !in_order || slot.tau > DELTA {
                return Err(DisplacementError::Tau { layer, slot: i });
            }
            if !(2..=MAX_GENERATIONS).contains(&usize::from(slot.generations)) {
                let found = slot.generations;
                return Err(DisplacementError::Generations { layer, slot: i, found });
            }
            if !(slot.scale >= 0.0 && slot.scale.is_finite()) {
                return Err(DisplacementError::Scale { layer, slot: i });
            }
            let generations = usize::from(slot.generations);
            let (least, most) = if i == 0 || i == last {
                (0, 0)
            } else {
                let next = f64::from(slots[i + 1].tau);
                (born_classes(generations, next), class_count(generations).unwrap_or(0))
            };
            if slot.vectors.len() < least as usize || slot.vectors.len() > most as usize {
                let found = slot.vectors.len() as u32;
                return Err(DisplacementError::VectorCount { layer, slot: i, found });
            }
            if slot.longest() > MAX_LENGTH {
                return Err(DisplacementError::TooFar { layer, slot: i });
            }
        }
        Ok(Self { slots })
    }

    /// The slots.
    #[must_use]
    pub fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// The vector of a point at phase `tau`, in its grandparent's frame, in edges of its level.
    ///
    /// `tau` outside [1, δ] is taken as the nearer end, NaN as 1. With slots i and i + 1 such that
    /// τ_i ≤ τ < τ_{i+1}, and w = (τ − τ_i)·[`per_phase`](Self::per_phase), it is v_i + (v_{i+1} − v_i)·w;
    /// τ − τ_i is computed in `f64` and rounded to `f32`, and so is every other operation. v_i is the
    /// class's entry of slot i times its scale; a class not yet born there takes the entry of the first
    /// later slot that holds it.
    #[must_use]
    pub fn vector(&self, classes: &Classes, tau: f64) -> [f32; 2] {
        let after = self.slots.partition_point(|slot| f64::from(slot.tau) <= tau);
        if after == 0 || after == self.slots.len() {
            return [0.0; 2];
        }
        let i = after - 1;
        let w = (tau - f64::from(self.slots[i].tau)) as f32 * self.per_phase(i);
        let (a, b) = (self.entry(classes, i), self.entry(classes, i + 1));
        [a[0] + (b[0] - a[0]) * w, a[1] + (b[1] - a[1]) * w]
    }

    /// 1/(τ_{i+1} − τ_i), in `f32`; 0 for the last slot.
    #[must_use]
    pub fn per_phase(&self, i: usize) -> f32 {
        self.slots.get(i + 1).map_or(0.0, |next| 1.0 / (next.tau - self.slots[i].tau))
    }

    /// The vector of a class at slot `i`, or at the first later slot that holds it.
    #[must_use]
    pub fn entry(&self, classes: &Classes, i: usize) -> [f32; 2] {
        if i == 0 {
            return [0.0; 2];
        }
        for slot in self.slots.iter().skip(i) {
            let class = classes.over(usize::from(slot.generations)) as usize;
            if let Some(vector) = slot.vectors.get(class) {
                return vector.map(|v| f32::from(v) * slot.scale);
            }
        }
        [0.0; 2]
    }

    /// For each of [`PHASES`] intervals of τ, the number of slots at or below its beginning: where the
    /// search for a slot starts.
    pub(super) fn phases(&self) -> impl Iterator<Item = u16> {
        (0..PHASES).map(|interval| {
            let begin = f64::from_bits((FIRST_PHASE + interval as u64) << PHASE_SHIFT);
            // At most 65,535 slots.
            self.slots.partition_point(|slot| f64::from(slot.tau) <= begin) as u16
        })
    }

    /// A bound on the length of every vector at phases in [`from`, `to`], in edges of the point's
    /// level: the longest entry of the slots that such a phase may read. Walks widen their
    /// regions by it, so that no point that moves in is lost.
    #[must_use]
    pub fn longest(&self, from: f64, to: f64) -> f64 {
        let first = self.slots.partition_point(|slot| f64::from(slot.tau) <= from).max(1) - 1;
        let last = self.slots.partition_point(|slot| f64::from(slot.tau) <= to);
        // An unborn class reads a later slot: walk on until every class is held.
        let mut longest: f64 = 0.0;
        for (i, slot) in self.slots.iter().enumerate().skip(first.max(1)) {
            longest = longest.max(slot.longest());
            let complete = class_count(usize::from(slot.generations))
                .is_some_and(|n| slot.vectors.len() == n as usize);
            if i >= last && complete {
                break;
            }
        }
        longest
    }
}

impl Slot {
    /// The length of the longest vector, rounded up: more than single precision makes of it.
    #[must_use]
    pub fn longest(&self) -> f64 {
        let squared = |v: &[i8; 2]| i32::from(v[0]).pow(2) + i32::from(v[1]).pow(2);
        let longest = self.vectors.iter().map(squared).max().unwrap_or(0);
        libm::sqrt(f64::from(longest)) * f64::from(self.scale) * (1.0 + 1e-6)
    }
}

impl Displacements {
    /// Encodes the table; [`from_bytes`](Self::from_bytes) reads it back.
    ///
    /// # Errors
    /// [`DisplacementError::Provenance`] when the text is too long.
    pub fn to_bytes(&self) -> Result<Vec<u8>, DisplacementError> {
        let mut bytes = Vec::from(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.digits.iter().flatten());
        let text = self.provenance.as_bytes();
        bytes.extend(
            u16::try_from(text.len()).map_err(|_| DisplacementError::Provenance)?.to_le_bytes(),
        );
        bytes.extend(text);
        bytes.push(1 + u8::from(self.rough.is_some()));
        for layer in core::iter::once(&self.smooth).chain(&self.rough) {
            bytes.extend((layer.slots.len() as u16).to_le_bytes());
            for slot in &layer.slots {
                bytes.extend(slot.tau.to_le_bytes());
                bytes.push(slot.generations);
                bytes.extend(slot.scale.to_le_bytes());
                bytes.extend((slot.vectors.len() as u32).to_le_bytes());
                bytes.extend(slot.vectors.iter().flatten().map(|v| *v as u8));
            }
        }
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        Ok(bytes)
    }

    /// Reads and validates a file.
    ///
    /// # Errors
    /// [`DisplacementError`]: magic and version first, then the checksum, then the fields in order.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DisplacementError> {
        if bytes.len() > MAX_BYTES {
            return Err(DisplacementError::TooLong { length: bytes.len() });
        }
        if !bytes.starts_with(&MAGIC) {
            return Err(DisplacementError::NotDisplacements);
        }
        let mut reader = Reader { bytes, offset: MAGIC.len() };
        let found = u16::from_le_bytes(reader.array()?);
        if found != VERSION {
            return Err(DisplacementError::Version { found });
        }
        let Some((body, sum)) = bytes.split_last_chunk::<4>().filter(|b| b.0.len() >= HEADER)
        else {
            return Err(DisplacementError::Truncated { offset: reader.offset });
        };
        let (stored, computed) = (u32::from_le_bytes(*sum), crc32fast::hash(body));
        if stored != computed {
            return Err(DisplacementError::Checksum { stored, computed });
        }
        reader.bytes = body;
        let mut digits = [[0; 14]; 4];
        for row in &mut digits {
            *row = reader.array()?;
        }
        let length = u16::from_le_bytes(reader.array()?);
        let text = reader.take(usize::from(length))?;
        let provenance =
            core::str::from_utf8(text).map_err(|_| DisplacementError::Provenance)?.into();
        let [layers] = reader.array()?;
        if !(1..=2).contains(&layers) {
            return Err(DisplacementError::LayerCount { found: layers });
        }
        let smooth = reader.layer(0)?;
        let rough = if layers == 2 { Some(reader.layer(1)?) } else { None };
        if reader.offset != body.len() {
            return Err(DisplacementError::Trailing { offset: reader.offset });
        }
        Ok(Self { digits, provenance, smooth, rough })
    }

    /// Whether the vectors were trained for this digit assignment; for another they are noise.
    #[must_use]
    pub fn fits(&self, digits: &Digits) -> bool {
        TileType::ALL.iter().all(|kind| self.digits[kind.index()].starts_with(digits.of(*kind)))
    }

    /// The vector of a point at phase `tau` where the importance has contrast `detail`, in the
    /// grandparent's frame and in edges of the point's level: smooth + (rough − smooth)·detail.
    /// `detail`, the rough layer's share, is clamped to [0, 1]; it does nothing without a rough layer.
    #[must_use]
    pub fn vector(&self, classes: &Classes, tau: f64, detail: f64) -> [f32; 2] {
        let smooth = self.smooth.vector(classes, tau);
        match &self.rough {
            Some(layer) if detail > 0.0 => {
                let w = detail.min(1.0) as f32;
                let rough = layer.vector(classes, tau);
                [smooth[0] + (rough[0] - smooth[0]) * w, smooth[1] + (rough[1] - smooth[1]) * w]
            }
            _ => smooth,
        }
    }
}

/// Reads fields one after another.
struct Reader<'a> {
    bytes: &'a [u8],
    offset: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], DisplacementError> {
        let rest = self.bytes.get(self.offset..).unwrap_or(&[]);
        let taken =
            rest.get(..length).ok_or(DisplacementError::Truncated { offset: self.offset })?;
        self.offset += length;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], DisplacementError> {
        let offset = self.offset;
        self.take(N)?.try_into().map_err(|_| DisplacementError::Truncated { offset })
    }

    fn layer(&mut self, layer: u8) -> Result<Layer, DisplacementError> {
        let count = u16::from_le_bytes(self.array()?);
        // Sizes are bounded by the bytes that are there, so a lying count allocates nothing.
        let mut slots = Vec::new();
        for slot in 0..usize::from(count) {
            let tau = f32::from_le_bytes(self.array()?);
            let [generations] = self.array()?;
            let scale = f32::from_le_bytes(self.array()?);
            let found = u32::from_le_bytes(self.array()?);
            let length = usize::try_from(found)
                .ok()
                .and_then(|n| n.checked_mul(2))
                .ok_or(DisplacementError::VectorCount { layer, slot, found })?;
            let pairs = self.take(length)?.chunks_exact(2);
            let vectors = pairs.map(|v| [v[0] as i8, v[1] as i8]).collect();
            slots.push(Slot { tau, generations, scale, vectors });
        }
        Layer::new(layer, slots)
    }
}
