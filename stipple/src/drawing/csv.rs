//! Dots as a table of coordinates.

use std::io::{self, BufWriter, Write};

use glam::DVec2;

use super::{Drawing, Layer, Look};

/// Lines `x,y`, or `x,y,pen`, after a header that says so. A pen's name is that of its layer. Coordinates are the shortest decimals that read back as
/// the same 32-bit floats.
pub struct Csv<W: Write> {
    out: BufWriter<W>,
    /// What comes after the coordinates.
    end: String,
    named: bool,
    x: zmij::Buffer,
    y: zmij::Buffer,
}

impl<W: Write> Csv<W> {
    /// Begins a table.
    ///
    /// # Errors
    /// The system's.
    pub fn new(out: W, look: &Look) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, out);
        let named = look.named;
        if look.piece.first {
            out.write_all(if named { b"x,y,pen\n" } else { b"x,y\n" })?;
        }
        Ok(Self {
            out,
            end: "\n".to_owned(),
            named,
            x: zmij::Buffer::new(),
            y: zmij::Buffer::new(),
        })
    }
}

impl<W: Write> Drawing for Csv<W> {
    fn layer(&mut self, layer: &Layer) -> io::Result<()> {
        if self.named {
            self.end = format!(",{}\n", quoted(&layer.name));
        }
        Ok(())
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        // Formatted by the standard library, a point would take longer than it takes to place it.
        let (x, y) = (self.x.format(at.x as f32), self.y.format(at.y as f32));
        for part in [x, ",", y, &self.end] {
            self.out.write_all(part.as_bytes())?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.out.flush()
    }
}

/// A name as a field of a table (RFC 4180).
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_read_back_to_the_bit() {
        let dots = [(0.0f32, 511.99997f32), (1e-6, 0.1), (16_777_215.0, 33.333_332)];
        let (mut bytes, look) = (Vec::new(), Look::of_pixels(9, 9, 1.0, 1.0));
        let mut csv = Box::new(Csv::new(&mut bytes, &look).unwrap());
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

    #[test]
    fn pens_have_a_column() {
        let mut bytes = Vec::new();
        let look = Look { named: true, ..Look::of_pixels(9, 9, 1.0, 1.0) };
        let mut csv = Box::new(Csv::new(&mut bytes, &look).unwrap());
        for name in ["teal", "a,\"b\""] {
            csv.layer(&Layer { name: name.to_owned(), ..Layer::black() }).unwrap();
            csv.dot(DVec2::new(1.5, 2.0)).unwrap();
        }
        csv.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text, "x,y,pen\n1.5,2.0,teal\n1.5,2.0,\"a,\"\"b\"\"\"\n");
    }
}
