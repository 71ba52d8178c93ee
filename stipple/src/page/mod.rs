//! Paper: lengths and pages as the command line has them, where on a sheet the photograph lies, and what one dot
//! is drawn with.

pub mod color;
pub mod length;
pub mod mark;
pub mod sheet;
