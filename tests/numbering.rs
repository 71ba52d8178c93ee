//! F-codes, exact ranks and the paper's own numbers.

use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use twelvefold::paper::{
    self, DELTA, delta_fraction, dodecatodecimal, kappa, normalized_threshold, psi,
};
use twelvefold::tiling::rank::child_rank;
use twelvefold::tiling::{
    Digits, DigitsError, FCode, FCodeError, MAX_LEVEL, RankError, Rules, Tile, TileCounts, TileType,
};

const DIGITS: &str = include_str!("../tables/digits.txt");

fn rules() -> Rules {
    Rules::new(&Digits::parse(DIGITS).unwrap()).unwrap()
}

/// Every tile of a level with its code, by subdivision alone.
fn level(rules: &Rules, root: TileType, levels: usize) -> Vec<(FCode, Tile)> {
    let mut tiles = vec![(FCode::parse(root, "").unwrap(), Tile::root(root))];
    for _ in 0..levels {
        tiles = tiles
            .iter()
            .flat_map(|(code, tile)| {
                (0..tile.kind.child_count() as u8).map(move |digit| {
                    let word = format!("{digit:X}{code}");
                    let child = rules.child_of(tile, digit).unwrap().unwrap();
                    (FCode::parse(root, &word).unwrap(), child)
                })
            })
            .collect();
    }
    tiles
}

/// `values` without repetitions, ascending.
fn distinct(values: impl IntoIterator<Item = u64>) -> Vec<u64> {
    let mut values: Vec<u64> = values.into_iter().collect();
    values.sort_unstable();
    values.dedup();
    values
}

fn any_root() -> impl Strategy<Value = TileType> {
    prop::sample::select(TileType::ALL.to_vec())
}

/// A possible word of 0 to 16 digits, built from the oldest digit on.
fn any_code() -> impl Strategy<Value = FCode> {
    (any_root(), prop::collection::vec(0..14u8, 0..=MAX_LEVEL)).prop_map(|(root, mut digits)| {
        let mut parent_is_hexagon = root == TileType::A;
        for digit in &mut digits {
            if parent_is_hexagon && *digit == 13 {
                *digit = 12;
            }
            parent_is_hexagon = *digit == 0;
        }
        digits.reverse();
        FCode::from_newest_first(root, &digits).unwrap()
    })
}

// ---------------------------------------------------------------------------------------- F-codes

#[test]
fn impossible_words_are_rejected_where_they_go_wrong() {
    use FCodeError::{NoSuchChild, NoSuchChildOfRoot, NotADigit, TooLong};
    let parse = FCode::parse;
    assert_eq!(parse(TileType::B, "1D05"), Err(NoSuchChild { position: 1 }));
    assert_eq!(parse(TileType::A, "D0"), Err(NoSuchChild { position: 0 }));
    assert_eq!(parse(TileType::A, "31D"), Err(NoSuchChildOfRoot { position: 2 }));
    assert_eq!(parse(TileType::A, "D"), Err(NoSuchChildOfRoot { position: 0 }));
    assert_eq!(parse(TileType::A, "1E"), Err(NotADigit { position: 1, found: 'E' }));
    assert_eq!(parse(TileType::C, "δ"), Err(NotADigit { position: 0, found: 'δ' }));
    assert_eq!(parse(TileType::C, "1 2"), Err(NotADigit { position: 1, found: ' ' }));
    assert_eq!(parse(TileType::C, "00000000000000000"), Err(TooLong { length: 17 }));
    assert_eq!(
        FCode::from_newest_first(TileType::C, &[3, 14]),
        Err(NotADigit { position: 1, found: 'e' })
    );
    for (error, message) in [
        (parse(TileType::B, "1D0"), "position 1: D left of 0 is impossible"),
        (parse(TileType::A, "2D"), "position 1: D is impossible here"),
        (parse(TileType::A, "2?"), "position 1: '?' is not a digit"),
        (parse(TileType::A, &"1".repeat(40)), "40 digits"),
    ] {
        let text = error.unwrap_err().to_string();
        assert!(text.starts_with(message), "{text}");
    }
}

#[test]
fn possible_words_near_the_impossible_ones_are_accepted() {
    for (root, word) in [
        (TileType::A, ""),
        (TileType::B, "D"),
        (TileType::C, "D"),
        (TileType::D, "DDDDDDDDDDDDDDDD"),
        (TileType::A, "0D1"),
        (TileType::A, "DC"),
    ] {
        let code = FCode::parse(root, word).unwrap();
        assert_eq!(code.to_string(), word);
        assert_eq!((code.root(), code.level()), (root, word.len()));
    }
    let lower_case = FCode::parse(TileType::B, "dab").unwrap();
    assert_eq!(lower_case.to_string(), "DAB");
    assert_eq!(lower_case.newest_first(), [13, 10, 11]);
    assert_eq!(lower_case.oldest_first().collect::<Vec<_>>(), [11, 10, 13]);
    assert_eq!(format!("{lower_case:>5}|{lower_case:?}"), "  DAB|b:DAB");
}

#[test]
fn the_words_without_impossible_pairs_are_exactly_the_tiles() {
    // Every word of length 3 that parses is a tile, and no other.
    for root in TileType::ALL {
        let tiles = level(&rules(), root, 3).len();
        let words = (0..14u32.pow(3))
            .map(|n| [n / 196, n / 14 % 14, n % 14].map(|digit| digit as u8))
            .filter(|word| FCode::from_newest_first(root, word).is_ok())
            .count();
        assert_eq!(words, tiles);
    }
}

// ------------------------------------------------------------------------------------- exact ranks

#[test]
fn ranks_number_every_tile_without_gaps_through_level_4() {
    let rules = rules();
    for root in TileType::ALL {
        for levels in 0..=4 {
            let tiles = level(&rules, root, levels);
            let expected = TileCounts::of(root).at(levels).unwrap();
            assert_eq!(tiles.len() as u64, expected);
            let mut seen = vec![false; tiles.len()];
            for (code, tile) in &tiles {
                let rank = code.rank();
                let slot = seen.get_mut(rank as usize).expect("a rank past the last tile");
                assert!(!std::mem::replace(slot, true), "{code:?}: rank {rank} twice");
                assert_eq!(FCode::from_rank(root, levels, rank).as_ref(), Ok(code));
                assert_eq!(code.tile(&rules).as_ref(), Ok(tile));
            }
        }
    }
}

#[test]
fn a_rank_is_a_fixed_index_and_subtrees_start_where_the_design_says() {
    let rules = rules();
    for root in TileType::ALL {
        let counts = TileCounts::of(root);
        for levels in 0..=3 {
            for (code, tile) in level(&rules, root, levels) {
                let children = (0..tile.kind.child_count())
                    .map(|digit| FCode::parse(root, &format!("{digit:X}{code}")).unwrap().rank());
                let ranks: Vec<u64> = children.collect();
                // The centre keeps its rank; the first new one is N_m later; all ascend with the digit.
                assert_eq!(ranks[0], code.rank());
                assert_eq!(ranks[1], counts.at(levels).unwrap() + code.rank());
                assert!(ranks.is_sorted_by(|a, b| a < b), "{code:?} {ranks:?}");
                // The `a` tiles are exactly the first N_{m−1} ranks.
                let is_hexagon = code.rank() < counts.before(levels).unwrap();
                assert_eq!(tile.kind == TileType::A, is_hexagon, "{code:?}");
            }
        }
    }
}

#[test]
fn going_past_the_last_level_or_rank_is_an_error() {
    for root in TileType::ALL {
        let counts = TileCounts::of(root);
        let tiles = counts.at(MAX_LEVEL).unwrap();
        // 17 levels would not fit, 16 do.
        let next = 14 * u128::from(tiles) - u128::from(counts.before(MAX_LEVEL).unwrap());
        assert!(next > u128::from(u64::MAX) && counts.all().len() == MAX_LEVEL + 1);

        let too_deep = |level| Err(RankError::TooDeep { level });
        assert_eq!(FCode::from_rank(root, MAX_LEVEL + 1, 0), too_deep(17).map(|()| unreachable!()));
        assert_eq!(counts.at(17), too_deep(17).map(|()| 0));
        assert_eq!(counts.at(usize::MAX), too_deep(usize::MAX).map(|()| 0));
        assert_eq!(counts.before(17), too_deep(17).map(|()| 0));
        assert_eq!(
            FCode::from_rank(root, MAX_LEVEL, tiles),
            Err(RankError::NoSuchRank { rank: tiles, tiles })
        );
        assert_eq!(
            FCode::from_rank(root, 0, u64::MAX),
            Err(RankError::NoSuchRank { rank: u64::MAX, tiles: 1 })
        );
        let last = FCode::from_rank(root, MAX_LEVEL, tiles - 1).unwrap();
        assert_eq!(last.rank(), tiles - 1);
    }
    assert_eq!(
        RankError::TooDeep { level: 17 }.to_string(),
        "level 17 is past 16, the last whose ranks fit 64 bits"
    );
    assert_eq!(
        RankError::NoSuchRank { rank: 13, tiles: 13 }.to_string(),
        "rank 13 is not below 13, the number of tiles of its level"
    );
}

#[test]
fn the_rank_of_an_impossible_child_is_an_error() {
    let pentagon = &TileCounts::PENTAGON;
    assert_eq!(child_rank(pentagon, 1, 0, 13), Err(RankError::NoSuchChild { rank: 0, digit: 13 }));
    assert_eq!(child_rank(pentagon, 1, 1, 13), Ok(13 * 14));
    assert_eq!(child_rank(pentagon, 1, 1, 14), Err(RankError::NoSuchChild { rank: 1, digit: 14 }));
    assert_eq!(child_rank(pentagon, 1, 14, 0), Err(RankError::NoSuchRank { rank: 14, tiles: 14 }));
    assert_eq!(child_rank(pentagon, 16, 0, 0), Err(RankError::TooDeep { level: 17 }));
    assert!(child_rank(pentagon, usize::MAX, u64::MAX, u8::MAX).is_err());
    assert_eq!(
        RankError::NoSuchChild { rank: 0, digit: 13 }.to_string(),
        "the tile of rank 0 has no child with digit 13"
    );
}

proptest! {
    #[test]
    fn words_survive_a_round_trip_through_text(code in any_code()) {
        let text = code.to_string();
        prop_assert_eq!(FCode::parse(code.root(), &text), Ok(code));
        prop_assert_eq!(FCode::parse(code.root(), &text.to_lowercase()), Ok(code));
        prop_assert_eq!(FCode::from_newest_first(code.root(), code.newest_first()), Ok(code));
    }

    #[test]
    fn any_text_parses_or_is_refused(root in any_root(), text in "[0-9A-Ea-e \u{e9}]{0,20}") {
        if let Ok(code) = FCode::parse(root, &text) {
            prop_assert_eq!(code.to_string(), text.to_uppercase());
        }
    }

    #[test]
    fn deep_codes_and_ranks_are_one_to_one(code in any_code()) {
        let rank = code.rank();
        prop_assert!(rank < TileCounts::of(code.root()).at(code.level()).unwrap());
        prop_assert_eq!(FCode::from_rank(code.root(), code.level(), rank), Ok(code));
    }

    #[test]
    fn deep_ranks_lead_to_tiles_by_subdivision(
        root in any_root(), levels in 0..=MAX_LEVEL, bits in any::<u64>(),
    ) {
        let rules = rules();
        let rank = bits % TileCounts::of(root).at(levels).unwrap();
        let code = FCode::from_rank(root, levels, rank).unwrap();
        prop_assert_eq!(code.rank(), rank);
        prop_assert_eq!(code.level(), levels);
        let mut tile = Tile::root(root);
        for digit in code.oldest_first() {
            tile = rules.child_of(&tile, digit).unwrap().unwrap();
        }
        prop_assert_eq!(code.tile(&rules), Ok(tile));
        // The rank from the definition, in wide integers.
        let counts = TileCounts::of(root);
        let wide = code.oldest_first().enumerate().fold(0u128, |parent, (level, digit)| {
            let tiles = u128::from(counts.at(level).unwrap());
            let hexagons = u128::from(counts.before(level).unwrap());
            u128::from(digit) * tiles + parent - if digit == 13 { hexagons } else { 0 }
        });
        prop_assert_eq!(u128::from(rank), wide);
    }
}

// ----------------------------------------------------------------------------- the paper's numbers

#[test]
fn dodecatodecimal_has_the_gaps_and_collisions_that_were_measured() {
    let rules = rules();
    let values = |root, levels| -> Vec<u64> {
        let tiles = level(&rules, root, levels);
        tiles.iter().map(|(code, _)| dodecatodecimal(code).unwrap()).collect()
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
    // In depth-first order, which is useless as a threshold: neighbours get neighbouring numbers.
    let rules = rules();
    for root in TileType::ALL {
        for levels in 0..=3 {
            let values: Vec<u64> = level(&rules, root, levels)
                .iter()
                .map(|(code, _)| {
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
    let rules = rules();
    for root in TileType::ALL {
        let tiles = level(&rules, root, 2);
        for (code, _) in &tiles {
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

// ------------------------------------------------------------------------------- digits.txt errors

/// The parse error after replacing `from`, which must occur, by `to`.
fn broken(from: &str, to: &str) -> DigitsError {
    assert!(DIGITS.contains(from), "{from}");
    Digits::parse(&DIGITS.replacen(from, to, 1)).unwrap_err()
}

/// The line, from 1, of the rule for `letter` in the shipped file.
fn line_of(letter: char) -> usize {
    1 + DIGITS.lines().position(|line| line.starts_with(&format!("{letter}:"))).unwrap()
}

#[test]
fn every_mistake_in_the_digit_table_is_named_with_its_line() {
    use DigitsError::*;
    let (a, b, c, d) = (line_of('a'), line_of('b'), line_of('c'), line_of('d'));

    assert_eq!(broken("c: 0", "e: 0"), UnknownParent { line: c });
    assert_eq!(broken("c: 0", "c 0"), UnknownParent { line: c });
    assert_eq!(broken("c: 0", "cc: 0"), UnknownParent { line: c });
    assert_eq!(broken("c: 0", ": 0"), UnknownParent { line: c });
    let twice =
        DIGITS.replacen("d: 0 | 6 A 5 B 4 C | D 2 1 9 3", "b: 0 | 6 A 5 B 4 C | D 2 1 9 3", 1);
    assert_eq!(Digits::parse(&twice), Err(RepeatedParent { line: d, parent: TileType::B }));
    let without_b: String =
        DIGITS.lines().filter(|l| !l.starts_with("b:")).map(|l| format!("{l}\n")).collect();
    assert_eq!(Digits::parse(&without_b), Err(MissingParent { parent: TileType::B }));
    assert_eq!(Digits::parse(""), Err(MissingParent { parent: TileType::A }));

    assert_eq!(broken("b: 0 | A", "b: 0 | E"), NotADigit { line: b, column: 8 });
    assert_eq!(broken("b: 0 | A", "b: 0 | é"), NotADigit { line: b, column: 8 });
    assert_eq!(broken("  b: 0 | A".trim(), "  b: x | A"), NotADigit { line: b, column: 6 });

    let group_length = |line, group, expected, found| GroupLength { line, group, expected, found };
    assert_eq!(broken("a: 0", "a: 0 0"), group_length(a, 0, 1, 2));
    assert_eq!(broken("| A 4 C 5 B 6 |", "| A 4 C 5 B |"), group_length(b, 1, 6, 5));
    assert_eq!(broken("| 8 3 1 9 2 ", "| "), group_length(c, 2, 5, 0));
    assert_eq!(broken("| 7 8", ""), group_length(d, 3, 2, 0));
    assert_eq!(broken("| 7 8", "| 7 8 | 9"), group_length(d, 4, 0, 1));
    assert_eq!(broken("3 8 9 1 7 2 |", "3 8 9 1 7 2 | 3"), group_length(a, 3, 0, 1));

    assert_eq!(
        broken("| A 4 C 5 B 6 |", "| A 4 C 5 A 6 |"),
        RepeatedDigit { line: b, parent: TileType::B, digit: 10 }
    );
    assert_eq!(
        broken("| 7 D", "| 7 3"),
        WrongType { line: b, parent: TileType::B, digit: 3, child: TileType::D }
    );
    assert_eq!(
        broken("a: 0", "a: 1"),
        WrongType { line: a, parent: TileType::A, digit: 1, child: TileType::A }
    );
}

#[test]
fn the_messages_say_where_and_which_rule() {
    for (error, expected) in [
        (broken("c: 0", "e: 0"), format!("line {}: a rule begins with", line_of('c'))),
        (broken("| 7 D", "| 7 7"), format!("line {}: digit 7 stands twice under", line_of('b'))),
        (
            broken("| 7 D", "| 7 A"),
            format!("line {}: equation 1 does not give digit A of parent b to", line_of('b')),
        ),
        (broken("d: 0", "d: z"), format!("line {}, column 4: not a digit", line_of('d'))),
        (
            broken("| 7 8", ""),
            format!("line {}: group 4 (square corners) needs 2 digits, found 0", line_of('d')),
        ),
    ] {
        let text = error.to_string();
        assert!(text.starts_with(&expected), "{text:?} {expected:?}");
    }
}

#[test]
fn rules_made_without_a_text_are_checked_too() {
    let good = Digits::parse(DIGITS).unwrap();
    let mut rows = [[0; 14]; 4];
    for kind in TileType::ALL {
        rows[kind.index()][..kind.child_count()].copy_from_slice(good.of(kind));
    }
    assert_eq!(Digits::from_derivation_order(rows), good);
    assert_eq!(Rules::new(&good), Ok(rules()));
    rows[2][1] = 200;
    assert_eq!(
        Rules::new(&Digits::from_derivation_order(rows)),
        Err(DigitsError::WrongType {
            line: 0,
            parent: TileType::C,
            digit: 200,
            child: TileType::C
        })
    );
}

#[test]
fn comments_spacing_and_order_do_not_matter() {
    let tidy = "d:0|6A5B4C|D2193|78 # last first\n\n   # nothing\n a : 0|B46C5A|389172\n\
                b:\t0|A4C5B6|89123|7D\r\nc:0|5D6B7C|83192|A4";
    assert_eq!(Digits::parse(tidy), Digits::parse(DIGITS));
}
