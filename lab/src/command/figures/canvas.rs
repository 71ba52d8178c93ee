//! A page of SVG: shapes in page units (pixels, y down) written as text, and views that map the plane
//! of the tiling (edges, y up) onto it.

use std::fmt::{self, Write as _};

use glam::DVec2;

/// The fonts of all text: whatever sans serif the viewer has.
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";

/// A picture under construction.
#[derive(Debug)]
pub(crate) struct Canvas {
    body: String,
}

impl Canvas {
    /// A white page, `size` pixels wide and high, with a title and a description for readers who
    /// cannot see it.
    pub(crate) fn new(size: DVec2, title: &str, description: &str) -> Self {
        let (width, height) = (Number(size.x), Number(size.y));
        let mut body = String::new();
        push(
            &mut body,
            format_args!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
                 viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n\
                 <title>{}</title>\n<desc>{}</desc>\n\
                 <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
                Escaped(title),
                Escaped(description),
            ),
        );
        Self { body }
    }

    /// A closed polygon. `style` holds attributes, here and below.
    pub(crate) fn polygon(&mut self, corners: &[DVec2], style: &str) {
        self.path(corners, "z", style);
    }

    /// An open line through the points.
    pub(crate) fn polyline(&mut self, points: &[DVec2], style: &str) {
        self.path(points, "", style);
    }

    fn path(&mut self, points: &[DVec2], end: &str, style: &str) {
        self.body.push_str("<path d=\"");
        for (i, point) in points.iter().enumerate() {
            let command = if i == 0 { 'M' } else { 'L' };
            push(&mut self.body, format_args!("{command}{}", Point(*point)));
        }
        push(&mut self.body, format_args!("{end}\"{}/>\n", Style(style)));
    }

    /// A disc.
    pub(crate) fn circle(&mut self, center: DVec2, radius: f64, style: &str) {
        push(
            &mut self.body,
            format_args!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n",
                Number(center.x),
                Number(center.y),
                Number(radius),
                Style(style)
            ),
        );
    }

    /// A rectangle with `min` as its upper left corner.
    pub(crate) fn rectangle(&mut self, min: DVec2, size: DVec2, style: &str) {
        push(
            &mut self.body,
            format_args!("<rect {}{}/>\n", RectangleAttributes { min, size }, Style(style)),
        );
    }

    /// Text whose baseline starts at `start` (or is anchored there as `style` says). `_x` in it sets
    /// the character x as a subscript.
    pub(crate) fn text(&mut self, start: DVec2, text: &str, style: &str) {
        push(
            &mut self.body,
            format_args!(
                "<text x=\"{}\" y=\"{}\"{}>{}</text>\n",
                Number(start.x),
                Number(start.y),
                Style(style),
                Subscripts(text)
            ),
        );
    }

    /// Defines a fill `url(#id)` that changes from one color at the left to another at the right.
    pub(crate) fn linear_gradient(&mut self, id: &str, left: &str, right: &str) {
        push(
            &mut self.body,
            format_args!(
                "<linearGradient id=\"{id}\"><stop offset=\"0\" stop-color=\"{left}\"/>\
                 <stop offset=\"1\" stop-color=\"{right}\"/></linearGradient>\n"
            ),
        );
    }

    /// Everything drawn until [`close`](Self::close) shares these attributes.
    pub(crate) fn open(&mut self, style: &str) {
        push(&mut self.body, format_args!("<g{}>\n", Style(style)));
    }

    /// As [`open`](Self::open), and shows only what lies in the rectangle. `id` must be unique in the
    /// page.
    pub(crate) fn open_clipped(&mut self, id: &str, min: DVec2, size: DVec2, style: &str) {
        push(
            &mut self.body,
            format_args!(
                "<clipPath id=\"{id}\"><rect {}/></clipPath>\n<g clip-path=\"url(#{id})\"{}>\n",
                RectangleAttributes { min, size },
                Style(style)
            ),
        );
    }

    /// Ends the innermost group.
    pub(crate) fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// The page as a complete SVG document.
    pub(crate) fn finish(mut self) -> String {
        self.body.push_str("</svg>\n");
        self.body
    }
}

/// Appends to a `String`, which cannot fail.
fn push(text: &mut String, arguments: fmt::Arguments<'_>) {
    let _ = text.write_fmt(arguments);
}

/// Hundredths of a pixel, without trailing zeros.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Adding 0 turns −0 into 0.
        write!(out, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}

struct Point(DVec2);

impl fmt::Display for Point {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} {}", Number(self.0.x), Number(self.0.y))
    }
}

struct RectangleAttributes {
    min: DVec2,
    size: DVec2,
}

impl fmt::Display for RectangleAttributes {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            out,
            "x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
            Number(self.min.x),
            Number(self.min.y),
            Number(self.size.x),
            Number(self.size.y)
        )
    }
}

/// Attributes after a space, or nothing.
struct Style<'a>(&'a str);

impl fmt::Display for Style<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() { Ok(()) } else { write!(out, " {}", self.0) }
    }
}

struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => out.write_str("&amp;")?,
                '<' => out.write_str("&lt;")?,
                '>' => out.write_str("&gt;")?,
                c => out.write_char(c)?,
            }
        }
        Ok(())
    }
}

struct Subscripts<'a>(&'a str);

impl fmt::Display for Subscripts<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = self.0.split('_');
        write!(out, "{}", Escaped(parts.next().unwrap_or_default()))?;
        for part in parts {
            let end = part.chars().next().map_or(0, char::len_utf8);
            let (subscript, rest) = part.split_at(end);
            // The size of `em` in the second tspan is the parent's, so it undoes 0.7 × 0.3 of it.
            write!(
                out,
                "<tspan font-size=\"0.7em\" dy=\"0.3em\">{}</tspan><tspan dy=\"-0.21em\">{}</tspan>",
                Escaped(subscript),
                // An empty tspan would lose its shift.
                if rest.is_empty() { Escaped("\u{200b}") } else { Escaped(rest) },
            )?;
        }
        Ok(())
    }
}

/// Maps the plane onto a page: a point p lands at `origin` + `scale`·(p − `center`), y flipped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Pixels a unit of the plane.
    pub(crate) scale: f64,
    /// The point of the plane that lands on `origin`.
    pub(crate) center: DVec2,
    /// Where `center` lands on the page.
    pub(crate) origin: DVec2,
}

impl View {
    /// The page position of a point of the plane.
    pub(crate) fn map(&self, point: DVec2) -> DVec2 {
        let offset = self.scale * (point - self.center);
        self.origin + DVec2::new(offset.x, -offset.y)
    }

    /// The page positions of the corners of a polygon.
    pub(crate) fn map_all(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|point| self.map(*point)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_never_minus_zero() {
        let shown = |n: f64| Number(n).to_string();
        assert_eq!(shown(1.0), "1");
        assert_eq!(shown(-0.001), "0");
        assert_eq!(shown(12.345_678), "12.35");
        assert_eq!(shown(-2.5), "-2.5");
    }

    #[test]
    fn text_is_escaped_and_subscripts_return_to_the_baseline() {
        assert_eq!(Subscripts("a<b & c").to_string(), "a&lt;b &amp; c");
        let one = Subscripts("c_A, ").to_string();
        assert!(one.starts_with("c<tspan") && one.contains(">A</tspan>") && one.contains(">, <"));
        // 0.3 em at 0.7 of the size goes down as far as 0.21 em at full size comes up.
        assert!((0.3f64 * 0.7 - 0.21).abs() < 1e-12);
    }

    #[test]
    fn views_flip_y_about_their_center() {
        let view =
            View { scale: 10.0, center: DVec2::new(1.0, 2.0), origin: DVec2::new(100.0, 50.0) };
        assert_eq!(view.map(DVec2::new(1.0, 2.0)), DVec2::new(100.0, 50.0));
        assert_eq!(view.map(DVec2::new(2.0, 3.0)), DVec2::new(110.0, 40.0));
    }

    #[test]
    fn pages_are_well_formed() {
        let mut page = Canvas::new(DVec2::new(20.0, 10.0), "1 < 2", "a & b");
        page.open_clipped("window", DVec2::ZERO, DVec2::ONE, "fill=\"none\"");
        page.polygon(&[DVec2::ZERO, DVec2::X, DVec2::Y], "");
        page.close();
        page.text(DVec2::ONE, "c_4", "");
        let text = page.finish();
        let document = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(document.root_element().first_element_child().unwrap().text(), Some("1 < 2"));
    }
}
