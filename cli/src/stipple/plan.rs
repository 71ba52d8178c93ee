//! What is drawn, of what size and where: worked out before the first dot.

use std::f64::consts::PI;
use std::fmt;

use glam::DVec2;
use twelvefold::Tables;

use crate::args::{MAX_EXACT, MAX_HELD, MAX_POINTS, StippleOptions};
use crate::format::Format;
use crate::page::options::Marks;
use crate::page::options::Order;
use crate::survey::Darkness;
use twelvefold_stipple::budget::{default_count, default_dot_size};
use twelvefold_stipple::drawing::{Look, Piece};
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::length::Length;
use twelvefold_stipple::page::mark::Mark;
use twelvefold_stipple::page::sheet::{DotWidth, NoRoom, Page, Sheet};
use twelvefold_stipple::wish::{self, Count, STREAMED, Wish};

/// The share of a black area that a pen draws over. Discs that do not overlap cover at most 0.907 of an area;
/// at 0.8 even ones lie 1.065 of their width apart.
pub(crate) const PEN_SHARE: f64 = 0.8;

/// The same of several pens, whose dots lie 1.1 of their width apart where they are densest. Colors leave much
/// more of a picture as dark as can be than one pen's tone does, and those of each pen are to stay even when
/// all are kept apart: at 0.8 that takes some hundred rounds.
pub(crate) const PENS_SHARE: f64 = 0.75;

/// The length of a line through n even dots in an area of 1, over √n: measured on 2,000 and on 8,000 refined
/// dots of one density. (If each stroke were as long as the distance in a triangular grid, 1.07.)
const LINE_LENGTH: f64 = 1.02;

/// A dot of rings, if nothing else says how large it is, in pens.
const RING_PENS: f64 = 3.0;

/// Pixels of a PNG in an inch of the page.
const DPI: u16 = 300;

/// The most dots that are ordered for a pen if nobody asks, and the most that one line goes through.
const ORDERED: f64 = 1_000_000.0;
const LONGEST_LINE: f64 = 1_000_000.0;

/// What is drawn.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    pub(crate) wish: Wish,
    pub(crate) look: Look,
    pub(crate) order: Order,
    pub(crate) line: bool,
    /// The least distance of two dots, in the sheet's unit.
    pub(crate) apart: Option<f64>,
    pub(crate) ink: Color,
}

/// Why nothing can be drawn so.
#[derive(Debug)]
pub(crate) enum PlanError {
    NoRoom(NoRoom),
    /// The best dots are refined ones.
    BestUnrefined,
    /// A unit, where only pixels can be meant.
    UnitWithoutPage,
    /// A dot of a pen has the pen's width.
    DotSizeOfPen,
    /// Rings need a pen to draw them.
    RingWithoutPen,
    /// A dot, in millimeters, thinner than the pen.
    DotBelowPen {
        dot: f64,
        pen: f64,
    },
    /// More dots than the page can hold.
    TooMany {
        asked: f64,
        capacity: f64,
    },
    /// More dots than can be refined.
    TooManyToRefine,
    /// More dots than the format can hold in memory.
    TooManyToHold,
    /// More dots than can be put into this order.
    TooManyToOrder {
        most: f64,
    },
}

impl PlanError {
    /// The option that is at fault.
    pub(crate) fn option(&self) -> &'static str {
        match self {
            Self::NoRoom(_) => "--margin",
            Self::BestUnrefined => "--best",
            Self::UnitWithoutPage | Self::DotSizeOfPen | Self::DotBelowPen { .. } => "--dot-size",
            Self::RingWithoutPen => "--marks ring",
            Self::TooMany { .. }
            | Self::TooManyToRefine
            | Self::TooManyToHold
            | Self::TooManyToOrder { .. } => "--points",
        }
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoRoom(error) => error.fmt(out),
            Self::BestUnrefined => {
                out.write_str("moves refined dots, and --refine 0 asks for none")
            }
            Self::UnitWithoutPage => {
                out.write_str("is in pixels of the photograph; a length needs a --page")
            }
            Self::DotSizeOfPen => out.write_str(
                "is not for a pen, whose dots are as wide as it is; --marks ring draws wider ones",
            ),
            Self::RingWithoutPen => out.write_str("needs the width of a --pen"),
            Self::DotBelowPen { dot, pen } => {
                write!(out, "{dot} mm is less than the {pen} mm that the pen draws")
            }
            Self::TooMany { asked, capacity } => write!(
                out,
                "{asked} dots do not fit on the page a pen's width apart; it can hold {capacity}"
            ),
            Self::TooManyToRefine => {
                write!(out, "at most {MAX_HELD} dots can be refined; see --refine 0")
            }
            Self::TooManyToHold => write!(
                out,
                "at most {MAX_HELD} dots go into a PDF or an NPY file; choose CSV or SVG, or parts of NPY"
            ),
            Self::TooManyToOrder { most } => write!(out, "at most {most} dots can be put in order"),
        }
    }
}

impl std::error::Error for PlanError {}

impl Plan {
    /// The plan for a picture of so much importance, as dots should have it, written as `format`.
    ///
    /// # Errors
    /// [`PlanError`].
    pub(crate) fn new(
        options: &StippleOptions,
        darkness: &Darkness,
        format: Format,
    ) -> Result<Self, PlanError> {
        if options.best && options.refine == Some(0) {
            return Err(PlanError::BestUnrefined);
        }
        let paper = &options.paper;
        let black = darkness.total;
        let asked = options.exact.or(options.points).map(|count| count as f64);
        let pen = paper.pen.map(Length::millimeters);
        let photograph = DVec2::new(darkness.width as f64, darkness.height as f64);
        let width = dot_width(options, asked, black, pen)?;
        let sheet = match paper.page {
            None => Sheet::of_pixels(photograph, options.scale.unwrap_or(1.0)),
            Some(size) => {
                let page = Page {
                    size,
                    margin: paper.margin,
                    landscape: paper.landscape,
                    dpi: paper.dpi.unwrap_or(DPI),
                };
                Sheet::of_page(photograph, &page, width).map_err(PlanError::NoRoom)?
            }
        };
        let pixel = sheet.pixel();
        let width = match width {
            DotWidth::Millimeters(width) => width,
            DotWidth::Pixels(width) => width * pixel,
        };
        let count = match pen {
            None => asked.unwrap_or_else(|| default_count(black)),
            // The densest that a pen may draw, and what that makes where the picture is black.
            Some(_) => {
                let densest = pixel * pixel * densest(width, paper.line);
                let darkest = f64::from(darkness.darkest);
                let capacity = (densest * black / darkest).floor().max(1.0);
                if let Some(asked) = asked.filter(|asked| *asked > capacity) {
                    return Err(PlanError::TooMany { asked, capacity });
                }
                asked.unwrap_or((densest * black).floor().clamp(1.0, MAX_POINTS as f64))
            }
        };
        let order = order(options, count)?;
        let mark = match (paper.line, paper.marks, pen) {
            (true, ..) => Mark::Line(width),
            (false, Marks::Disc, _) => Mark::Disc(width),
            (false, Marks::Tap, _) => Mark::Tap(width),
            (false, Marks::Ring, pen) => Mark::ring(width, pen.unwrap_or(width)),
        };
        let wish = Wish {
            count: match options.exact {
                Some(count) => Count::Exactly(count as usize),
                None => Count::About(count),
            },
            centers: options.centers.centers(),
            seed: options.seed,
            refine: options
                .refine
                .map_or(wish::default_iterations(count, options.best), usize::from),
            best: options.best,
            ranked: order == Order::Rank,
            tables: Tables::built_in(),
        };
        if options.part.is_none() && wish.refine > 0 && count > MAX_HELD as f64 {
            return Err(PlanError::TooManyToRefine);
        }
        let parts = options.part.map_or(1, |part| part.of) as f64;
        if matches!(format, Format::Pdf | Format::Npy) && count / parts > MAX_HELD as f64 {
            return Err(PlanError::TooManyToHold);
        }
        Ok(Self {
            look: look(options, format, sheet, mark, pixel / (count / black).sqrt(), &wish),
            wish,
            order,
            line: paper.line,
            apart: match pen {
                Some(pen) if paper.line => Some(pen),
                Some(_) => Some(width),
                // Dots of several pens lie apart at the width that is theirs by default.
                None if paper.pens.is_some() && options.dot_size.is_none() => Some(width),
                None => None,
            },
            ink: if options.tone.invert { Color::WHITE } else { Color::BLACK },
        })
    }

    /// Whether dots must all be there before the first is drawn.
    pub(crate) fn needs_list(&self) -> bool {
        self.line || self.apart.is_some() || self.order == Order::Short
    }
}

/// How many dots, or places of a line, of this width there may be in a squared unit.
fn densest(width: f64, line: bool) -> f64 {
    if line {
        let root = PEN_SHARE / (LINE_LENGTH * width);
        root * root
    } else {
        PEN_SHARE / (PI / 4.0 * width * width)
    }
}

/// The width of dots, or of the line.
fn dot_width(
    options: &StippleOptions,
    asked: Option<f64>,
    black: f64,
    pen: Option<f64>,
) -> Result<DotWidth, PlanError> {
    let paper = &options.paper;
    let ring = paper.marks == Marks::Ring && !paper.line;
    match (options.dot_size, pen) {
        (_, None) if ring => Err(PlanError::RingWithoutPen),
        (Some(_), Some(_)) if !ring => Err(PlanError::DotSizeOfPen),
        (Some(Length::Millimeters(_)), _) if paper.page.is_none() => {
            Err(PlanError::UnitWithoutPage)
        }
        (Some(dot), Some(pen)) if dot.millimeters() < pen => {
            Err(PlanError::DotBelowPen { dot: dot.millimeters(), pen })
        }
        (Some(Length::Bare(dot)), _) if paper.page.is_none() => Ok(DotWidth::Pixels(dot)),
        (Some(dot), _) => Ok(DotWidth::Millimeters(dot.millimeters())),
        (None, Some(pen)) if ring => {
            let Some(asked) = asked.filter(|asked| *asked > 0.0 && paper.page.is_some()) else {
                return Ok(DotWidth::Millimeters(RING_PENS * pen));
            };
            Ok(DotWidth::Pixels((PEN_SHARE * black / asked / (PI / 4.0)).sqrt()))
        }
        (None, Some(pen)) => Ok(DotWidth::Millimeters(pen)),
        (None, None) => {
            // Dots in a squared pixel of black.
            let density = asked.unwrap_or_else(|| default_count(black)) / black;
            Ok(DotWidth::Pixels(if paper.line && density > 0.0 {
                PEN_SHARE / (LINE_LENGTH * density.sqrt())
            } else {
                // Dots of several pens lie apart.
                let share: f64 = if paper.pens.is_some() { PEN_SHARE } else { 1.0 };
                share.sqrt() * default_dot_size(density)
            }))
        }
    }
}

/// The order of `count` dots.
fn order(options: &StippleOptions, count: f64) -> Result<Order, PlanError> {
    let paper = &options.paper;
    let for_pen = paper.pen.is_some() || paper.pens.is_some() || paper.marks != Marks::Disc;
    let order = match paper.order {
        Some(order) => order,
        None if for_pen && count <= ORDERED => Order::Short,
        None => Order::None,
    };
    let most = match order {
        _ if paper.line => LONGEST_LINE,
        Order::Short | Order::Rank => MAX_EXACT as f64,
        Order::None => f64::INFINITY,
    };
    if count > most {
        return Err(PlanError::TooManyToOrder { most });
    }
    Ok(order)
}

fn look(
    options: &StippleOptions,
    format: Format,
    sheet: Sheet,
    mark: Mark,
    spacing: f64,
    wish: &Wish,
) -> Look {
    let ground = if options.tone.invert { Color::BLACK } else { Color::WHITE };
    // What a pen draws gets nothing around it that a pen would draw too.
    let on_screen = !sheet.is_page() && matches!(mark, Mark::Disc(_) | Mark::Line(_));
    let photo = &options.photo;
    Look {
        piece: Piece::WHOLE,
        sheet,
        mark,
        spacing,
        ground: options.paper.paper.unwrap_or(ground),
        ground_drawn: options.paper.paper.is_some() || on_screen || format == Format::Png,
        // Pens' amounts are those of light.
        linear: options.tone.linear || options.paper.pens.is_some(),
        named: options.paper.pens.is_some(),
        title: photo.file_name().unwrap_or(photo.as_os_str()).to_string_lossy().into_owned(),
        description: wish.description(),
    }
}

/// Whether dots that nobody asked to refine are not refined because there are so many.
pub(crate) fn streams_unasked(options: &StippleOptions, wish: &Wish) -> bool {
    options.refine.is_none() && !options.best && wish.count.number() >= STREAMED
}
