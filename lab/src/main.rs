//! The command-line program: each subcommand is a module with a `run` that returns a [`Failure`] or
//! nothing, and this file is the only place that prints an error or chooses the exit code.

mod args;
mod command;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;

use twelvefold_files::failure::Failure;

use crate::args::{Arguments, Command};
use crate::command::{classes, evenness, figures, report, speed, stipplers, train};

fn main() -> ExitCode {
    match process(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // A closed stderr leaves nobody to tell; the exit code still says it.
            let _ = writeln!(std::io::stderr(), "twelvefold-lab: {failure}");
            ExitCode::FAILURE
        }
    }
}

fn process(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Train(options) => train::run(options),
        Command::Report(options) => report::run(options),
        Command::Figures(options) => figures::run(options),
        Command::Speed(options) => speed::run(options),
        Command::Stipplers(options) => stipplers::run(options),
        Command::Classes(options) => classes::run(options),
        Command::Evenness(options) => evenness::run(options),
    }
}
