//! A table in training: real vectors, all classes of every slot.

use super::site::Site;
use twelvefold::bake::class::{self, class_count};
use twelvefold::bake::displacement::{DELTA, DisplacementError, Layer, Slot, born_classes};
use twelvefold::tiling::Rules;

/// One slot's place on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotSpec {
    /// τ.
    pub tau: f32,
    /// Generations that a class spans.
    pub generations: usize,
}

/// Vectors of a layer while it is trained, in edges of the point's level and the grandparent's frame.
#[derive(Clone, Debug)]
pub struct Table {
    slots: Vec<SlotSpec>,
    /// Where each slot's vectors begin, and after the last one the end.
    starts: Vec<usize>,
    /// The vectors.
    pub vectors: Vec<[f32; 2]>,
}

/// Which entries a point reads, with what weight; unused places have weight 0.
pub type Reads = [(u32, f32); 2];

impl Table {
    /// A table of zeros on a grid: `segments` of (first τ, generations, slots a unit of τ), each up to
    /// the next one's first τ, the last up to δ. The first begins at 1; `extra` are more slots.
    #[must_use]
    pub fn zeros(segments: &[(f64, usize, f64)], extra: &[(f64, usize)]) -> Self {
        let delta = f64::from(DELTA);
        let mut slots: Vec<SlotSpec> = extra
            .iter()
            .map(|&(tau, generations)| SlotSpec { tau: tau as f32, generations })
            .collect();
        for (i, &(from, generations, a_unit)) in segments.iter().enumerate() {
            let to = segments.get(i + 1).map_or(delta, |next| next.0);
            let count = libm::round((to - from) * a_unit).max(1.0) as u32;
            for k in 0..count {
                let tau = from + (to - from) * f64::from(k) / f64::from(count);
                slots.push(SlotSpec { tau: tau as f32, generations });
            }
        }
        let last = segments.last().map_or(2, |s| s.1);
        slots.push(SlotSpec { tau: DELTA, generations: last });
        slots.sort_by(|a, b| a.tau.total_cmp(&b.tau));
        slots.dedup_by(|a, b| a.tau == b.tau);
        Self::on(slots)
    }

    /// A finished layer as a table to train further; classes that it does not hold read the first later
    /// slot that does.
    #[must_use]
    pub fn from_layer(rules: &Rules, layer: &Layer) -> Self {
        let spec = |s: &Slot| SlotSpec { tau: s.tau, generations: s.generations.into() };
        let slots: Vec<SlotSpec> = layer.slots().iter().map(spec).collect();
        let mut table = Self::on(slots);
        for slot in 0..table.slots.len() {
            for class in 0..table.range(slot).len() {
                let held = (slot..table.slots.len()).find_map(|later| {
                    let generations = table.slots[slot].generations;
                    let held = &layer.slots()[later];
                    let fewer = usize::from(held.generations);
                    let class = class::coarsened(rules, generations, class as u32, fewer)?;
                    let vector = held.vectors.get(class as usize)?;
                    Some(vector.map(|v| f32::from(v) * held.scale))
                });
                table.vectors[table.starts[slot] + class] = held.unwrap_or_default();
            }
        }
        table
    }

    fn on(slots: Vec<SlotSpec>) -> Self {
        let mut starts = vec![0];
        for slot in &slots {
            let count = class_count(slot.generations).unwrap_or(0) as usize;
            starts.push(starts[starts.len() - 1] + count);
        }
        let vectors = vec![[0.0; 2]; starts[slots.len()]];
        Self { slots, starts, vectors }
    }

    /// The grid.
    #[must_use]
    pub fn slots(&self) -> &[SlotSpec] {
        &self.slots
    }

    /// The range of a slot's vectors.
    #[must_use]
    pub fn range(&self, slot: usize) -> core::ops::Range<usize> {
        self.starts[slot]..self.starts[slot + 1]
    }

    /// The slots either side of `tau` and the weight of the second.
    fn between(&self, tau: f64) -> (usize, f64) {
        let after = self.slots.partition_point(|slot| f64::from(slot.tau) <= tau);
        let i = after.clamp(1, self.slots.len() - 1) - 1;
        let (low, high) = (f64::from(self.slots[i].tau), f64::from(self.slots[i + 1].tau));
        (i, ((tau - low) / (high - low)).clamp(0.0, 1.0))
    }

    /// What a site reads.
    #[must_use]
    pub fn reads(&self, site: &Site) -> Reads {
        let (i, w) = self.between(site.tau);
        let entry = |slot: usize| {
            (self.starts[slot] + site.classes.over(self.slots[slot].generations) as usize) as u32
        };
        [(entry(i), (1.0 - w) as f32), (entry(i + 1), w as f32)]
    }

    /// The vector of a site, in edges of its level and its grandparent's frame.
    #[must_use]
    pub fn read(&self, site: &Site) -> glam::Vec2 {
        self.reads(site)
            .iter()
            .map(|(entry, weight)| glam::Vec2::from(self.vectors[*entry as usize]) * *weight)
            .sum()
    }

    /// The vectors at other slots, interpolated from this table; classes keep what their coarser
    /// class has.
    #[must_use]
    pub fn resampled(&self, rules: &Rules, mut onto: Self) -> Self {
        for (slot, spec) in onto.slots.iter().enumerate() {
            let (i, w) = self.between(f64::from(spec.tau));
            for (class, vector) in
                (0u32..).zip(&mut onto.vectors[onto.starts[slot]..onto.starts[slot + 1]])
            {
                let at = |i: usize| {
                    let fewer = self.slots[i].generations.min(spec.generations);
                    let class = class::coarsened(rules, spec.generations, class, fewer)?;
                    self.vectors.get(self.starts[i] + class as usize).copied()
                };
                let (a, b) = (at(i).unwrap_or_default(), at(i + 1).unwrap_or_default());
                *vector = core::array::from_fn(|k| a[k] + (b[k] - a[k]) * w as f32);
            }
        }
        onto
    }

    /// The finished layer: int8 with one scale a slot, without the classes that are not yet born.
    ///
    /// # Errors
    /// [`DisplacementError`] if the grid breaks a rule of [`Layer`].
    pub fn quantized(&self, layer: u8) -> Result<Layer, DisplacementError> {
        let last = self.slots.len() - 1;
        let slots = self.slots.iter().enumerate().map(|(i, spec)| {
            let generations = spec.generations as u8;
            if i == 0 || i == last {
                return Slot { tau: spec.tau, generations, scale: 0.0, vectors: Vec::new() };
            }
            let born = born_classes(spec.generations, f64::from(self.slots[i + 1].tau)) as usize;
            let vectors = &self.vectors[self.range(i)][..born];
            let longest = vectors.iter().flatten().fold(0.0f32, |m, v| m.max(v.abs()));
            let scale = longest / 127.0;
            let quantize = |v: f32| if scale > 0.0 { libm::roundf(v / scale) as i8 } else { 0 };
            Slot {
                tau: spec.tau,
                generations,
                scale,
                vectors: vectors.iter().map(|v| v.map(quantize)).collect(),
            }
        });
        Layer::new(layer, slots.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twelvefold::tiling::Digits;

    #[test]
    fn grids_resample_between_generations_and_quantize_within_half_a_step() {
        let rules = Rules::new(&Digits::parse(include_str!("../../../tables/digits.txt")).unwrap())
            .unwrap();
        let mut coarse = Table::zeros(&[(1.0, 2, 2.0), (3.0, 2, 0.5)], &[]);
        let taus: Vec<f32> = coarse.slots().iter().map(|s| s.tau).collect();
        assert_eq!(taus[..4], [1.0, 1.5, 2.0, 2.5]);
        assert_eq!(taus.last(), Some(&DELTA));
        let last = coarse.slots().len() - 1;
        for slot in 1..last {
            for (class, entry) in coarse.range(slot).enumerate() {
                coarse.vectors[entry] = [class as f32 / 300.0, 0.5 * slot as f32];
            }
        }
        let fine = coarse.resampled(&rules, Table::zeros(&[(1.0, 3, 4.0), (3.0, 2, 1.0)], &[]));
        // Slot 3 of the fine grid, τ = 1.75, lies halfway between slots 1 and 2 of the coarse one.
        let range = fine.range(3);
        for (class, entry) in range.enumerate().step_by(97) {
            let parent = class::coarsened(&rules, 3, class as u32, 2).unwrap();
            let [x, y] = fine.vectors[entry];
            assert!((x - parent as f32 / 300.0).abs() < 1e-5 && (y - 0.75).abs() < 1e-6);
        }
        let layer = coarse.quantized(0).unwrap();
        let again = Table::from_layer(&rules, &layer);
        for slot in 1..last {
            let held = layer.slots()[slot].vectors.len();
            let half = 0.5001 * layer.slots()[slot].scale;
            for entry in coarse.range(slot).take(held) {
                for k in 0..2 {
                    assert!((coarse.vectors[entry][k] - again.vectors[entry][k]).abs() <= half);
                }
            }
        }
    }
}
