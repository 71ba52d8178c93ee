//! Bakes the lookup tables: reads `tables/`, checks the rules, subdivides each tile type to a fixed
//! depth and writes the encoded blocks to `OUT_DIR/tables.bin`.
//!
//! The rules and the encoder are the library's own sources, compiled here a second time, so that there
//! is one place to change them. `TWELVEFOLD_DEPTH` (1 to 4) chooses the depth.

extern crate alloc;

#[allow(dead_code, unreachable_pub, reason = "the library uses the rest of these modules")]
#[path = "src/bake/mod.rs"]
mod bake;
#[allow(
    dead_code,
    unreachable_pub,
    unused_imports,
    reason = "the library uses the rest of these modules"
)]
#[path = "src/tiling/mod.rs"]
mod tiling;

use std::process::ExitCode;

const DIGITS: &str = "tables/digits.txt";
const RELAXED: &str = "tables/relaxed.bin";

fn main() -> ExitCode {
    for input in ["build.rs", "src/tiling", "src/bake", "tables"] {
        println!("cargo::rerun-if-changed={input}");
    }
    println!("cargo::rerun-if-env-changed=TWELVEFOLD_DEPTH");
    match write_tables() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            println!("cargo::error={message}");
            ExitCode::FAILURE
        }
    }
}

fn write_tables() -> Result<(), String> {
    let depth = match std::env::var("TWELVEFOLD_DEPTH") {
        Ok(text) => text.trim().parse().map_err(|_| {
            format!("TWELVEFOLD_DEPTH={text}: not a whole number from 1 to {}", bake::MAX_DEPTH)
        })?,
        Err(_) => bake::DEFAULT_DEPTH,
    };
    let text = std::fs::read_to_string(DIGITS).map_err(|error| format!("{DIGITS}: {error}"))?;
    let digits = tiling::Digits::parse(&text).map_err(|error| format!("{DIGITS}, {error}"))?;
    let rules = tiling::Rules::new(&digits).map_err(|error| format!("{DIGITS}, {error}"))?;
    let displacements = read_displacements()?;
    let bytes = bake::bake(&rules, depth, displacements.as_ref()).map_err(|error| match error {
        bake::BakeError::Depth { .. } => format!("TWELVEFOLD_DEPTH: {error}"),
        _ => format!("{RELAXED}: {error}"),
    })?;
    let folder = std::env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: run by cargo only")?;
    let folder = std::path::PathBuf::from(folder);
    // Lets tests/build_script.rs find and run this very script.
    println!("cargo::rustc-env=OUT_DIR_OF_BUILD={}", folder.display());
    let file = folder.join("tables.bin");
    std::fs::write(&file, bytes).map_err(|error| format!("{}: {error}", file.display()))
}

/// The relaxed offsets, unless the file is missing: then the tables hold fixed centers only.
fn read_displacements() -> Result<Option<bake::displacement::Displacements>, String> {
    match std::fs::read(RELAXED) {
        Ok(bytes) => bake::displacement::Displacements::from_bytes(&bytes)
            .map(Some)
            .map_err(|error| format!("{RELAXED}: {error}")),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("{RELAXED}: {error}")),
    }
}
