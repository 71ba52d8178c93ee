//! Lengths and sizes of paper.

use std::str::FromStr;

use glam::DVec2;

const MILLIMETERS_IN_INCH: f64 = 25.4;

/// The longest side of a page: plotters with rolls draw some tens of meters. With it, a thousandth of a
/// millimeter is well above the rounding of the numbers that are written.
const LONGEST_SIDE: f64 = 100_000.0;

/// A length above zero: a number with or without a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Length {
    /// Without a unit: what it means is for the option to say.
    Bare(f64),
    Millimeters(f64),
}

impl Length {
    /// The length in millimeters, which a bare number is taken to be in.
    pub fn millimeters(self) -> f64 {
        match self {
            Self::Bare(length) | Self::Millimeters(length) => length,
        }
    }
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, unit) = split(text);
        let length: f64 = number
            .parse()
            .ok()
            .filter(|length: &f64| length.is_finite() && *length > 0.0)
            .ok_or("not a length above zero, such as 0.3, 0.3mm or 0.01in")?;
        match unit {
            "" => Ok(Self::Bare(length)),
            "mm" => Ok(Self::Millimeters(length)),
            "in" => Ok(Self::Millimeters(length * MILLIMETERS_IN_INCH)),
            _ => Err("has a unit other than mm and in".to_owned()),
        }
    }
}

/// Reads a length of zero or more, in millimeters unless it says otherwise.
pub fn margin(text: &str) -> Result<f64, String> {
    let (number, unit) = split(text);
    if number.parse() == Ok(0.0) && ["", "mm", "in"].contains(&unit) {
        return Ok(0.0);
    }
    text.parse().map(Length::millimeters)
}

/// The number at the start of a text, and the unit that follows it.
fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    let end = text.trim_end_matches(|c: char| c.is_ascii_alphabetic()).len();
    let (number, unit) = text.split_at(end);
    (number.trim(), unit)
}

/// The size of a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PageSize {
    /// Millimeters.
    pub size: DVec2,
    /// Whether the page may be turned so that the picture is larger: a kind of paper may, a size that was
    /// written out is meant as it stands.
    pub turns: bool,
}

impl FromStr for PageSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let paper = |width, height| Ok(Self { size: DVec2::new(width, height), turns: true });
        match text.to_ascii_lowercase().as_str() {
            "a3" => return paper(297.0, 420.0),
            "a4" => return paper(210.0, 297.0),
            "a5" => return paper(148.0, 210.0),
            "letter" => return paper(8.5 * MILLIMETERS_IN_INCH, 11.0 * MILLIMETERS_IN_INCH),
            _ => {}
        }
        let unknown = || "neither a3, a4, a5, letter nor a size such as 210x297mm or 8.5x11in";
        let (width, height) = text.split_once(['x', 'X']).ok_or_else(unknown)?;
        let height: Length = height.parse().map_err(|_| unknown())?;
        let width: Length = width.parse().map_err(|_| unknown())?;
        // The unit behind the height is that of the width too.
        let width = match (width, split(text).1) {
            (Length::Bare(width), "in") => width * MILLIMETERS_IN_INCH,
            (width, _) => width.millimeters(),
        };
        let size = DVec2::new(width, height.millimeters());
        if size.max_element() > LONGEST_SIDE {
            return Err(format!("longer than {} m", LONGEST_SIDE / 1e3));
        }
        Ok(Self { size, turns: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_have_names_or_sizes_in_either_unit() {
        let size = |text: &str| text.parse::<PageSize>().map(|page| page.size.to_array());
        for (text, expected) in [
            ("a4", [210.0, 297.0]),
            ("A3", [297.0, 420.0]),
            ("letter", [215.9, 279.4]),
            ("210x297", [210.0, 297.0]),
            ("210x297mm", [210.0, 297.0]),
            ("210mmX297mm", [210.0, 297.0]),
            ("8.5x11in", [215.9, 279.4]),
            ("8.5inx11in", [215.9, 279.4]),
            ("1in x 10mm", [25.4, 10.0]),
        ] {
            let found = size(text).unwrap();
            assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1e-9), "{text}: {found:?}");
        }
        for bad in [
            "",
            "x",
            "a9",
            "a4x",
            "210",
            "210x",
            "x297",
            "0x10",
            "-1x10",
            "NaNx1",
            "infx1",
            "1e9x1",
            "10x10cm",
            "10pxx10px",
            "10x10x10",
            "210×297",
            "mmxmm",
            "10inx5ft",
        ] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lengths_are_above_zero_and_margins_may_be_zero() {
        assert_eq!("0.3".parse(), Ok(Length::Bare(0.3)));
        assert_eq!("0.3mm".parse(), Ok(Length::Millimeters(0.3)));
        assert_eq!("0.5in".parse(), Ok(Length::Millimeters(12.7)));
        for bad in ["0", "0mm", "-1", "NaN", "inf", "", "mm", "3px", "1e999", "0.3 mm mm"] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
        assert_eq!((margin("0"), margin("0in"), margin("5mm")), (Ok(0.0), Ok(0.0), Ok(5.0)));
        for bad in ["-0.1", "0px", "", "x"] {
            assert!(margin(bad).is_err(), "{bad}");
        }
    }
}
