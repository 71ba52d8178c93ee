//! An extension's link arguments, so that `cargo build` links it where an extension may not name the
//! interpreter's symbols otherwise (macOS).

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
