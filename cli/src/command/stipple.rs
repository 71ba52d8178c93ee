//! `twelvefold stipple`: a photograph drawn with equal dots.
//!
//! The photograph becomes importance; [`Plan`] settles how many dots there are and how large; they are placed
//! and refined, kept apart and put in order where a pen draws them, and written one by one.

use std::fmt;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

use glam::DVec2;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::{self, Levels, Picture, Tone};
use twelvefold_files::progress::Progress;

use crate::args::{DotGain, StippleOptions};
use crate::format::Format;
use crate::order;
use crate::page::apart::keep_apart;
use crate::page::options::Order;
use crate::pens::{Inks, InksError, Pens};
use crate::stipple::plan::{PEN_SHARE, PENS_SHARE, Plan, streams_unasked};
use twelvefold_stipple::dots::{self, Count, DotsError, Wish};
use twelvefold_stipple::drawing::{Drawing, DrawingError, Layer};
use twelvefold_stipple::gain;
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::sheet::STEPS;

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    let (format, mut output) = open(options)?;
    if let Some(option) = idle(options, format) {
        let format = format!("{format:?}").to_uppercase();
        return Err(Failure::about(option, format!("has no effect on {format}; leave it out")));
    }
    let (picture, inks) = match &options.paper.pens {
        None => {
            let mut picture = read(options)?;
            prepare(&mut picture, options, format);
            (picture, None)
        }
        Some(pens) => {
            let (picture, inks) = read_color(options, pens)?;
            (picture, Some(inks))
        }
    };
    let plan = Plan::new(options, &picture, format)
        .map_err(|error| Failure::about(error.option(), error))?;
    let mut progress = Progress::new(plan.wish.count.number(), options.quiet);
    let drawn = draw(format, (picture, inks), &plan, &mut output, &mut progress);
    let (points, time) = progress.finish();
    let drawn = match drawn {
        Ok(drawn) => drawn,
        Err(DotsError::Taker(DrawError::Drawing(DrawingError::Io(error)))) => {
            return finish(options, Err(OutputError::Io(error)));
        }
        Err(DotsError::Taker(DrawError::Drawing(error))) => {
            return Err(Failure::at(&options.output, error));
        }
        Err(DotsError::Taker(error)) => return Err(Failure::about("--exact", error)),
        Err(error) => return Err(of_photo(options, error)),
    };
    finish(options, output.commit())?;
    if !options.quiet {
        let seconds = time.as_secs_f64();
        // Stderr may be closed; the points are written all the same.
        let _ = writeln!(
            io::stderr(),
            "twelvefold: {points} points in {seconds:.3} s, {:.0} points a second{}",
            points as f64 / seconds.max(1e-9),
            remarks(options, &plan, points, &drawn),
        );
    }
    Ok(())
}

/// Opens the output before the photograph is read: a mistake in its name shows at once.
fn open(options: &StippleOptions) -> Result<(Format, Output), Failure> {
    let path = &options.output;
    if path.as_os_str() == "-" {
        return Ok((options.format.unwrap_or(Format::Csv), Output::standard()));
    }
    let format = options.format.or_else(|| Format::of(path)).ok_or_else(|| {
        Failure::at(path, "has none of the endings .svg, .png, .pdf, .csv and .npy; see --format")
    })?;
    let output =
        Output::create_from(path, &options.photo).map_err(|error| of_output(path, error))?;
    Ok((format, output))
}

/// An option that was given and that changes nothing in files of this format.
fn idle(options: &StippleOptions, format: Format) -> Option<&'static str> {
    let paper = &options.paper;
    // Dots of pens lie apart by their size, and have colors by that of the paper.
    let by_size = paper.pen.is_some() || paper.pens.is_some();
    [
        ("--dpi", paper.dpi.is_some() && format != Format::Png),
        ("--scale", options.scale.is_some() && format.is_list()),
        ("--paper", paper.paper.is_some() && paper.pens.is_none() && format.is_list()),
        ("--dot-size", options.dot_size.is_some() && !by_size && format.is_list()),
    ]
    .into_iter()
    .find_map(|(option, idle)| idle.then_some(option))
}

/// Reads the photograph, which must not be blank if dots are to be drawn.
fn read(options: &StippleOptions) -> Result<Picture, Failure> {
    let picture = picture::read_layer(&options.photo, tone(options)?, options.layer.as_deref())
        .map_err(|error| of_photo(options, error))?;
    warn(options, &picture.warnings);
    let nothing = options.points == Some(0) || options.exact == Some(0);
    if picture.total() == 0.0 && !nothing {
        let blank = Blank { invert: options.invert, range: picture.range };
        return Err(of_photo(options, blank));
    }
    Ok(picture)
}

/// Reads the photograph's colors and divides them among pens; what all pens together draw is the picture.
fn read_color(options: &StippleOptions, pens: &Pens) -> Result<(Picture, Inks), Failure> {
    let paper = options.paper.paper.unwrap_or(Color::WHITE);
    let pens = pens.on(paper).map_err(|error| Failure::about("--pens", error))?;
    let tone = tone(options)?;
    let mut colors = picture::read_color(&options.photo, tone, options.layer.as_deref())
        .map_err(|error| of_photo(options, error))?;
    warn(options, &colors.warnings);
    if let Some(levels) = tone.levels {
        colors.level(levels);
    }
    let gray = options.paper.gcr.unwrap_or(1.0);
    let inks =
        Inks::new(&colors, pens, paper, [PENS_SHARE, PEN_SHARE], options.paper.shadows, gray)
            .map_err(|error| match error {
                InksError::Memory { .. } => Failure::about("--pens", error),
                InksError::Classes(_) => of_photo(options, error),
            })?;
    let mut importance = Vec::new();
    let total = inks.classes.total();
    importance
        .try_reserve_exact(total.len())
        .map_err(|_| of_photo(options, InksError::Memory { bytes: Some(size_of_val(total)) }))?;
    importance.extend_from_slice(total);
    let (width, height) = (colors.width, colors.height);
    let picture = Picture { width, height, importance, range: None, warnings: colors.warnings };
    let nothing = options.points == Some(0) || options.exact == Some(0);
    if picture.total() == 0.0 && !nothing {
        let reason = "has no color that these pens could bring nearer than bare paper";
        return Err(of_photo(options, reason));
    }
    Ok((picture, inks))
}

fn warn(options: &StippleOptions, warnings: &[String]) {
    if !options.quiet {
        super::warn(&options.photo, warnings);
    }
}

/// The tone that the options ask for.
fn tone(options: &StippleOptions) -> Result<Tone, Failure> {
    let plain = Levels::default();
    let levels = Levels {
        black: options.black.unwrap_or(plain.black),
        white: options.white.unwrap_or(plain.white),
        gamma: options.gamma.unwrap_or(plain.gamma),
    };
    if levels.black >= levels.white {
        let reason = format!("{} is not below --white {}", levels.black, levels.white);
        return Err(Failure::about("--black", reason));
    }
    Ok(Tone {
        linear: options.linear,
        invert: options.invert,
        levels: (levels != plain).then_some(levels),
        exposure: options.exposure,
    })
}

/// Turns a picture's darkness into how many dots it should have.
fn prepare(picture: &mut Picture, options: &StippleOptions, format: Format) {
    let paper = &options.paper;
    // A pen's dots lie apart, so that none of their ink is lost; a list of points has no ink.
    let lies_apart = paper.pen.is_some() || format.is_list();
    let gain = if lies_apart { DotGain::Ignore } else { DotGain::Correct };
    if paper.line {
        gain::square(&mut picture.importance);
    } else if options.dot_gain.unwrap_or(gain) == DotGain::Correct {
        gain::correct(&mut picture.importance);
    }
}

/// What there is to say about what was drawn.
#[derive(Debug, Default)]
struct Drawn {
    /// How far a pen travels between dots, where they were put in order for it.
    travel: Option<f64>,
    /// Dots of each of several pens.
    pens: Vec<(String, usize)>,
}

/// Draws a picture's dots, those of each pen in its layer.
fn draw(
    format: Format,
    (picture, inks): (Picture, Option<Inks>),
    plan: &Plan,
    output: &mut Output,
    progress: &mut Progress,
) -> Result<Drawn, DotsError<DrawError>> {
    let failed = |error: io::Error| DotsError::Taker(DrawError::Drawing(error.into()));
    let mut drawing = format
        .begin(output, &plan.look)
        .map_err(|error| DotsError::Taker(DrawError::Drawing(error)))?;
    let mut drawn = Drawn::default();
    if inks.is_some() || plan.needs_list() {
        // What is polished before it has pens is moved again.
        let several = inks.as_ref().is_some_and(|inks| inks.pens.len() > 1);
        let wish = Wish { best: plan.wish.best && !several, ..plan.wish };
        let mut dots = dots::list(picture, wish, || {})?;
        let class_of = match &inks {
            Some(inks) => {
                dots::classified(&inks.classes, &mut dots, plan.wish).map_err(DotsError::Refine)?
            }
            None => Vec::new(),
        };
        let layers = layers(inks, dots, class_of, plan).map_err(DotsError::Taker)?;
        for (layer, dots) in layers {
            drawing.layer(&layer).map_err(failed)?;
            let length: f64 = dots.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            if plan.line || plan.order == Order::Short {
                drawn.travel = Some(drawn.travel.unwrap_or(0.0) + length);
            }
            if plan.look.named {
                drawn.pens.push((layer.name, dots.len()));
            }
            dots.into_iter()
                .try_for_each(|dot| put(&mut *drawing, dot, progress))
                .map_err(DotsError::Taker)?;
        }
    } else {
        drawing.layer(&layer(plan)).map_err(failed)?;
        let sheet = &plan.look.sheet;
        dots::place(
            picture,
            plan.wish,
            || {},
            |dot| put(&mut *drawing, sheet.place(dot), progress),
        )?;
    }
    drawing.finish().map_err(failed)?;
    Ok(drawn)
}

fn layer(plan: &Plan) -> Layer {
    Layer { name: plan.ink.svg(), color: plan.ink }
}

/// Dots as pens draw them: on the sheet, all apart, those of each pen in order.
fn layers(
    inks: Option<Inks>,
    mut dots: Vec<DVec2>,
    mut class_of: Vec<u8>,
    plan: &Plan,
) -> Result<Vec<(Layer, Vec<DVec2>)>, DrawError> {
    let sheet = &plan.look.sheet;
    for dot in &mut dots {
        *dot = sheet.place(*dot);
    }
    if let Some(least) = plan.apart {
        let asked = dots.len();
        let kept = keep_apart(&mut dots, least, sheet);
        if let (Count::Exactly(_), true) = (plan.wish.count, dots.len() < asked) {
            return Err(DrawError::NotExact { asked, found: dots.len() });
        }
        let mut kept = kept.into_iter();
        class_of.retain(|_| kept.next().unwrap_or(true));
    }
    let Some(inks) = inks else {
        return Ok(vec![(layer(plan), arranged(dots, plan))]);
    };
    let mut layers: Vec<(Layer, Vec<DVec2>)> = inks
        .pens
        .into_iter()
        .map(|pen| (Layer { name: pen.name, color: pen.color }, Vec::new()))
        .collect();
    for (dot, class) in dots.into_iter().zip(class_of) {
        if let Some((_, dots)) = layers.get_mut(usize::from(class)) {
            dots.push(dot);
        }
    }
    for (_, dots) in &mut layers {
        *dots = arranged(std::mem::take(dots), plan);
    }
    Ok(layers)
}

fn put(drawing: &mut dyn Drawing, dot: DVec2, progress: &mut Progress) -> Result<(), DrawError> {
    progress.point();
    drawing.dot(dot).map_err(|error| DrawError::Drawing(error.into()))
}

/// Dots in the order in which a pen draws them.
fn arranged(mut dots: Vec<DVec2>, plan: &Plan) -> Vec<DVec2> {
    let sheet = &plan.look.sheet;
    if plan.line {
        // Thousandths that lie in the half-open picture.
        let most = sheet.picture()[1] - 1.0 / STEPS;
        if !sheet.is_page() {
            dots.iter_mut().for_each(|dot| *dot = dot.min(most));
        }
        order::line(&mut dots);
    } else if plan.order == Order::Short {
        order::short(&mut dots);
    }
    dots
}

/// What there is to say about a drawing besides its number of dots.
fn remarks(options: &StippleOptions, plan: &Plan, points: u64, drawn: &Drawn) -> String {
    let mut remarks = String::new();
    if streams_unasked(options, &plan.wish) {
        remarks += ", not refined since so many are drawn as they come (see --refine)";
    }
    if let Some(page) = options.paper.page {
        let size = plan.look.sheet.size;
        let turned = if size == page.size { "" } else { ", turned" };
        remarks += &format!(", on {} x {} mm{turned}", size.x, size.y);
    }
    if let (Some(pen), None, None) = (options.paper.pen, options.points, options.exact) {
        remarks += &format!(", which a {} mm pen fills", pen.millimeters());
    }
    for (pen, dots) in &drawn.pens {
        remarks += &format!(", {dots} {pen}");
    }
    if let Some(travel) = drawn.travel.filter(|_| options.paper.page.is_some() && points > 1) {
        let what = if plan.line { "a line of" } else { "travel" };
        remarks += &format!(", {what} {:.1} m", travel / 1e3);
    }
    remarks
}

fn of_photo(options: &StippleOptions, reason: impl Into<Box<dyn std::error::Error>>) -> Failure {
    super::of_input(&options.photo, reason)
}

/// A file that could not be written is an error, unless whoever read it has had enough.
fn finish(options: &StippleOptions, written: Result<(), OutputError>) -> Result<(), Failure> {
    match written {
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| of_output(&options.output, error)),
    }
}

fn of_output(path: &Path, error: OutputError) -> Failure {
    if path.as_os_str() == "-" {
        Failure::about("standard output", error)
    } else {
        Failure::at(path, error)
    }
}

/// Why drawing stopped.
#[derive(Debug)]
enum DrawError {
    Drawing(DrawingError),
    /// Fewer dots than asked for lie a pen's width apart.
    NotExact {
        asked: usize,
        found: usize,
    },
}

impl fmt::Display for DrawError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawing(error) => error.fmt(out),
            Self::NotExact { asked, found } => {
                write!(out, "of {asked} dots only {found} lie a pen's width apart; ask for fewer")
            }
        }
    }
}

impl std::error::Error for DrawError {}

/// The photograph has nothing to put dots on.
#[derive(Debug)]
struct Blank {
    invert: bool,
    /// Of a float file.
    range: Option<(f64, f64)>,
}

impl fmt::Display for Blank {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.range {
            Some((least, greatest)) if !self.invert && least >= 1.0 => write!(
                out,
                "is brighter than 1, which is white, everywhere ({least:.3} to {greatest:.3}); \
                 try --exposure {}",
                -greatest.log2().ceil().max(1.0)
            ),
            _ => out.write_str(if self.invert {
                "is all black, which leaves no place for dots; try without --invert"
            } else {
                "is all white, which leaves no place for dots; try --invert"
            }),
        }
    }
}

impl std::error::Error for Blank {}
