//! Weighted Voronoi stippling (Secord 2002): Lloyd's method with darkness as the weight.

use glam::DVec2;

use super::Darkness;
use super::sampled::cells;
use crate::random::Random;

/// `count` dots after `rounds` rounds from random ones whose density is the darkness.
#[must_use]
pub fn weighted_voronoi(
    darkness: &Darkness<'_>,
    count: usize,
    rounds: usize,
    seed: u64,
) -> Vec<DVec2> {
    let mut dots = random_dots(darkness, count, seed);
    for _ in 0..rounds {
        let found = cells(darkness, &dots);
        for (dot, cell) in dots.iter_mut().zip(&found) {
            *dot = cell.centroid().unwrap_or(*dot);
        }
    }
    dots
}

/// Independent dots whose density is the darkness.
pub(super) fn random_dots(darkness: &Darkness<'_>, count: usize, seed: u64) -> Vec<DVec2> {
    let mut random = Random::new(seed, &[]);
    let mut sums = Vec::with_capacity(darkness.values.len());
    let mut sum = 0.0;
    for value in darkness.values {
        sum += f64::from(*value);
        sums.push(sum);
    }
    (0..count)
        .map(|_| {
            let wanted = random.unit() * sum;
            let pixel = sums.partition_point(|s| *s <= wanted).min(sums.len() - 1);
            let corner =
                DVec2::new((pixel % darkness.width) as f64, (pixel / darkness.width) as f64);
            corner + DVec2::new(random.unit(), random.unit())
        })
        .collect()
}
