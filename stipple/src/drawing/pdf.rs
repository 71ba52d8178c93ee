//! Dots as strokes of a PDF page.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec2;
use pdf_writer::{Filter, Finish as _, Name, Pdf as Writer, Rect, Ref, TextStr};

use super::decimal;
use super::{Drawing, Layer, Look};
use crate::page::color::Color;
use crate::page::mark::Mark;
use crate::page::sheet::Unit;

/// Points, PDF's unit, in a millimeter and in a screen's pixel.
const POINTS_IN_MILLIMETER: f64 = 72.0 / 25.4;
const POINTS_IN_PIXEL: f64 = 0.75;

/// Strokes are painted so many dots at a time: viewers slow down over very long paths.
const DOTS_IN_PATH: u64 = 1000;

/// A quarter of a circle as a Bézier curve: how far its control points are along the tangents, in radii.
const QUARTER: f64 = 0.552_284_75;

/// A PDF file of one page. Its strokes are held in memory, compressed, some ten bytes each, until all are in:
/// their length goes before them.
#[derive(Debug)]
pub struct Pdf<'a, W: Write> {
    out: W,
    look: &'a Look,
    content: ZlibEncoder<Vec<u8>>,
    /// Steps of coordinates in the sheet's unit, and the page's size in points.
    steps: f64,
    size: DVec2,
    /// Dots in the path, and before it.
    dots: u64,
    text: Vec<u8>,
    layers: Vec<String>,
}

impl<'a, W: Write> Pdf<'a, W> {
    /// Begins the file.
    ///
    /// # Errors
    /// Those of memory.
    pub fn new(out: W, look: &'a Look) -> io::Result<Self> {
        let points = match look.sheet.unit {
            Unit::Pixel(scale) => POINTS_IN_PIXEL * scale,
            Unit::Millimeter(_) => POINTS_IN_MILLIMETER,
        };
        let size = look.sheet.size * points;
        let steps = 10f64.powi(look.decimals() as i32);
        let mut content = ZlibEncoder::new(Vec::new(), Compression::default());
        if look.ground_drawn {
            let color = ink(look.ground);
            writeln!(content, "{color} rg 0 0 {} {} re f", real(size.x), real(size.y))?;
        }
        // From here on in steps, from the upper left corner down; strokes with round caps and joins.
        let step = real(points / steps);
        writeln!(content, "{step} 0 0 -{step} 0 {} cm 1 J 1 j", real(size.y))?;
        writeln!(content, "{} w", real(look.mark.stroke() * steps))?;
        Ok(Self {
            out,
            look,
            content,
            steps,
            size,
            dots: 0,
            text: Vec::with_capacity(256),
            layers: Vec::new(),
        })
    }

    fn paint(&mut self) -> io::Result<()> {
        if self.dots > 0 {
            self.content.write_all(b"S\n")?;
        }
        self.dots = 0;
        Ok(())
    }

    fn end_layer(&mut self) -> io::Result<()> {
        if self.look.named && !self.layers.is_empty() {
            self.content.write_all(b"EMC\n")?;
        }
        Ok(())
    }

    /// The operator with operands, in steps from `at`.
    fn operator(&mut self, at: [i64; 2], points: &[[f64; 2]], name: &[u8]) {
        for point in points {
            for k in 0..2 {
                decimal::push(&mut self.text, at[k] + point[k].round() as i64, 0);
                self.text.push(b' ');
            }
        }
        self.text.extend_from_slice(name);
        self.text.push(b'\n');
    }

    fn circle(&mut self, at: [i64; 2], radius: f64) {
        let (r, c) = (radius, QUARTER * radius);
        self.operator(at, &[[r, 0.0]], b"m");
        for curve in [
            [[r, c], [c, r], [0.0, r]],
            [[-c, r], [-r, c], [-r, 0.0]],
            [[-r, -c], [-c, -r], [0.0, -r]],
            [[c, -r], [r, -c], [r, 0.0]],
        ] {
            self.operator(at, &curve, b"c");
        }
        self.text.extend_from_slice(b"h\n");
    }
}

impl<W: Write> Drawing for Pdf<'_, W> {
    fn layer(&mut self, layer: &Layer) -> io::Result<()> {
        self.paint()?;
        self.end_layer()?;
        self.layers.push(layer.name.clone());
        if self.look.named {
            writeln!(self.content, "/OC /{} BDC", property(self.layers.len()))?;
        }
        writeln!(self.content, "{} RG", ink(layer.color))
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        let whole = |t: f64| (t * self.steps).round() as i64;
        let at = [whole(at.x), whole(at.y)];
        self.text.clear();
        let look = self.look;
        match &look.mark {
            Mark::Line(_) => {
                let name: &[u8] = if self.dots == 0 { b"m" } else { b"l" };
                self.operator(at, &[[0.0; 2]], name);
            }
            // A stroke without length is painted as its round cap (ISO 32000-1, 8.5.3.2).
            Mark::Disc(_) | Mark::Tap(_) => {
                self.operator(at, &[[0.0; 2]], b"m");
                self.operator(at, &[[0.0; 2]], b"l");
            }
            Mark::Ring { radii, .. } => {
                for radius in radii {
                    let radius = (radius * self.steps).round();
                    if radius > 0.0 {
                        self.circle(at, radius);
                    } else {
                        self.operator(at, &[[0.0; 2]], b"m");
                        self.operator(at, &[[0.0; 2]], b"l");
                    }
                }
            }
        }
        self.content.write_all(&self.text)?;
        self.dots += 1;
        if self.dots == DOTS_IN_PATH && !matches!(look.mark, Mark::Line(_)) {
            self.paint()?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.paint()?;
        self.end_layer()?;
        let content = self.content.finish()?;
        let mut pdf = Writer::with_capacity(content.len() + 2048);
        let [catalog, pages, page, strokes, information] = [1, 2, 3, 4, 5].map(Ref::new);
        // Layers that viewers can hide (ISO 32000-1, 8.11).
        let named = if self.look.named { self.layers.as_slice() } else { &[] };
        let groups: Vec<Ref> = (6..).map(Ref::new).take(named.len()).collect();
        let mut root = pdf.catalog(catalog);
        root.pages(pages);
        if !groups.is_empty() {
            let mut properties = root.insert(Name(b"OCProperties")).dict();
            properties.insert(Name(b"OCGs")).array().items(&groups);
            let mut shown = properties.insert(Name(b"D")).dict();
            shown.insert(Name(b"Order")).array().items(&groups);
        }
        root.finish();
        for (group, name) in groups.iter().zip(named) {
            let mut group = pdf.indirect(*group).dict();
            group.pair(Name(b"Type"), Name(b"OCG")).pair(Name(b"Name"), TextStr(name));
        }
        pdf.pages(pages).kids([page]).count(1);
        let mut sheet = pdf.page(page);
        sheet.media_box(Rect::new(0.0, 0.0, self.size.x as f32, self.size.y as f32));
        sheet.parent(pages);
        sheet.contents(strokes);
        let mut resources = sheet.resources();
        if !groups.is_empty() {
            let mut properties = resources.insert(Name(b"Properties")).dict();
            for (group, number) in groups.iter().zip(1..) {
                properties.pair(Name(property(number).as_bytes()), *group);
            }
        }
        resources.finish();
        sheet.finish();
        pdf.stream(strokes, &content).filter(Filter::FlateDecode);
        let mut about = pdf.document_info(information);
        about.title(TextStr(&self.look.title)).subject(TextStr(&self.look.description));
        about.pair(Name(b"Creator"), TextStr(concat!("twelvefold ", env!("CARGO_PKG_VERSION"))));
        about.finish();
        self.out.write_all(&pdf.finish())?;
        self.out.flush()
    }
}

/// What the page calls a layer.
fn property(number: usize) -> String {
    format!("L{number}")
}

/// A number as PDF has them: without an exponent.
fn real(number: f64) -> String {
    format!("{number:.9}")
}

/// A color's components, 0 to 1.
fn ink(Color(components): Color) -> String {
    components.map(|component| format!("{:.4}", f64::from(component) / 255.0)).join(" ")
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use flate2::read::ZlibDecoder;

    use super::*;
    use crate::page::sheet::{DotWidth, Page, Sheet};

    /// The page's operators.
    fn operators(mark: Mark, dots: &[DVec2]) -> String {
        let size = "100x80".parse().unwrap();
        let page = Page { size, margin: None, landscape: false, dpi: 300 };
        let dot = DotWidth::Millimeters(1.0);
        let sheet = Sheet::of_page(DVec2::new(10.0, 8.0), &page, dot).unwrap();
        let look = Look { sheet, mark, ground_drawn: false, ..Look::of_pixels(1, 1, 1.0, 1.0) };
        let mut bytes = Vec::new();
        let mut pdf = Box::new(Pdf::new(&mut bytes, &look).unwrap());
        pdf.layer(&Layer::black()).unwrap();
        dots.iter().for_each(|dot| pdf.dot(*dot).unwrap());
        Drawing::finish(pdf).unwrap();
        let find = |what: &[u8]| bytes.windows(what.len()).position(|part| part == what).unwrap();
        assert!(bytes.starts_with(b"%PDF-") && bytes.ends_with(b"%%EOF"));
        find(b"/MediaBox [0 0 283.46457 226.77165]");
        let start = find(b"stream\n") + 7;
        let mut text = String::new();
        ZlibDecoder::new(&bytes[start..find(b"\nendstream")]).read_to_string(&mut text).unwrap();
        text
    }

    #[test]
    fn marks_are_strokes_in_thousandths_of_a_millimeter() {
        let dots = [DVec2::new(10.0, 20.0), DVec2::new(11.5, 18.25)];
        let head = "0.002834646 0 0 -0.002834646 0 226.771653543 cm 1 J 1 j\n";
        let discs = operators(Mark::Disc(0.8), &dots);
        assert_eq!(
            discs,
            format!(
                "{head}800.000000000 w\n0.0000 0.0000 0.0000 RG\n10000 20000 m\n10000 20000 l\n\
                 11500 18250 m\n11500 18250 l\nS\n"
            )
        );
        let line = operators(Mark::Line(0.3), &dots);
        assert!(line.ends_with("RG\n10000 20000 m\n11500 18250 l\nS\n"), "{line}");
        let ring = operators(Mark::ring(0.9, 0.3), &dots[..1]);
        assert_eq!(ring.matches(" c\n").count(), 4);
        assert!(ring.ends_with("h\n10000 20000 m\n10000 20000 l\nS\n"), "{ring}");
    }
}
