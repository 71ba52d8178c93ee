//! The importance of every pixel, filled in the order that a file holds them and stored upright.

use image::metadata::Orientation;

use super::{Picture, PictureError, limits};

/// A picture being filled. Pixels are addressed as the file stores them, before the orientation that
/// the file may ask for.
#[derive(Debug)]
pub(super) struct Plane {
    picture: Picture,
    /// Index of the stored pixel (0, 0), and the steps to the next in its row and its column.
    origin: isize,
    step_x: isize,
    step_y: isize,
    not_finite: Option<(usize, usize)>,
}

impl Plane {
    /// A plane for a file with `width` × `height` stored pixels, each of importance `background`
    /// until it is set.
    ///
    /// # Errors
    /// [`PictureError::Empty`] without pixels, and [`PictureError::TooLarge`] beyond the memory limit
    /// or what the system gives.
    pub(super) fn new(
        (width, height): (usize, usize),
        orientation: Orientation,
        background: f32,
    ) -> Result<Self, PictureError> {
        let count = limits::check(width, height, 0)?;
        let mut importance = Vec::new();
        importance.try_reserve_exact(count).map_err(|_| limits::too_large(width, height, 0))?;
        importance.resize(count, background);

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
            picture: Picture { width: upright_width, height: upright_height, importance },
            origin,
            step_x,
            step_y,
            not_finite: None,
        })
    }

    /// Sets the importance of the stored pixel (x, y), which must lie in the plane; `None` marks a
    /// pixel that is not a finite number.
    pub(super) fn set(&mut self, x: usize, y: usize, importance: Option<f32>) {
        match importance {
            Some(importance) => {
                let index = self.origin + x as isize * self.step_x + y as isize * self.step_y;
                self.picture.importance[index as usize] = importance;
            }
            None => {
                let earlier = self.not_finite.is_none_or(|(u, v)| (y, x) < (v, u));
                if earlier {
                    self.not_finite = Some((x, y));
                }
            }
        }
    }

    /// The filled picture.
    ///
    /// # Errors
    /// [`PictureError::NotFinite`] with the first marked pixel, in reading order.
    pub(super) fn finish(self) -> Result<Picture, PictureError> {
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
            let picture = plane.finish().unwrap();
            let mut upright = DynamicImage::ImageLuma8(stored.clone());
            upright.apply_orientation(orientation);
            assert_eq!(
                (picture.width, picture.height),
                (upright.width() as usize, upright.height() as usize)
            );
            let expected: Vec<f32> =
                upright.pixels().map(|(_, _, pixel)| f32::from(pixel.0[0])).collect();
            assert_eq!(picture.importance, expected, "orientation {tag}");
        }
    }

    #[test]
    fn the_first_bad_pixel_in_reading_order_is_named() {
        let mut plane = Plane::new((4, 4), Orientation::NoTransforms, 0.0).unwrap();
        for (x, y) in [(3, 2), (2, 1), (0, 2), (3, 1)] {
            plane.set(x, y, None);
        }
        assert!(matches!(plane.finish(), Err(PictureError::NotFinite { x: 2, y: 1 })));
    }
}
