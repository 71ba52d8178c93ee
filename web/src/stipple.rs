//! From a picture to its dots, in steps.

use std::convert::Infallible;

use js_sys::{Float32Array, Function, Promise};
use twelvefold::refine::Refiner;
use twelvefold_files::picture::Picture;
use twelvefold_stipple::dots::unrefined;
use twelvefold_stipple::wish::{Centers, Count, Wish};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};
use wasm_bindgen_futures::{JsFuture, future_to_promise};

use crate::photograph::{Photograph, plain};
use crate::stippled::{Stippled, places_on};
use crate::tables::tables;

/// The most dots that a page draws.
const MOST_DOTS: f64 = 1_000_000.0;

/// How dots are placed.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// At the centers of tiles.
    Fixed,
    /// Moved aside, by the tables.
    Relaxed,
    /// And then until they draw the picture.
    Refined,
}

#[wasm_bindgen]
impl Photograph {
    /// A promise of about so many `dots`, as [`Stippled`].
    ///
    /// `refine` is how often they are moved in [`Mode::Refined`]. Before each time, `pause` is called with how often
    /// they were moved and, if that is `watched`, where they are, as of [`Stippled::places`]; it returns a promise
    /// that says whether to go on; else the dots stay where they are then.
    pub fn stipple(
        &self,
        mode: Mode,
        dots: f64,
        seed: f64,
        refine: usize,
        watched: bool,
        pause: Function,
    ) -> Promise {
        let wish = Wish {
            count: Count::About(dots.clamp(0.0, MOST_DOTS).round()),
            centers: if mode == Mode::Fixed { Centers::Fixed } else { Centers::Relaxed },
            seed: seed as u64,
            refine: if mode == Mode::Refined { refine } else { 0 },
            best: false,
            ranked: false,
            tables: tables(),
        };
        let (picture, tones, black) = (self.picture(), self.tones(), self.black());
        future_to_promise(async move {
            let mut dots = unrefined::<Infallible>(copy(&picture), wish).map_err(plain)?;
            if wish.refine > 0 {
                let Picture { width, height, importance, .. } = &*picture;
                let mut refiner =
                    Refiner::new(*width, *height, importance, &dots).map_err(plain)?;
                for step in 0..wish.refine {
                    let mut places = JsValue::NULL;
                    if watched {
                        refiner.write(&mut dots).map_err(plain)?;
                        places = Float32Array::from(&places_on(&picture, &dots)[..]).into();
                    }
                    if !goes_on(&pause, step, &places).await? {
                        break;
                    }
                    refiner.step();
                }
                refiner.write(&mut dots).map_err(plain)?;
            }
            Ok(Stippled::new(dots, wish, picture, tones, black).into())
        })
    }
}

/// Waits, and then knows whether anybody still wants the dots.
async fn goes_on(pause: &Function, step: usize, places: &JsValue) -> Result<bool, JsValue> {
    let promise = pause.call2(&JsValue::NULL, &JsValue::from(step as u32), places)?;
    Ok(JsFuture::from(Promise::from(promise)).await?.is_truthy())
}

/// A picture for a map, which keeps its pixels.
fn copy(picture: &Picture) -> Picture {
    let importance = picture.importance.clone();
    Picture { importance, warnings: Vec::new(), ..*picture }
}
