//! The tables, made where they are used.

use std::sync::OnceLock;

use twelvefold::Tables;
use twelvefold::bake::{DEFAULT_DEPTH, bake};

/// Tables of the usual depth, baked once from those of this build: `web/build` asks for shallow ones, since deep
/// ones would be a quarter of what is downloaded, and take less time to bake than to receive. Points would be the same
/// from either, but not their order.
pub(crate) fn tables() -> Tables<'static> {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    static TABLES: OnceLock<Tables<'static>> = OnceLock::new();
    *TABLES.get_or_init(|| {
        let built_in = Tables::built_in();
        let baked = || bake(&built_in.rules(), DEFAULT_DEPTH, built_in.to_relaxation().as_ref());
        // What is baked here cannot fail to be read here; if it did, the points would be right.
        let bytes = BYTES.get_or_init(|| baked().unwrap_or_default());
        Tables::from_bytes(bytes).unwrap_or(built_in)
    })
}
