//! The pixels of a picture or of a window of it, filled in the order that a file holds them and stored upright.

use std::ops::Range;

use image::metadata::Orientation;

use super::area::Area;
use super::{PictureError, Pixel, Toner, limits};

/// A file's pixels, upright.
#[derive(Debug)]
pub(super) struct Decoded<P> {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Row by row from the top, each row from the left.
    pub(super) pixels: Vec<P>,
    /// Width of a pixel over its height.
    pub(super) aspect: f64,
    /// As of [`super::Picture`].
    pub(super) range: Option<(f64, f64)>,
    pub(super) warnings: Vec<String>,
}

/// A picture being filled. Pixels are addressed as the file stores them, before the orientation that
/// the file may ask for.
#[derive(Debug)]
pub(super) struct Plane<P> {
    picture: Decoded<P>,
    stored: Area,
    orientation: Orientation,
    /// Index of the stored pixel (0, 0), and the steps to the next in its row and its column.
    origin: isize,
    step_x: isize,
    step_y: isize,
    not_finite: Option<(usize, usize)>,
}

impl<P: Pixel> Plane<P> {
    /// A plane for a file with `width` × `height` stored pixels, each `background` until it is
    /// set.
    ///
    /// # Errors
    /// [`PictureError::Empty`] without pixels, and [`PictureError::TooLarge`] beyond the memory limit
    /// or what the system gives.
    pub(super) fn new(
        size: (usize, usize),
        orientation: Orientation,
        background: P,
    ) -> Result<Self, PictureError> {
        let window = Area::whole(upright(size, orientation));
        Self::of_window(size, orientation, background, &window)
    }

    /// A plane for no more of such a file than a window of the upright picture, in which it must lie.
    ///
    /// # Errors
    /// As of [`Self::new`], of the window.
    pub(super) fn of_window(
        size: (usize, usize),
        orientation: Orientation,
        background: P,
        window: &Area,
    ) -> Result<Self, PictureError> {
        let (width, height) = window.size();
        let bytes = size_of::<P>() - size_of::<f32>();
        let count = limits::check(width, height, bytes)?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| limits::too_large(width, height, bytes))?;
        pixels.resize(count, background);

        let (turned, [left_right, up_down]) = turns(orientation);
        // To the next pixel of a row and of a column of the window, and from the first one stored.
        let step_x = if left_right { -1 } else { 1 };
        let step_y = if up_down { -(width as isize) } else { width as isize };
        let first = |mirrored: bool, length: usize| if mirrored { length - 1 } else { 0 };
        let corner = (first(up_down, height) * width + first(left_right, width)) as isize;
        let (step_x, step_y) = if turned { (step_y, step_x) } else { (step_x, step_y) };
        let stored = stored(size, orientation, window);
        // What lies before the window may be beyond the numbers there are, but no pixel within is.
        let origin = corner
            .wrapping_sub((stored.columns.start as isize).wrapping_mul(step_x))
            .wrapping_sub((stored.rows.start as isize).wrapping_mul(step_y));
        Ok(Self {
            picture: Decoded {
                width,
                height,
                pixels,
                aspect: 1.0,
                range: None,
                warnings: Vec::new(),
            },
            stored,
            orientation,
            origin,
            step_x,
            step_y,
            not_finite: None,
        })
    }

    /// The stored pixels that are wanted.
    pub(super) fn stored(&self) -> &Area {
        &self.stored
    }

    /// Sets the stored pixel (x, y), which must be one of [`Self::stored`]; `None` marks a
    /// pixel that is not a finite number.
    pub(super) fn set(&mut self, x: usize, y: usize, pixel: Option<P>) {
        match pixel {
            Some(pixel) => {
                let index = self
                    .origin
                    .wrapping_add((x as isize).wrapping_mul(self.step_x))
                    .wrapping_add((y as isize).wrapping_mul(self.step_y));
                self.picture.pixels[index as usize] = pixel;
            }
            None => {
                let earlier = self.not_finite.is_none_or(|(u, v)| (y, x) < (v, u));
                if earlier {
                    self.not_finite = Some((x, y));
                }
            }
        }
    }

    /// Says that a stored pixel is so many times as wide as high; what is no shape is passed over.
    pub(super) fn set_aspect(&mut self, aspect: f64) {
        self.picture.aspect = upright_aspect(aspect, self.orientation);
    }

    /// Adds what was assumed or amiss.
    pub(super) fn warn(&mut self, warnings: impl IntoIterator<Item = String>) {
        self.picture.warnings.extend(warnings);
    }

    /// The filled picture, with what `toner` saw.
    ///
    /// # Errors
    /// [`PictureError::NotFinite`] with the first marked pixel, in reading order.
    pub(super) fn finish(mut self, toner: Option<&Toner>) -> Result<Decoded<P>, PictureError> {
        self.picture.range = toner.and_then(Toner::range);
        match self.not_finite {
            Some((x, y)) => Err(PictureError::NotFinite { x, y }),
            None => Ok(self.picture),
        }
    }
}

/// The size of the upright picture of a file of this size.
pub(super) fn upright((width, height): (usize, usize), orientation: Orientation) -> (usize, usize) {
    if turns(orientation).0 { (height, width) } else { (width, height) }
}

/// Where an area of the upright picture of a file of this size is stored.
pub(super) fn stored(size: (usize, usize), orientation: Orientation, area: &Area) -> Area {
    let (width, height) = upright(size, orientation);
    let (turned, [left_right, up_down]) = turns(orientation);
    let columns = mirrored(&area.columns, width, left_right);
    let rows = mirrored(&area.rows, height, up_down);
    if turned { Area { columns: rows, rows: columns } } else { Area { columns, rows } }
}

/// Where a stored area of such a file lies in the upright picture.
pub(super) fn shown(size: (usize, usize), orientation: Orientation, area: &Area) -> Area {
    let (width, height) = upright(size, orientation);
    let (turned, [left_right, up_down]) = turns(orientation);
    let Area { columns, rows } = area;
    let (columns, rows) = if turned { (rows, columns) } else { (columns, rows) };
    Area { columns: mirrored(columns, width, left_right), rows: mirrored(rows, height, up_down) }
}

fn mirrored(range: &Range<usize>, length: usize, mirrored: bool) -> Range<usize> {
    if mirrored { length - range.end..length - range.start } else { range.clone() }
}

/// How many times as wide as high a pixel is upright that as stored is so many times; what is no shape is square.
pub(super) fn upright_aspect(aspect: f64, orientation: Orientation) -> f64 {
    match aspect.is_finite() && (1.0 / 64.0..=64.0).contains(&aspect) {
        true if turns(orientation).0 => 1.0 / aspect,
        true => aspect,
        false => 1.0,
    }
}

/// Whether a stored picture's rows are columns when it is upright; and whether then left and right, and top and
/// bottom, change places.
fn turns(orientation: Orientation) -> (bool, [bool; 2]) {
    match orientation {
        Orientation::NoTransforms => (false, [false, false]),
        Orientation::FlipHorizontal => (false, [true, false]),
        Orientation::FlipVertical => (false, [false, true]),
        Orientation::Rotate180 => (false, [true, true]),
        Orientation::Rotate90 => (true, [true, false]),
        Orientation::Rotate270 => (true, [false, true]),
        Orientation::Rotate90FlipH => (true, [false, false]),
        Orientation::Rotate270FlipH => (true, [true, true]),
    }
}

#[cfg(test)]
mod tests {
    use image::{DynamicImage, GenericImageView as _, GrayImage};

    use super::*;

    #[test]
    fn every_orientation_agrees_with_the_image_library() {
        let stored = GrayImage::from_fn(3, 2, |x, y| image::Luma([(10 * y + x) as u8]));
        for tag in 1..=8 {
            let orientation = Orientation::from_exif(tag).unwrap();
            let mut plane = Plane::new((3, 2), orientation, 0.0).unwrap();
            for (x, y, pixel) in stored.enumerate_pixels() {
                plane.set(x as usize, y as usize, Some(f32::from(pixel.0[0])));
            }
            let picture = plane.finish(None).unwrap();
            let mut upright = DynamicImage::ImageLuma8(stored.clone());
            upright.apply_orientation(orientation);
            assert_eq!(
                (picture.width, picture.height),
                (upright.width() as usize, upright.height() as usize)
            );
            let expected: Vec<f32> =
                upright.pixels().map(|(_, _, pixel)| f32::from(pixel.0[0])).collect();
            assert_eq!(picture.pixels, expected, "orientation {tag}");
        }
    }

    #[test]
    fn a_window_of_any_orientation_is_cut_out_of_the_whole() {
        let size = (4, 3);
        for tag in 1..=8 {
            let orientation = Orientation::from_exif(tag).unwrap();
            let filled = |mut plane: Plane<f32>| {
                let stored = plane.stored().clone();
                for (x, y) in (0..12).map(|i| (i % 4, i / 4)).filter(|&(x, y)| stored.holds(x, y)) {
                    plane.set(x, y, Some((10 * y + x) as f32));
                }
                plane.finish(None).unwrap().pixels
            };
            let whole = Area::whole(upright(size, orientation));
            let pixels = filled(Plane::new(size, orientation, 99.0).unwrap());
            for (left, top) in (0..16).map(|i| (i % 4, i / 4)) {
                for (right, bottom) in (0..25).map(|i| (i % 5, i / 5)) {
                    let window = Area { columns: left..right, rows: top..bottom };
                    if window.is_empty() || window.meet(&whole) != window {
                        continue;
                    }
                    let found = Plane::of_window(size, orientation, 99.0, &window).unwrap();
                    assert_eq!(found.stored().columns.len() * found.stored().rows.len(), {
                        window.columns.len() * window.rows.len()
                    });
                    assert_eq!(shown(size, orientation, found.stored()), window);
                    assert_eq!(filled(found), window.cut(&whole, &pixels), "{tag} {window:?}");
                }
            }
        }
    }

    #[test]
    fn the_first_bad_pixel_in_reading_order_is_named() {
        let mut plane = Plane::new((4, 4), Orientation::NoTransforms, 0.0f32).unwrap();
        for (x, y) in [(3, 2), (2, 1), (0, 2), (3, 1)] {
            plane.set(x, y, None::<f32>);
        }
        assert!(matches!(plane.finish(None), Err(PictureError::NotFinite { x: 2, y: 1 })));
    }
}
