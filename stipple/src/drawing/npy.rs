//! Dots as an array for NumPy.

use std::io::{self, Write};

use glam::DVec2;

use super::{Drawing, Layer};

/// An array of shape (dots, 2) and type float32, or with the layer's number, from 0, as a third column. NPY version 1.0. Its header says how many dots there are, so
/// they are held in memory, eight bytes each, until all are in.
#[derive(Debug)]
pub struct Npy<W: Write> {
    out: W,
    bytes: Vec<u8>,
    columns: usize,
    layers: usize,
}

impl<W: Write> Npy<W> {
    pub fn new(out: W, named: bool) -> Self {
        Self { out, bytes: Vec::new(), columns: if named { 3 } else { 2 }, layers: 0 }
    }
}

impl<W: Write> Drawing for Npy<W> {
    fn layer(&mut self, _: &Layer) -> io::Result<()> {
        self.layers += 1;
        Ok(())
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        self.bytes.try_reserve(self.columns * size_of::<f32>())?;
        let layer = self.layers.saturating_sub(1) as f32;
        for number in [at.x as f32, at.y as f32, layer].iter().take(self.columns) {
            self.bytes.extend_from_slice(&number.to_le_bytes());
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        let dots = self.bytes.len() / (self.columns * size_of::<f32>());
        self.out.write_all(&header(dots, self.columns))?;
        self.out.write_all(&self.bytes)?;
        self.out.flush()
    }
}

/// What goes before the numbers of an array of this shape. The magic number, the version, the length of the rest, and
/// the rest: padded so that the array begins at a multiple of 64 bytes.
pub fn header(dots: usize, columns: usize) -> Vec<u8> {
    let mut header = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    let text =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({dots}, {columns}), }}");
    header.extend_from_slice(format!("{text:117}\n").as_bytes());
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_says_its_length_and_is_aligned() {
        for dots in [0, 1, 50_000_000] {
            let header = header(dots, 2);
            assert_eq!(header.len(), 128);
            assert_eq!(usize::from(header[8]) + 256 * usize::from(header[9]) + 10, 128);
            assert_eq!(header[127], b'\n');
        }
    }

    #[test]
    fn dots_follow_the_header_little_endian() {
        let mut bytes = Vec::new();
        let mut npy = Box::new(Npy::new(&mut bytes, false));
        npy.dot(DVec2::new(1.5, 0.1)).unwrap();
        npy.finish().unwrap();
        assert_eq!(bytes[128..], [1.5f32.to_le_bytes(), 0.1f32.to_le_bytes()].concat());
    }

    #[test]
    fn a_third_column_is_the_layer() {
        let mut bytes = Vec::new();
        let mut npy = Box::new(Npy::new(&mut bytes, true));
        for _ in 0..2 {
            npy.layer(&Layer::black()).unwrap();
            npy.dot(DVec2::new(1.5, 0.1)).unwrap();
        }
        npy.finish().unwrap();
        assert!(String::from_utf8_lossy(&bytes[..128]).contains("'shape': (2, 3)"));
        assert_eq!(bytes[136..140], 0.0f32.to_le_bytes());
        assert_eq!(bytes[148..], 1.0f32.to_le_bytes());
    }
}
