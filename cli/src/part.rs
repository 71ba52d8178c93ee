//! Which part of a drawing is made.

use std::str::FromStr;

/// One of several parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part {
    /// From 0.
    pub(crate) index: usize,
    /// More than `index`.
    pub(crate) of: usize,
}

impl Part {
    pub(crate) fn is_first(self) -> bool {
        self.index == 0
    }

    pub(crate) fn is_last(self) -> bool {
        self.index + 1 == self.of
    }
}

impl FromStr for Part {
    type Err = &'static str;

    /// Reads I/N, 1 ≤ I ≤ N.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let number = |text: &str| text.parse::<u32>().ok().map(|number| number as usize);
        let part = text.split_once('/').and_then(|(i, n)| Some((number(i)?, number(n)?)));
        match part {
            Some((i, of)) if (1..=of).contains(&i) => Ok(Self { index: i - 1, of }),
            _ => Err("not I/N with I from 1 to N"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_count_from_one() {
        assert_eq!("1/3".parse(), Ok(Part { index: 0, of: 3 }));
        assert_eq!("3/3".parse(), Ok(Part { index: 2, of: 3 }));
        for bad in ["", "3", "0/3", "4/3", "-1/3", "1/0", "0/0", "1/3/5", "1/x", "9999999999/1"] {
            assert!(bad.parse::<Part>().is_err(), "{bad}");
        }
    }
}
