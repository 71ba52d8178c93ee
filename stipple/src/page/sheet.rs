//! A sheet: what the drawing is drawn on, and where on it the photograph lies.

use std::fmt;

use glam::DVec2;

use super::length::PageSize;

/// Steps of coordinates on a page, in a millimeter: finer than any plotter.
pub const STEPS: f64 = 1e3;

/// The length of a dot's stroke, in the sheet's unit: too short to see, but programs drop those without any.
pub const TAP: f64 = 0.01;

/// What a sheet measures in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unit {
    /// The photograph's pixel, shown this many pixels large.
    Pixel(f64),
    /// The millimeter, shown this many pixels large where there are pixels.
    Millimeter(f64),
}

/// The drawing's rectangle, from (0, 0) at the upper left, and a photograph on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    pub size: DVec2,
    pub unit: Unit,
    /// The photograph's upper left corner, and the side of its pixels.
    corner: DVec2,
    pixel: f64,
    /// The photograph's size in pixels.
    photograph: DVec2,
}

/// How wide a dot is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DotWidth {
    Pixels(f64),
    Millimeters(f64),
}

/// A page as it was asked for.
#[derive(Debug, Clone, Copy)]
pub struct Page {
    pub size: PageSize,
    /// `None` is the default.
    pub margin: Option<f64>,
    pub landscape: bool,
    pub dpi: u16,
}

/// The margins leave no room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoRoom {
    size: DVec2,
    margin: f64,
}

impl fmt::Display for NoRoom {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size: DVec2 { x, y }, margin } = self;
        write!(out, "{margin} mm on each side leave no room for a dot on a page of {x} x {y} mm")
    }
}

impl std::error::Error for NoRoom {}

impl Sheet {
    /// The photograph itself, `scale` times as large on a screen.
    pub fn of_pixels(photograph: DVec2, scale: f64) -> Self {
        let unit = Unit::Pixel(scale);
        Self { size: photograph, unit, corner: DVec2::ZERO, pixel: 1.0, photograph }
    }

    /// A photograph as large as it can be on a page. Dots lie on it, and half a dot more on each side is
    /// still within the margins.
    ///
    /// # Errors
    /// [`NoRoom`].
    pub fn of_page(photograph: DVec2, page: &Page, dot: DotWidth) -> Result<Self, NoRoom> {
        let given = page.size.size;
        let (short, long) = (given.min_element(), given.max_element());
        let (upright, lying) = (DVec2::new(short, long), DVec2::new(long, short));
        match (page.landscape, page.size.turns) {
            (true, _) => Self::of_size(photograph, lying, page, dot),
            (false, false) => Self::of_size(photograph, given, page, dot),
            (false, true) => {
                match [upright, lying].map(|size| Self::of_size(photograph, size, page, dot)) {
                    [Ok(upright), Ok(lying)] if lying.pixel > upright.pixel => Ok(lying),
                    [Err(_), lying] => lying,
                    [upright, _] => upright,
                }
            }
        }
    }

    fn of_size(photograph: DVec2, size: DVec2, page: &Page, dot: DotWidth) -> Result<Self, NoRoom> {
        let margin = page.margin.unwrap_or((0.1 * size.min_element()).min(10.0));
        let room = size - 2.0 * margin;
        // A dot as wide as some pixels grows with them.
        let pixel = match dot {
            DotWidth::Millimeters(dot) => ((room - dot) / photograph).min_element(),
            DotWidth::Pixels(dot) => (room / (photograph + dot)).min_element(),
        };
        // A picture no larger than the strokes of its dots is none.
        if pixel * photograph.min_element() < 2.0 * TAP {
            return Err(NoRoom { size, margin });
        }
        let corner = 0.5 * (size - pixel * photograph);
        let unit = Unit::Millimeter(f64::from(page.dpi) / 25.4);
        Ok(Self { size, unit, corner, pixel, photograph })
    }

    /// The side of a pixel of the photograph.
    pub fn pixel(&self) -> f64 {
        self.pixel
    }

    /// Whether this is a page, in millimeters.
    pub fn is_page(&self) -> bool {
        matches!(self.unit, Unit::Millimeter(_))
    }

    /// Pixels in a unit, where a drawing has pixels.
    pub fn resolution(&self) -> f64 {
        match self.unit {
            Unit::Pixel(resolution) | Unit::Millimeter(resolution) => resolution,
        }
    }

    /// The upper left and lower right corner of where dots' centers may lie. On a page, their strokes, which
    /// go to the right, end on the photograph too.
    pub fn picture(&self) -> [DVec2; 2] {
        let end = self.corner + self.pixel * self.photograph;
        [self.corner, if self.is_page() { end - DVec2::new(TAP, 0.0) } else { end }]
    }

    /// Where on the sheet a place of the photograph is: on a page rounded to its steps and in the picture,
    /// else exactly representable in 32 bits and within the photograph's half-open rectangle.
    pub fn place(&self, dot: DVec2) -> DVec2 {
        match self.unit {
            Unit::Millimeter(_) => self.rounded(self.corner + self.pixel * dot),
            Unit::Pixel(_) => DVec2::new(
                narrowed(dot.x, self.photograph.x).into(),
                narrowed(dot.y, self.photograph.y).into(),
            ),
        }
    }

    /// The step nearest to `at` that lies in the picture.
    pub fn rounded(&self, at: DVec2) -> DVec2 {
        let [low, high] = self.picture().map(|corner| corner * STEPS);
        let (low, high) = (low.ceil(), high.floor());
        (at * STEPS).round().min(high).max(low) / STEPS
    }
}

/// The 32-bit float nearest to `coordinate` of those below `end`.
fn narrowed(coordinate: f64, end: f64) -> f32 {
    let narrow = coordinate as f32;
    if f64::from(narrow) < end { narrow } else { narrow.next_down() }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn page(size: &str) -> Page {
        Page { size: size.parse().unwrap(), margin: None, landscape: false, dpi: 300 }
    }

    #[test]
    fn rounding_never_carries_a_dot_onto_the_open_border() {
        for end in [1.0, 451.0, 4000.0, 16_777_217.0, 1e8 + 1.0] {
            let narrow = narrowed(f64::next_down(end), end);
            assert!(f64::from(narrow) < end && f64::from(narrow.next_up()) >= end, "{end}");
        }
        assert_eq!(narrowed(0.1, 1.0), 0.1);
    }

    #[test]
    fn named_pages_turn_with_the_picture_and_sizes_do_not() {
        let dot = DotWidth::Millimeters(0.5);
        let size = |photograph, page: &Page| {
            Sheet::of_page(photograph, page, dot).unwrap().size.to_array()
        };
        let (wide, tall) = (DVec2::new(300.0, 200.0), DVec2::new(200.0, 300.0));
        assert_eq!(size(wide, &page("a4")), [297.0, 210.0]);
        assert_eq!(size(tall, &page("a4")), [210.0, 297.0]);
        assert_eq!(size(wide, &page("210x297")), [210.0, 297.0]);
        let landscape = Page { landscape: true, ..page("210x297") };
        assert_eq!(size(tall, &landscape), [297.0, 210.0]);
    }

    #[test]
    fn margins_that_leave_no_room_are_an_error() {
        for margin in [104.9, 105.0, 1e9] {
            let page = Page { margin: Some(margin), ..page("210x297") };
            let dot = DotWidth::Millimeters(0.3);
            assert!(Sheet::of_page(DVec2::splat(100.0), &page, dot).is_err());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn the_picture_with_its_dots_touches_the_margins_and_keeps_its_shape(
            photograph in (1u16.., 1u16..), size in (20.0..900.0, 20.0..900.0), margin in 0.0..9.0,
            dot in 0.05..1.5,
        ) {
            let photograph = DVec2::new(photograph.0.into(), photograph.1.into());
            prop_assume!(photograph.max_element() < 500.0 * photograph.min_element());
            let size = PageSize { size: DVec2::new(size.0, size.1), turns: false };
            let page = Page { size, margin: Some(margin), landscape: false, dpi: 300 };
            for width in [DotWidth::Millimeters(dot), DotWidth::Pixels(dot)] {
                let sheet = Sheet::of_page(photograph, &page, width).unwrap();
                let radius = 0.5 * match width {
                    DotWidth::Millimeters(dot) => dot,
                    DotWidth::Pixels(dot) => dot * sheet.pixel(),
                };
                let [low, high] = sheet.picture();
                let high = high + DVec2::new(TAP, 0.0);
                let border = (low - radius).min(size.size - high - radius) - margin;
                prop_assert!(border.min_element().abs() < 1e-9, "{border}");
                prop_assert!(((high - low) / photograph - sheet.pixel()).abs().max_element() < 1e-9);
                for dot in [DVec2::ZERO, photograph, 0.3 * photograph] {
                    let place = sheet.place(dot);
                    prop_assert!(place.cmpge(low - 1e-9).all() && place.cmple(high + 1e-9).all());
                }
            }
        }
    }
}
