//! The kinds of files that dots are written to.

use std::io::Write;
use std::path::Path;

use clap::ValueEnum;

use twelvefold_stipple::drawing::{Csv, Drawing, DrawingError, Look, Npy, Pdf, Png, Svg};

/// What to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    Svg,
    Png,
    Pdf,
    Csv,
    Npy,
}

impl Format {
    /// The format that the name of a file asks for.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::from_str(extension, true).ok()
    }

    /// Whether it holds places only, and nothing is drawn.
    pub(crate) fn is_list(self) -> bool {
        matches!(self, Self::Csv | Self::Npy)
    }

    /// Begins a drawing.
    ///
    /// # Errors
    /// [`DrawingError`], before large memory is allocated.
    pub(crate) fn begin<'a>(
        self,
        out: impl Write + 'a,
        look: &'a Look,
    ) -> Result<Box<dyn Drawing + 'a>, DrawingError> {
        Ok(match self {
            Self::Svg => Box::new(Svg::new(out, look)?),
            Self::Png => Box::new(Png::new(out, look)?),
            Self::Pdf => Box::new(Pdf::new(out, look)?),
            Self::Csv => Box::new(Csv::new(out, look)?),
            Self::Npy => Box::new(Npy::new(out, look.named)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_chooses_the_format_in_any_case() {
        assert_eq!(Format::of(Path::new("a/b.SVG")), Some(Format::Svg));
        assert_eq!(Format::of(Path::new("x.tar.csv")), Some(Format::Csv));
        assert_eq!(Format::of(Path::new("x.Pdf")), Some(Format::Pdf));
        for none in ["svg", ".png", "x.jpg", "x.", "png/x"] {
            assert_eq!(Format::of(Path::new(none)), None, "{none}");
        }
    }
}
