//! Dots as a table of coordinates.

use std::io::{self, BufWriter, Write};

use glam::DVec2;

use super::{Drawing, Layer};

/// Lines `x,y` after a header that says so. Coordinates are the shortest decimals that read back as
/// the same 32-bit floats.
pub(crate) struct Csv<W: Write> {
    out: BufWriter<W>,
    x: zmij::Buffer,
    y: zmij::Buffer,
}

impl<W: Write> Csv<W> {
    /// Begins a table.
    ///
    /// # Errors
    /// The system's.
    pub(crate) fn new(out: W) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, out);
        out.write_all(b"x,y\n")?;
        Ok(Self { out, x: zmij::Buffer::new(), y: zmij::Buffer::new() })
    }
}

impl<W: Write> Drawing for Csv<W> {
    fn layer(&mut self, _: &Layer) -> io::Result<()> {
        Ok(())
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        // Formatted by the standard library, a point would take longer than it takes to place it.
        let (x, y) = (self.x.format(at.x as f32), self.y.format(at.y as f32));
        for part in [x, ",", y, "\n"] {
            self.out.write_all(part.as_bytes())?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_read_back_to_the_bit() {
        let dots = [(0.0f32, 511.99997f32), (1e-6, 0.1), (16_777_215.0, 33.333_332)];
        let mut bytes = Vec::new();
        let mut csv = Box::new(Csv::new(&mut bytes).unwrap());
        for (x, y) in dots {
            csv.dot(DVec2::new(f64::from(x), f64::from(y))).unwrap();
        }
        csv.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("x,y"));
        for (line, (x, y)) in lines.by_ref().zip(dots) {
            let (a, b) = line.split_once(',').unwrap();
            assert_eq!((a.parse(), b.parse()), (Ok(x), Ok(y)));
        }
        assert_eq!(lines.next(), None);
        assert!(text.ends_with('\n'));
    }
}
