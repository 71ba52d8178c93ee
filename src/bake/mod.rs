//! From rules to baked bytes.

pub mod class;
pub mod relaxation;
