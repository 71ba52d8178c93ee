//! Dots as an 8-bit gray PNG picture.

use std::error::Error;
use std::fmt;
use std::io::{self, BufWriter, Write};

use super::canvas::Canvas;
use super::coverage::FULL;
use super::{Drawing, Style};
use twelvefold_files::picture::srgb;

/// The most bytes of a drawing in memory, two for each of its pixels: one gibibyte.
const MEMORY_LIMIT: f64 = (1u64 << 30) as f64;

/// A PNG picture. It is held in memory, two bytes a pixel, until all dots are in.
#[derive(Debug)]
pub(crate) struct Png<W: Write> {
    out: W,
    canvas: Canvas,
    /// Pixels of the drawing in one of the photograph.
    scale_x: f64,
    scale_y: f64,
    width: u32,
    height: u32,
    white_on_black: bool,
    linear: bool,
}

/// Why a PNG picture cannot be drawn.
#[derive(Debug)]
pub(crate) enum PngError {
    /// The drawing would need more memory than the limit, or than there is.
    TooLarge { width: f64, height: f64 },
}

impl fmt::Display for PngError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge { width, height } => write!(
                out,
                "would be {width:.0} x {height:.0} pixels large, more than {} MiB of memory hold; \
                 choose a smaller --scale",
                (1u64 << 30) >> 20
            ),
        }
    }
}

impl Error for PngError {}

impl<W: Write> Png<W> {
    /// Begins a picture.
    ///
    /// # Errors
    /// [`PngError`], before anything is allocated.
    pub(crate) fn new(out: W, style: &Style) -> Result<Self, PngError> {
        let side = |pixels: usize| (pixels as f64 * style.scale).round().max(1.0);
        let (width, height) = (side(style.width), side(style.height));
        let too_large = PngError::TooLarge { width, height };
        // Written so that a product beyond all floats is too large as well.
        let fits = width * height * size_of::<u16>() as f64 <= MEMORY_LIMIT
            && width.max(height) <= f64::from(i32::MAX);
        if !fits {
            return Err(too_large);
        }
        let radius = style.dot_size / 2.0 * style.scale;
        // A dot much larger than the drawing covers no more of it, and its square must be finite.
        let radius = radius.min(1e3 * (width + height));
        let Some(canvas) = Canvas::new(width as usize, height as usize, radius) else {
            return Err(too_large);
        };
        Ok(Self {
            out,
            canvas,
            scale_x: width / style.width as f64,
            scale_y: height / style.height as f64,
            width: width as u32,
            height: height as u32,
            white_on_black: style.white_on_black,
            linear: style.linear,
        })
    }
}

impl<W: Write> Drawing for Png<W> {
    fn dot(&mut self, x: f32, y: f32) -> io::Result<()> {
        self.canvas.dot(f64::from(x) * self.scale_x, f64::from(y) * self.scale_y);
        Ok(())
    }

    fn finish(self) -> io::Result<()> {
        let levels = levels(self.white_on_black, self.linear);
        let mut out = BufWriter::with_capacity(1 << 16, self.out);
        let mut encoder = png::Encoder::new(&mut out, self.width, self.height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header().map_err(system_error)?;
        let mut pixels = writer.stream_writer().map_err(system_error)?;
        let mut bytes = Vec::with_capacity(self.width as usize);
        for row in self.canvas.rows() {
            bytes.clear();
            bytes.extend(row.iter().map(|&ink| levels[usize::from(ink)]));
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

/// The gray level of each amount of ink.
///
/// A pixel half covered is half as bright either in encoded values or in linear light, whichever the
/// dots follow.
fn levels(white_on_black: bool, linear: bool) -> Vec<u8> {
    (0..=FULL)
        .map(|ink| {
            let covered = f64::from(ink) / f64::from(FULL);
            let bright = if white_on_black { covered } else { 1.0 - covered };
            let encoded = if linear { srgb::encode(bright) } else { bright };
            (encoded * 255.0).round() as u8
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn style(width: usize, height: usize, scale: f64) -> Style {
        Style {
            width,
            height,
            scale,
            dot_size: 4.0,
            spacing: 4.0,
            white_on_black: false,
            linear: false,
            title: String::new(),
            description: String::new(),
        }
    }

    fn drawn(style: &Style, dots: &[(f32, f32)]) -> image::GrayImage {
        let mut bytes = Vec::new();
        let mut png = Png::new(&mut bytes, style).unwrap();
        for &(x, y) in dots {
            png.dot(x, y).unwrap();
        }
        png.finish().unwrap();
        match image::load_from_memory(&bytes).unwrap() {
            image::DynamicImage::ImageLuma8(gray) => gray,
            other => panic!("{:?}", other.color()),
        }
    }

    #[test]
    fn a_dot_is_a_black_disc_of_its_size_times_the_scale() {
        let gray = drawn(&style(20, 10, 3.0), &[(10.0, 5.0)]);
        assert_eq!(gray.dimensions(), (60, 30));
        assert_eq!(gray.get_pixel(30, 15).0, [0]);
        assert_eq!(gray.get_pixel(30, 23).0, [255]);
        let ink: f64 = gray.pixels().map(|p| 1.0 - f64::from(p.0[0]) / 255.0).sum();
        assert!((ink - std::f64::consts::PI * 36.0).abs() < 0.5, "{ink}");
    }

    #[test]
    fn inverted_it_is_white_on_black() {
        let gray = drawn(&Style { white_on_black: true, ..style(9, 9, 1.0) }, &[(4.5, 4.5)]);
        assert_eq!((gray.get_pixel(4, 4).0, gray.get_pixel(0, 0).0), ([255], [0]));
    }

    #[test]
    fn half_covered_pixels_reflect_half_the_light_when_light_counts() {
        let half = usize::from(FULL / 2);
        assert_eq!(levels(false, false)[half], 128);
        assert_eq!(levels(false, true)[half], 188);
        for linear in [false, true] {
            assert_eq!((levels(false, linear)[0], levels(false, linear)[65535]), (255, 0));
        }
    }

    #[test]
    fn sizes_beyond_the_limit_are_refused_and_tiny_ones_have_a_pixel() {
        for scale in [1e4, 1e200, f64::MAX] {
            assert!(Png::new(io::sink(), &style(500, 500, scale)).is_err(), "{scale}");
        }
        assert_eq!(drawn(&style(500, 300, 1e-9), &[(1.0, 1.0)]).dimensions(), (1, 1));
        let huge = Style { dot_size: f64::MAX, ..style(5, 5, 1.0) };
        assert_eq!(drawn(&huge, &[(1.0, 1.0)]).get_pixel(4, 4).0, [0]);
    }
}
