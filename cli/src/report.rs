//! What is said about files that are read and written.

use std::error::Error;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;
use std::time::Duration;

use twelvefold_files::failure::Failure;
use twelvefold_files::output::OutputError;

/// A failure about an input, by the name that the user knows it by.
pub(crate) fn of_input(path: &Path, reason: impl Into<Box<dyn Error>>) -> Failure {
    if path.as_os_str() == "-" {
        Failure::about("standard input", reason)
    } else {
        Failure::at(path, reason)
    }
}

/// Says what was assumed of an input or is amiss with it.
pub(crate) fn warn(path: &Path, warnings: &[String]) {
    for warning in warnings {
        // Stderr may be closed, which is no reason to stop.
        let warning = of_input(path, format!("warning: {warning}"));
        let _ = writeln!(io::stderr(), "twelvefold: {warning}");
    }
}

/// A failure about an output.
pub(crate) fn of_output(path: &Path, error: OutputError) -> Failure {
    if path.as_os_str() == "-" {
        Failure::about("standard output", error)
    } else {
        Failure::at(path, error)
    }
}

/// A file that could not be written is an error, unless whoever read it has had enough.
pub(crate) fn finish(path: &Path, written: Result<(), OutputError>) -> Result<(), Failure> {
    match written {
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| of_output(path, error)),
    }
}

/// Says how many points were made in which time, and what else there is to say.
pub(crate) fn points(points: u64, time: Duration, remarks: &str) {
    let seconds = time.as_secs_f64();
    // Stderr may be closed; the points are written all the same.
    let _ = writeln!(
        io::stderr(),
        "twelvefold: {points} points in {seconds:.3} s, {:.0} points a second{remarks}",
        points as f64 / seconds.max(1e-9),
    );
}
