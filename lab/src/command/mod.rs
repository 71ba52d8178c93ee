//! The subcommands, a module each.

pub(crate) mod evenness;
pub(crate) mod figures;
pub(crate) mod report;
pub(crate) mod speed;
pub(crate) mod train;
