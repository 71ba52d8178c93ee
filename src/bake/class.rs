//! Structural classes: what a tile knows of its surroundings from its last few ancestors.
//!
//! A class over G generations is (type of the ancestor G levels up, the G digits below it). Classes
//! are numbered by the rank recurrence itself, started from four roots `a`, `b`, `c`, `d` at once:
//!
//! class_0 = 0 … 3 for `a` … `d`,  n_{−1} = 1,  n_0 = 4,  n_{G+1} = 14·n_G − n_{G−1},
//! class_{G+1}(child) = d·n_G + class_G(parent)                   for d = 0 … C,
//! class_{G+1}(child) = 13·n_G + class_G(parent) − n_{G−1}        for d = D.
//!
//! So n = 4, 55, 766, 10669, … and, as for ranks, the order of the classes is the order in which
//! growing thresholds give birth to their members: classes not yet born are a suffix.

use crate::tiling::{Rules, TileType};

/// The most generations of ancestors that a class may span.
pub const MAX_GENERATIONS: usize = 4;

/// n_{−1}, n_0 … n_4.
const CLASS_COUNTS: [u32; MAX_GENERATIONS + 2] = {
    let mut counts = [1, 4, 0, 0, 0, 0];
    let mut i = 2;
    while i < counts.len() {
        counts[i] = 14 * counts[i - 1] - counts[i - 2];
        i += 1;
    }
    counts
};

/// The number of classes over `generations`, or `None` past [`MAX_GENERATIONS`].
#[must_use]
pub const fn class_count(generations: usize) -> Option<u32> {
    if generations > MAX_GENERATIONS { None } else { Some(CLASS_COUNTS[generations + 1]) }
}

/// A tile's class over each number of generations, 0 ..= [`MAX_GENERATIONS`].
///
/// Ancestors above a root are taken to be roots' center chains: a root is its own grandparent's
/// digit 0. Points relaxed that near a root are no sample of anything, so nothing depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Classes([u32; MAX_GENERATIONS + 1]);

impl Classes {
    /// The classes of a root tile.
    #[must_use]
    pub const fn root(kind: TileType) -> Self {
        // Digit 0 under any ancestor adds nothing to the number.
        Self([kind as u32; MAX_GENERATIONS + 1])
    }

    /// The classes of the child with `digit` (0..14, existing) of type `child` of a tile of these
    /// classes.
    #[must_use]
    pub const fn child(&self, digit: u8, child: TileType) -> Self {
        let mut classes = [child as u32; MAX_GENERATIONS + 1];
        let mut g = 0;
        while g < MAX_GENERATIONS {
            let gap = if digit == 13 { CLASS_COUNTS[g] } else { 0 };
            classes[g + 1] = digit as u32 * CLASS_COUNTS[g + 1] + self.0[g] - gap;
            g += 1;
        }
        Self(classes)
    }

    /// The class over `generations` (taken as at most [`MAX_GENERATIONS`]), below [`class_count`].
    #[must_use]
    pub const fn over(&self, generations: usize) -> u32 {
        self.0[if generations > MAX_GENERATIONS { MAX_GENERATIONS } else { generations }]
    }
}

/// A class taken apart: the type of its oldest ancestor and the digits below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The type of the ancestor `generations` levels up.
    pub ancestor: TileType,
    /// The digits, oldest first, in the first `generations` places.
    pub oldest_first: [u8; MAX_GENERATIONS],
}

/// The parts of a class over `generations`, or `None` if there is no such class.
#[must_use]
pub fn parts(generations: usize, class: u32) -> Option<Parts> {
    if class >= class_count(generations)? {
        return None;
    }
    let mut oldest_first = [0; MAX_GENERATIONS];
    let mut rest = class;
    for g in (0..generations).rev() {
        let parents = CLASS_COUNTS[g + 1];
        let digit = (rest / parents).min(13);
        rest -= digit * parents;
        if digit == 13 {
            rest += CLASS_COUNTS[g];
        }
        oldest_first[g] = digit as u8;
    }
    Some(Parts { ancestor: TileType::ALL[rest as usize % 4], oldest_first })
}

/// The class over fewer generations that the members of `class` have, or `None` if there is no such
/// class or it spans fewer than `fewer` generations.
#[must_use]
pub fn coarsened(rules: &Rules, generations: usize, class: u32, fewer: usize) -> Option<u32> {
    let parts = parts(generations, class)?;
    let digits = &parts.oldest_first[..generations];
    let mut kind = parts.ancestor;
    let mut classes = Classes::root(kind);
    for (g, &digit) in digits.iter().enumerate() {
        kind = rules.children(kind).get(usize::from(digit))?.kind;
        classes = if generations - g == fewer + 1 {
            Classes::root(kind)
        } else {
            classes.child(digit, kind)
        };
    }
    (fewer <= generations).then(|| classes.over(fewer))
}

#[cfg(test)]
mod tests {
    use alloc::{vec, vec::Vec};

    use super::*;
    use crate::tiling::Digits;

    #[test]
    fn classes_number_all_words_without_gaps_and_take_apart_again() {
        let rules =
            Rules::new(&Digits::parse(include_str!("../../tables/digits.txt")).unwrap()).unwrap();
        let mut tiles: Vec<(TileType, Classes)> =
            TileType::ALL.iter().map(|kind| (*kind, Classes::root(*kind))).collect();
        for generations in 1..=MAX_GENERATIONS {
            tiles = tiles
                .iter()
                .flat_map(|(kind, classes)| {
                    (0u8..)
                        .zip(rules.children(*kind))
                        .map(|(d, c)| (c.kind, classes.child(d, c.kind)))
                })
                .collect();
            let count = class_count(generations).unwrap();
            let mut seen = vec![false; count as usize];
            for (kind, classes) in &tiles {
                let class = classes.over(generations);
                assert!(!core::mem::replace(&mut seen[class as usize], true));
                assert_eq!(classes.over(0), *kind as u32);
                for fewer in 0..generations {
                    let coarse = coarsened(&rules, generations, class, fewer);
                    assert_eq!(coarse, Some(classes.over(fewer)), "{generations} {class} {fewer}");
                }
            }
            assert!(seen.iter().all(|s| *s));
            assert_eq!(parts(generations, count), None);
        }
        assert_eq!(
            [class_count(2), class_count(3), class_count(5)],
            [Some(766), Some(10669), None]
        );
    }
}
