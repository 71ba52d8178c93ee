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

use serde_json::{Map, Value, json};
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
    let mut samples = Map::new();
    for picture in pictures {
        let name = Path::new(picture).file_name().ok_or("a picture without a name")?;
        let bytes = fs::read(picture)?;
        samples.insert(name.to_string_lossy().into_owned(), z85(&bytes).into());
    }
    let packed = json!({
        "worker": format!("{glue}\n{}", fs::read_to_string(worker)?),
        "engine": z85(&compressed),
        "samples": Value::Object(samples),
    });
    Ok(format!("\"use strict\";\nconst PACKED = {packed};\n"))
}

/// Bytes as text, five characters for four bytes, where base64 takes five and a third; none of them is escaped in a
/// script. The alphabet is that of ZeroMQ's RFC 32. The number of bytes goes before.
fn z85(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 85] =
        b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";
    let mut text = format!("{} ", bytes.len());
    for group in bytes.chunks(4) {
        let mut word = [0; 4];
        word[..group.len()].copy_from_slice(group);
        let mut rest = u32::from_be_bytes(word);
        let mut digits = [0; 5];
        for digit in digits.iter_mut().rev() {
            *digit = ALPHABET[(rest % 85) as usize];
            rest /= 85;
        }
        text.extend(digits.map(char::from));
    }
    text
}
