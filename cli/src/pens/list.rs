//! The pens as the command line names them.

use std::fmt;
use std::str::FromStr;

use super::MAX_PENS;
use twelvefold_stipple::page::color::Color;

/// A pen: what its layer is called, and its ink.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pen {
    /// As the user wrote it, such as `teal` or `#c33`.
    pub(crate) name: String,
    /// The ink as it looks on the paper: what the drawing shows.
    pub(crate) color: Color,
}

impl Pen {
    fn new(name: &str, srgb: [u8; 3]) -> Self {
        Self { name: name.to_owned(), color: Color(srgb) }
    }
}

/// At least one pen, and no more than [`MAX_PENS`], of different colors.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pens(Vec<Pen>);

impl Pens {
    /// The pens, light ones first: what a dark pen leaves on the paper would soil a light one.
    ///
    /// # Errors
    /// [`PenError::Paper`] for a pen whose ink is the paper's color.
    pub(crate) fn on(&self, paper: Color) -> Result<Vec<Pen>, PenError> {
        if let Some(pen) = self.0.iter().find(|pen| pen.color == paper) {
            return Err(PenError::Paper(pen.name.clone()));
        }
        let mut pens = self.0.clone();
        let luma = |Color([red, green, blue]): Color| {
            2126 * u32::from(red) + 7152 * u32::from(green) + 722 * u32::from(blue)
        };
        pens.sort_by_key(|pen| std::cmp::Reverse(luma(pen.color)));
        Ok(pens)
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
    /// This is no opaque color.
    Unknown(String),
    /// Two pens of one color would draw the same thing twice.
    Twice(String, String),
    /// Ink that cannot be told from the paper draws nothing.
    Paper(String),
}

impl fmt::Display for PenError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => out.write_str("no pen"),
            Self::TooMany(count) => write!(out, "{count} pens, more than {MAX_PENS}"),
            Self::Unknown(name) => write!(
                out,
                "{name:?} is not a color; write a name such as teal, #c33, or cmyk for four pens"
            ),
            Self::Twice(first, second) => write!(out, "{first} and {second} are one color"),
            Self::Paper(name) => write!(out, "{name} is the paper's color, which draws nothing"),
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

impl FromStr for Pens {
    type Err = PenError;

    /// Reads `cmyk`, or colors separated by commas.
    fn from_str(text: &str) -> Result<Self, PenError> {
        let mut pens = Vec::new();
        for name in text.split(',').map(str::trim).filter(|name| !name.is_empty()) {
            if name.eq_ignore_ascii_case("cmyk") {
                pens.extend(CMYK.iter().map(|(name, srgb)| Pen::new(name, *srgb)));
                continue;
            }
            let color =
                csscolorparser::parse(name).map_err(|_| PenError::Unknown(name.to_owned()))?;
            let [red, green, blue, alpha] = color.to_rgba8();
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
            if let Some(earlier) = pens[..i].iter().find(|earlier| earlier.color == pen.color) {
                return Err(PenError::Twice(earlier.name.clone(), pen.name.clone()));
            }
        }
        Ok(Self(pens))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(pens: &[Pen]) -> Vec<&str> {
        pens.iter().map(|pen| pen.name.as_str()).collect()
    }

    #[test]
    fn names_hexadecimals_and_the_four_inks_are_read_and_draw_light_to_dark() {
        let pens: Pens = "black, #c33,teal".parse().unwrap();
        assert_eq!(names(&pens.0), ["black", "#c33", "teal"]);
        let colors: Vec<_> = pens.0.iter().map(|pen| pen.color.svg()).collect();
        assert_eq!(colors, ["black", "#cc3333", "#008080"]);
        assert_eq!(names(&pens.on(Color::WHITE).unwrap()), ["teal", "#c33", "black"]);
        let pens: Pens = "CMYK".parse().unwrap();
        assert_eq!(names(&pens.on(Color::WHITE).unwrap()), ["yellow", "cyan", "magenta", "black"]);
        let five: Pens = "cmyk,orange".parse().unwrap();
        assert_eq!(five.0.len(), 5);
    }

    #[test]
    fn what_is_not_a_list_of_pens_is_named() {
        let read = |text: &str| text.parse::<Pens>();
        assert_eq!(read(" , "), Err(PenError::Empty));
        assert_eq!(read("blurple"), Err(PenError::Unknown("blurple".into())));
        assert_eq!(read("#0008"), Err(PenError::Unknown("#0008".into())));
        assert_eq!(read("red,#f00"), Err(PenError::Twice("red".into(), "#f00".into())));
        let white = read("black,white").unwrap();
        assert_eq!(white.on(Color::WHITE), Err(PenError::Paper("white".into())));
        assert!(white.on(Color([255, 255, 240])).is_ok());
        let many: Vec<String> = (0..13).map(|i| format!("#0000{i:02x}")).collect();
        assert_eq!(read(&many.join(",")), Err(PenError::TooMany(13)));
    }
}
