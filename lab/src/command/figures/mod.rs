//! `twelvefold figures`: the paper's seven figures, drawn again from this program's own code.

mod canvas;
mod cells;
mod psi;
mod ramp;
mod rules;
mod sequences;
mod thresholds;
mod tilings;

use std::error::Error;
use std::fs;
use std::io::Write as _;

use twelvefold::Tables;
use twelvefold::tiling::Rules;

use crate::args::FiguresOptions;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::Output;

/// What a figure's code returns; the errors are the library's.
type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A figure's file name and the function that draws it as an SVG document.
type Figure = (&'static str, fn(&Rules) -> Result<String>);

const FIGURES: [Figure; 7] = [
    ("fig1.svg", tilings::tiling_and_dual),
    ("fig2.svg", tilings::two_levels_and_points),
    ("fig3.svg", rules::production_rules),
    ("fig4.svg", psi::psi),
    ("fig5.svg", ramp::ramp),
    ("fig6.svg", thresholds::thresholds),
    ("fig7.svg", sequences::sequences),
];

/// Runs the subcommand.
pub(crate) fn run(options: &FiguresOptions) -> std::result::Result<(), Failure> {
    let folder = &options.output;
    let rules = Tables::built_in().rules();
    // All are drawn before any is written, so that a mistake leaves the folder as it was.
    let mut documents = Vec::new();
    for (name, draw) in FIGURES {
        documents.push((name, draw(&rules).map_err(|error| Failure::about(name, error))?));
    }
    fs::create_dir_all(folder).map_err(|error| Failure::at(folder, error))?;
    // And all are written before any takes its place.
    let mut outputs = Vec::new();
    for (name, document) in documents {
        let path = folder.join(name);
        let mut output = Output::create(&path).map_err(|error| Failure::at(&path, error))?;
        output.write_all(document.as_bytes()).map_err(|error| Failure::at(&path, error))?;
        outputs.push((path, output));
    }
    for (path, output) in outputs {
        output.commit().map_err(|error| Failure::at(&path, error))?;
    }
    Ok(())
}
