//! Pictures, as the program reads them.

use std::fmt;
use std::path::Path;
use std::rc::Rc;

use js_sys::Error;
use twelvefold_files::picture::{self, Picture, PictureError, Tone};
use twelvefold_stipple::budget::{default_count, default_dot_size};
use twelvefold_stipple::gain;
use wasm_bindgen::prelude::wasm_bindgen;

/// What is asked of a picture's tones.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug, Default)]
pub struct Tones {
    /// Dots follow light instead of encoded values.
    pub linear: bool,
    /// Dots are white and follow what is bright.
    pub invert: bool,
    /// More dots where they overlap.
    pub gain: bool,
}

#[wasm_bindgen]
impl Tones {
    /// All three.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new(linear: bool, invert: bool, gain: bool) -> Self {
        Self { linear, invert, gain }
    }

    pub(crate) fn tone(self) -> Tone {
        Tone { linear: self.linear, invert: self.invert, ..Tone::default() }
    }
}

/// A picture to draw.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Photograph {
    picture: Rc<Picture>,
    tones: Tones,
    black: f64,
    /// Its size before it was made smaller.
    whole: [usize; 2],
}

#[wasm_bindgen]
impl Photograph {
    /// Reads the file of this name, made smaller if it has more than so many pixels.
    ///
    /// # Errors
    /// An `Error` whose message goes on after the file's name. Its own name is `UnknownFormat` if another decoder
    /// may know the format.
    pub fn read(bytes: Vec<u8>, name: &str, tones: &Tones, most: usize) -> Result<Self, Error> {
        let picture =
            picture::read_bytes(bytes, Path::new(name), tones.tone()).map_err(|error| {
                let foreign =
                    matches!(error, PictureError::UnknownFormat | PictureError::Foreign { .. });
                failure(error, if foreign { "UnknownFormat" } else { "Error" })
            })?;
        Self::of(picture, *tones, most)
    }

    /// The picture on a canvas: red, green, blue and coverage of each pixel.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn of_rgba(
        rgba: &[u8],
        width: usize,
        height: usize,
        tones: &Tones,
        most: usize,
    ) -> Result<Self, Error> {
        let picture = picture::of_rgba((width, height), rgba, tones.tone());
        Self::of(picture.map_err(plain)?, *tones, most)
    }

    /// Pixels across.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn width(&self) -> usize {
        self.picture.width
    }

    /// Pixels down.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn height(&self) -> usize {
        self.picture.height
    }

    /// Pixels across and down of what was read, before it was made smaller.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn whole(&self) -> Vec<usize> {
        self.whole.to_vec()
    }

    /// What was assumed or amiss, each a sentence's end that follows the file's name.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        self.picture.warnings.clone()
    }

    /// How many dots it gets if nobody says.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn dots(&self) -> f64 {
        default_count(self.black)
    }

    /// The diameter of so many dots, in pixels, if nobody says.
    #[must_use]
    pub fn dot_size(&self, dots: f64) -> f64 {
        default_dot_size(dots / self.black)
    }
}

impl Photograph {
    /// # Errors
    /// A picture without a place for dots.
    pub(crate) fn of(picture: Picture, tones: Tones, most: usize) -> Result<Self, Error> {
        if picture.total() == 0.0 {
            return Err(plain(if tones.invert {
                "is all black, which leaves no place for dots. Try without “White on black”."
            } else {
                "is all white, which leaves no place for dots. Try “White on black”."
            }));
        }
        let whole = [picture.width, picture.height];
        let mut picture = picture.reduced(most);
        if tones.gain {
            gain::correct(&mut picture.importance);
        }
        let black = picture.total();
        Ok(Self { picture: Rc::new(picture), tones, black, whole })
    }

    pub(crate) fn picture(&self) -> Rc<Picture> {
        Rc::clone(&self.picture)
    }

    pub(crate) fn tones(&self) -> Tones {
        self.tones
    }

    /// The sum of all importance.
    pub(crate) fn black(&self) -> f64 {
        self.black
    }
}

/// An error with a name by which scripts tell it.
fn failure(reason: impl fmt::Display, name: &str) -> Error {
    let error = Error::new(&reason.to_string());
    error.set_name(name);
    error
}

/// An error that is only shown.
pub(crate) fn plain(reason: impl fmt::Display) -> Error {
    failure(reason, "Error")
}
