//! Dots on their way into a file, one by one: each format takes them in any order and keeps no list, but for
//! PNG, which keeps a picture, and PDF and NPY, which keep bytes: a size goes before them.

mod canvas;
mod coverage;
mod csv;
mod decimal;
pub mod npy;
mod pdf;
mod png;
mod svg;
mod y4m;

use std::fmt;
use std::io;

use glam::DVec2;

use crate::page::color::Color;
use crate::page::mark::Mark;
use crate::page::sheet::Sheet;

pub use self::csv::Csv;
pub use self::npy::Npy;
pub use self::pdf::Pdf;
pub use self::png::Png;
pub use self::svg::Svg;
pub use self::y4m::Y4m;

/// A file being filled with the dots of one layer after the other.
pub trait Drawing {
    /// Begins a layer. There is one before the first dot.
    ///
    /// # Errors
    /// The system's, when a full buffer cannot be written.
    fn layer(&mut self, layer: &Layer) -> io::Result<()>;

    /// Adds the dot with this center, in the sheet's unit; of a line, where it goes next.
    ///
    /// # Errors
    /// The system's, as for [`layer`](Self::layer).
    fn dot(&mut self, at: DVec2) -> io::Result<()>;

    /// Says that what was drawn so far does not depend on what follows, nor that on it: a file may be cut here.
    ///
    /// # Errors
    /// The system's, as for [`layer`](Self::layer).
    fn cut(&mut self) -> io::Result<()> {
        Ok(())
    }

    /// Writes what is left and ends the file.
    ///
    /// # Errors
    /// The system's.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// What one pen draws.
#[derive(Debug, Clone)]
pub struct Layer {
    pub name: String,
    pub color: Color,
}

/// Which part of a file is written, where it may be cut: parts in order, one after the other, are the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece {
    /// What goes before the first dot belongs to it.
    pub first: bool,
    /// What goes after the last dot belongs to it.
    pub last: bool,
}

impl Piece {
    pub const WHOLE: Self = Self { first: true, last: true };
}

/// What the drawing looks like.
#[derive(Debug, Clone)]
pub struct Look {
    /// Of CSV and SVG; others are not cut.
    pub piece: Piece,
    pub sheet: Sheet,
    pub mark: Mark,
    /// The distance of neighbors where dots are densest, in the sheet's unit.
    pub spacing: f64,
    /// What lies below the dots where something must: pixels have to have a color.
    pub ground: Color,
    /// Whether the ground is drawn where nothing need lie there.
    pub ground_drawn: bool,
    /// Averages are to be right in linear light, instead of in encoded values.
    pub linear: bool,
    /// Lists say of which layer each dot is.
    pub named: bool,
    /// What the drawing shows, in plain text.
    pub title: String,
    /// How it was made, in plain text.
    pub description: String,
}

impl Look {
    /// Decimals of coordinates, in the sheet's unit.
    fn decimals(&self) -> usize {
        // A thousandth of a millimeter; and a line is free of crossings in thousandths.
        if self.sheet.is_page() || matches!(self.mark, Mark::Line(_)) {
            return 3;
        }
        // At least two, in which a tap has a length.
        decimal::decimals(self.spacing).max(2)
    }
}

/// Why a drawing cannot be begun.
#[derive(Debug)]
pub enum DrawingError {
    /// A picture of pixels would need more memory than the limit, or than there is.
    TooLarge { width: f64, height: f64, page: bool },
    /// The system's.
    Io(io::Error),
}

impl fmt::Display for DrawingError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge { width, height, page } => write!(
                out,
                "would be {width:.0} x {height:.0} pixels large, more than {} MiB of memory hold; \
                 choose a smaller {}",
                png::MEMORY_LIMIT >> 20,
                if *page { "--dpi" } else { "--scale" }
            ),
            Self::Io(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for DrawingError {}

impl From<io::Error> for DrawingError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

#[cfg(test)]
impl Look {
    /// A look for tests: a photograph of this size, discs of this width on white.
    fn of_pixels(width: usize, height: usize, scale: f64, dot: f64) -> Self {
        Self {
            piece: Piece::WHOLE,
            sheet: Sheet::of_pixels(DVec2::new(width as f64, height as f64), scale),
            mark: Mark::Disc(dot),
            spacing: 3.0,
            ground: Color::WHITE,
            ground_drawn: true,
            linear: false,
            named: false,
            title: "t".into(),
            description: "d".into(),
        }
    }
}

#[cfg(test)]
impl Layer {
    fn black() -> Self {
        Self { name: "black".into(), color: Color::BLACK }
    }
}
