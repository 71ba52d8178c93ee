//! Pictures with more pixels than somebody can use.

use super::Picture;

impl Picture {
    /// The picture with squares of pixels averaged, the smallest that leave at most `most`; at the right and at the
    /// bottom what is left of a square. As it is if it has no more.
    #[must_use]
    pub fn reduced(self, most: usize) -> Self {
        let Self { width, height, importance, range, warnings } = self;
        let (mut side, mut across, mut down) = (1, width, height);
        while across * down > most.max(1) {
            side += 1;
            (across, down) = (width.div_ceil(side), height.div_ceil(side));
        }
        if side == 1 {
            return Self { width, height, importance, range, warnings };
        }
        let mut means = Vec::with_capacity(across * down);
        for rows in importance.chunks(width * side) {
            for x in (0..width).step_by(side) {
                let end = (x + side).min(width);
                let (mut sum, mut pixels) = (0.0, 0.0);
                for row in rows.chunks(width) {
                    sum += row[x..end].iter().copied().map(f64::from).sum::<f64>();
                    pixels += (end - x) as f64;
                }
                means.push((sum / pixels) as f32);
            }
        }
        Self { width: across, height: down, importance: means, range, warnings }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn picture(width: usize, height: usize, pixel: impl Fn(usize, usize) -> f32) -> Picture {
        let importance = (0..width * height).map(|i| pixel(i % width, i / width)).collect();
        Picture { width, height, importance, range: None, warnings: Vec::new() }
    }

    #[test]
    fn squares_are_averaged_and_what_is_left_of_them() {
        let small = picture(5, 3, |x, y| (x + 10 * y) as f32).reduced(6);
        assert_eq!((small.width, small.height), (3, 2));
        assert_eq!(small.importance, [5.5, 7.5, 9.0, 20.5, 22.5, 24.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn no_more_pixels_are_left_than_asked_and_tones_stay(
            width in 1usize..60, height in 1usize..60, most in 0usize..400,
        ) {
            let whole = picture(width, height, |x, _| if 2 * x < width { 0.25 } else { 0.75 });
            let small = picture(width, height, |x, _| if 2 * x < width { 0.25 } else { 0.75 }).reduced(most);
            prop_assert!(small.importance.len() <= most.max(1));
            prop_assert_eq!(small.importance.len(), small.width * small.height);
            prop_assert!(small.importance.iter().all(|pixel| (0.25..=0.75).contains(pixel)));
            if whole.importance.len() <= most {
                prop_assert_eq!(small.importance, whole.importance);
            }
        }
    }
}
