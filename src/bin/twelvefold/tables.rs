//! `twelvefold tables`: what the baked tables hold.

use crate::failure::Failure;

/// Runs the subcommand.
pub(crate) fn run() -> Result<(), Failure> {
    Err(Failure::about("tables", "the tables are being written"))
}
