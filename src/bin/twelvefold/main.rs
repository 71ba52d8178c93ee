//! The command-line program: each subcommand is a module with a `run` that returns a [`Failure`] or
//! nothing, and this file is the only place that prints an error or chooses the exit code.

mod args;
mod drawing;
mod envmap;
mod failure;
mod figures;
mod interrupt;
mod measure;
mod output;
mod picture;
mod point_list;
mod progress;
mod relax;
mod report;
mod stipple;
mod tables;
mod tiling;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;

use crate::args::{Arguments, Command};
use crate::failure::Failure;

fn main() -> ExitCode {
    match process(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // A closed stderr leaves nobody to tell; the exit code still says it.
            let _ = writeln!(std::io::stderr(), "twelvefold: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn process(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Stipple(options) => stipple::run(options),
        Command::Envmap(options) => envmap::run(options),
        Command::Relax(options) => relax::run(options),
        Command::Measure(options) => measure::run(options),
        Command::Report(options) => report::run(options),
        Command::Tables => tables::run(),
        Command::Tiling(options) => tiling::run(options),
        Command::Figures(options) => figures::run(options),
    }
}
