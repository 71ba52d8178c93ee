//! Names of files that differ in a number.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{self, Path, PathBuf};

use twelvefold_files::failure::Failure;

/// The names of a sequence's files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pattern {
    before: String,
    /// The least there are; shorter numbers have zeros before them.
    digits: usize,
    after: String,
}

/// The longest number that fits 64 bits.
const MOST_DIGITS: usize = 20;

impl Pattern {
    /// The pattern that a path is, with one `%d` or `%04d` in its last part; `None` for a path without `%`.
    ///
    /// # Errors
    /// What else a `%` is.
    pub(crate) fn of(path: &Path) -> Result<Option<Self>, &'static str> {
        const NOT_ONE: &str = "has not one number such as %04d; a % of the name is written %%";
        let Some(text) = path.to_str().filter(|text| text.contains('%')) else { return Ok(None) };
        let (mut before, mut after, mut digits) = (String::new(), String::new(), None);
        let mut rest = text.split('%');
        before.push_str(rest.next().unwrap_or_default());
        while let Some(part) = rest.next() {
            let to = if digits.is_some() { &mut after } else { &mut before };
            if part.is_empty() {
                // Two in a row, and what follows them.
                to.push('%');
                to.push_str(rest.next().ok_or(NOT_ONE)?);
                continue;
            }
            let (width, name) = part.split_once('d').ok_or(NOT_ONE)?;
            let width = match width {
                "" => 1,
                // Without a zero there would be spaces.
                _ if width.starts_with('0') => width.parse().map_err(|_| NOT_ONE)?,
                _ => return Err(NOT_ONE),
            };
            if digits.replace(width).is_some() || width > MOST_DIGITS {
                return Err(NOT_ONE);
            }
            after.push_str(name);
        }
        if after.contains(path::is_separator) {
            return Err("has its number in the name of a folder; it must be in that of the file");
        }
        let Some(digits) = digits else { return Err(NOT_ONE) };
        Ok(Some(Self { before, digits, after }))
    }

    /// The file of this number.
    pub(crate) fn path(&self, number: u64) -> PathBuf {
        let Self { before, digits, after } = self;
        PathBuf::from(format!("{before}{number:0digits$}{after}"))
    }

    /// The numbers of the files that there are, in order.
    fn numbers(&self) -> io::Result<Vec<u64>> {
        let (folder, name) = match self.before.rfind(path::is_separator) {
            // With the separator: it may be all there is.
            Some(end) => self.before.split_at(end + 1),
            None => (".", &self.before[..]),
        };
        let mut numbers = Vec::new();
        for entry in fs::read_dir(folder)? {
            let found = entry?.file_name();
            let digits = found
                .to_str()
                .and_then(|found| found.strip_prefix(name)?.strip_suffix(&self.after));
            // 7 is not the number of 0007 where two digits are asked for.
            let number = digits.and_then(|digits| digits.parse().ok()).filter(|&number: &u64| {
                digits == Some(&format!("{number:0width$}", width = self.digits))
            });
            numbers.extend(number);
        }
        numbers.sort_unstable();
        Ok(numbers)
    }

    /// The numbers of a sequence, from `first` or the least there is, to `last` or the one before the first that is
    /// missing; and how many files come after that.
    ///
    /// # Errors
    /// [`Failure`] if there is none, or a file of those that are asked for is missing.
    pub(crate) fn sequence(
        &self,
        first: Option<u64>,
        last: Option<u64>,
    ) -> Result<(Range<u64>, usize), Failure> {
        let shown = format!("{}%0{}d{}", self.before, self.digits, self.after);
        let numbers = self
            .numbers()
            .map_err(|error| Failure::about(&shown, format!("cannot be looked for: {error}")))?;
        let Some(start) = first.or(numbers.first().copied()) else {
            return Err(Failure::about(&shown, "is the name of no file"));
        };
        let there = &numbers[numbers.partition_point(|&number| number < start)..];
        let run = there.iter().zip(start..).take_while(|&(&found, wanted)| found == wanted).count();
        let end = start.saturating_add(run as u64);
        if let Some(last) = last {
            if last < start {
                return Err(Failure::about(
                    "--last",
                    format!("{last} is before the first, {start}"),
                ));
            }
            if end <= last {
                return Err(Failure::at(&self.path(end), "is missing in the sequence"));
            }
            return Ok((start..last + 1, 0));
        }
        if run == 0 {
            return Err(Failure::at(&self.path(start), "is not there to begin with"));
        }
        Ok((start..end, there.len() - run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(text: &str) -> Option<Pattern> {
        Pattern::of(Path::new(text)).unwrap()
    }

    #[test]
    fn numbers_have_their_digits_in_any_name() {
        for (text, number, path) in [
            ("in/%04d.png", 7, "in/0007.png"),
            ("%d", 12, "12"),
            ("a%03d", 12_345, "a12345"),
            ("100%%/x%%%02d%%.svg", 3, "100%/x%03%.svg"),
        ] {
            assert_eq!(pattern(text).unwrap().path(number), PathBuf::from(path), "{text}");
        }
        assert_eq!(pattern("in/a.png"), None);
        for bad in ["%", "%s", "%4d", "%d%d", "a%", "%%", "%0d0d%", "%099d", "%d/a.png", "%-4d"] {
            assert!(Pattern::of(Path::new(bad)).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_sequence_goes_to_the_first_gap_or_is_as_asked() {
        let folder = tempfile::tempdir().unwrap();
        let names =
            ["x008.png", "x009.png", "x010.png", "x012.png", "x13.png", "y001.png", "x.png"];
        names.iter().for_each(|name| fs::write(folder.path().join(name), b"").unwrap());
        let pattern = pattern(folder.path().join("x%03d.png").to_str().unwrap()).unwrap();
        assert_eq!(pattern.numbers().unwrap(), [8, 9, 10, 12]);
        assert_eq!(pattern.sequence(None, None).unwrap(), (8..11, 1));
        assert_eq!(pattern.sequence(Some(9), None).unwrap(), (9..11, 1));
        assert_eq!(pattern.sequence(Some(9), Some(9)).unwrap(), (9..10, 0));
        assert_eq!(pattern.sequence(None, Some(10)).unwrap(), (8..11, 0));
        for (first, last, said) in [
            (None, Some(12), "x011.png: is missing"),
            (Some(11), None, "x011.png: is not there"),
            (Some(7), Some(9), "x007.png: is missing"),
            (None, Some(3), "--last: 3 is before the first, 8"),
            (Some(u64::MAX), Some(u64::MAX), "x18446744073709551615.png: is missing"),
        ] {
            let error = pattern.sequence(first, last).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
        let none = Pattern { before: "no such folder/".into(), ..pattern.clone() };
        assert!(
            none.sequence(None, None).unwrap_err().to_string().contains("cannot be looked for")
        );
        let none = Pattern { after: ".tif".into(), ..pattern };
        assert!(
            none.sequence(None, None).unwrap_err().to_string().contains("is the name of no file")
        );
    }
}
