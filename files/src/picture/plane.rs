//! The pixels of a picture, filled in the order that a file holds them and stored upright.

use image::metadata::Orientation;

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
    turned: bool,
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
        (width, height): (usize, usize),
        orientation: Orientation,
        background: P,
    ) -> Result<Self, PictureError> {
        let bytes = size_of::<P>() - size_of::<f32>();
        let count = limits::check(width, height, bytes)?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| limits::too_large(width, height, bytes))?;
        pixels.resize(count, background);

        let turned = matches!(
            orientation,
            Orientation::Rotate90
                | Orientation::Rotate270
                | Orientation::Rotate90FlipH
                | Orientation::Rotate270FlipH
        );
        let (upright_width, upright_height) =
            if turned { (height, width) } else { (width, height) };
        // Both dimensions are below the memory limit, so nothing here can overflow.
        let row = upright_width as isize;
        let (right, bottom) = (row - 1, (upright_height as isize - 1) * row);
        let (origin, step_x, step_y) = match orientation {
            Orientation::NoTransforms => (0, 1, row),
            Orientation::FlipHorizontal => (right, -1, row),
            Orientation::FlipVertical => (bottom, 1, -row),
            Orientation::Rotate180 => (bottom + right, -1, -row),
            Orientation::Rotate90 => (right, row, -1),
            Orientation::Rotate270 => (bottom, -row, 1),
            Orientation::Rotate90FlipH => (0, row, 1),
            Orientation::Rotate270FlipH => (bottom + right, -row, -1),
        };
        Ok(Self {
            picture: Decoded {
                width: upright_width,
                height: upright_height,
                pixels,
                aspect: 1.0,
                range: None,
                warnings: Vec::new(),
            },
            turned,
            origin,
            step_x,
            step_y,
            not_finite: None,
        })
    }

    /// Sets the stored pixel (x, y), which must lie in the plane; `None` marks a
    /// pixel that is not a finite number.
    pub(super) fn set(&mut self, x: usize, y: usize, pixel: Option<P>) {
        match pixel {
            Some(pixel) => {
                let index = self.origin + x as isize * self.step_x + y as isize * self.step_y;
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
        if aspect.is_finite() && (1.0 / 64.0..=64.0).contains(&aspect) {
            self.picture.aspect = if self.turned { 1.0 / aspect } else { aspect };
        }
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
    fn the_first_bad_pixel_in_reading_order_is_named() {
        let mut plane = Plane::new((4, 4), Orientation::NoTransforms, 0.0f32).unwrap();
        for (x, y) in [(3, 2), (2, 1), (0, 2), (3, 1)] {
            plane.set(x, y, None::<f32>);
        }
        assert!(matches!(plane.finish(None), Err(PictureError::NotFinite { x: 2, y: 1 })));
    }
}
