//! The walk down the hierarchy of tiles: from the few that touch the domain to blocks of points.

pub(crate) mod batch;
pub(crate) mod chunk;
pub(crate) mod either;
pub(crate) mod expand;
pub(crate) mod fill;
pub(crate) mod frame;
pub(crate) mod ground;
pub(crate) mod kin;
pub(crate) mod node;
pub(crate) mod relaxed;
pub(crate) mod scalar;
pub(crate) mod share;
pub(crate) mod traverse;
pub(crate) mod vectors;
