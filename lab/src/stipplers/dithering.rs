//! Error diffusion (Floyd and Steinberg 1976), back and forth, on a picture reduced or enlarged so that its
//! darkness adds up to the number of dots.

use glam::DVec2;

use super::Darkness;

/// About `count` dots at the centers of pixels of a grid of its own.
#[must_use]
pub fn floyd_steinberg(darkness: &Darkness<'_>, count: usize) -> Vec<DVec2> {
    let scale = (count as f64 / darkness.sum()).sqrt();
    let size = |pixels: usize| ((pixels as f64 * scale).round() as usize).max(1);
    let (width, height) = (size(darkness.width), size(darkness.height));
    let mut wanted = resized(darkness, width, height);
    let step = darkness.size() / DVec2::new(width as f64, height as f64);
    let mut dots = Vec::new();
    for y in 0..height {
        let forth = y % 2 == 0;
        for i in 0..width {
            let x = if forth { i } else { width - 1 - i };
            let value = wanted[y * width + x];
            let dot = value >= 0.5;
            if dot {
                dots.push(step * DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            }
            let error = value - f64::from(u8::from(dot));
            let mut pass = |ahead: i64, down: usize, share: f64| {
                let column = x as i64 + if forth { ahead } else { -ahead };
                if (0..width as i64).contains(&column) && y + down < height {
                    wanted[(y + down) * width + column as usize] += error * share / 16.0;
                }
            };
            for (ahead, down, share) in [(1, 0, 7.0), (-1, 1, 3.0), (0, 1, 5.0), (1, 1, 1.0)] {
                pass(ahead, down, share);
            }
        }
    }
    dots
}

/// Area means.
fn resized(darkness: &Darkness<'_>, width: usize, height: usize) -> Vec<f64> {
    // Row or column i of the new size, as parts of old ones.
    let parts = |i: usize, new: usize, old: usize| {
        let (from, to) =
            (i as f64 * old as f64 / new as f64, (i + 1) as f64 * old as f64 / new as f64);
        (from as usize..(to.ceil() as usize).min(old)).map(move |k| {
            let share = to.min((k + 1) as f64) - from.max(k as f64);
            (k, share * new as f64 / old as f64)
        })
    };
    let mut values = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let sum: f64 = parts(y, height, darkness.height)
                .flat_map(|(row, high)| {
                    parts(x, width, darkness.width).map(move |(column, wide)| {
                        high * wide * f64::from(darkness.values[row * darkness.width + column])
                    })
                })
                .sum();
            values.push(sum);
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stippler_keeps_the_tone_of_halves() {
        // Darker below.
        let values: Vec<f32> = (0..60 * 60).map(|i| if i < 1800 { 0.2 } else { 0.8 }).collect();
        let darkness = Darkness::new(60, &values).unwrap();
        for dots in [
            floyd_steinberg(&darkness, 500),
            super::super::weighted_voronoi(&darkness, 500, 10, 1),
            super::super::linked_voronoi(&darkness, 500, 1),
        ] {
            let below = dots.iter().filter(|dot| dot.y >= 30.0).count() as f64 / dots.len() as f64;
            assert!((below - 0.8).abs() < 0.05, "{below}");
            assert!((dots.len() as f64 / 500.0 - 1.0).abs() < 0.1, "{}", dots.len());
        }
    }
}
