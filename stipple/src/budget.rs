//! How many dots a picture gets, and how large they are.

/// Black area, in squared pixels, that gets one dot when no number is asked for: a dot every 3 pixels.
const AREA_PER_DOT: f64 = 9.0;

/// The most dots that nobody asked for: more is no better on paper, and too much for a plotter.
const MOST: f64 = 30_000.0;

/// Even a small picture gets this many, but not more than [`DENSEST`] a pixel of black.
const LEAST: f64 = 3_000.0;
const DENSEST: f64 = 4.0;

/// The number of dots for a picture whose importance adds up to `black` pixels of black.
pub fn default_count(black: f64) -> f64 {
    let least = LEAST.min(DENSEST * black);
    (black / AREA_PER_DOT).max(least).min(MOST).round().max(1.0)
}

/// The diameter at which `density` dots in a squared pixel have an area of one squared pixel.
pub fn default_dot_size(density: f64) -> f64 {
    if density > 0.0 { (4.0 / (std::f64::consts::PI * density)).sqrt() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_count_follows_the_darkness_between_its_bounds() {
        // A photograph of 512 × 512, a phone's of 4,000 × 4,000, an icon, a single pixel.
        assert_eq!(default_count(129_240.0), 14_360.0);
        assert_eq!(default_count(7_900_000.0), 30_000.0);
        assert_eq!(default_count(2_000.0), 3_000.0);
        assert_eq!(default_count(1.0), 4.0);
        assert_eq!(default_count(1e-6), 1.0);
    }

    #[test]
    fn dots_of_the_default_size_cover_black_once() {
        let density = 1.0 / AREA_PER_DOT;
        let diameter = default_dot_size(density);
        let area = std::f64::consts::PI * diameter * diameter / 4.0;
        assert!((area * density - 1.0).abs() < 1e-12);
    }
}
