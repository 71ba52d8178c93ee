//! The subcommands, a module each.

pub(crate) mod envmap;
pub(crate) mod frames;
pub(crate) mod measure;
pub(crate) mod merge;
pub(crate) mod part;
pub(crate) mod stipple;
pub(crate) mod survey;
pub(crate) mod tables;
pub(crate) mod tiling;
