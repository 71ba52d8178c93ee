//! Dots as an 8-bit PNG picture.

use std::io::{self, BufWriter, Write};

use glam::DVec2;

use super::canvas::Canvas;
use super::coverage::FULL;
use super::{Drawing, DrawingError, Layer, Look};
use crate::page::color::Color;
use crate::page::mark::Mark;
use twelvefold_files::picture::srgb;

/// The most bytes of a drawing in memory: one gibibyte. Two for each of its pixels, three more from the second
/// layer on.
pub(super) const MEMORY_LIMIT: u64 = 1 << 30;

const MILLIMETERS_IN_METER: f64 = 1e3;

/// A PNG picture, gray where its colors are. It is held in memory, two bytes a pixel, until all dots are in.
#[derive(Debug)]
pub struct Png<'a, W: Write> {
    out: W,
    look: &'a Look,
    canvas: Canvas,
    /// Pixels of the drawing in one unit of the sheet.
    scale: DVec2,
    width: u32,
    height: u32,
    /// The color of what is on the canvas, and all that lies below it if there is more than the ground.
    ink: Color,
    below: Option<Vec<Color>>,
    /// Whether anything is on the canvas.
    inked: bool,
    /// Where a line was last.
    last: Option<DVec2>,
}

impl<'a, W: Write> Png<'a, W> {
    /// Begins a picture.
    ///
    /// # Errors
    /// [`DrawingError::TooLarge`], before anything is allocated.
    pub fn new(out: W, look: &'a Look) -> Result<Self, DrawingError> {
        let (canvas, [width, height]) = canvas(look)?;
        let scale = DVec2::new(width.into(), height.into()) / look.sheet.size;
        Ok(Self {
            out,
            look,
            canvas,
            scale,
            width,
            height,
            ink: Color::BLACK,
            below: None,
            inked: false,
            last: None,
        })
    }

    /// What each amount of ink looks like on the ground.
    fn mixed(&self) -> Vec<Color> {
        (0..=FULL).map(|ink| mix(self.look.ground, self.ink, ink, self.look.linear)).collect()
    }
}

/// An empty canvas for a drawing that looks so, and how many pixels it has across and down.
///
/// # Errors
/// [`DrawingError::TooLarge`], before anything is allocated.
pub(super) fn canvas(look: &Look) -> Result<(Canvas, [u32; 2]), DrawingError> {
    let resolution = look.sheet.resolution();
    let size = (look.sheet.size * resolution).round().max(DVec2::ONE);
    let DVec2 { x: width, y: height } = size;
    let too_large = DrawingError::TooLarge { width, height, page: look.sheet.is_page() };
    // Written so that a product beyond all floats is too large as well.
    let fits = width * height * size_of::<u16>() as f64 <= MEMORY_LIMIT as f64
        && width.max(height) <= f64::from(i32::MAX);
    if !fits {
        return Err(too_large);
    }
    let radius = look.mark.width() / 2.0 * resolution;
    // A dot much larger than the drawing covers no more of it, and its square must be finite.
    let radius = radius.min(1e3 * (width + height));
    match Canvas::new(width as usize, height as usize, radius) {
        Some(canvas) => Ok((canvas, [width as u32, height as u32])),
        None => Err(too_large),
    }
}

impl<W: Write> Drawing for Png<'_, W> {
    fn layer(&mut self, layer: &Layer) -> io::Result<()> {
        if self.inked {
            let mut all = Vec::new();
            all.try_reserve_exact(self.width as usize * self.height as usize)?;
            let mixed = self.mixed();
            let mut colors = Vec::new();
            for (row, ink) in self.canvas.rows().enumerate() {
                let below =
                    self.below.as_deref().map(|below| &below[row * ink.len()..][..ink.len()]);
                mix_row(ink, &mixed, (below, self.ink, self.look.linear), &mut colors);
                all.extend_from_slice(&colors);
            }
            self.below = Some(all);
            self.canvas.clear();
        }
        self.ink = layer.color;
        self.inked = false;
        self.last = None;
        Ok(())
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        let at = at * self.scale;
        if matches!(self.look.mark, Mark::Line(_)) {
            self.canvas.line([self.last.replace(at).unwrap_or(at), at]);
        } else {
            self.canvas.dot(at.x, at.y);
        }
        self.inked = true;
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        let mixed = self.mixed();
        let Self { out, look, canvas, width, height, ink, below, .. } = *self;
        let mut out = BufWriter::with_capacity(1 << 16, out);
        let gray = below.is_none() && ink.is_gray() && look.ground.is_gray();
        let mut encoder = png::Encoder::new(&mut out, width, height);
        encoder.set_color(if gray { png::ColorType::Grayscale } else { png::ColorType::Rgb });
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        if look.sheet.is_page() {
            let resolution = (look.sheet.resolution() * MILLIMETERS_IN_METER).round() as u32;
            encoder.set_pixel_dims(Some(png::PixelDimensions {
                xppu: resolution,
                yppu: resolution,
                unit: png::Unit::Meter,
            }));
        }
        let mut writer = encoder.write_header().map_err(system_error)?;
        let mut pixels = writer.stream_writer().map_err(system_error)?;
        let mut bytes = Vec::new();
        let mut colors = Vec::new();
        for (row, covered) in canvas.rows().enumerate() {
            let below =
                below.as_deref().map(|below| &below[row * covered.len()..][..covered.len()]);
            mix_row(covered, &mixed, (below, ink, look.linear), &mut colors);
            bytes.clear();
            if gray {
                bytes.extend(colors.iter().map(|color| color.0[0]));
            } else {
                bytes.extend(colors.iter().flat_map(|color| color.0));
            }
            pixels.write_all(&bytes)?;
        }
        pixels.finish().map_err(system_error)?;
        writer.finish().map_err(system_error)?;
        out.flush()
    }
}

/// The system's error as it was: the encoder's own conversion keeps only its text.
fn system_error(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => other.into(),
    }
}

/// The colors of one row of ink: each amount as `mixed` has it on the ground, or over what lies below.
fn mix_row(
    covered: &[u16],
    mixed: &[Color],
    (below, ink, linear): (Option<&[Color]>, Color, bool),
    colors: &mut Vec<Color>,
) {
    colors.clear();
    match below {
        None => colors.extend(covered.iter().map(|&part| mixed[usize::from(part)])),
        Some(below) => colors.extend(below.iter().zip(covered).map(|(&below, &part)| match part {
            0 => below,
            part => mix(below, ink, part, linear),
        })),
    }
}

/// The color of a pixel of which `ink` is covered.
///
/// A pixel half covered is half as bright either in encoded values or in linear light, whichever the
/// dots follow.
pub(super) fn mix(Color(below): Color, Color(above): Color, ink: u16, linear: bool) -> Color {
    let covered = f64::from(ink) / f64::from(FULL);
    Color(std::array::from_fn(|k| {
        let [below, above] = [below[k], above[k]].map(|value| f64::from(value) / 255.0);
        let mixed = if linear {
            let [below, above] = [below, above].map(srgb::decode);
            srgb::encode(below + covered * (above - below))
        } else {
            below + covered * (above - below)
        };
        (mixed * 255.0).round() as u8
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(look: &Look, layers: &[(Color, &[(f64, f64)])]) -> image::DynamicImage {
        let mut bytes = Vec::new();
        let mut png = Box::new(Png::new(&mut bytes, look).unwrap());
        for &(color, dots) in layers {
            png.layer(&Layer { color, ..Layer::black() }).unwrap();
            for &(x, y) in dots {
                png.dot(DVec2::new(x, y)).unwrap();
            }
        }
        png.finish().unwrap();
        image::load_from_memory(&bytes).unwrap()
    }

    fn drawn(look: &Look, ink: Color, dots: &[(f64, f64)]) -> image::GrayImage {
        match decoded(look, &[(ink, dots)]) {
            image::DynamicImage::ImageLuma8(gray) => gray,
            other => panic!("{:?}", other.color()),
        }
    }

    #[test]
    fn a_dot_is_a_black_disc_of_its_size_times_the_scale() {
        let gray = drawn(&Look::of_pixels(20, 10, 3.0, 4.0), Color::BLACK, &[(10.0, 5.0)]);
        assert_eq!(gray.dimensions(), (60, 30));
        assert_eq!(gray.get_pixel(30, 15).0, [0]);
        assert_eq!(gray.get_pixel(30, 23).0, [255]);
        let ink: f64 = gray.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum();
        assert!((ink - std::f64::consts::PI * 36.0).abs() < 0.5, "{ink}");
    }

    #[test]
    fn inverted_it_is_white_on_black() {
        let look = Look { ground: Color::BLACK, ..Look::of_pixels(9, 9, 1.0, 4.0) };
        let gray = drawn(&look, Color::WHITE, &[(4.5, 4.5)]);
        assert_eq!((gray.get_pixel(4, 4).0, gray.get_pixel(0, 0).0), ([255], [0]));
    }

    #[test]
    fn layers_lie_over_each_other_and_over_the_paper() {
        let ivory = Color([255, 255, 240]);
        let red = Color([200, 0, 0]);
        let look = Look { ground: ivory, ..Look::of_pixels(30, 9, 1.0, 6.0) };
        let colors = decoded(
            &look,
            &[(Color::BLACK, &[(5.0, 4.5), (15.0, 4.5)]), (red, &[(15.0, 4.5), (25.0, 4.5)])],
        )
        .into_rgb8();
        let found = [(5, 4), (15, 4), (25, 4), (10, 0)].map(|(x, y)| colors.get_pixel(x, y).0);
        assert_eq!(found, [Color::BLACK.0, red.0, red.0, ivory.0]);
    }

    #[test]
    fn a_line_goes_from_each_dot_to_the_next() {
        let look = Look { mark: Mark::Line(2.0), ..Look::of_pixels(30, 20, 1.0, 1.0) };
        let gray = drawn(&look, Color::BLACK, &[(5.0, 5.0), (25.0, 5.0), (25.0, 15.0)]);
        let found = [(15, 4), (25, 10), (15, 10)].map(|(x, y)| gray.get_pixel(x, y).0);
        assert_eq!(found, [[0], [0], [255]]);
    }

    #[test]
    fn half_covered_pixels_reflect_half_the_light_when_light_counts() {
        let half = |linear| mix(Color::WHITE, Color::BLACK, FULL / 2, linear).0[0];
        assert_eq!((half(false), half(true)), (128, 188));
        for linear in [false, true] {
            let ends = [0, FULL].map(|ink| mix(Color::WHITE, Color([1, 2, 3]), ink, linear));
            assert_eq!(ends, [Color::WHITE, Color([1, 2, 3])]);
        }
    }

    #[test]
    fn sizes_beyond_the_limit_are_refused_and_tiny_ones_have_a_pixel() {
        for scale in [1e4, 1e200, f64::MAX] {
            let look = Look::of_pixels(500, 500, scale, 4.0);
            assert!(Png::new(io::sink(), &look).is_err(), "{scale}");
        }
        let tiny = Look::of_pixels(500, 300, 1e-9, 4.0);
        assert_eq!(drawn(&tiny, Color::BLACK, &[(1.0, 1.0)]).dimensions(), (1, 1));
        let huge = Look::of_pixels(5, 5, 1.0, f64::MAX);
        assert_eq!(drawn(&huge, Color::BLACK, &[(1.0, 1.0)]).get_pixel(4, 4).0, [0]);
    }
}
