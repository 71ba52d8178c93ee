//! The digit table: every mistake in it is an error that names line and rule.

use twelvefold::tiling::{Digits, DigitsError, Rules, TileType};

const DIGITS: &str = include_str!("../../tables/digits.txt");

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
    assert_eq!(Rules::new(&good), Ok(Rules::new(&Digits::parse(DIGITS).unwrap()).unwrap()));
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
