//! Dots as circles of an SVG file.

use std::io::{self, BufWriter, Write};

use super::{Drawing, Style};

/// An SVG file whose user unit is the photograph's pixel. Streams: each dot is written when it comes.
#[derive(Debug)]
pub(crate) struct Svg<W: Write> {
    out: BufWriter<W>,
    decimals: usize,
    /// 10 to the power of `decimals`.
    unit: f64,
    /// What follows the coordinates of every circle.
    tail: String,
}

impl<W: Write> Svg<W> {
    /// Begins the file.
    ///
    /// # Errors
    /// The system's.
    pub(crate) fn new(out: W, style: &Style) -> io::Result<Self> {
        let mut out = BufWriter::with_capacity(1 << 16, out);
        let (width, height) = (style.width, style.height);
        let (shown_width, shown_height) = (width as f64 * style.scale, height as f64 * style.scale);
        let (ground, ink) =
            if style.white_on_black { ("black", "white") } else { ("white", "black") };
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{shown_width}\" \
             height=\"{shown_height}\" viewBox=\"0 0 {width} {height}\">\n\
             <title>{}</title>\n<desc>{}</desc>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>\n<g fill=\"{ink}\">",
            escaped(&style.title),
            escaped(&style.description),
        )?;
        let radius = style.dot_size / 2.0;
        // A thousandth of the radius is as little to see as a hundredth of the spacing.
        let tail = format!("\" r=\"{radius:.*}\"/>\n", decimals(radius / 10.0));
        let decimals = decimals(style.spacing);
        Ok(Self { out, decimals, unit: 10f64.powi(decimals as i32), tail })
    }
}

impl<W: Write> Svg<W> {
    /// Writes `value`, which is not negative, rounded to the decimals of this file.
    ///
    /// The standard library does the same in several times the time, which would be most of a run.
    fn coordinate(&mut self, value: f32) -> io::Result<()> {
        let mut rest = (f64::from(value) * self.unit).round() as u64;
        // A 64-bit number has at most twenty digits; with the point that is one more.
        let mut text = [b'0'; 24];
        let mut start = text.len();
        let mut digits = 0;
        while rest > 0 || digits <= self.decimals {
            if digits == self.decimals && digits > 0 {
                start -= 1;
                text[start] = b'.';
            }
            start -= 1;
            text[start] = b'0' + (rest % 10) as u8;
            rest /= 10;
            digits += 1;
        }
        self.out.write_all(&text[start..])
    }
}

/// How many decimals keep the rounding error under a hundredth of `length`.
fn decimals(length: f64) -> usize {
    let (mut decimals, mut error) = (0, 0.5);
    // A 32-bit float below one pixel has no more than nine decimals that mean anything.
    while error >= length / 100.0 && decimals < 9 {
        decimals += 1;
        error /= 10.0;
    }
    decimals
}

impl<W: Write> Drawing for Svg<W> {
    fn dot(&mut self, x: f32, y: f32) -> io::Result<()> {
        self.out.write_all(b"<circle cx=\"")?;
        self.coordinate(x)?;
        self.out.write_all(b"\" cy=\"")?;
        self.coordinate(y)?;
        self.out.write_all(self.tail.as_bytes())
    }

    fn finish(mut self) -> io::Result<()> {
        self.out.write_all(b"</g>\n</svg>\n")?;
        self.out.flush()
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

    #[test]
    fn just_enough_decimals() {
        // Two decimals are off by up to 0.005 pixels.
        for (spacing, expected) in [(3.0, 2), (0.6, 2), (0.5, 3), (0.3, 3), (60.0, 0), (40.0, 1)] {
            assert_eq!(decimals(spacing), expected, "{spacing}");
        }
        assert_eq!(decimals(0.0), 9);
    }

    #[test]
    fn coordinates_are_those_that_the_standard_library_rounds_to() {
        let mut values = vec![0.0f32, 0.004, 0.996, 1.0, 99.995, 511.99997, 65_535.996];
        values.extend((0..1000u32).map(|i| i.wrapping_mul(2_654_435_761) as f32 / 1e6));
        for decimals in 0..=9 {
            for &value in &values {
                let mut bytes = Vec::new();
                let out = BufWriter::new(&mut bytes);
                let unit = 10f64.powi(decimals as i32);
                let mut svg = Svg { out, decimals, unit, tail: String::new() };
                svg.coordinate(value).unwrap();
                svg.out.flush().unwrap();
                drop(svg);
                let written = String::from_utf8(bytes).unwrap();
                let expected = format!("{value:.decimals$}");
                // Halves may go either way.
                let error = written.parse::<f64>().unwrap() - f64::from(value);
                let nearest = error.abs() <= 0.5 / unit + 1e-12;
                assert!(written == expected || nearest, "{written} for {expected}");
                assert_eq!(written.len(), expected.len());
            }
        }
    }

    #[test]
    fn a_file_name_cannot_break_the_markup() {
        assert_eq!(escaped("a<b>&\"c\"\u{1}\n"), "a&lt;b&gt;&amp;\"c\"\u{fffd} ");
    }

    #[test]
    fn each_dot_is_one_circle_on_a_ground_of_the_photographs_shape() {
        let style = Style {
            width: 40,
            height: 30,
            scale: 2.5,
            dot_size: 3.25,
            spacing: 3.0,
            white_on_black: true,
            linear: false,
            title: "t".into(),
            description: "d".into(),
        };
        let mut bytes = Vec::new();
        let mut svg = Svg::new(&mut bytes, &style).unwrap();
        svg.dot(0.0, 29.999).unwrap();
        svg.dot(12.345, 6.0).unwrap();
        svg.finish().unwrap();
        assert_eq!(
            String::from_utf8(bytes).unwrap(),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"75\" \
             viewBox=\"0 0 40 30\">\n<title>t</title>\n<desc>d</desc>\n\
             <rect width=\"40\" height=\"30\" fill=\"black\"/>\n<g fill=\"white\">\n\
             <circle cx=\"0.00\" cy=\"30.00\" r=\"1.625\"/>\n\
             <circle cx=\"12.35\" cy=\"6.00\" r=\"1.625\"/>\n</g>\n</svg>\n"
        );
    }
}
