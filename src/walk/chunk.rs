//! Chunks: up to a few hundred candidates in arrays, one pass each for positions, bounds of the
//! domain, importance and comparison. Each pass is a loop without branches over arrays, which
//! compilers turn into vector instructions.
//!
//! ```text
//! entries   start ………………… sure ………………… end      a batch: sure entries need no look at the importance
//!           └─ chunk ─┘└─ chunk ─┘└─ chunk ─┘      at most 256 entries each, never some of both kinds
//!
//! load           x, y of the entries             always; candidate i is entry `first` + i
//! mark_inside    keep = in domain and clip       only across the clip's border; there, seamless: x, y wrapped
//! pack           candidates kept to the front    from here on candidate i is `entry[i]`
//! read_values    values = importance at x, y     only entries that are not sure
//! mark_accepted  keep = rank < limit(value)      the same
//! ```
//!
//! Whoever receives the chunk takes the candidates with `keep` 1.

use core::ops::Range;

use glam::DVec2;

use super::candidates::Candidates;
use super::context::Context;
use super::displaced::Displaced;
use crate::error::SamplingError;
use crate::importance::Importance;
use crate::placement::Placement;
use crate::position::{Position, Scalar};
use crate::sampling::Sampling;
use crate::tree::frame::Segment;

/// Candidates a chunk. A block of depth 2 fits, and the arrays stay in the first-level cache.
pub(crate) const CHUNK: usize = 256;

/// Ranks below this are exact as `f64`.
const EXACT: u64 = 1 << 53;

/// Candidates of one batch: positions relative to the domain's least corner, and which to keep.
#[derive(Clone, Debug)]
pub(crate) struct Chunk<S> {
    pub(crate) len: usize,
    pub(crate) x: [S; CHUNK],
    pub(crate) y: [S; CHUNK],
    /// Which entries of the block they are, if `packed`; otherwise `first` and those after it.
    pub(crate) entry: [u16; CHUNK],
    first: usize,
    packed: bool,
    /// 1 for the points of the set, 0 for the others.
    pub(crate) keep: [u8; CHUNK],
    /// Whether it is known that all are.
    pub(crate) whole: bool,
    /// The importance at each.
    pub(crate) values: [f64; CHUNK],
}

impl<S: Scalar> Chunk<S> {
    pub(crate) fn new() -> Self {
        let zero = S::default();
        Self {
            len: 0,
            x: [zero; CHUNK],
            y: [zero; CHUNK],
            entry: [0; CHUNK],
            first: 0,
            packed: false,
            keep: [0; CHUNK],
            whole: false,
            values: [0.0; CHUNK],
        }
    }

    /// The entry of the block that candidate `i` is.
    #[inline(always)]
    pub(crate) fn entry(&self, i: usize) -> usize {
        if self.packed { self.entry[i].into() } else { self.first + i }
    }

    /// Takes the batch's entries from `start` on, as many as fit and are all sure or all not, and
    /// marks the points among them. Returns the next entry.
    #[inline(always)]
    pub(crate) fn select<I: Importance, P: Position<Scalar = S>>(
        &mut self,
        walk: &Context<'_, '_, I, S>,
        batch: &Candidates,
        start: usize,
    ) -> Result<usize, SamplingError> {
        let sampling = walk.sampling;
        let sure = start < batch.sure;
        let next = self.load(sampling.placement(), batch, start..batch.run_end(start));
        if batch.inside {
            if sure {
                self.keep_all();
            }
        } else {
            self.mark_inside::<I, P>(walk);
            if !sure {
                self.pack();
            }
        }
        if !sure {
            self.read_values(sampling);
            self.mark_accepted(sampling, batch)?;
        }
        Ok(next)
    }

    /// Takes the fixed centers of some of the batch's entries, as many as fit. Returns the next entry.
    #[inline(always)]
    pub(crate) fn load(
        &mut self,
        placement: &Placement<'_>,
        batch: &Candidates,
        entries: Range<usize>,
    ) -> usize {
        self.load_as(
            placement,
            batch,
            entries,
            #[inline(always)]
            |_, segment, x, y| segment.write_columns(x, y),
        )
    }

    /// The same, moved.
    #[inline(always)]
    pub(crate) fn load_moved(
        &mut self,
        placement: &Placement<'_>,
        batch: &Candidates,
        entries: Range<usize>,
        steps: &Displaced<'_, S>,
    ) -> usize {
        self.load_as(
            placement,
            batch,
            entries,
            #[inline(always)]
            |first, segment, x, y| {
                let moved = steps.moved(first, segment.positions());
                for ((to_x, to_y), [x, y]) in x.iter_mut().zip(y).zip(moved) {
                    (*to_x, *to_y) = (x, y);
                }
            },
        )
    }

    #[inline(always)]
    fn load_as(
        &mut self,
        placement: &Placement<'_>,
        batch: &Candidates,
        entries: Range<usize>,
        write: impl Fn(usize, Segment<'_, S>, &mut [S], &mut [S]),
    ) -> usize {
        let mut next = entries.start;
        self.len = 0;
        while self.len < CHUNK && next < entries.end {
            let most = (CHUNK - self.len).min(entries.end - next);
            let (segment, end) = batch.segment::<S>(placement, next, most);
            let filled = self.len..self.len + (end - next);
            write(next, segment, &mut self.x[filled.clone()], &mut self.y[filled.clone()]);
            (self.len, next) = (filled.end, end);
        }
        (self.first, self.packed, self.whole) = (entries.start, false, false);
        next
    }

    /// Marks all candidates.
    #[inline(always)]
    pub(crate) fn keep_all(&mut self) {
        self.keep[..self.len].fill(1);
        self.whole = true;
    }

    /// The importance at each candidate.
    #[inline(always)]
    pub(crate) fn read_values<I: Importance>(&mut self, sampling: &Sampling<'_, I>) {
        let len = self.len;
        let corner = sampling.placement().domain().min();
        let values = &mut self.values[..len];
        sampling.importance().values(corner, &self.x[..len], &self.y[..len], values);
    }

    /// Marks what lies in the half-open domain, and in the clip's rectangle. In a seamless domain all
    /// candidates do, once they are wrapped into it.
    #[inline(always)]
    pub(crate) fn mark_inside<I: Importance, P: Position<Scalar = S>>(
        &mut self,
        walk: &Context<'_, '_, I, S>,
    ) {
        let Context { sampling, clip, to_world } = *walk;
        if sampling.placement().is_seamless() {
            self.wrap(sampling.placement());
            self.keep[..self.len].fill(1);
        } else {
            let [width, height] = sampling.placement().domain().size().to_array().map(S::from_f64);
            let zero = S::default();
            let columns = self.x[..self.len].iter().zip(&self.y[..self.len]);
            for (keep, (x, y)) in self.keep.iter_mut().zip(columns) {
                *keep = u8::from((zero <= *x) & (*x < width) & (zero <= *y) & (*y < height));
            }
        }
        if let Some(rectangle) = clip.rectangle() {
            let columns = self.x[..self.len].iter().zip(&self.y[..self.len]);
            for (keep, (x, y)) in self.keep.iter_mut().zip(columns) {
                let [x, y] = to_world.place::<P>(*x, *y).xy();
                *keep &= u8::from(rectangle.contains(DVec2::new(x.to_f64(), y.to_f64())));
            }
        }
    }

    /// Notes which entries of the block the candidates are.
    #[inline(always)]
    pub(crate) fn list_entries(&mut self) {
        for (i, entry) in self.entry[..self.len].iter_mut().enumerate() {
            // A block has at most 37,829 entries.
            *entry = (self.first + i) as u16;
        }
        self.packed = true;
    }

    /// Moves the marked candidates to the front, in order.
    #[inline(always)]
    pub(crate) fn pack(&mut self) {
        if !self.packed {
            self.list_entries();
        }
        let mut kept = 0;
        for i in 0..self.len.min(CHUNK) {
            let (x, y, entry) = (self.x[i], self.y[i], self.entry[i]);
            (self.x[kept], self.y[kept], self.entry[kept]) = (x, y, entry);
            kept += usize::from(self.keep[i]);
        }
        (self.len, self.packed) = (kept, true);
    }

    /// The same, and their values with them.
    #[inline(always)]
    pub(crate) fn pack_with_values(&mut self) {
        self.pack();
        for i in 0..self.len.min(CHUNK) {
            // Never before `i`.
            self.values[i] = self.values[usize::from(self.entry[i]) - self.first];
        }
    }

    /// Marks those whose importance, in `values`, reaches their rank.
    #[inline(always)]
    pub(crate) fn mark_accepted<I: Importance>(
        &mut self,
        sampling: &Sampling<'_, I>,
        batch: &Candidates,
    ) -> Result<(), SamplingError> {
        let len = self.len;
        let corner = sampling.placement().domain().min();
        let values = &self.values[..len];
        // One comparison that is false for NaN, so that no broken promise passes.
        let most = if sampling.importance().bounds_hold() { batch.bound } else { f64::MAX };
        let sound = |value: f64| (value >= 0.0) & (value <= most);
        if !values.iter().fold(true, |all, value| all & sound(*value)) {
            let i = values.iter().position(|value| !sound(*value)).unwrap_or(0);
            let at = corner + DVec2::new(self.x[i].to_f64(), self.y[i].to_f64());
            return Err(SamplingError::InvalidValue { at, value: values[i], bound: most });
        }

        let block = batch.block(sampling.placement());
        let scale = sampling.scale();
        let numbering = sampling.placement().numbering();
        let (tiles, before) = numbering.counts().pair(batch.node.level);
        let (greatest, _) = block.rank_coefficients(batch.end - 1);
        let largest_term =
            batch.node.rank.saturating_add(u64::from(greatest).saturating_mul(tiles));
        if largest_term >= EXACT {
            for i in 0..len {
                let rank = batch.rank(numbering, block, self.entry(i));
                self.keep[i] = u8::from(scale.accepts(rank, self.values[i]));
            }
            return Ok(());
        }
        // Every term is an integer below 2⁵³, so that sums and products of them round nothing, and
        // comparing a rank k with a limit x as f64 is comparing integers: k < x exactly when k < ⌈x⌉.
        let (tiles, before) = (tiles as f64, before as f64);
        let own = batch.node.rank as f64;
        let accepted = |a: u16, b: u16, value: f64| {
            let rank = own + f64::from(a) * tiles - f64::from(b) * before;
            u8::from(rank < scale.limit_before_rounding(value))
        };
        if !self.packed {
            let coefficients = block.rank_coefficients_of(self.first..self.first + len);
            for ((keep, (a, b)), value) in self.keep.iter_mut().zip(coefficients).zip(values) {
                *keep = accepted(a, b, *value);
            }
        } else {
            for ((keep, entry), value) in self.keep.iter_mut().zip(&self.entry).zip(values) {
                let (a, b) = block.rank_coefficients(usize::from(*entry));
                *keep = accepted(a, b, *value);
            }
        }
        Ok(())
    }
}
