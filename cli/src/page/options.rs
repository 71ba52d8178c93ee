//! The options of paper and pens.

use clap::{Args, ValueEnum};
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::length::{Length, PageSize, margin};

use crate::pens::{Pens, Shadows};

/// Options for paper, pens and printers.
#[derive(Debug, Args)]
#[command(next_help_heading = "Paper and pens")]
pub(crate) struct PaperOptions {
    /// Draw on a page of this size: a3, a4, a5, letter, or WIDTHxHEIGHT in mm, or in inches as in 8.5x11in.
    ///
    /// The picture keeps its shape and lies in the middle of the margins; nothing is drawn outside it. SVG
    /// and PDF then measure in millimeters and have no background; PNG has `--dpi`; CSV and NPY hold
    /// millimeters from the upper left corner of the page. A named page is turned so that the picture is as
    /// large as can be; a size that is written out is taken as it stands.
    #[arg(long, value_name = "PAGE", conflicts_with = "scale")]
    pub(crate) page: Option<PageSize>,

    /// Empty border of the page, in mm, or in inches as in 0.5in [default: 10, or a tenth of the page's
    /// shorter side if that is less].
    #[arg(long, value_name = "LENGTH", requires = "page", value_parser = margin)]
    pub(crate) margin: Option<f64>,

    /// The page's longer side is its width.
    #[arg(long, requires = "page")]
    pub(crate) landscape: bool,

    /// How wide a line the pen draws, in mm, or in inches as in 0.01in.
    ///
    /// A dot is then as wide as the pen, no two are nearer to each other than that, and at most 0.8 of a
    /// black area is drawn over. Without a number of dots there are as many as the page can hold so; more
    /// are an error. `--exact` draws what fits or fails.
    #[arg(long, value_name = "WIDTH", requires = "page", conflicts_with = "dot_gain")]
    pub(crate) pen: Option<Length>,

    /// Draw in color, with these pens: `cmyk`, or CSS colors such as black,#c33,teal, at most 12.
    ///
    /// Seen from afar, dots and paper have the photograph's colors, as far as these pens can make them. No two dots overlap, of whichever pens, and those of each pen are even. The number of
    /// dots is that of all pens together.
    ///
    /// Each pen has a layer of its own, light ones first: in SVG one that Inkscape knows, in PDF one that
    /// viewers can hide. CSV has a third column, pen, with its name; NPY a third number, the layer's,
    /// from 0. For dark paper name its color with `--paper`.
    #[arg(long, value_name = "PENS", conflicts_with_all = ["line", "invert", "linear", "dot_gain"])]
    pub(crate) pens: Option<Pens>,

    /// What becomes of colors darker than `--pens` can make with 0.75 of the area covered: `clip` draws them as
    /// dark as can be, and all others as they are; `keep` draws everything lighter, so that differences in
    /// the shadows stay.
    #[arg(long, value_enum, value_name = "HOW", requires = "pens", default_value = "clip")]
    pub(crate) shadows: Shadows,

    /// How far the darkest pen replaces colored ones that together make gray, from 0 to 1 [default: 1, which
    /// takes the fewest dots; less has fewer dark dots among light ones].
    #[arg(long, value_name = "SHARE", requires = "pens", value_parser = share)]
    pub(crate) gcr: Option<f64>,

    /// What is drawn for each dot: `disc`, a filled circle, for screens and printers; `tap`, the shortest
    /// stroke, for a pen that goes down and up; `ring`, a circle that the pen draws, and in it as many as
    /// fill a dot wider than the pen (`--dot-size`; default three pens wide, or as wide as the number of
    /// dots allows).
    ///
    /// CSV and NPY hold no marks, but are ordered as for them; in PNG all are alike. A disc is a stroke without length, with round
    /// caps: a plotter treats it as a tap.
    #[arg(long, value_enum, value_name = "MARK", default_value = "disc")]
    pub(crate) marks: Marks,

    /// Draw one line through all dots that never crosses itself.
    ///
    /// Its dots follow the square of the darkness, so that the line, which is as long as the root of the
    /// number of dots in an area, has the picture's tone. About 5 microseconds a dot; at most 1,000,000.
    #[arg(long, conflicts_with_all = ["marks", "order", "dot_gain", "exact"])]
    pub(crate) line: bool,

    /// The order of the dots in the file: `short`, so that a pen travels little between them, which takes
    /// about 2 microseconds a dot, for at most 10,000,000; `rank`, of which each beginning is itself a good
    /// stippling; `none`, as the tiling gives them, which is all that is done for more than 2,000,000 dots.
    ///
    /// [default: short with `--pen`, `--marks tap` or `--marks ring` up to 1,000,000 dots; else none]
    #[arg(long, value_enum, value_name = "ORDER")]
    pub(crate) order: Option<Order>,

    /// Color of a background, by CSS name or as #rrggbb, which a plotter would draw around
    /// [default: none on a page or with `--marks tap` and `ring`; else white, or black with `--invert`].
    ///
    /// PNG always has one. Not for CSV and NPY, unless with `--pens`.
    #[arg(long, value_name = "COLOR")]
    pub(crate) paper: Option<Color>,

    /// Pixels of a PNG in an inch of the page, at most 4800 [default: 300]. Not for other formats.
    #[arg(long, value_name = "N", requires = "page", value_parser = clap::value_parser!(u16).range(1..=4800))]
    pub(crate) dpi: Option<u16>,
}

/// Reads a number from 0 to 1.
fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("not a number from 0 to 1".to_owned()),
    }
}

/// A kind of mark, as the command line has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Marks {
    /// A filled circle.
    Disc,
    /// The shortest stroke: pen down, pen up.
    Tap,
    /// A circle that the pen draws, and within it as many as fill a dot wider than the pen.
    Ring,
}

/// An order of dots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Order {
    /// Little travel from one to the next.
    Short,
    /// Each beginning is a good set.
    Rank,
    /// As they come.
    None,
}
