//! The paper's own numbers: DODECATODECIMAL, σ₁ and σ₂, S_n, the δ-system, Ψ, κ.

use num_bigint::{BigInt, Sign};
use twelvefold::tiling::{FCode, MAX_LEVEL, RankError, TileCounts, TileType};
use twelvefold_lab::paper::{
    self, DELTA, delta_fraction, dodecatodecimal, kappa, normalized_threshold, psi,
};

/// The code of every tile of a level, depth first, children by ascending digit.
fn codes(root: TileType, levels: usize) -> Vec<FCode> {
    let mut codes = vec![FCode::parse(root, "").unwrap()];
    for _ in 0..levels {
        // Every digit that makes a possible word: tests/library/numbering.rs shows that these are the tiles.
        let children = |code: &FCode| {
            let code = *code;
            (0..14).filter_map(move |digit| FCode::parse(root, &format!("{digit:X}{code}")).ok())
        };
        codes = codes.iter().flat_map(children).collect();
    }
    codes
}

/// `values` without repetitions, ascending.
fn distinct(values: impl IntoIterator<Item = u64>) -> Vec<u64> {
    let mut values: Vec<u64> = values.into_iter().collect();
    values.sort_unstable();
    values.dedup();
    values
}

#[test]
fn dodecatodecimal_has_the_gaps_and_collisions_that_were_measured() {
    let values = |root, levels| -> Vec<u64> {
        codes(root, levels).iter().map(|code| dodecatodecimal(code).unwrap()).collect()
    };

    // Level 1 is numbered without gaps: a has 13 children, a pentagon 14.
    for root in TileType::ALL {
        let count = root.child_count() as u64;
        assert_eq!(distinct(values(root, 1)), (0..count).collect::<Vec<_>>());
    }

    // Gaps: root a, level 2: 181 tiles with values up to 193.
    let a2 = values(TileType::A, 2);
    assert_eq!((a2.len(), a2.iter().max()), (181, Some(&193)));
    assert_eq!(distinct(a2).len(), 181);

    // A collision: root b, level 2: 194 distinct values for 195 tiles.
    let b2 = values(TileType::B, 2);
    assert_eq!((b2.len(), distinct(b2).len()), (195, 194));

    // Many of them: root a, level 4: 34,789 distinct values for 35,113 tiles.
    let a4 = values(TileType::A, 4);
    assert_eq!((a4.len(), distinct(a4).len()), (35_113, 34_789));
}

#[test]
fn the_same_weights_oldest_digit_first_do_number_the_tiles() {
    // In depth-first order, which is useless as a threshold: neighbors get neighboring numbers.
    for root in TileType::ALL {
        for levels in 0..=3 {
            let values: Vec<u64> = codes(root, levels)
                .iter()
                .map(|code| {
                    let weighted = code.newest_first().iter().enumerate();
                    weighted.map(|(i, digit)| paper::s(*digit, i).unwrap()).sum()
                })
                .collect();
            assert_eq!(values, (0..values.len() as u64).collect::<Vec<_>>());
        }
    }
}

#[test]
fn sigma_sequences_are_the_papers_and_agree_with_the_closed_forms() {
    let listed_1 = [1, 13, 181, 2521, 35_113, 489_061, 6_811_741, 94_875_313];
    let listed_2 = [1, 14, 195, 2716, 37_829, 526_890, 7_338_631, 102_213_944];
    for (i, (first, second)) in listed_1.into_iter().zip(listed_2).enumerate() {
        assert_eq!((paper::sigma_1(i), paper::sigma_2(i)), (Ok(first), Ok(second)));
    }
    for i in 0..=MAX_LEVEL {
        for (exact, closed) in [
            (paper::sigma_1(i).unwrap(), paper::sigma_1_closed_form(i)),
            (paper::sigma_2(i).unwrap(), paper::sigma_2_closed_form(i)),
        ] {
            let error = (closed - exact as f64).abs();
            assert!(error <= 4e-15 * (i + 1) as f64 * exact as f64, "{i}: {exact} {closed}");
            // Where f64 holds the integer, rounding the formula gives it (through level 12 here).
            assert!(i > 12 || closed.round() as u64 == exact, "{i}: {exact} {closed}");
        }
    }
    assert_eq!(paper::sigma_1(17), Err(RankError::TooDeep { level: 17 }));
    assert_eq!(paper::sigma_2(17), Err(RankError::TooDeep { level: 17 }));
}

#[test]
fn s_n_follows_equation_5() {
    let at = |i| (0..14).map(|n| paper::s(n, i).unwrap()).collect::<Vec<_>>();
    assert_eq!(at(0), (0..14).collect::<Vec<_>>());
    assert_eq!(at(1), [0, 13, 27, 41, 55, 69, 83, 97, 111, 125, 139, 153, 167, 181]);
    assert_eq!(at(2)[..4], [0, 181, 376, 571]);
    // A whole subtree of each child type in turn: S_13 is the number of tiles of the next level
    // under `a`, S_14 under a pentagon.
    for i in 0..MAX_LEVEL {
        assert_eq!(paper::s(13, i), paper::sigma_1(i + 1));
        assert_eq!(paper::s(14, i), paper::sigma_2(i + 1));
    }
    assert_eq!(paper::s(13, 16), Err(RankError::TooDeep { level: 16 }));
    assert_eq!(paper::s(1, 17), Err(RankError::TooDeep { level: 17 }));
}

#[test]
fn the_delta_fraction_weighs_the_newest_digit_most() {
    let fraction = |word| delta_fraction(&FCode::parse(TileType::D, word).unwrap());
    assert_eq!(fraction(""), 0.0);
    assert_eq!(fraction("000"), 0.0);
    assert!((fraction("1") - 1.0 / DELTA).abs() < 1e-16);
    let mixed = 10.0 / DELTA + 3.0 / DELTA.powi(3) + 13.0 / DELTA.powi(4);
    assert!((fraction("A03D") - mixed).abs() < 1e-15);
    // The largest word exceeds 1, as the documentation says.
    let largest = fraction("DDDDDDDDDDDDDDDD");
    assert!(largest > 1.0055 && largest < 1.006, "{largest}");
}

#[test]
fn normalized_thresholds_fill_the_unit_interval_evenly() {
    for root in TileType::ALL {
        let tiles = codes(root, 2);
        for code in &tiles {
            let threshold = normalized_threshold(code);
            assert_eq!(threshold, code.rank() as f64 / tiles.len() as f64);
            assert!((0.0..1.0).contains(&threshold));
        }
        // The last rank of the deepest level would round to 1.
        for levels in 0..=MAX_LEVEL {
            let last = TileCounts::of(root).at(levels).unwrap() - 1;
            let threshold = normalized_threshold(&FCode::from_rank(root, levels, last).unwrap());
            assert!((0.0..1.0).contains(&threshold), "{levels}: {threshold}");
        }
    }
}

/// δ^k = p + q√3, exact. For k < 0, q < 0.
struct DeltaPower {
    p: BigInt,
    q: BigInt,
}

impl DeltaPower {
    fn one() -> Self {
        Self { p: BigInt::from(1), q: BigInt::from(0) }
    }

    fn next(&self) -> Self {
        Self { p: 7 * &self.p + 12 * &self.q, q: 4 * &self.p + 7 * &self.q }
    }

    /// δ^−k, the conjugate.
    fn inverse(&self) -> Self {
        Self { p: self.p.clone(), q: -&self.q }
    }

    /// Whether the power is at most `x` > 0, in integers only.
    fn is_at_most(&self, x: f64) -> bool {
        // x = mantissa·2^(exponent − 1075), so everything is scaled by 2^1075.
        let (exponent, fraction) = (x.to_bits() >> 52, x.to_bits() & ((1 << 52) - 1));
        let mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
        let x = BigInt::from(mantissa) << exponent.max(1);
        // x − p ≥ q√3, by signs and then by squares.
        let (left, right): (BigInt, BigInt) = (x - (&self.p << 1075), &self.q << 1075);
        let (left_squared, right_squared) = (&left * &left, 3 * &right * &right);
        match (left.sign() != Sign::Minus, right.sign() != Sign::Minus) {
            (true, false) => true,
            (false, true) => false,
            (true, true) => left_squared >= right_squared,
            (false, false) => left_squared <= right_squared,
        }
    }
}

#[test]
fn psi_falls_exactly_at_the_powers_of_delta() {
    assert_eq!(psi(1.0), Some(0.0));
    let (mut power, mut rounded) = (DeltaPower::one(), 1.0f64);
    for k in 1..=269 {
        (power, rounded) = (power.next(), rounded * DELTA);
        for (k, power, near) in [(k, &power, rounded), (-k, &power.inverse(), 1.0 / rounded)] {
            // Products of rounded factors are some ulps off: find the first f64 at or past the power.
            let mut first = near;
            while power.is_at_most(first) {
                first = first.next_down();
            }
            while !power.is_at_most(first) {
                first = first.next_up();
            }
            assert!((first / near - 1.0).abs() < 1e-13);
            let (mut above, mut below) = (first, first.next_down());
            for _ in 0..3 {
                let (small, large) = (psi(above).unwrap(), psi(below).unwrap());
                assert!((0.0..1e-14).contains(&small), "{above:e}, from δ^{k} up: {small}");
                assert!((1.0 - 1e-14..1.0).contains(&large), "{below:e}, below δ^{k}: {large}");
                (above, below) = (above.next_up(), below.next_down());
            }
        }
    }
}

#[test]
fn psi_is_the_fraction_of_the_logarithm_and_refuses_the_rest() {
    for x in [1e-300f64, 3.5e-12, 0.02, 0.5, 1.7, 13.0, 14.0, 193.0, 1e9, 6.02e23, 1.7e308] {
        let expected = (x.ln() / DELTA.ln()).rem_euclid(1.0);
        assert!((psi(x).unwrap() - expected).abs() < 1e-12, "{x}");
    }
    // Subnormal, and the largest: log_δ 2^−1074 and 2^1024.
    for (x, log2) in [(f64::from_bits(1), -1074.0), (f64::MAX, 1024.0)] {
        let expected = (log2 * 2f64.ln() / DELTA.ln()).rem_euclid(1.0);
        assert!((psi(x).unwrap() - expected).abs() < 1e-12, "{x}");
    }
    for x in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(psi(x), None);
    }
}

#[test]
fn kappa_is_the_first_level_with_enough_tiles() {
    assert_eq!(kappa(-1.0), Ok(0));
    assert_eq!(kappa(0.0), Ok(0));
    for level in 0..=MAX_LEVEL {
        let tiles = paper::sigma_1(level).unwrap();
        // From level 14 on the count is no f64: the nearest one may lie on either side.
        let nearest = tiles as f64;
        let enough = nearest as u64 <= tiles;
        assert_eq!(kappa(nearest).ok(), enough.then_some(level).or(past(level)), "{level}");
        assert_eq!(kappa(nearest.next_down()), Ok(level), "{level}");
        assert_eq!(kappa(nearest.next_up()).ok(), past(level), "{level}");
    }
    for x in [f64::NAN, f64::INFINITY, 1e19, f64::MAX] {
        assert_eq!(kappa(x), Err(RankError::TooDeep { level: 17 }));
    }
}

/// The level after `level`, if there is one.
fn past(level: usize) -> Option<usize> {
    (level < MAX_LEVEL).then_some(level + 1)
}
