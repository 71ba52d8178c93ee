//! The library from outside: one program, since each is linked by itself.

mod common;
mod digits;
mod estimates;
mod exact_counts;
mod floors;
mod frame;
mod hard_domains;
mod hard_importance;
mod invariance;
mod laws;
mod meshes;
mod numbering;
mod seamless;
#[cfg(feature = "serde")]
mod stored;
mod tables;
mod tiling;
mod value_stability;
