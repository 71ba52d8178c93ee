//! `twelvefold-web-bindgen IN.wasm DIR`: splits what rustc made into `DIR/engine_bg.wasm` and `DIR/engine.js`, a
//! classic script, which a worker can load from anywhere.
//!
//! wasm-bindgen has a program for this; but it is installed apart, and must have the very version of the
//! library. Here the lock file sees to that.

use std::env;
use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, folder] = &arguments[..] else {
        eprintln!("usage: twelvefold-web-bindgen IN.wasm DIR");
        return ExitCode::FAILURE;
    };
    match generate(input, folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{input}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn generate(input: &str, folder: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(input).out_name("engine").no_modules(true)?.typescript(false);
    bindgen.generate(folder)?;
    Ok(())
}
