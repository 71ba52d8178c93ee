//! How a walk finds its points: the tiles that it opens, and those that stay whole.

use js_sys::Error;
use twelvefold::{
    Amount, ImageMap, InvalidPixels, Limits, Pixels, PlacedTile, Placement, Sampling,
};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::photograph::plain;
use crate::tables::tables;

/// What a page can show.
const LIMITS: Limits = Limits { points: 60_000, tiles: 60_000 };

/// The tiles of a walk, and the points that it found.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Descent {
    tiles: Vec<f64>,
    points: Vec<f64>,
}

#[wasm_bindgen]
impl Descent {
    /// Under an importance of `side` × `side` pixels, from 0 to 1, with `density` points a pixel where it is 1.
    ///
    /// # Errors
    /// Too many points or tiles.
    #[wasm_bindgen(constructor)]
    pub fn new(importance: Vec<f32>, side: usize, density: f64, seed: f64) -> Result<Self, Error> {
        let map = Pixels::new(side, side, importance, InvalidPixels::Reject)
            .and_then(ImageMap::new)
            .map_err(plain)?;
        let placement = Placement::new_in(map.domain(), seed as u64, tables());
        let amount = Amount::Density(density);
        let sampling = Sampling::within(&placement, &map, amount, LIMITS).map_err(plain)?;
        let mut descent = Self::default();
        sampling
            .opened(|parent, children| {
                if let Some(tile) = parent {
                    descent.push(tile, true);
                }
                children.iter().for_each(|tile| descent.push(tile, false));
            })
            .map_err(plain)?;
        // The same points, where they were accepted and where they are moved to, both in the order of the walk.
        for sampling in [sampling, sampling.relaxed().map_err(plain)?] {
            for point in sampling.points::<glam::DVec2>().map_err(plain)? {
                let point = point.map_err(plain)?;
                descent.points.extend([point.rank as f64, point.position.x, point.position.y]);
            }
        }
        Ok(descent)
    }

    /// Eight numbers a tile, in the order of the walk: level, rank, type from 0 to 3, whether it is opened (a tile
    /// is listed by its parent, and again when it is), its center x and y, and an edge x and y.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn tiles(&self) -> Vec<f64> {
        self.tiles.clone()
    }

    /// Rank, x and y of each point at its tile's center; and then of each where it is moved to.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn points(&self) -> Vec<f64> {
        self.points.clone()
    }

    /// Directions, in units of 30° from a tile's edge, of the edges of the square-triangle tiling at a tile of each
    /// type: its corners are the centers of the triangles and squares between them.
    #[must_use]
    pub fn star(kind: usize) -> Vec<u8> {
        twelvefold::tiling::TileType::ALL.get(kind).map_or(&[][..], |kind| kind.star()).to_vec()
    }

    fn push(&mut self, tile: &PlacedTile, opened: bool) {
        self.tiles.extend([
            f64::from(tile.level),
            tile.rank as f64,
            tile.kind.index() as f64,
            f64::from(u8::from(opened)),
            tile.center.x,
            tile.center.y,
            tile.edge.x,
            tile.edge.y,
        ]);
    }
}
