//! The subcommands, a module each.

pub(crate) mod classes;
pub(crate) mod evenness;
pub(crate) mod figures;
pub(crate) mod report;
pub(crate) mod speed;
pub(crate) mod stipplers;
pub(crate) mod train;
