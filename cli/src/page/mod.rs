//! Paper: lengths and pages as the command line has them, where on a sheet the photograph lies, what one dot
//! is drawn with, and how far apart the dots of a pen must be.

pub(crate) mod apart;
pub(crate) mod color;
pub(crate) mod length;
pub(crate) mod marks;
pub(crate) mod options;
pub(crate) mod sheet;
