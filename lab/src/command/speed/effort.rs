//! What the walk does for a point, counted: the same on every machine.

use std::fmt::Write as _;

use twelvefold::{Amount, Placement, Sampling};

use twelvefold_lab::maps;

const COUNTS: [usize; 5] = [1 << 6, 1 << 10, 1 << 14, 1 << 17, 1 << 20];

/// Markdown.
pub(crate) fn table() -> String {
    let mut text = String::from(
        "### What the walk does\n\nFor a point: tiles visited / candidates read / candidates whose \
         importance was looked up.\n\n| |",
    );
    for n in COUNTS {
        let _ = if n < 1024 { write!(text, " {n} |") } else { write!(text, " {}k |", n >> 10) };
    }
    text += "\n|---|";
    text += &"---:|".repeat(COUNTS.len());
    for map in &maps::all() {
        let placement = Placement::new(map.importance.domain(), 1);
        let _ = write!(text, "\n| {} map |", map.name);
        for n in COUNTS {
            let amount = Amount::Points(n as f64);
            let effort = Sampling::new(&placement, &map.importance, amount)
                .and_then(|sampling| sampling.effort())
                .expect("a valid sampling");
            let [tiles, candidates, tested] = [effort.tiles, effort.candidates, effort.tested]
                .map(|count| count as f64 / effort.points as f64);
            let _ = write!(text, " {tiles:.3} / {candidates:.2} / {tested:.2} |");
        }
    }
    text + "\n\n"
}
