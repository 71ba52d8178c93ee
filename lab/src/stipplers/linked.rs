//! Weighted linked Voronoi stippling (Deussen, Spicker, Zheng 2017), with dots of one size: cells that are
//! too dark are split, those too light vanish, between which they move to their centroids.

use glam::DVec2;

use super::Darkness;
use super::sampled::cells;
use super::voronoi::random_dots;
use crate::random::Random;

/// Rounds after which it ends in any case.
const ROUNDS: usize = 100;

/// Half the width of the band of masses that is left alone: at the first round, and more for each.
const BAND: [f64; 2] = [0.3, 0.005];

/// About `count` dots (some percent more: the band is not symmetric about 1).
#[must_use]
pub fn linked_voronoi(darkness: &Darkness<'_>, count: usize, seed: u64) -> Vec<DVec2> {
    let mass = darkness.sum() / count as f64;
    let mut dots = random_dots(darkness, (count / 4).max(1), seed);
    let mut random = Random::new(seed, &[1]);
    for round in 0..ROUNDS {
        let band = BAND[0] + BAND[1] * round as f64;
        let mut next = Vec::with_capacity(2 * dots.len());
        let mut changes = 0;
        for cell in cells(darkness, &dots) {
            let Some(center) = cell.centroid() else {
                changes += 1;
                continue;
            };
            if cell.mass < (1.0 - band) * mass {
                changes += 1;
            } else if cell.mass <= (1.0 + band) * mass {
                next.push(center);
            } else {
                changes += 1;
                // A little jitter keeps equal splits from meeting in one place.
                let radius = (cell.mass / std::f64::consts::PI).sqrt();
                let jitter = 0.02 * radius * (random.unit() - 0.5);
                let half = (0.5 * radius + jitter) * cell.longest();
                let edge = darkness.size().map(f64::next_down);
                next.extend([center - half, center + half].map(|dot| dot.clamp(DVec2::ZERO, edge)));
            }
        }
        if next.is_empty() {
            break;
        }
        dots = next;
        if changes * 1000 < dots.len() {
            break;
        }
    }
    dots
}
