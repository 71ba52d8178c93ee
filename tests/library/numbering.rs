//! F-codes and exact ranks.

use proptest::prelude::*;
use twelvefold::Tables;
use twelvefold::tiling::rank::child_rank;
use twelvefold::tiling::{
    FCode, FCodeError, MAX_LEVEL, RankError, Rules, Tile, TileCounts, TileType,
};

fn rules() -> Rules {
    Tables::built_in().rules()
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
                // The center keeps its rank; the first new one is N_m later; all ascend with the digit.
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
