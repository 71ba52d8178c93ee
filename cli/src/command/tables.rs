//! `twelvefold tables`: what the tables inside this program hold.

use std::fmt::Write as _;
use std::io::{self, ErrorKind, Write as _};

use sha2::{Digest as _, Sha256};
use twelvefold::Tables;
use twelvefold::tiling::{MAX_LEVEL, TileType};

use twelvefold_files::failure::Failure;

/// Runs the subcommand.
pub(crate) fn run() -> Result<(), Failure> {
    let text = description(&Tables::built_in());
    let mut stdout = io::stdout();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        // Whoever read this has seen enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::about("standard output", error)),
    }
}

/// One line for each property.
fn description(tables: &Tables<'_>) -> String {
    let entries: Vec<String> = TileType::ALL
        .iter()
        .map(|&kind| format!("{} {}", kind.letter(), tables.block(kind).len()))
        .collect();
    let bytes = tables.as_bytes();
    let hash = Sha256::digest(bytes).iter().fold(String::new(), |mut hex, byte| {
        // Writing to a string cannot fail.
        let _ = write!(hex, "{byte:02x}");
        hex
    });
    format!(
        "depth    {}\nentries  {}\nbytes    {}\nsha-256  {hash}\nlevels   {}\n",
        tables.depth(),
        entries.join(", "),
        bytes.len(),
        MAX_LEVEL,
    )
}
