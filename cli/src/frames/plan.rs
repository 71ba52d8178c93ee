//! What all frames share.

use std::path::Path;

use glam::DVec2;
use twelvefold::Tables;
use twelvefold_files::failure::Failure;
use twelvefold_files::picture::Picture;
use twelvefold_stipple::budget::{default_count, default_dot_size};
use twelvefold_stipple::drawing::{Layer, Look, Piece};
use twelvefold_stipple::frames::Frames;
use twelvefold_stipple::page::color::Color;
use twelvefold_stipple::page::mark::Mark;
use twelvefold_stipple::page::sheet::Sheet;
use twelvefold_stipple::wish::{Centers, Count, Wish};

use super::options::FramesOptions;
use super::output::Kind;
use crate::args::{DotGain, MAX_HELD};
use crate::format::Format;
use crate::report;
use crate::stipple::tones::Importance;

/// How frames are drawn.
pub(crate) struct Plan {
    pub(crate) frames: Frames,
    look: Look,
    pub(crate) layer: Layer,
    /// Of the first frame.
    pub(crate) dots: f64,
    /// On a pixel of importance 1.
    density: f64,
    /// Whether all dots of a frame are held in memory.
    holds: bool,
}

/// What the frames' darkness becomes.
pub(crate) fn importance(options: &FramesOptions, kind: Kind) -> Importance {
    // A list of points has no ink that could be lost.
    let gain = if kind.is_list() { DotGain::Ignore } else { DotGain::Correct };
    match options.dot_gain.unwrap_or(gain) {
        DotGain::Correct => Importance::Corrected,
        DotGain::Ignore => Importance::Plain,
    }
}

impl Plan {
    /// The plan by the first frame that is not blank.
    ///
    /// # Errors
    /// [`Failure`] for more dots than can be held.
    pub(crate) fn new(
        options: &FramesOptions,
        first: &Picture,
        kind: Kind,
    ) -> Result<Self, Failure> {
        let black = first.total();
        let count = options.points.map_or_else(|| default_count(black), |count| count as f64);
        let density = count / black;
        let wish = Wish {
            count: Count::About(count),
            centers: Centers::Relaxed,
            seed: options.seed,
            refine: options.refine.into(),
            best: false,
            ranked: false,
            tables: Tables::built_in(),
        };
        let invert = options.tone.invert;
        let (ink, ground) =
            if invert { (Color::WHITE, Color::BLACK) } else { (Color::BLACK, Color::WHITE) };
        let size = DVec2::new(first.width as f64, first.height as f64);
        let look = Look {
            piece: Piece::WHOLE,
            sheet: Sheet::of_pixels(size, options.scale.unwrap_or(1.0)),
            mark: Mark::Disc(options.dot_size.unwrap_or_else(|| default_dot_size(density))),
            spacing: 1.0 / density.sqrt(),
            ground,
            ground_drawn: !kind.is_list(),
            linear: options.tone.linear,
            named: false,
            title: String::new(),
            description: wish.description(),
        };
        let frames =
            Frames::new(first, wish).map_err(|error| report::of_input(&options.input, error))?;
        let layer = Layer { name: ink.svg(), color: ink };
        let holds = options.refine > 0 || matches!(kind, Kind::Files(Format::Pdf | Format::Npy));
        Ok(Self { frames, look, layer, dots: count, density, holds })
    }

    /// Where a dot of a frame lies in the drawing.
    pub(crate) fn place(&self, dot: DVec2) -> DVec2 {
        self.look.sheet.place(dot)
    }

    /// The look of a frame that was read from a file, if it was.
    pub(crate) fn look(&self, file: Option<&Path>, number: u64) -> Look {
        let title = match file.and_then(Path::file_name) {
            Some(name) => name.to_string_lossy().into_owned(),
            None => format!("Frame {number}"),
        };
        Look { title, ..self.look.clone() }
    }

    /// Fails if a frame gets more dots than can be held.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn check(&self, frame: &Picture) -> Result<(), Failure> {
        let dots = frame.total() * self.density;
        if self.holds && dots > MAX_HELD as f64 {
            let reason = format!(
                "at most {MAX_HELD} dots can be refined or go into a PDF or an NPY file, and a frame has \
                 some {dots:.0}"
            );
            return Err(Failure::about("--points", reason));
        }
        Ok(())
    }
}
