//! Dots as strokes of an SVG file.
//!
//! A layer is a group as Inkscape has them, with one path in it: moves from dot to dot, relative and without
//! idle characters, and at each dot its strokes. A disc is a stroke of next to no length and with round caps,
//! some 14 bytes; as a circle it would take 43.

use std::f64::consts::PI;
use std::io::{self, BufWriter, Write};

use glam::DVec2;

use super::decimal;
use super::{Drawing, Layer, Look};
use crate::page::mark::Mark;
use crate::page::sheet::{TAP, Unit};

/// A path ends after so many dots, and another begins: some readers of XML take no attribute longer than ten
/// million bytes.
const DOTS_IN_PATH: u64 = 200_000;

/// An SVG file whose user unit is the photograph's pixel, or the millimeter. Streams: each dot is written when
/// it comes.
#[derive(Debug)]
pub struct Svg<'a, W: Write> {
    out: BufWriter<W>,
    look: &'a Look,
    decimals: usize,
    /// 10 to the power of `decimals`.
    steps: f64,
    strokes: Strokes,
    /// Where the pen is, in steps; dots in the path; layers so far.
    pen: [i64; 2],
    dots: u64,
    layers: usize,
    text: Vec<u8>,
}

impl<'a, W: Write> Svg<'a, W> {
    /// Begins the file.
    ///
    /// # Errors
    /// The system's.
    pub fn new(out: W, look: &'a Look) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, out);
        if look.piece.first {
            write_head(&mut out, look)?;
        }
        let decimals = look.decimals();
        let steps = 10f64.powi(decimals as i32);
        let strokes = Strokes::of(&look.mark, decimals, steps);
        Ok(Self {
            out,
            look,
            decimals,
            steps,
            strokes,
            pen: [0; 2],
            dots: 0,
            layers: 0,
            text: Vec::with_capacity(64),
        })
    }

    fn end_path(&mut self) -> io::Result<()> {
        if self.dots > 0 {
            self.out.write_all(b"\"/>\n")?;
        }
        self.dots = 0;
        self.pen = [0; 2];
        Ok(())
    }
}

/// What goes before the first layer.
fn write_head(out: &mut impl Write, look: &Look) -> io::Result<()> {
    let DVec2 { x: width, y: height } = look.sheet.size;
    let (shown_width, shown_height) = match look.sheet.unit {
        Unit::Pixel(scale) => ((width * scale).to_string(), (height * scale).to_string()),
        Unit::Millimeter(_) => (format!("{width}mm"), format!("{height}mm")),
    };
    write!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{shown_width}\" height=\"{shown_height}\" viewBox=\"0 0 {width} {height}\">\n\
         <title>{}</title>\n<desc>{}</desc>\n",
        escaped(&look.title),
        escaped(&look.description),
    )?;
    if look.ground_drawn {
        let ground = look.ground.svg();
        writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>")?;
    }
    Ok(())
}

/// The width of a stroke as long as a tap that has the area of a disc: (π/4)·w² + TAP·w = (π/4)·width².
/// As wide as the disc, 60,000 dots on 512 × 512 pixels would be 0.9 % too much ink.
fn disc_stroke(width: f64) -> f64 {
    let half = 2.0 * TAP / PI;
    (width * width + half * half).sqrt() - half
}

/// What is drawn at a dot, in steps.
#[derive(Debug, Default)]
struct Strokes {
    text: Vec<u8>,
    /// Where it begins and ends, to the right of the dot.
    begin: i64,
    end: i64,
}

impl Strokes {
    fn of(mark: &Mark, decimals: usize, steps: f64) -> Self {
        let mut strokes = Self::default();
        match mark {
            Mark::Disc(_) | Mark::Tap(_) => strokes.tap(decimals, steps),
            Mark::Ring { radii, .. } => {
                let radii = radii.iter().map(|radius| (radius * steps).round() as i64);
                for (k, radius) in radii.enumerate() {
                    if k == 0 {
                        strokes.begin = -radius;
                    } else {
                        // From where the last circle began to where this one begins.
                        strokes.push("m", &[-radius - strokes.end, 0], decimals);
                    }
                    strokes.end = -radius;
                    if radius == 0 {
                        strokes.tap(decimals, steps);
                    } else {
                        strokes.half_circle(radius, 2 * radius, decimals);
                        strokes.half_circle(radius, -2 * radius, decimals);
                    }
                }
            }
            Mark::Line(_) => {}
        }
        strokes
    }

    fn push(&mut self, command: &str, numbers: &[i64], decimals: usize) {
        self.text.extend_from_slice(command.as_bytes());
        for (k, &number) in numbers.iter().enumerate() {
            if k > 0 && number >= 0 {
                self.text.push(b' ');
            }
            decimal::push(&mut self.text, number, decimals);
        }
    }

    fn tap(&mut self, decimals: usize, steps: f64) {
        let length = (TAP * steps).round() as i64;
        self.push("h", &[length], decimals);
        self.end += length;
    }

    fn half_circle(&mut self, radius: i64, across: i64, decimals: usize) {
        self.push("a", &[radius, radius], decimals);
        self.text.extend_from_slice(b" 0 1 0");
        if across >= 0 {
            self.text.push(b' ');
        }
        self.push("", &[across, 0], decimals);
    }
}

impl<W: Write> Drawing for Svg<'_, W> {
    fn layer(&mut self, layer: &Layer) -> io::Result<()> {
        self.end_path()?;
        if self.layers > 0 {
            self.out.write_all(b"</g>\n")?;
        }
        self.layers += 1;
        if !self.look.piece.first && self.layers == 1 {
            return Ok(());
        }
        let stroke = match self.look.mark {
            // On a page, a stroke is as wide as the pen.
            Mark::Disc(width) if !self.look.sheet.is_page() => disc_stroke(width),
            ref mark => mark.stroke(),
        };
        writeln!(
            self.out,
            "<g inkscape:groupmode=\"layer\" inkscape:label=\"{}\" id=\"layer{}\" fill=\"none\" \
             stroke=\"{}\" stroke-width=\"{stroke:.*}\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\">",
            escaped(&label(&layer.name, self.layers)),
            self.layers,
            layer.color.svg(),
            // A thousandth of the radius is as little to see as a hundredth of the spacing.
            decimal::decimals(stroke / 20.0),
        )
    }

    fn dot(&mut self, at: DVec2) -> io::Result<()> {
        let line = matches!(self.look.mark, Mark::Line(_));
        if self.dots == DOTS_IN_PATH && !line {
            self.end_path()?;
        }
        let step = |t: f64| (t * self.steps).round() as i64;
        let [x, y] = [step(at.x), step(at.y)];
        let (across, down) = (x + self.strokes.begin - self.pen[0], y - self.pen[1]);
        self.text.clear();
        let command: &[u8] = match (self.dots, line) {
            (0, _) => b"<path d=\"M",
            (_, true) if self.dots == 1 => b"\nl",
            (_, true) => b"\n",
            (_, false) => b"\nm",
        };
        self.text.extend_from_slice(command);
        decimal::push(&mut self.text, across, self.decimals);
        if down >= 0 {
            self.text.push(b' ');
        }
        decimal::push(&mut self.text, down, self.decimals);
        self.text.extend_from_slice(&self.strokes.text);
        self.out.write_all(&self.text)?;
        self.pen = [x + self.strokes.end, y];
        self.dots += 1;
        Ok(())
    }

    fn cut(&mut self) -> io::Result<()> {
        self.end_path()
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.end_path()?;
        if self.look.piece.last {
            if self.layers > 0 {
                self.out.write_all(b"</g>\n")?;
            }
            self.out.write_all(b"</svg>\n")?;
        }
        self.out.flush()
    }
}

/// What a layer is called. vpype takes the first digits of a label for the layer's number, or else those of the id:
/// `#c33` would be layer 33, and come last.
fn label(name: &str, number: usize) -> String {
    if name.contains(|c: char| c.is_ascii_digit()) {
        format!("{number} {name}")
    } else {
        name.to_owned()
    }
}

/// `text` as XML character data. Control characters, which XML 1.0 cannot hold, become U+FFFD.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\t' | '\n' => escaped.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {
                escaped.push(char::REPLACEMENT_CHARACTER);
            }
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Piece;
    use crate::page::color::Color;
    use crate::page::sheet::{DotWidth, Page, Sheet};

    fn drawn(look: &Look, dots: &[(f64, f64)]) -> String {
        let mut bytes = Vec::new();
        let mut svg = Box::new(Svg::new(&mut bytes, look).unwrap());
        svg.layer(&Layer { name: "a \"b\"".into(), color: look.ground }).unwrap();
        for &(x, y) in dots {
            svg.dot(DVec2::new(x, y)).unwrap();
        }
        svg.finish().unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_file_name_cannot_break_the_markup() {
        assert_eq!(escaped("a<b>&\"c\"\u{1}\n"), "a&lt;b&gt;&amp;&quot;c&quot;\u{fffd} ");
    }

    #[test]
    fn the_first_digits_of_a_label_or_else_of_the_id_are_the_layers_number() {
        let look = Look::of_pixels(40, 30, 1.0, 1.0);
        let mut bytes = Vec::new();
        let mut svg = Box::new(Svg::new(&mut bytes, &look).unwrap());
        for name in ["teal", "#c33", "black"] {
            svg.layer(&Layer { name: name.into(), color: Color::BLACK }).unwrap();
        }
        svg.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        for (label, id) in [("teal", 1), ("2 #c33", 2), ("black", 3)] {
            let layer = format!("inkscape:label=\"{label}\" id=\"layer{id}\"");
            assert!(text.contains(&layer), "{text}");
        }
    }

    #[test]
    fn each_dot_is_one_stroke_on_a_ground_of_the_photographs_shape() {
        let look = Look { ground: Color::WHITE, ..Look::of_pixels(40, 30, 2.5, 3.25) };
        assert_eq!(
            drawn(&look, &[(0.0, 29.999), (12.345, 6.0)]),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" \
             xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"100\" \
             height=\"75\" viewBox=\"0 0 40 30\">\n<title>t</title>\n<desc>d</desc>\n\
             <rect width=\"40\" height=\"30\" fill=\"white\"/>\n\
             <g inkscape:groupmode=\"layer\" inkscape:label=\"a &quot;b&quot;\" id=\"layer1\" \
             fill=\"none\" stroke=\"white\" stroke-width=\"3.244\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\">\n<path d=\"M0 30h.01\nm12.34-24h.01\"/>\n</g>\n</svg>\n"
        );
    }

    #[test]
    fn marks_begin_where_the_moves_before_them_end() {
        let size = "100x80".parse().unwrap();
        let page = Page { size, margin: None, landscape: false, dpi: 300 };
        let dot = DotWidth::Millimeters(1.0);
        let sheet = Sheet::of_page(DVec2::new(10.0, 8.0), &page, dot).unwrap();
        for (mark, path) in [
            (Mark::Disc(1.0), "M10 20h.01\nm1.49-2h.01"),
            (Mark::Tap(0.3), "M10 20h.01\nm1.49-2h.01"),
            (Mark::Line(0.3), "M10 20\nl1.5-2"),
            (
                Mark::ring(0.5, 0.3),
                "M9.9 20a.1 .1 0 1 0 .2 0a.1 .1 0 1 0-.2 0\nm1.5-2a.1 .1 0 1 0 .2 0a.1 .1 0 1 0-.2 0",
            ),
            (Mark::ring(0.9, 0.3), "M9.7 20a.3 .3 0 1 0 .6 0a.3 .3 0 1 0-.6 0m.3 0h.01\nm1.19-2a"),
        ] {
            let look = Look { sheet, mark, ground_drawn: false, ..Look::of_pixels(1, 1, 1.0, 1.0) };
            let text = drawn(&look, &[(10.0, 20.0), (11.5, 18.0)]);
            assert!(text.contains(&format!("<path d=\"{path}")), "{path}\n{text}");
            assert!(text.contains("width=\"100mm\" height=\"80mm\" viewBox=\"0 0 100 80\""));
            assert!(!text.contains("<rect"));
        }
    }

    #[test]
    fn a_path_is_no_longer_than_readers_take() {
        let look = Look::of_pixels(40, 30, 1.0, 1.0);
        let dots = vec![(1.0, 2.0); DOTS_IN_PATH as usize + 1];
        assert_eq!(drawn(&look, &dots).matches("<path d=\"M1 2h.01").count(), 2);
    }

    #[test]
    fn pieces_one_after_the_other_are_the_file() {
        let dots =
            |from: usize, to: usize| (from..to).map(|i| DVec2::new(i as f64, 30.0 - i as f64));
        let drawn = |piece: Piece, parts: &[(usize, usize)]| {
            let look = Look { piece, ..Look::of_pixels(40, 30, 1.0, 3.0) };
            let mut bytes = Vec::new();
            let mut svg = Box::new(Svg::new(&mut bytes, &look).unwrap());
            svg.layer(&Layer::black()).unwrap();
            for (from, to) in parts {
                dots(*from, *to).for_each(|dot| svg.dot(dot).unwrap());
                svg.cut().unwrap();
            }
            svg.finish().unwrap();
            bytes
        };
        let whole = drawn(Piece::WHOLE, &[(0, 7), (7, 7), (7, 19), (19, 25)]);
        let pieces = [
            drawn(Piece { first: true, last: false }, &[(0, 7)]),
            drawn(Piece { first: false, last: false }, &[(7, 7)]),
            drawn(Piece { first: false, last: false }, &[]),
            drawn(Piece { first: false, last: true }, &[(7, 19), (19, 25)]),
        ];
        assert_eq!(String::from_utf8(whole), String::from_utf8(pieces.concat()));
    }
}
