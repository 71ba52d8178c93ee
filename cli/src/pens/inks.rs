//! A color picture divided among pens.

use std::fmt;

use twelvefold::refine::{Classes, RefineError};
use twelvefold_files::picture::ColorPicture;

use super::{Pen, Separation, Shadows};
use twelvefold_stipple::page::color::Color;

/// The most bytes for what all pens draw of a picture: one gibibyte.
const MEMORY_LIMIT: usize = 1 << 30;

/// Pens, in drawing order, and how much of each a picture needs.
#[derive(Debug)]
pub(crate) struct Inks {
    pub(crate) pens: Vec<Pen>,
    /// One class a pen.
    pub(crate) classes: Classes,
}

/// Why a picture cannot be divided.
#[derive(Debug)]
pub(crate) enum InksError {
    /// More memory than the limit, or than there is.
    Memory {
        bytes: Option<usize>,
    },
    Classes(RefineError),
}

impl fmt::Display for InksError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Memory { bytes } => {
                out.write_str("so many pens for so many pixels need ")?;
                match bytes {
                    Some(bytes) => write!(out, "{} MiB", bytes.div_ceil(1 << 20))?,
                    None => out.write_str("over 16 EiB")?,
                }
                write!(out, " of memory, more than there is or than {} MiB", MEMORY_LIMIT >> 20)
            }
            Self::Classes(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for InksError {}

impl Inks {
    /// Divides a picture. `most` is the share of an area that all dots together may cover, and `full` the one
    /// that counts as 1; for the rest see [`Separation::new`].
    ///
    /// # Errors
    /// [`InksError`].
    pub(crate) fn new(
        picture: &ColorPicture,
        pens: Vec<Pen>,
        paper: Color,
        [most, full]: [f64; 2],
        shadows: Shadows,
        gray: f64,
    ) -> Result<Self, InksError> {
        // Every plane, and their sum twice: once for the map that is sampled.
        let bytes = picture.pixels.len().checked_mul(size_of::<f32>() * (pens.len() + 2));
        let too_large = || InksError::Memory { bytes };
        if bytes.is_none_or(|bytes| bytes > MEMORY_LIMIT) {
            return Err(too_large());
        }
        let separation = Separation::new(&pens, paper, most, shadows, gray);
        let mut planes = Vec::new();
        for _ in &pens {
            let mut plane: Vec<f32> = Vec::new();
            plane.try_reserve_exact(picture.pixels.len()).map_err(|_| too_large())?;
            planes.push(plane);
        }
        // Neighbors are often alike.
        let mut last = ([f32::NAN; 3], separation.amounts([0.0; 3]));
        let scale = (1.0 / full) as f32;
        for &[red, green, blue, covered] in &picture.pixels {
            let light = [red, green, blue];
            if light != last.0 {
                last = (light, separation.amounts(light));
            }
            for (plane, amount) in planes.iter_mut().zip(last.1) {
                plane.push(amount * covered * scale);
            }
        }
        let classes =
            Classes::new(picture.width, picture.height, planes).map_err(InksError::Classes)?;
        Ok(Self { pens, classes })
    }
}
