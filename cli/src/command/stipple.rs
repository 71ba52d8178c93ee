//! `twelvefold stipple`: a photograph drawn with equal dots.
//!
//! The photograph becomes importance; [`Plan`] settles how many dots there are and how large; they are placed
//! and refined, kept apart and put in order where a pen draws them, and written one by one.

use std::io;

use glam::DVec2;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::{self, Picture};
use twelvefold_files::progress::Progress;
use twelvefold_stipple::dots;
use twelvefold_stipple::drawing::{DrawingError, Layer};
use twelvefold_stipple::error::DotsError;
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::sheet::STEPS;
use twelvefold_stipple::raw::Step;
use twelvefold_stipple::wish::{Count, Wish};

use crate::args::StippleOptions;
use crate::format::Format;
use crate::order;
use crate::page::apart::keep_apart;
use crate::page::options::Order;
use crate::pens::{Inks, InksError, Pens};
use crate::report;
use crate::stipple::drawn::{DrawError, layer, open, put};
use crate::stipple::plan::{PEN_SHARE, PENS_SHARE, Plan, streams_unasked};
use crate::stipple::tones::{Blank, importance};
use crate::survey::Darkness;

/// Runs the subcommand.
pub(crate) fn run(options: &StippleOptions) -> Result<(), Failure> {
    let (format, mut output) = open(options)?;
    let (picture, inks) = match &options.paper.pens {
        None => {
            let mut picture = read(options)?;
            importance(options, format).of_darkness(&mut picture.importance);
            (picture, None)
        }
        Some(pens) => {
            let (picture, inks) = read_color(options, pens)?;
            (picture, Some(inks))
        }
    };
    let plan = Plan::new(options, &Darkness::of(&picture), format)
        .map_err(|error| Failure::about(error.option(), error))?;
    let mut progress = Progress::new(plan.wish.count.number(), options.quiet);
    let drawn = draw(format, (picture, inks), &plan, &mut output, &mut progress);
    let (points, time) = progress.finish();
    let drawn = match drawn {
        Ok(drawn) => drawn,
        Err(DotsError::Taker(DrawError::Drawing(DrawingError::Io(error)))) => {
            return report::finish(&options.output, Err(OutputError::Io(error)));
        }
        Err(DotsError::Taker(DrawError::Drawing(error))) => {
            return Err(Failure::at(&options.output, error));
        }
        Err(DotsError::Taker(error)) => return Err(Failure::about("--exact", error)),
        Err(error) => return Err(of_photo(options, error)),
    };
    report::finish(&options.output, output.commit())?;
    if !options.quiet {
        report::points(points, time, &remarks(options, &plan, points, &drawn));
    }
    Ok(())
}

/// Reads the photograph, which must not be blank if dots are to be drawn.
fn read(options: &StippleOptions) -> Result<Picture, Failure> {
    let picture =
        picture::read_layer(&options.photo, options.tone.tone()?, options.layer.as_deref())
            .map_err(|error| of_photo(options, error))?;
    warn(options, &picture.warnings);
    let nothing = options.points == Some(0) || options.exact == Some(0);
    if picture.total() == 0.0 && !nothing {
        let blank = Blank { invert: options.tone.invert, range: picture.range };
        return Err(of_photo(options, blank));
    }
    Ok(picture)
}

/// Reads the photograph's colors and divides them among pens; what all pens together draw is the picture.
fn read_color(options: &StippleOptions, pens: &Pens) -> Result<(Picture, Inks), Failure> {
    let paper = options.paper.paper.unwrap_or(Color::WHITE);
    let pens = pens.on(paper).map_err(|error| Failure::about("--pens", error))?;
    let tone = options.tone.tone()?;
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
        report::warn(&options.photo, warnings);
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
            |step| match step {
                Step::Dot(dot) => put(&mut *drawing, sheet.place(dot), progress),
                Step::Cut => drawing.cut().map_err(|error| DrawError::Drawing(error.into())),
            },
        )?;
    }
    drawing.finish().map_err(failed)?;
    Ok(drawn)
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
    report::of_input(&options.photo, reason)
}
