//! Pixels that are not square, made square: the longer side of each is divided.

use super::plane::Decoded;
use super::{PictureError, Pixel, limits};

/// The most that a pixel's sides may differ and count as equal: printers' and scanners' rounding.
const TOLERANCE: f64 = 0.01;

/// The picture with square pixels, each the mean of what it covers.
///
/// # Errors
/// [`PictureError::TooLarge`].
pub(super) fn squared<P: Pixel>(picture: Decoded<P>) -> Result<Decoded<P>, PictureError> {
    let Decoded { width, height, pixels, aspect, range, mut warnings } = picture;
    if (aspect - 1.0).abs() <= TOLERANCE {
        return Ok(Decoded { width, height, pixels, aspect: 1.0, range, warnings });
    }
    let stretched = |length: usize, factor: f64| ((length as f64 * factor).round() as usize).max(1);
    let (across, down) = if aspect > 1.0 {
        (stretched(width, aspect), height)
    } else {
        (width, stretched(height, 1.0 / aspect))
    };
    let bytes = 2 * size_of::<P>() - size_of::<f32>();
    let count = limits::check(across, down, bytes)?;
    let mut square = Vec::new();
    square.try_reserve_exact(count).map_err(|_| limits::too_large(across, down, bytes))?;
    for y in 0..down {
        for x in 0..across {
            let (line, place, length, new) = if aspect > 1.0 {
                (&pixels[y * width..][..width], x, width, across)
            } else {
                (&pixels[x..], y, height, down)
            };
            let stride = if aspect > 1.0 { 1 } else { width };
            // The new pixel reaches from place/new to (place + 1)/new of the line; in units of
            // 1/(length · new) all borders are integers.
            let (start, end) = (place * length, (place + 1) * length);
            let mut mean = P::NOTHING;
            for old in start / new..end.div_ceil(new) {
                let covered = end.min((old + 1) * new) - start.max(old * new);
                mean = mean.plus(line[old * stride], covered as f32 / length as f32);
            }
            square.push(mean);
        }
    }
    warnings.push(format!(
        "its pixels are {aspect:.3} times as wide as high; it is drawn as {across} x {down} square ones"
    ));
    Ok(Decoded { width: across, height: down, pixels: square, aspect: 1.0, range, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, aspect: f64) -> Decoded<f32> {
        let pixels = (0..width * height).map(|i| (i * 7 % 5) as f32).collect();
        Decoded { width, height, pixels, aspect, range: None, warnings: Vec::new() }
    }

    #[test]
    fn the_mean_is_kept_and_the_shape_mended() {
        for (aspect, size) in [(2.0, (12, 4)), (0.5, (6, 8)), (1.5, (9, 4)), (0.4, (6, 10))] {
            let stored = picture(6, 4, aspect);
            let mean = |p: &Decoded<f32>| p.pixels.iter().sum::<f32>() / p.pixels.len() as f32;
            let before = mean(&stored);
            let square = squared(stored).unwrap();
            assert_eq!((square.width, square.height), size);
            assert!((mean(&square) - before).abs() < 1e-5);
            assert_eq!(square.warnings.len(), 1);
        }
        assert!(squared(picture(6, 4, 1.005)).unwrap().warnings.is_empty());
    }
}
