//! From importance to ranks, and the comparison that decides on every point.

/// From importance to ranks: T = importance · magnification, and rank k is accepted iff k + u < T.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RankScale {
    /// Rank units for importance 1.
    magnification: f64,
    /// u, in [0, 1).
    shift: f64,
}

impl RankScale {
    /// `magnification` rank units for importance 1; `shift` u in [0, 1).
    pub(crate) const fn new(magnification: f64, shift: f64) -> Self {
        Self { magnification, shift }
    }

    /// Rank units for importance 1.
    pub(crate) const fn magnification(self) -> f64 {
        self.magnification
    }

    /// The importance that a rank needs.
    #[inline(always)]
    pub(crate) fn importance_of(self, rank: u64) -> f64 {
        // Ranks are below 2⁶³, so `i64` serves, which converts faster than `u64`.
        rank as i64 as f64 / self.magnification
    }

    /// T, in rank units.
    pub(crate) fn threshold(self, value: f64) -> f64 {
        value * self.magnification
    }

    /// How many ranks are accepted where the importance is `value`: the number of k ≥ 0 with
    /// k < T − u, T − u as rounded to `f64`. 0 for NaN.
    #[inline]
    pub(crate) fn limit(self, value: f64) -> u64 {
        let limit = self.limit_before_rounding(value);
        // Conversion to a signed integer is the cheaper one.
        if limit < 4.0e18 {
            let whole = limit as i64;
            // Negative numbers admit nothing.
            return whole.max(0) as u64 + u64::from(whole >= 0 && (whole as f64) < limit);
        }
        // Truncation takes NaN to 0 and saturates above; so large a number is an integer.
        limit as u64
    }

    /// T − u: an integer k below 2⁵³ is under `limit(value)` exactly when k < this.
    #[inline(always)]
    pub(crate) fn limit_before_rounding(self, value: f64) -> f64 {
        value * self.magnification - self.shift
    }

    /// rank + u: a point's place in the sequence. Ranks are below 2⁶³, so `i64` serves, which
    /// converts faster than `u64`.
    #[inline(always)]
    pub(crate) fn shifted(self, rank: u64) -> f64 {
        rank as i64 as f64 + self.shift
    }

    /// z = (rank + u)/T, below 1 for an accepted point.
    pub(crate) fn place(self, rank: u64, value: f64) -> f64 {
        self.shifted(rank) / (value * self.magnification)
    }

    /// `rank < limit(value)`, for a rank below 2⁶³.
    #[inline(always)]
    pub(crate) fn accepts(self, rank: u64, value: f64) -> bool {
        let limit = self.limit_before_rounding(value);
        // An integer below 2⁵³ is exact as f64, so that comparing there is comparing the integers:
        // k < x exactly when k < ⌈x⌉. Ranks past that round to an even neighbor, but so coarse a
        // limit is an integer itself.
        if rank < 1 << 53 { (rank as i64 as f64) < limit } else { rank < self.limit(value) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiling::TileCounts;
    use proptest::prelude::*;

    /// The number of integers k ≥ 0 with k < x, for a finite x, by integer arithmetic on its bits.
    fn integers_below(x: f64) -> u64 {
        if x <= 0.0 {
            return 0;
        }
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
        // x = mantissa · 2^shift, but for subnormal numbers, which are below 1 anyway.
        let (mantissa, shift) = (fraction | 1 << 52, exponent - 1075);
        match shift {
            ..=-53 => 1,
            -52..=-1 => {
                let whole = mantissa >> -shift;
                whole + u64::from(whole << -shift != mantissa)
            }
            0..=11 => mantissa << shift,
            _ => u64::MAX,
        }
    }

    fn check(scale: RankScale, value: f64) {
        let exact = integers_below(value * scale.magnification - scale.shift);
        let limit = scale.limit(value);
        assert_eq!(limit, exact, "{scale:?} {value}");
        for rank in
            [0, 1, limit.saturating_sub(2), limit.saturating_sub(1), limit, limit.saturating_add(1)]
        {
            if rank < 1 << 62 {
                assert_eq!(scale.accepts(rank, value), rank < limit, "{scale:?} {value} {rank}");
            }
        }
    }

    #[test]
    fn limits_are_exact_on_below_and_above_every_tile_count() {
        for tiles in TileCounts::HEXAGON.all() {
            let count = *tiles as f64;
            let near = [count.next_down(), count, count.next_up(), count - 1.0, count + 1.0];
            for t in near.into_iter().filter(|t| *t >= 0.0) {
                for shift in [0.0, f64::MIN_POSITIVE, 0.5, 1.0f64.next_down()] {
                    check(RankScale { magnification: t, shift }, 1.0);
                    check(RankScale { magnification: 2.0 * t, shift }, 0.5);
                }
            }
            if *tiles < 1 << 53 {
                let limit = |t| RankScale { magnification: t, shift: 0.0 }.limit(1.0);
                assert_eq!(limit(count), *tiles);
                assert_eq!(limit(count.next_up()), *tiles + 1);
                let tie = RankScale { magnification: count, shift: 0.0 };
                assert!(tie.accepts(*tiles - 1, 1.0) && !tie.accepts(*tiles, 1.0));
            }
        }
    }

    #[test]
    fn broken_values_admit_nothing_or_everything_but_never_wrap() {
        let scale = RankScale { magnification: 1e9, shift: 0.25 };
        for value in [f64::NAN, -1.0, -0.0, 0.0, f64::NEG_INFINITY, 5e-324, 1e-310] {
            assert_eq!(scale.limit(value), 0, "{value}");
            assert!(!scale.accepts(0, value), "{value}");
        }
        for value in [f64::INFINITY, f64::MAX, 1e300] {
            assert_eq!(scale.limit(value), u64::MAX, "{value}");
            assert!(scale.accepts(1 << 62, value), "{value}");
        }
    }

    proptest! {
        #[test]
        fn limits_count_the_integers_below(
            value in prop_oneof![Just(1.0), 0.0..1e3f64, any::<f64>().prop_filter("sign", |v| *v >= 0.0)],
            magnification in prop_oneof![1.0..100.0f64, 1e0..1e19f64, (0u64..1 << 60).prop_map(|n| n as f64)],
            shift in prop_oneof![Just(0.0), 0.0..1.0f64],
        ) {
            check(RankScale { magnification, shift }, value);
        }
    }
}
