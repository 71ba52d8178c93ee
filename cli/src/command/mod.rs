//! The subcommands, a module each.

pub(crate) mod envmap;
pub(crate) mod measure;
pub(crate) mod stipple;
pub(crate) mod tables;
pub(crate) mod tiling;

use std::error::Error;
use std::io::{self, Write as _};
use std::path::Path;

use twelvefold_files::failure::Failure;

/// A failure about an input, by the name that the user knows it by.
fn of_input(path: &Path, reason: impl Into<Box<dyn Error>>) -> Failure {
    if path.as_os_str() == "-" {
        Failure::about("standard input", reason)
    } else {
        Failure::at(path, reason)
    }
}

/// Says what was assumed of an input or is amiss with it.
fn warn(path: &Path, warnings: &[String]) {
    for warning in warnings {
        // Stderr may be closed, which is no reason to stop.
        let warning = of_input(path, format!("warning: {warning}"));
        let _ = writeln!(io::stderr(), "twelvefold: {warning}");
    }
}
