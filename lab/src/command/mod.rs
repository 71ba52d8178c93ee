//! The subcommands, a module each.

pub(crate) mod figures;
pub(crate) mod report;
pub(crate) mod train;
