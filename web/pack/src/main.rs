//! `twelvefold-web-pack IN.wasm WORKER.js OUT.js [PICTURE …]` packs all that the page would otherwise fetch into one
//! classic script: a page that is opened from a folder may load scripts, but neither WebAssembly nor modules, workers
//! or the pixels of pictures.
//!
//! wasm-bindgen's JavaScript is written by its library here, which the lock file keeps at the version of the
//! page's own; its program is installed apart, and would have to be the same by chance.

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use serde_json::json;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [wasm, worker, output, pictures @ ..] = &arguments[..] else {
        eprintln!("usage: twelvefold-web-pack IN.wasm WORKER.js OUT.js [PICTURE ...]");
        return ExitCode::FAILURE;
    };
    match pack(wasm, worker, pictures).and_then(|script| Ok(fs::write(output, script)?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{output}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The script: a constant with the worker's source, the compressed engine, and the pictures by name.
fn pack(wasm: &str, worker: &str, pictures: &[String]) -> Result<String, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let mut bindgen = Bindgen::new();
    bindgen.input_path(wasm).out_name("engine").no_modules(true)?.typescript(false);
    bindgen.remove_name_section(true).remove_producers_section(true);
    bindgen.generate(folder.path())?;
    let glue = fs::read_to_string(folder.path().join("engine.js"))?;
    let engine = fs::read(folder.path().join("engine_bg.wasm"))?;

    let mut compressed = Vec::new();
    zopfli::compress(
        zopfli::Options::default(),
        zopfli::Format::Gzip,
        &engine[..],
        &mut compressed,
    )?;
    let worker = format!("{glue}\n{}", fs::read_to_string(worker)?);
    let mut script = format!("\"use strict\";\nconst PACKED = {{\n  worker: {},\n", json!(worker));
    script += &format!("  engine: \"{}\",\n  samples: {{\n", characters(&compressed));
    for picture in pictures {
        let name = Path::new(picture).file_name().ok_or("a picture without a name")?;
        let pixels = characters(&fs::read(picture)?);
        script += &format!("    {}: \"{pixels}\",\n", json!(name.to_string_lossy()));
    }
    script += "  },\n};\n";
    Ok(script)
}

/// Bytes as the text of a string of JavaScript, in UTF-8 a seventh longer than they are, where base64 is a third
/// longer. First comes their number and a space. Then seven bits are a character, which in UTF-8 is one byte; but
/// where that is none that may stand in a string, these seven bits and the next are one of two bytes.
fn characters(bytes: &[u8]) -> String {
    /// Zero, the ends of lines, what ends the string, and what gives the next character another meaning.
    const ELSEWHERE: [u8; 5] = [0, b'\n', b'\r', b'"', b'\\'];
    let mut sevens = (0..(8 * bytes.len()).div_ceil(7)).map(|i| {
        let (byte, bit) = (7 * i / 8, 7 * i % 8);
        let word = u16::from_be_bytes([bytes[byte], bytes.get(byte + 1).copied().unwrap_or(0)]);
        (word >> (9 - bit)) as u8 & 127
    });
    let mut text = format!("{} ", bytes.len());
    while let Some(seven) = sevens.next() {
        text.push(match ELSEWHERE.iter().position(|&elsewhere| elsewhere == seven) {
            None => char::from(seven),
            Some(place) => {
                let next = sevens.next().unwrap_or(0);
                char::from_u32(128 * (place as u32 + 1) + u32::from(next)).expect("below 768")
            }
        });
    }
    text
}
