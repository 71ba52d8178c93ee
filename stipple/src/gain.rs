//! Dot gain: what even discs cover, and how many of them make a tone.
//!
//! Discs whose areas add up to a share u of a place cover less of it once they overlap, from u = 0.7 on.
//! So a picture that is to be ink of darkness d asks for the share whose discs cover d.

/// Shares of an area, by steps of 0.05 from 0.7 on, and what they cover: the union of 8,000 refined dots of
/// one density, sampled 16 times a pixel's side. Below the first, discs lie apart.
const FIRST_SHARE: f32 = 0.7;
const SHARE_STEP: f32 = 0.05;
const COVERED: [f32; 9] = [0.7, 0.7482, 0.7949, 0.8382, 0.8767, 0.9095, 0.9363, 0.9573, 0.9729];

/// The share where the picture is black. More would only cover the last pinholes, at the price of clumps.
const LARGEST: f32 = FIRST_SHARE + SHARE_STEP * (COVERED.len() - 1) as f32;

/// The share of the area whose discs cover the part `darkness`, 0 to 1, of it.
fn share(darkness: f32) -> f32 {
    let above = COVERED.iter().position(|covered| darkness < *covered);
    match above {
        Some(0) => darkness,
        Some(i) => {
            let (low, high) = (COVERED[i - 1], COVERED[i]);
            let part = (darkness - low) / (high - low);
            FIRST_SHARE + SHARE_STEP * ((i - 1) as f32 + part)
        }
        None => LARGEST,
    }
}

/// Turns darkness, 0 to 1, into the share of each pixel's area that dots should have.
pub fn correct(pixels: &mut [f32]) {
    for pixel in pixels {
        *pixel = share(*pixel);
    }
}

/// Turns darkness, 0 to 1, into its square: a line through dots is as long as the root of their number, so
/// that squares give it the picture's tone.
pub fn square(pixels: &mut [f32]) {
    for pixel in pixels {
        *pixel *= *pixel;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_rises_with_darkness_and_is_darkness_where_discs_lie_apart() {
        let mut before = -1.0;
        for i in 0..=1000 {
            let darkness = i as f32 / 1000.0;
            let found = share(darkness);
            assert!(found > before || found == LARGEST);
            assert!(found >= darkness && found <= LARGEST);
            before = found;
        }
        assert_eq!(share(0.5), 0.5);
        assert_eq!(share(1.0), LARGEST);
        assert!((share(0.9363) - 1.0).abs() < 1e-4);
    }
}
