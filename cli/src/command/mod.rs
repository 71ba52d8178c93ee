//! The subcommands, a module each.

pub(crate) mod envmap;
pub(crate) mod measure;
pub(crate) mod stipple;
pub(crate) mod tables;
pub(crate) mod tiling;
