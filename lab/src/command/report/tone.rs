//! Tone: a stippling after the blur of a viewer's eye, against the picture after the same blur.

use glam::DVec2;
use twelvefold::{ImageMap, InvalidPixels, Pixels};

/// The viewer's blur in mean dot spacings: dots that are a line pair apart just merge.
const BLUR: f64 = 1.5;

/// A picture with all that is hard in a photograph: soft and steep shades, edges, texture, black and
/// white.
pub(crate) fn drawing() -> ImageMap {
    let side = 256usize;
    let pixels = (0..side * side)
        .map(|i| {
            let p = DVec2::new((i % side) as f64, (i / side) as f64) / side as f64;
            let ball = 1.0 - (p - DVec2::new(0.35, 0.4)).length() / 0.28;
            let texture = 0.5 + 0.5 * (90.0 * p.x + 25.0 * (7.0 * p.y).sin()).sin();
            let shade = if ball > 0.0 {
                (1.0 - ball).powi(2)
            } else if p.y > 0.75 {
                0.3 + 0.5 * texture
            } else {
                0.15 * p.y + 0.05
            };
            if (p - DVec2::new(0.8, 0.25)).length() < 0.1 { 1.0 } else { shade as f32 }
        })
        .collect();
    Pixels::new(side, side, pixels, InvalidPixels::Reject)
        .and_then(ImageMap::new)
        .unwrap_or_else(|_| unreachable!("shades lie in 0..=1"))
}

/// Root-mean-square difference between dots and picture, both blurred, relative to the mean tone; the
/// picture as if it held exactly `n` dots.
pub(crate) fn error(picture: &ImageMap, dots: &[DVec2], n: usize) -> f64 {
    let (width, height) = picture.size();
    let scale = n as f64 / (picture.mean() * (width * height) as f64);
    // Dots minus what is expected, so that one blur does for both; a dot is spread over four pixels.
    let mut difference: Vec<f64> =
        picture.pixels().iter().map(|pixel| -scale * f64::from(*pixel)).collect();
    for dot in dots {
        let at = *dot - 0.5;
        let corner = at.floor();
        let part = at - corner;
        for (dy, wy) in [(0.0, 1.0 - part.y), (1.0, part.y)] {
            for (dx, wx) in [(0.0, 1.0 - part.x), (1.0, part.x)] {
                // Casting takes what lies before the border to 0.
                let x = ((corner.x + dx) as usize).min(width - 1);
                let y = ((corner.y + dy) as usize).min(height - 1);
                difference[y * width + x] += wx * wy;
            }
        }
    }
    let spacing = ((width * height) as f64 / n as f64).sqrt();
    let blurred = blur(&difference, width, BLUR * spacing);
    let mean = n as f64 / (width * height) as f64;
    let square = blurred.iter().map(|value| value * value).sum::<f64>() / blurred.len() as f64;
    square.sqrt() / mean
}

/// Gaussian blur, rows and then columns, mirrored at the border.
fn blur(values: &[f64], width: usize, sigma: f64) -> Vec<f64> {
    let height = values.len() / width;
    let reach = (3.0 * sigma).ceil() as usize;
    let kernel: Vec<f64> = (0..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
    let total = 2.0 * kernel.iter().sum::<f64>() - kernel[0];
    let mirrored = |at: i64, count: usize| {
        let period = 2 * count as i64;
        let at = at.rem_euclid(period);
        (if at < count as i64 { at } else { period - 1 - at }) as usize
    };
    let along = |count: usize, at: usize, value: &dyn Fn(usize) -> f64| {
        let offsets = -(reach as i64)..=reach as i64;
        let sum: f64 = offsets
            .map(|o| kernel[o.unsigned_abs() as usize] * value(mirrored(at as i64 + o, count)))
            .sum();
        sum / total
    };
    let mut rows = vec![0.0; values.len()];
    for (i, target) in rows.iter_mut().enumerate() {
        let (x, y) = (i % width, i / width);
        *target = along(width, x, &|x| values[y * width + x]);
    }
    let mut both = vec![0.0; values.len()];
    for (i, target) in both.iter_mut().enumerate() {
        let (x, y) = (i % width, i / width);
        *target = along(height, y, &|y| rows[y * width + x]);
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blur_keeps_the_sum_and_levels() {
        let mut values = vec![0.0; 40 * 30];
        values[3 * 40 + 2] = 5.0;
        let blurred = blur(&values, 40, 2.5);
        assert!((blurred.iter().sum::<f64>() - 5.0).abs() < 1e-9);
        assert!(blurred.iter().all(|v| *v < 1.0));
    }

    #[test]
    fn even_dots_err_less_than_none_or_clumps() {
        let flat = Pixels::new(64, 64, vec![1.0; 4096], InvalidPixels::Reject)
            .and_then(ImageMap::new)
            .unwrap();
        let even: Vec<DVec2> = (0..256)
            .map(|i| 4.0 * DVec2::new(f64::from(i % 16), f64::from(i / 16)) + 2.0)
            .collect();
        let clumped = vec![DVec2::new(20.0, 20.0); 256];
        let [even, clumped, none] = [even, clumped, vec![]].map(|dots| error(&flat, &dots, 256));
        assert!(
            even < 0.01 && (none - 1.0).abs() < 1e-9 && clumped > 1.0,
            "{even} {clumped} {none}"
        );
    }
}
