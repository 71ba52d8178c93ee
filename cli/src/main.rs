//! The command-line program: each subcommand is a module with a `run` that returns a [`Failure`] or
//! nothing, and this file is the only place that prints an error or chooses the exit code.

mod args;
mod command;
mod format;
mod frames;
mod order;
mod page;
mod part;
mod pens;
mod report;
mod stipple;
mod survey;
mod tone;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;

use twelvefold_files::failure::Failure;

use crate::args::{Arguments, Command};
use crate::command::{envmap, measure, merge, tables, tiling};

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
        Command::Stipple(options) => match options.part {
            Some(part) => command::part::run(options, part),
            None => command::stipple::run(options),
        },
        Command::Frames(options) => command::frames::run(options),
        Command::Survey(options) => command::survey::run(options),
        Command::Merge(options) => merge::run(options),
        Command::Envmap(options) => envmap::run(options),
        Command::Measure(options) => measure::run(options),
        Command::Tables => tables::run(),
        Command::Tiling(options) => tiling::run(options),
    }
}
