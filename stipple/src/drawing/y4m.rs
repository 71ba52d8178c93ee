//! Dots as a frame of a YUV4MPEG2 stream, drawn as in PNG.

use std::fmt::Display;
use std::io::{self, Write};

use glam::DVec2;

use super::canvas::Canvas;
use super::coverage::FULL;
use super::png::{canvas, mix};
use super::{Drawing, DrawingError, Layer, Look};
use crate::page::color::Color;

/// Luma of black, and how much more white has.
const BLACK: f64 = 16.0;
const WHITE: f64 = 219.0;

/// No color.
const NEUTRAL: u8 = 128;

/// A frame of one layer, gray. It is held in memory, two bytes a pixel, until all dots are in.
///
/// With color differences, of no color, since not all players read streams without: 4:2:0, one for each four pixels.
#[derive(Debug)]
pub struct Y4m<'a, W> {
    out: W,
    look: &'a Look,
    canvas: Canvas,
    size: [u32; 2],
    ink: Color,
}

impl<'a, W: Write> Y4m<'a, W> {
    /// What goes before the first frame, at so many frames a second.
    ///
    /// # Errors
    /// [`DrawingError`].
    pub fn begin(mut out: W, look: &Look, rate: impl Display) -> Result<(), DrawingError> {
        let (_, [width, height]) = canvas(look)?;
        // Where color differences lie does not matter, and this kind is the oldest.
        writeln!(
            out,
            "YUV4MPEG2 W{width} H{height} F{rate} Ip A1:1 C420jpeg XYSCSS=420JPEG XCOLORRANGE=LIMITED"
        )?;
        Ok(())
    }

    /// Begins a frame.
    ///
    /// # Errors
    /// [`DrawingError::TooLarge`], before anything is allocated.
    pub fn new(out: W, look: &'a Look) -> Result<Self, DrawingError> {
        let (canvas, size) = canvas(look)?;
        Ok(Self { out, look, canvas, size, ink: Color::BLACK })
    }
}

impl<W: Write> Drawing for Y4m<'_, W> {
    fn layer(&mut self, layer: &Layer) -> io::Result<()> {
        self.ink = layer.color;
        Ok(())
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        let scale = DVec2::new(self.size[0].into(), self.size[1].into()) / self.look.sheet.size;
        let at = at * scale;
        self.canvas.dot(at.x, at.y);
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        let look = self.look;
        let luma: Vec<u8> = (0..=FULL)
            .map(|ink| {
                // Ground and ink are gray.
                let Color([gray, ..]) = mix(look.ground, self.ink, ink, look.linear);
                (BLACK + f64::from(gray) * WHITE / 255.0).round() as u8
            })
            .collect();
        self.out.write_all(b"FRAME\n")?;
        let mut row = Vec::with_capacity(self.size[0] as usize);
        for covered in self.canvas.rows() {
            row.clear();
            row.extend(covered.iter().map(|&ink| luma[usize::from(ink)]));
            self.out.write_all(&row)?;
        }
        let [across, down] = self.size.map(|side| side.div_ceil(2) as usize);
        let row = vec![NEUTRAL; across];
        (0..2 * down).try_for_each(|_| self.out.write_all(&row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_the_drawing_in_luma_with_neutral_chroma() {
        let look = Look::of_pixels(9, 5, 1.0, 4.0);
        let mut bytes = Vec::new();
        Y4m::begin(&mut bytes, &look, "30000:1001").unwrap();
        let header = bytes.len();
        assert!(bytes.starts_with(b"YUV4MPEG2 W9 H5 F30000:1001 Ip A1:1 C420jpeg "));
        let mut frame = Box::new(Y4m::new(&mut bytes, &look).unwrap());
        frame.layer(&Layer::black()).unwrap();
        frame.dot(DVec2::new(4.5, 2.5)).unwrap();
        frame.finish().unwrap();
        let frame = bytes[header..].strip_prefix(b"FRAME\n").unwrap();
        assert_eq!(frame.len(), 9 * 5 + 2 * 5 * 3);
        let (luma, chroma) = frame.split_at(45);
        assert_eq!((luma[2 * 9 + 4], luma[0]), (16, 235));
        let ink: f64 = luma.iter().map(|&luma| (235.0 - f64::from(luma)) / 219.0).sum();
        assert!((ink - std::f64::consts::PI * 4.0).abs() < 0.1, "{ink}");
        assert!(chroma.iter().all(|&value| value == 128));
    }

    #[test]
    fn white_dots_lie_on_black() {
        let look = Look { ground: Color::BLACK, ..Look::of_pixels(9, 5, 1.0, 4.0) };
        let mut bytes = Vec::new();
        let mut frame = Box::new(Y4m::new(&mut bytes, &look).unwrap());
        frame.layer(&Layer { color: Color::WHITE, ..Layer::black() }).unwrap();
        frame.dot(DVec2::new(4.5, 2.5)).unwrap();
        frame.finish().unwrap();
        assert_eq!((bytes[6 + 2 * 9 + 4], bytes[6]), (235, 16));
    }
}
