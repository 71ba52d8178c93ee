//! Dots on their way into a file, one by one: each format takes them in any order and keeps no list.

mod canvas;
mod coverage;
mod csv;
mod png;
mod svg;

use std::io;

pub(crate) use self::csv::Csv;
pub(crate) use self::png::{Png, PngError};
pub(crate) use self::svg::Svg;

/// A file being filled with dots.
pub(crate) trait Drawing: Sized {
    /// Adds the dot whose centre is (x, y), in pixels of the photograph, x to the right, y down.
    ///
    /// # Errors
    /// The system's, when a full buffer cannot be written.
    fn dot(&mut self, x: f32, y: f32) -> io::Result<()>;

    /// Writes what is left and ends the file.
    ///
    /// # Errors
    /// The system's.
    fn finish(self) -> io::Result<()>;
}

/// What the picture of the dots looks like.
#[derive(Debug, Clone)]
pub(crate) struct Style {
    /// Pixels of the photograph across.
    pub(crate) width: usize,
    /// Pixels of the photograph down.
    pub(crate) height: usize,
    /// Size of the drawing as a multiple of the photograph's, above zero.
    pub(crate) scale: f64,
    /// A dot's diameter in pixels of the photograph, above zero.
    pub(crate) dot_size: f64,
    /// The distance of neighbours where dots are densest, in pixels of the photograph.
    pub(crate) spacing: f64,
    /// White dots on black, instead of black on white.
    pub(crate) white_on_black: bool,
    /// Averages are to be right in linear light, instead of in encoded values.
    pub(crate) linear: bool,
    /// What the picture shows, in plain text.
    pub(crate) title: String,
    /// How it was made, in plain text.
    pub(crate) description: String,
}
