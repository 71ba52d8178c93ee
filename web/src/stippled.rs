//! Dots as places, and as the files that the program writes.

use std::rc::Rc;

use glam::DVec2;
use js_sys::Error;
use twelvefold_files::picture::Picture;
use twelvefold_stipple::budget::default_dot_size;
use twelvefold_stipple::drawing::{Csv, Drawing, Layer, Look, Piece, Png, Svg};
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::mark::Mark;
use twelvefold_stipple::page::sheet::Sheet;
use twelvefold_stipple::wish::Wish;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::photograph::{Tones, plain};

/// The dots of a picture.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Stippled {
    dots: Vec<DVec2>,
    wish: Wish,
    picture: Rc<Picture>,
    tones: Tones,
    /// Dots in a squared pixel where the picture is black.
    density: f64,
}

#[wasm_bindgen]
impl Stippled {
    /// x and y of each dot, in pixels: the numbers of the program's lists.
    #[must_use]
    pub fn places(&self) -> Vec<f32> {
        places_on(&self.picture, &self.dots)
    }

    /// An `svg`, `png` or `csv` file of the dots: of their usual diameter if `dot_size` is 0, else of that one in
    /// pixels; and so many times as large as the picture.
    ///
    /// # Errors
    /// A PNG picture that would take more memory than there is, and kinds that there are not.
    pub fn file(
        &self,
        kind: &str,
        title: &str,
        dot_size: f64,
        scale: f64,
    ) -> Result<Vec<u8>, Error> {
        let look = self.look(title, dot_size, scale);
        let mut bytes = Vec::new();
        let drawing: Box<dyn Drawing + '_> = match kind {
            "svg" => Box::new(Svg::new(&mut bytes, &look).map_err(plain)?),
            "png" => Box::new(Png::new(&mut bytes, &look).map_err(plain)?),
            "csv" => Box::new(Csv::new(&mut bytes, &look).map_err(plain)?),
            _ => return Err(plain(format!("{kind} files are not written"))),
        };
        self.draw(drawing, &look).map_err(plain)?;
        Ok(bytes)
    }
}

impl Stippled {
    pub(crate) fn new(
        dots: Vec<DVec2>,
        wish: Wish,
        picture: Rc<Picture>,
        tones: Tones,
        black: f64,
    ) -> Self {
        Self { dots, wish, picture, tones, density: wish.count.number() / black }
    }

    fn draw(&self, mut drawing: Box<dyn Drawing + '_>, look: &Look) -> std::io::Result<()> {
        let color = if self.tones.invert { Color::WHITE } else { Color::BLACK };
        drawing.layer(&Layer { name: color.svg(), color })?;
        for dot in &self.dots {
            drawing.dot(look.sheet.place(*dot))?;
        }
        drawing.finish()
    }

    fn look(&self, title: &str, dot_size: f64, scale: f64) -> Look {
        let width = if dot_size > 0.0 { dot_size } else { default_dot_size(self.density) };
        Look {
            piece: Piece::WHOLE,
            sheet: sheet(&self.picture, scale),
            mark: Mark::Disc(width),
            spacing: 1.0 / self.density.sqrt(),
            ground: if self.tones.invert { Color::BLACK } else { Color::WHITE },
            ground_drawn: true,
            linear: self.tones.linear,
            named: false,
            title: title.to_owned(),
            description: self.wish.description(),
        }
    }
}

/// Dots as numbers, x and y of each.
pub(crate) fn places_on(picture: &Picture, dots: &[DVec2]) -> Vec<f32> {
    let sheet = sheet(picture, 1.0);
    let places = dots.iter().map(|dot| sheet.place(*dot));
    places.flat_map(|place| place.as_vec2().to_array()).collect()
}

fn sheet(picture: &Picture, scale: f64) -> Sheet {
    Sheet::of_pixels(DVec2::new(picture.width as f64, picture.height as f64), scale)
}
