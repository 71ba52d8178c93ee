//! Ranks in 32 bits: the order-preserving renumbering of a placement's points.
//!
//! A square domain has 115,883 ranks for each of its points, because the root is 258 diagonals wide. But
//! they come in few families: one for each *reference tile*, a tile of level 5 from which points come,
//! 10 to 13 in most placements. The descendants of the one with the i-th least rank r_i have ranks
//!
//! r_i + A·N_5 − B·N_4,  B = ⌊(A + 1)/δ⌋,
//!
//! and ranks ascend by (A, i). So key = A·F + i, F being the number of reference tiles, is dense, in
//! the order of the ranks, and obeys their recurrence: below a level-m tile with a key k,
//!
//! key = k + A·S_{m−5} − B·S_{m−6},  S_j = α_j·F,  α = 1, 14, 195, 2716 …, α_{−1} = 0.

use twelvefold::tiling::{MAX_LEVEL, TileCounts};

/// The level of the reference tiles: the coarsest one gives the fewest and so the most room.
pub(crate) const KEY_LEVEL: u8 = 5;

/// What a key is where 32 bits do not hold it.
pub const NO_KEY: u32 = u32::MAX;

/// A placement's reference tiles, which turn keys into ranks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    /// Ascending.
    ranks: Vec<u64>,
}

impl Keys {
    /// Of reference tiles with these ranks, ascending.
    pub(crate) fn new(ranks: Vec<u64>) -> Self {
        Self { ranks }
    }

    /// The number of reference tiles, F.
    #[must_use]
    pub fn references(&self) -> usize {
        self.ranks.len()
    }

    /// S_j, 0 at −1: what A counts below a tile j levels below a reference tile. `u32::MAX` for more.
    pub(crate) fn stride(&self, below: i32) -> u32 {
        let (mut before, mut here) = (0u64, self.ranks.len() as u64);
        for _ in -1..below {
            (before, here) = (here, here.saturating_mul(14).saturating_sub(before));
        }
        u32::try_from(before).unwrap_or(u32::MAX)
    }

    /// The rank with this key; `None` for [`NO_KEY`] and past the last rank.
    #[must_use]
    pub fn rank(&self, key: u32) -> Option<u64> {
        let families = self.ranks.len() as u64;
        if key == NO_KEY || families == 0 {
            return None;
        }
        let (a, family) = (u64::from(key) / families, u64::from(key) % families);
        let [before, here] = [KEY_LEVEL - 1, KEY_LEVEL].map(|m| count(m.into()));
        let rank = u128::from(*self.ranks.get(family as usize)?) + u128::from(a) * u128::from(here)
            - u128::from(over_delta(a + 1)) * u128::from(before);
        u64::try_from(rank).ok()
    }
}

/// N_m.
pub(crate) fn count(level: usize) -> u64 {
    TileCounts::HEXAGON.all()[level.min(MAX_LEVEL)]
}

/// ⌊n/δ⌋ for n up to 2³²: 1/δ = 7 − 4√3 is the limit of α_j/α_{j+1}, here to 2⁻⁶⁰.
fn over_delta(n: u64) -> u64 {
    let all = TileCounts::PENTAGON.all();
    (u128::from(n) * u128::from(all[MAX_LEVEL - 1]) / u128::from(all[MAX_LEVEL])) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strides_obey_the_recurrence_and_saturate() {
        let keys = Keys::new((0..12).map(|i| i * 100).collect());
        let strides: Vec<u32> = (-1..4).map(|j| keys.stride(j)).collect();
        assert_eq!(strides, [0, 12, 14 * 12, 195 * 12, 2716 * 12]);
        assert_eq!(keys.stride(11), u32::MAX);
        assert_eq!(keys.stride(-2), 0);
    }

    #[test]
    fn quotients_are_those_of_the_irrational_number() {
        // ⌊n(7 − 4√3)⌋ by integers: the greatest q with (7n − q)² ≥ 48 n², q ≤ 7n.
        for n in (1..3000).chain(u64::from(u32::MAX) - 2000..=u64::from(u32::MAX) + 1) {
            let q = over_delta(n);
            let reaches = |q: u64| {
                let rest = u128::from(7 * n - q);
                rest * rest >= 48 * u128::from(n) * u128::from(n)
            };
            assert!(reaches(q) && !reaches(q + 1), "{n}");
        }
    }
}
