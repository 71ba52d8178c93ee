//! Paper as the command line has it, and how far apart the dots of a pen must be.

pub(crate) mod apart;
pub(crate) mod options;
