//! The pens as the command line names them.

use std::fmt;

use super::MAX_PENS;

/// A pen: what its layer is called, and its ink.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pen {
    /// As the user wrote it, such as `teal` or `#c33`.
    pub(crate) name: String,
    /// The ink on white paper as encoded sRGB, each 0..=255: what the drawing shows.
    pub(crate) srgb: [u8; 3],
}

impl Pen {
    /// The pen of this name and encoded colour.
    fn new(name: &str, srgb: [u8; 3]) -> Self {
        Self { name: name.to_owned(), srgb }
    }

    /// The colour as an SVG attribute has it.
    pub(crate) fn hex(&self) -> String {
        let [red, green, blue] = self.srgb;
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Why a text is not a list of pens.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub(crate) enum PenError {
    /// No pen at all.
    Empty,
    /// More than [`MAX_PENS`].
    TooMany(usize),
    /// This is no colour.
    Unknown(String),
    /// Two pens of one colour would draw the same thing twice.
    Twice(String, String),
    /// Ink that cannot be told from the paper draws nothing.
    Paper(String),
}

impl fmt::Display for PenError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => out.write_str("names no pen"),
            Self::TooMany(count) => write!(out, "names {count} pens, more than {MAX_PENS}"),
            Self::Unknown(name) => write!(
                out,
                "{name:?} is not a colour; write a name such as teal, #c33, or cmyk for four pens"
            ),
            Self::Twice(first, second) => write!(out, "{first} and {second} are one colour"),
            Self::Paper(name) => write!(out, "{name} is the paper's colour, which draws nothing"),
        }
    }
}

impl std::error::Error for PenError {}

/// The four process inks as they look on white paper: ISO Coated solids in sRGB, rounded. Printers'
/// cyan is far from #0ff, and a drawing made for #0ff comes out too blue.
const CMYK: [(&str, [u8; 3]); 4] = [
    ("cyan", [0, 158, 224]),
    ("magenta", [226, 0, 122]),
    ("yellow", [255, 230, 0]),
    ("black", [29, 29, 27]),
];

/// Reads pens in the order in which they draw: `cmyk`, or colours separated by commas.
///
/// # Errors
/// [`PenError`].
pub(crate) fn parse(text: &str, paper: [u8; 3]) -> Result<Vec<Pen>, PenError> {
    let mut pens = Vec::new();
    for name in text.split(',').map(str::trim).filter(|name| !name.is_empty()) {
        if name.eq_ignore_ascii_case("cmyk") {
            pens.extend(CMYK.iter().map(|(name, srgb)| Pen::new(name, *srgb)));
            continue;
        }
        let colour = csscolorparser::parse(name).map_err(|_| PenError::Unknown(name.to_owned()))?;
        let [red, green, blue, alpha] = colour.to_rgba8();
        if alpha < 255 {
            return Err(PenError::Unknown(name.to_owned()));
        }
        pens.push(Pen::new(name, [red, green, blue]));
    }
    if pens.is_empty() {
        return Err(PenError::Empty);
    }
    if pens.len() > MAX_PENS {
        return Err(PenError::TooMany(pens.len()));
    }
    for (i, pen) in pens.iter().enumerate() {
        if let Some(earlier) = pens[..i].iter().find(|earlier| earlier.srgb == pen.srgb) {
            return Err(PenError::Twice(earlier.name.clone(), pen.name.clone()));
        }
        if pen.srgb == paper {
            return Err(PenError::Paper(pen.name.clone()));
        }
    }
    Ok(pens)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: [u8; 3] = [255; 3];

    #[test]
    fn names_hexadecimals_and_the_four_inks_are_read_in_order() {
        let pens = parse("black, #c33,teal", WHITE).unwrap();
        let found: Vec<_> = pens.iter().map(|pen| (pen.name.as_str(), pen.hex())).collect();
        let expected = [("black", "#000000"), ("#c33", "#cc3333"), ("teal", "#008080")];
        assert_eq!(found, expected.map(|(name, hex)| (name, hex.to_owned())));
        let names: Vec<_> = parse("CMYK", WHITE).unwrap().into_iter().map(|pen| pen.name).collect();
        assert_eq!(names, ["cyan", "magenta", "yellow", "black"]);
    }

    #[test]
    fn what_is_not_a_list_of_pens_is_named() {
        assert_eq!(parse(" , ", WHITE), Err(PenError::Empty));
        assert_eq!(parse("blurple", WHITE), Err(PenError::Unknown("blurple".into())));
        assert_eq!(parse("#0008", WHITE), Err(PenError::Unknown("#0008".into())));
        assert_eq!(parse("red,#f00", WHITE), Err(PenError::Twice("red".into(), "#f00".into())));
        assert_eq!(parse("white", WHITE), Err(PenError::Paper("white".into())));
        let many: Vec<String> = (0..13).map(|i| format!("#0000{i:02x}")).collect();
        assert_eq!(parse(&many.join(","), WHITE), Err(PenError::TooMany(13)));
    }
}
