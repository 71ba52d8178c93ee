//! Large images, cell by cell.
//!
//! A gigapixel scan does not fit in memory with the maps that relaxed points read, and a billion dots are more than
//! one machine's share. So an image is cut into cells, rectangles of whole pixels that follow from its size and the
//! number of points alone. Each is made by itself, from the pixels in it and around it and from three numbers of the
//! whole: width, height and mean. The points of all cells are those of the whole image's [`StippleMap`], each in one
//! cell.

use core::ops::Range;

use glam::DVec2;

use crate::domain::Domain;
use crate::importance::{Area, MapError, Pixels, StippleMap, Whole};

/// More points make more cells: a second's work each.
const MOST_POINTS: f64 = 1_048_576.0;

/// More pixels make more cells, whose maps are made in some 30 bytes a pixel,
const MANY_PIXELS: f64 = 4_194_304.0;

/// as long as they have that many points: around each cell, some 30 spacings of the points are read as well.
const FEW_POINTS: f64 = 65_536.0;

/// And so many at any rate, a gibibyte.
const MOST_PIXELS: f64 = 33_554_432.0;

/// An image cut into cells: one if it has no more than a million points, and 4 million pixels or, of fewer than 65,536
/// points, 32 million.
///
/// Rows of cells from the top, each from the left, make up the image.
///
/// ```
/// use glam::DVec2;
/// use twelvefold::{Amount, InvalidPixels, Mosaic, Pixels, Placement, Sampling};
/// // What a large file would give: the pixels of some columns and rows.
/// let read = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
///     let pixel = |x: usize, y: usize| ((x + y) % 256) as f32 / 255.0;
///     let values = rows.clone().flat_map(|y| columns.clone().map(move |x| pixel(x, y)));
///     Pixels::new(columns.len(), rows.len(), values.collect(), InvalidPixels::Reject)
/// };
/// // Once: the mean.
/// let (width, height, mut row_sums) = (2560, 2048, Vec::new());
/// for first in (0..height).step_by(256) {
///     let band = read(0..width, first..first + 256)?;
///     row_sums.extend(band.values().chunks(width).map(Pixels::sum_of_row));
/// }
/// let mosaic = Mosaic::new((width, height), Pixels::mean_of_rows(width, &row_sums), 1e5)?;
/// assert_eq!(mosaic.cells().len(), 2);
/// // Then the second of two parts, as one of two processes would.
/// let placement = Placement::new(mosaic.domain(), 7);
/// let mut dots = 0;
/// for cell in mosaic.part(1, 2) {
///     let map = cell.map(read(cell.columns(), cell.rows())?)?;
///     let sampling = Sampling::new(&placement, &map, Amount::Points(1e5))?.relaxed()?;
///     dots += sampling.clipped(cell.domain()).points::<DVec2>()?.count();
/// }
/// assert!(dots.abs_diff(50_000) < 500);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mosaic {
    whole: Whole,
    domain: Domain,
    /// Cells in a row, and rows of cells.
    across: usize,
    down: usize,
}

/// A cell of a [`Mosaic`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    mosaic: Mosaic,
    index: usize,
}

impl Mosaic {
    /// The cells of an image of `width` × `height` pixels of this mean, for about `points` points on all of it. The
    /// mean is [`Pixels::mean`], or [`Pixels::mean_of_rows`] where the image is never in one piece.
    ///
    /// # Errors
    /// [`MapError::Empty`] without pixels, [`MapError::InvalidMean`] unless the mean is finite and not negative.
    pub fn new((width, height): (usize, usize), mean: f64, points: f64) -> Result<Self, MapError> {
        let pixels = width as f64 * height as f64;
        let by_pixels = (pixels / MANY_PIXELS).min(points / FEW_POINTS);
        let count = (points / MOST_POINTS).max(by_pixels).max(pixels / MOST_PIXELS);
        let (mut across, mut down) = (1, 1);
        if count > 1.0 {
            let cells =
                |count: f64, length: usize| (libm::ceil(count) as usize).clamp(1, length.max(1));
            across = cells(libm::sqrt(count * width as f64 / height as f64), width);
            down = cells(count / across as f64, height);
        }
        Self::with_grid((width, height), mean, points, (across, down))
    }

    fn with_grid(
        (width, height): (usize, usize),
        mean: f64,
        points: f64,
        (across, down): (usize, usize),
    ) -> Result<Self, MapError> {
        if !(mean >= 0.0 && mean.is_finite()) {
            return Err(MapError::InvalidMean { mean });
        }
        let domain = Domain::new(DVec2::ZERO, DVec2::new(width as f64, height as f64))
            .map_err(|_| MapError::Empty { width, height })?;
        Ok(Self { whole: Whole { width, height, mean, points }, domain, across, down })
    }

    /// The rectangle that the image covers: [0, width) × [0, height).
    #[must_use]
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// All cells.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = Cell> + Clone + use<> {
        self.part(0, 1)
    }

    /// The cells of part `index`, from 0, of `of`, which differ by one cell at most. The parts' cells one after the
    /// other are all; parts that there are not have none.
    pub fn part(
        &self,
        index: usize,
        of: usize,
    ) -> impl ExactSizeIterator<Item = Cell> + Clone + use<> {
        let mosaic = *self;
        let cells = self.across * self.down;
        let begin =
            |part: usize| (cells as u128 * part.min(of) as u128 / of.max(1) as u128) as usize;
        (begin(index)..begin(index.saturating_add(1))).map(move |index| Cell { mosaic, index })
    }
}

impl Cell {
    /// The cell's own columns and rows.
    fn area(&self) -> Area {
        let Mosaic { whole: Whole { width, height, .. }, across, down, .. } = self.mosaic;
        let between = |length: usize, i: usize, of: usize| {
            let border = |i: usize| (length as u128 * i as u128 / of as u128) as usize;
            border(i)..border(i + 1)
        };
        Area {
            x: between(width, self.index % across, across),
            y: between(height, self.index / across, down),
        }
    }

    /// The half-open rectangle whose points are the cell's.
    #[must_use]
    pub fn domain(&self) -> Domain {
        let Area { x, y } = self.area();
        let min = DVec2::new(x.start as f64, y.start as f64);
        // A cell has a pixel at least.
        Domain::new(min, DVec2::new(x.len() as f64, y.len() as f64)).unwrap_or(self.mosaic.domain)
    }

    /// The columns of the pixels that its map is made from.
    #[must_use]
    pub fn columns(&self) -> Range<usize> {
        self.mosaic.whole.needed(&self.area()).x
    }

    /// The rows of the pixels that its map is made from: some 30 mean spacings of the points, or 100 pixels,
    /// more than its own on each side.
    #[must_use]
    pub fn rows(&self) -> Range<usize> {
        self.mosaic.whole.needed(&self.area()).y
    }

    /// The importance of the points in this cell, from the pixels in its [`columns`](Self::columns) and
    /// [`rows`](Self::rows). It is that of the whole image: its domain and integral are the image's. Beyond the cell's
    /// surroundings it means nothing, so that its sampling must be [`clipped`](crate::Sampling::clipped) to
    /// [`domain`](Self::domain).
    ///
    /// # Errors
    /// [`MapError::Length`] for another size, [`MapError::Memory`].
    pub fn map(&self, pixels: Pixels) -> Result<StippleMap, MapError> {
        StippleMap::of_part(&pixels, &self.area(), &self.mosaic.whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Placement;
    use crate::random::SplitMix64;
    use crate::sampling::{Amount, Sampling};
    use crate::{Importance as _, InvalidPixels};
    use alloc::vec::Vec;
    use proptest::prelude::*;

    /// Flat parts, edges, texture and near white.
    fn picture(width: usize, height: usize, seed: u64) -> Vec<f32> {
        let mut random = SplitMix64::new(seed);
        let tones: [f32; 4] = core::array::from_fn(|_| random.unit() as f32);
        (0..width * height)
            .map(|i| {
                let (x, y) = (i % width, i / width);
                match (x / 37 + y / 29) % 5 {
                    0 => 0.0,
                    1 => tones[0],
                    2 => tones[1] * random.unit() as f32,
                    3 => 0.004 * tones[2],
                    _ => tones[3] * x as f32 / width as f32,
                }
            })
            .collect()
    }

    fn pixels(picture: &[f32], width: usize, columns: Range<usize>, rows: Range<usize>) -> Pixels {
        let size = (columns.len(), rows.len());
        let values = rows.flat_map(|y| picture[y * width..][columns.clone()].iter().copied());
        Pixels::new(size.0, size.1, values.collect(), InvalidPixels::Reject).unwrap()
    }

    fn dots(sampling: Sampling<'_, StippleMap>, into: &mut Vec<[u64; 2]>) {
        let points = sampling.relaxed().unwrap().points::<DVec2>().unwrap();
        into.extend(points.map(|point| point.unwrap().position.to_array().map(f64::to_bits)));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Whatever the cells: the points of the whole image, each once.
        #[test]
        fn the_cells_points_are_the_images(
            seed: u64,
            (width, height) in (1usize..300, 1usize..300),
            (across, down) in (1usize..5, 1usize..5),
            spacing in 0.3f64..9.0,
        ) {
            let picture = picture(width, height, seed);
            let count = 1.0 + (width * height) as f64 / (spacing * spacing);
            let whole = pixels(&picture, width, 0..width, 0..height);
            prop_assume!(whole.mean() > 0.0);
            let mosaic = Mosaic::with_grid(
                (width, height), whole.mean(), count, (across.min(width), down.min(height)),
            ).unwrap();
            let map = StippleMap::new(whole, count).unwrap();
            let placement = Placement::new(mosaic.domain(), seed);
            let (mut expected, mut found) = (Vec::new(), Vec::new());
            dots(Sampling::new(&placement, &map, Amount::Points(count)).unwrap(), &mut expected);
            for cell in mosaic.cells() {
                let map = cell.map(pixels(&picture, width, cell.columns(), cell.rows())).unwrap();
                let sampling = Sampling::new(&placement, &map, Amount::Points(count)).unwrap();
                dots(sampling.clipped(cell.domain()), &mut found);
            }
            expected.sort_unstable();
            found.sort_unstable();
            prop_assert_eq!(expected, found);
        }

        #[test]
        fn parts_are_all_cells_in_order_and_cells_all_pixels(
            (width, height) in (1usize..5000, 1usize..5000),
            points in 0.0..1e9f64,
            of in 1usize..50,
        ) {
            let mosaic = Mosaic::new((width, height), 0.5, points).unwrap();
            let whole: Vec<usize> = mosaic.cells().map(|cell| cell.index).collect();
            let parts: Vec<usize> =
                (0..of).flat_map(|i| mosaic.part(i, of).map(|cell| cell.index)).collect();
            prop_assert_eq!(&whole, &parts);
            prop_assert_eq!(mosaic.part(of, of).len(), 0);
            let (pixels, least) = mosaic.cells().fold((0, usize::MAX), |(sum, least), cell| {
                let len = cell.area().len();
                (sum + len, least.min(len))
            });
            prop_assert_eq!(pixels, width * height);
            prop_assert!(least > 0);
            let cells = whole.len() as f64;
            prop_assert!(cells >= points / MOST_POINTS || whole.len() == width * height);
            prop_assert!(cells * MOST_PIXELS >= (width * height) as f64);
            prop_assert!(cells < 2.0 || points > FEW_POINTS);
        }
    }

    #[test]
    fn what_is_no_image_is_refused() {
        let mosaic = |size, mean| Mosaic::new(size, mean, 100.0);
        assert_eq!(mosaic((0, 5), 0.5), Err(MapError::Empty { width: 0, height: 5 }));
        assert!(matches!(mosaic((5, 5), f64::NAN), Err(MapError::InvalidMean { .. })));
        assert!(matches!(mosaic((5, 5), -0.5), Err(MapError::InvalidMean { .. })));
        let cell = mosaic((5, 5), 0.5).unwrap().cells().next().unwrap();
        let wrong = Pixels::new(4, 5, alloc::vec![0.5; 20], InvalidPixels::Reject).unwrap();
        assert_eq!(cell.map(wrong).err(), Some(MapError::Length { expected: 25, found: 20 }));
    }

    #[test]
    fn a_part_of_a_huge_image_needs_little_of_it() {
        // A gigapixel, a billion points.
        let mosaic = Mosaic::new((40_000, 25_000), 0.4, 1e9).unwrap();
        let cells = mosaic.cells();
        assert!((950..1100).contains(&cells.len()), "{}", cells.len());
        for cell in cells {
            let (own, needed) = (cell.area().len(), cell.columns().len() * cell.rows().len());
            assert!((needed as f64) < 1.5 * own as f64, "{needed} for {own}");
        }
        // Importance is known of the whole.
        let small = Mosaic::with_grid((64, 48), 0.5, 900.0, (2, 2)).unwrap();
        let cell = small.cells().nth(3).unwrap();
        let gray = pixels(&[0.5; 64 * 48], 64, cell.columns(), cell.rows());
        let map = cell.map(gray).unwrap();
        assert_eq!(map.domain(), small.domain());
        assert_eq!(map.integral(&small.domain()), Some(0.5 * 64.0 * 48.0));
    }
}
