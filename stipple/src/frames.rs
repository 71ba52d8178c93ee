//! Dots of moving pictures: where a frame is as the one before, so are its dots.
//!
//! Dots of single pictures follow two numbers of the whole, the mean darkness and the number of dots: they set how
//! many dots a darkness gets, and how far around itself a dot looks. For frames both are those of one frame, so that
//! a dot depends on nothing but the pixels within some 30 mean spacings, or 100 pixels, of it (see [`Cell::rows`]).
//!
//! [`Cell::rows`]: twelvefold::Cell::rows

use twelvefold::{MapError, Mosaic, Pixels};
use twelvefold_files::picture::Picture;

use crate::dots::refined;
use crate::error::DotsError;
use crate::raw::{self, Step};
use crate::wish::Wish;

/// What all frames have in common.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    mosaic: Mosaic,
    wish: Wish,
}

impl Frames {
    /// Frames of the size of this one, which gets the number of dots that are wished. They are relaxed, in no order,
    /// and about as many as are wished.
    ///
    /// # Errors
    /// [`MapError`] for a frame without pixels.
    pub fn new(frame: &Picture, wish: Wish) -> Result<Self, MapError> {
        let width = frame.width;
        let sums: Vec<f64> =
            frame.importance.chunks(width.max(1)).map(Pixels::sum_of_row).collect();
        let mean = Pixels::mean_of_rows(width, &sums);
        let mosaic = Mosaic::new((width, frame.height), mean, wish.count.number())?;
        Ok(Self { mosaic, wish })
    }

    /// Hands the dots of a frame, in pixels, to `take`, and cuts between the [cells](Mosaic) of a large one. Keeps no
    /// list if they are not refined.
    ///
    /// # Errors
    /// [`DotsError`], and what `take` fails with.
    pub fn place<E>(
        &self,
        frame: &Picture,
        mut take: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), DotsError<E>> {
        if self.wish.refine == 0 {
            return self.raw(frame, take);
        }
        let mut dots = Vec::new();
        self.raw(frame, |step| {
            let Step::Dot(dot) = step else { return Ok(()) };
            dots.try_reserve(1).map_err(|_| dots.len() + 1)?;
            dots.push(dot);
            Ok(())
        })
        .map_err(|error| error.map_taker(DotsError::Memory))?;
        refined(frame, &mut dots, self.wish, || {}).map_err(DotsError::Refine)?;
        dots.into_iter().try_for_each(|dot| take(Step::Dot(dot)).map_err(DotsError::Taker))
    }

    /// The dots as the sampling gives them.
    fn raw<E>(
        &self,
        frame: &Picture,
        mut take: impl FnMut(Step) -> Result<(), E>,
    ) -> Result<(), DotsError<E>> {
        let several = self.mosaic.cells().len() > 1;
        let read = |columns, rows| raw::window(&frame.importance, frame.width, columns, rows);
        raw::cells(self.mosaic.cells(), self.wish, read, |step, _| match step {
            // As a single picture is drawn.
            Step::Cut if !several => Ok(()),
            step => take(step),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use proptest::prelude::*;
    use twelvefold::Tables;

    use super::*;
    use crate::dots;
    use crate::wish::{Centers, Count};

    fn wish(count: f64, seed: u64) -> Wish {
        Wish {
            count: Count::About(count),
            centers: Centers::Relaxed,
            seed,
            refine: 0,
            best: false,
            ranked: false,
            tables: Tables::built_in(),
        }
    }

    fn picture(size: usize, pixel: impl Fn(usize, usize) -> f32) -> Picture {
        let importance = (0..size * size).map(|i| pixel(i % size, i / size)).collect();
        Picture { width: size, height: size, importance, range: None, warnings: Vec::new() }
    }

    fn placed(frames: &Frames, frame: &Picture) -> Vec<[u64; 2]> {
        let mut dots = Vec::new();
        let taken = frames.place(frame, |step| {
            dots.push(match step {
                Step::Dot(dot) => dot.to_array().map(f64::to_bits),
                Step::Cut => [u64::MAX; 2],
            });
            Ok::<(), Infallible>(())
        });
        taken.unwrap();
        dots
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6))]

        /// Whatever happens on one side of a picture, the other side's dots are the same to the bit.
        #[test]
        fn dots_far_from_what_changes_stay(
            seed: u64, count in 8_000f64..20_000.0, before in 0.0f32..1.0, after in 0.0f32..1.0,
        ) {
            let size = 300;
            let texture = |x: usize, y: usize| (x * 7 % 13 + y * 5 % 11) as f32 / 40.0 + 0.2;
            let of = |moving: f32| picture(size, |x, y| if x < 40 { moving } else { texture(x, y) });
            let (first, second) = (of(before), of(after));
            let frames = Frames::new(&first, wish(count, seed)).unwrap();
            let [found, expected] = [second, first].map(|frame| placed(&frames, &frame));
            let margin = (30.0 * (size as f64) / count.sqrt()).max(100.0);
            let far = |dots: &[[u64; 2]]| {
                let mut far: Vec<_> =
                    dots.iter().filter(|dot| f64::from_bits(dot[0]) > 40.0 + margin).copied().collect();
                far.sort_unstable();
                far
            };
            let far = [far(&found), far(&expected)];
            prop_assert!(far[0].len() > 1000, "{}", far[0].len());
            prop_assert_eq!(&far[0], &far[1]);
        }
    }

    #[test]
    fn a_large_frame_is_cut_as_a_large_picture_is() {
        // More than one cell's dots.
        let large = || picture(300, |x, y| ((x / 50 + y / 70) % 4) as f32 / 3.0);
        let frames = Frames::new(&large(), wish(1.1e6, 3)).unwrap();
        let found = placed(&frames, &large());
        let mut expected = Vec::new();
        let taken = dots::place(
            large(),
            wish(1.1e6, 3),
            || {},
            |step| {
                expected.push(match step {
                    Step::Dot(dot) => dot.to_array().map(f64::to_bits),
                    Step::Cut => [u64::MAX; 2],
                });
                Ok::<(), Infallible>(())
            },
        );
        taken.unwrap();
        assert!(found == expected && found.contains(&[u64::MAX; 2]));
    }

    #[test]
    fn the_first_frame_is_the_picture_and_others_have_as_many_dots_as_they_are_dark() {
        let half = picture(200, |x, y| 0.3 + 0.2 * ((x + y) % 3) as f32);
        let frames = Frames::new(&half, wish(5000.0, 3)).unwrap();
        let found = placed(&frames, &half);
        let alone = dots::unrefined::<Infallible>(
            picture(200, |x, y| half.importance[y * 200 + x]),
            wish(5000.0, 3),
        );
        let alone: Vec<_> =
            alone.unwrap().into_iter().map(|dot| dot.to_array().map(f64::to_bits)).collect();
        assert_eq!(found, alone);
        let quarter = picture(200, |x, y| if x < 100 { half.importance[y * 200 + x] } else { 0.0 });
        let (all, left) = (found.len() as f64, placed(&frames, &quarter).len() as f64);
        assert!((left / all - 0.5).abs() < 0.02, "{left} of {all}");
        assert!(placed(&frames, &picture(200, |_, _| 0.0)).is_empty());
        let refined = Frames { wish: Wish { refine: 2, ..frames.wish }, ..frames };
        let moved = placed(&refined, &half);
        assert!(moved.len() == found.len() && moved != found);
        assert!(placed(&refined, &picture(200, |_, _| 0.0)).is_empty());
    }
}
