//! Table files: what is baked, and that nothing else is accepted.

use proptest::prelude::*;
use sha2::{Digest, Sha256};
use twelvefold::bake::displacement::Displacements;
use twelvefold::bake::{self, BakeError};
use twelvefold::tiling::{Digits, DigitsError, Rules, TileType};
use twelvefold::{Tables, TablesError};

fn rules() -> Rules {
    Tables::built_in().rules()
}

fn displacements() -> Displacements {
    Displacements::from_bytes(include_bytes!("../../tables/relaxed.bin")).unwrap()
}

#[test]
fn the_built_in_tables_are_the_baked_rules() {
    let built_in = Tables::built_in();
    let digits = Digits::parse(include_str!("../../tables/digits.txt")).unwrap();
    assert_eq!(built_in.rules(), Rules::new(&digits).unwrap());
    let displacements = displacements();
    let baked = bake::bake(&rules(), built_in.depth(), Some(&displacements)).unwrap();
    assert_eq!(built_in.as_bytes(), baked);
    assert_eq!(built_in.displacements().unwrap().provenance(), displacements.provenance);
    assert!(Tables::from_bytes(built_in.as_bytes()).is_ok());
}

#[test]
fn the_default_depth_has_the_recorded_hash() {
    let bytes = bake::bake(&rules(), bake::DEFAULT_DEPTH, Some(&displacements())).unwrap();
    let hash: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    let recorded = include_str!("../../tables/baked.sha256");
    assert_eq!(recorded.split_whitespace().next(), Some(hash.as_str()));
}

#[test]
fn blocks_have_the_counts_of_their_levels_and_ascending_thresholds() {
    for depth in 1..=bake::MAX_DEPTH {
        let bytes = bake::bake(&rules(), depth, None).unwrap();
        let tables = Tables::from_bytes(&bytes).unwrap();
        assert_eq!(tables.depth(), depth);
        for kind in TileType::ALL {
            let block = tables.block(kind);
            let tiles = twelvefold::tiling::TileCounts::of(kind).at(depth.into()).unwrap();
            assert_eq!(block.len() as u64, tiles);
            let thresholds: Vec<f32> = block.thresholds().collect();
            assert_eq!(thresholds[0], 0.0);
            assert!(thresholds.is_sorted_by(|a, b| a < b));
            // Up to 1 for a pentagon, and to N_depth/δ^depth of it for `a`.
            let last = thresholds[thresholds.len() - 1];
            assert!((0.85..1.0).contains(&last), "{last}");
        }
    }
}

#[test]
fn other_depths_are_refused() {
    for depth in [0, 5, 255] {
        assert_eq!(bake::bake(&rules(), depth, None), Err(BakeError::Depth { depth }));
    }
}

#[test]
fn every_flipped_byte_is_an_error() {
    let bytes = bake::bake(&rules(), 1, None).unwrap();
    for i in 0..bytes.len() {
        for flip in [1, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[i] ^= flip;
            assert!(Tables::from_bytes(&damaged).is_err(), "byte {i} xor {flip}");
        }
    }
}

#[test]
fn a_flipped_byte_under_a_matching_checksum_is_an_error_too() {
    let bytes = bake::bake(&rules(), 1, None).unwrap();
    let length = bytes.len() - 4;
    for i in 0..length {
        let mut forged = bytes[..length].to_vec();
        forged[i] ^= 1;
        forged.extend(crc32fast::hash(&forged).to_le_bytes());
        assert!(Tables::from_bytes(&forged).is_err(), "byte {i}");
    }
}

#[test]
fn every_truncation_and_any_trailing_byte_is_an_error() {
    let bytes = bake::bake(&rules(), 1, None).unwrap();
    for length in 0..bytes.len() {
        assert!(Tables::from_bytes(&bytes[..length]).is_err(), "{length} bytes");
    }
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(Tables::from_bytes(&longer).unwrap_err(), TablesError::Checksum);
    let mut longer = bytes[..bytes.len() - 4].to_vec();
    longer.push(0);
    longer.extend(crc32fast::hash(&longer).to_le_bytes());
    assert_eq!(Tables::from_bytes(&longer).unwrap_err(), TablesError::Malformed);
}

#[test]
fn damaged_relaxed_offsets_are_an_error_even_under_a_matching_checksum() {
    let bytes = bake::bake(&rules(), 1, Some(&displacements())).unwrap();
    assert!(Tables::from_bytes(&bytes).unwrap().displacements().is_some());
    let length = bytes.len() - 4;
    // The records of the slots and the lengths around them lie in the last part; vectors may hold
    // anything, but the bound on their length is checked against them.
    for i in (0..length).step_by(97) {
        let mut damaged = bytes.clone();
        damaged[i] ^= 0x55;
        assert!(Tables::from_bytes(&damaged).is_err(), "byte {i}");
        damaged.truncate(length);
        damaged.extend(crc32fast::hash(&damaged).to_le_bytes());
        // Never a panic; an error unless the byte is one of the free ones.
        let _ = Tables::from_bytes(&damaged);
    }
    let other = rules().digits().derivation_order();
    let mut swapped = other;
    swapped[0].swap(1, 2);
    let swapped = Rules::new(&Digits::from_derivation_order(swapped)).unwrap();
    assert_eq!(bake::bake(&swapped, 1, Some(&displacements())), Err(BakeError::OtherDigits));
}

#[test]
fn errors_say_what_is_wrong() {
    assert_eq!(Tables::from_bytes(b"abc").unwrap_err(), TablesError::Truncated { length: 3 });
    assert_eq!(Tables::from_bytes(b"not a table").unwrap_err(), TablesError::NotATableFile);
}

proptest! {
    #[test]
    fn arbitrary_bytes_are_an_error(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(Tables::from_bytes(&bytes).is_err());
    }
}

#[test]
fn a_digit_given_twice_or_to_a_wrong_type_is_named_with_its_line() {
    let text = include_str!("../../tables/digits.txt");
    let line = text.lines().position(|l| l.starts_with("c:")).unwrap() + 1;
    let twice = text.replace("5 D 6 B 7 C", "5 D 6 B 7 B");
    let repeated = DigitsError::RepeatedDigit { line, parent: TileType::C, digit: 11 };
    assert_eq!(Digits::parse(&twice), Err(repeated));
    assert_eq!(
        repeated.to_string(),
        format!("line {line}: digit B stands twice under tile type c")
    );
    let wrong = text.replace("5 D 6 B 7 C", "5 D 6 B 7 4");
    assert_eq!(
        Digits::parse(&wrong),
        Err(DigitsError::WrongType { line, parent: TileType::C, digit: 4, child: TileType::C })
    );
}
