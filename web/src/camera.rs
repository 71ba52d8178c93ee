//! Frames of a camera, held still where nothing changes.

use js_sys::Error;
use twelvefold_files::picture;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::photograph::{Photograph, Tones, plain};

/// A change of darkness, from 0 to 1, below which a pixel is taken to be as it was: sensors' noise is less. Dots
/// that draw the same pixels are the same dots.
const TOLERANCE: f32 = 0.06;

/// What a camera sees.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Camera {
    held: Vec<f32>,
    size: [usize; 2],
    tones: (bool, bool),
}

#[wasm_bindgen]
impl Camera {
    /// One that has seen nothing yet.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The next frame as a picture.
    ///
    /// # Errors
    /// As [`Photograph::of_rgba`].
    pub fn frame(
        &mut self,
        rgba: &[u8],
        width: usize,
        height: usize,
        tones: &Tones,
    ) -> Result<Photograph, Error> {
        let mut picture = picture::of_rgba((width, height), rgba, tones.tone()).map_err(plain)?;
        let same = self.size == [width, height] && self.tones == (tones.linear, tones.invert);
        if same && self.held.len() == picture.importance.len() {
            for (seen, held) in picture.importance.iter_mut().zip(&self.held) {
                if (*seen - held).abs() < TOLERANCE {
                    *seen = *held;
                }
            }
        }
        self.held.clone_from(&picture.importance);
        self.size = [width, height];
        self.tones = (tones.linear, tones.invert);
        Photograph::of(picture, *tones, usize::MAX)
    }
}
