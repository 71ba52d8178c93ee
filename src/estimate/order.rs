//! Sorting in the time of a few passes: keys of a sampling are spread evenly below its magnification,
//! because its ranks are.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::cmp::Ordering;

use glam::DVec2;

/// Candidates a coarse bucket: with its keys it stays in the second-level cache.
const COARSE: usize = 2048;

/// The most coarse buckets: while points arrive, one cache line of each is being written.
const MOST_BUCKETS: usize = 512;

/// The most candidates for which there is room from the start.
const MOST_ROOM: usize = 1 << 20;

/// A point and the magnification at which it appears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    /// (rank + u)/value, not NaN.
    pub(super) key: f64,
    pub(super) position: DVec2,
    pub(super) rank: u64,
    /// The importance at the position.
    pub(super) value: f64,
}

/// Candidates in coarse buckets by key.
pub(super) struct Buckets {
    buckets: Vec<Vec<Candidate>>,
    /// Buckets a unit of the key.
    per_key: f64,
    len: usize,
}

/// A candidate's key, and its index in the coarse bucket.
type Place = (f64, u32);

impl Buckets {
    /// For about `expected` candidates with keys from 0 to about `greatest`. Others are sorted as
    /// well, only not as fast.
    pub(super) fn new(expected: usize, greatest: f64) -> Result<Self, TryReserveError> {
        let count = (expected / COARSE).clamp(1, MOST_BUCKETS);
        let per_key = count as f64 / greatest;
        // Buckets differ little. What is never filled is never touched, but may never be free either.
        let room = (expected.min(MOST_ROOM) / count * 17 / 16) + 64;
        let mut buckets = Vec::new();
        buckets.resize_with(count, Vec::new);
        for bucket in &mut buckets {
            bucket.try_reserve_exact(room)?;
        }
        Ok(Self { buckets, per_key, len: 0 })
    }

    /// The number of candidates.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline]
    pub(super) fn push(&mut self, candidate: Candidate) -> Result<(), TryReserveError> {
        // Multiplication by a number and truncation keep the order; NaN is 0.
        let bucket = ((candidate.key * self.per_key) as u32 as usize).min(self.buckets.len() - 1);
        let bucket = &mut self.buckets[bucket];
        if bucket.len() == bucket.capacity() {
            bucket.try_reserve(1)?;
        }
        bucket.push(candidate);
        self.len += 1;
        Ok(())
    }

    /// Calls `take` for each candidate, by key and then by rank, until it returns `false`.
    pub(super) fn in_order(
        self,
        mut take: impl FnMut(&Candidate) -> bool,
    ) -> Result<(), TryReserveError> {
        let (mut places, mut starts) = (Vec::new(), Vec::new());
        for (i, bucket) in self.buckets.into_iter().enumerate() {
            sort(&bucket, i as f64, self.per_key, &mut places, &mut starts)?;
            if !places.iter().all(|(_, at)| take(&bucket[*at as usize])) {
                break;
            }
        }
        Ok(())
    }
}

/// Writes the order of a bucket's candidates, whose keys times `per_key` are from `first` to
/// `first` + 1, to `places`: one fine bucket a candidate, by counting, and those of more than one
/// sorted.
fn sort(
    bucket: &[Candidate],
    first: f64,
    per_key: f64,
    places: &mut Vec<Place>,
    starts: &mut Vec<u32>,
) -> Result<(), TryReserveError> {
    let count = bucket.len();
    let fine = |key: f64| {
        // Truncation takes what is below the first to 0.
        (((key * per_key - first) * count as f64) as usize).min(count - 1)
    };
    starts.clear();
    starts.try_reserve(count + 1)?;
    starts.resize(count + 1, 0);
    for candidate in bucket {
        starts[fine(candidate.key) + 1] += 1;
    }
    for i in 0..count {
        starts[i + 1] += starts[i];
    }
    places.clear();
    places.try_reserve(count)?;
    places.resize(count, (0.0, 0));
    for (index, candidate) in (0..).zip(bucket) {
        let start = &mut starts[fine(candidate.key)];
        places[*start as usize] = (candidate.key, index);
        *start += 1;
    }
    // Each start has moved to its end.
    let mut start = 0;
    for &end in &starts[..count] {
        let end = end as usize;
        if end - start > 1 {
            places[start..end].sort_unstable_by(|a, b| order(bucket, a, b));
        }
        start = end;
    }
    Ok(())
}

fn order(bucket: &[Candidate], a: &Place, b: &Place) -> Ordering {
    let rank = |place: &Place| bucket[place.1 as usize].rank;
    a.0.total_cmp(&b.0).then_with(|| rank(a).cmp(&rank(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use proptest::prelude::*;

    fn check(keys: Vec<f64>, expected: usize, greatest: f64) {
        let mut buckets = Buckets::new(expected, greatest).unwrap();
        let mut plain: Vec<(f64, u64)> = (0..).zip(keys).map(|(rank, key)| (key, rank)).collect();
        // Ranks against the order of arrival.
        for (key, rank) in plain.iter().rev().copied() {
            buckets.push(Candidate { key, position: DVec2::ZERO, rank, value: 1.0 }).unwrap();
        }
        assert_eq!(buckets.len(), plain.len());
        let mut sorted = Vec::new();
        buckets
            .in_order(|candidate| {
                sorted.push((candidate.key, candidate.rank));
                true
            })
            .unwrap();
        plain.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        assert_eq!(sorted, plain);
    }

    #[test]
    fn many_even_keys_are_sorted() {
        let mut random = SplitMix64::new(3);
        for n in [0, 1, 2, 100, 5000, 60_000] {
            check((0..n).map(|_| 40.0 * random.unit()).collect(), n, 40.0);
        }
    }

    #[test]
    fn it_stops_when_told() {
        let mut buckets = Buckets::new(3, 1.0).unwrap();
        for (rank, key) in (0..).zip([0.9, 0.1, 0.5]) {
            buckets.push(Candidate { key, position: DVec2::ZERO, rank, value: 1.0 }).unwrap();
        }
        let mut taken = Vec::new();
        buckets
            .in_order(|candidate| {
                taken.push(candidate.rank);
                taken.len() < 2
            })
            .unwrap();
        assert_eq!(taken, [1, 2]);
    }

    proptest! {
        #[test]
        fn any_keys_are_sorted(
            keys in proptest::collection::vec(
                prop_oneof![0.0..1.0f64, Just(0.5), 0.0..1e300f64, Just(0.0), Just(f64::INFINITY)],
                0..300,
            ),
            expected in 0usize..20_000,
            greatest in prop_oneof![Just(1.0), 1e-300..1e300f64],
        ) {
            check(keys, expected, greatest);
        }
    }
}
