//! What is wanted of the dots.

use twelvefold::Tables;
use twelvefold::refine::ITERATIONS;

/// From this many dots on, they are drawn as they come, unless refinement is asked for: a list of them all,
/// and what refining needs beside it, would take a hundred bytes a dot.
pub const STREAMED: f64 = 2_000_000.0;

/// What is wanted of the dots.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    pub count: Count,
    pub centers: Centers,
    pub seed: u64,
    /// Iterations.
    pub refine: usize,
    /// Polished after them.
    pub best: bool,
    /// In an order of which each beginning is itself a good set.
    pub ranked: bool,
    /// What the dots are read from.
    pub tables: Tables<'static>,
}

impl Wish {
    /// How the dots were made, in plain text.
    pub fn description(&self) -> String {
        let dots = match self.count {
            Count::About(count) => format!("about {count}"),
            Count::Exactly(count) => count.to_string(),
        };
        let (version, seed) = (env!("CARGO_PKG_VERSION"), self.seed);
        format!("Stippled with {dots} dots by twelvefold {version}, seed {seed}")
    }
}

/// Where dots lie before they are refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Centers {
    /// Moved aside, evenly spread.
    Relaxed,
    /// At the centers of tiles.
    Fixed,
}

/// A number of dots.
#[derive(Clone, Copy, Debug)]
pub enum Count {
    About(f64),
    Exactly(usize),
}

impl Count {
    pub fn number(self) -> f64 {
        match self {
            Self::About(count) => count,
            Self::Exactly(count) => count as f64,
        }
    }
}

/// The iterations for so many dots, if nobody says; `best` dots are always refined.
pub fn default_iterations(count: f64, best: bool) -> usize {
    if count < STREAMED || best { ITERATIONS } else { 0 }
}
