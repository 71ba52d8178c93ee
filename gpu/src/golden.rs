//! Golden positions: the bits that the `f32` formula of [`twelvefold::export::position`] gives, as CPU and GPU
//! must agree on them.

/// A position and what it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Golden {
    /// Bits of the origin, x and y, in `f32`.
    pub origin: [u32; 2],
    /// Bits of half an edge, x and y.
    pub half_edge: [u32; 2],
    /// u, v, p, q.
    pub at: [i32; 4],
    /// Bits of the position.
    pub position: [u32; 2],
}

/// The vectors, a line each: ten numbers, bits in hexadecimal.
const TEXT: &str = include_str!("golden.txt");

/// All vectors: placements' own numbers of every level, and integers up to 2³⁰, which `f32` rounds.
#[must_use]
pub fn golden() -> Vec<Golden> {
    TEXT.lines().filter_map(line).collect()
}

fn line(text: &str) -> Option<Golden> {
    let mut words = text.split_ascii_whitespace();
    let mut bits = || u32::from_str_radix(words.next()?, 16).ok();
    let (origin, half_edge) = ([bits()?, bits()?], [bits()?, bits()?]);
    let position = [bits()?, bits()?];
    let mut whole = || words.next()?.parse().ok();
    Some(Golden { origin, half_edge, at: [whole()?, whole()?, whole()?, whole()?], position })
}
