//! From a pixel's samples to how many dots it deserves: its importance, from 0 (none) to 1 (most).

use std::ops::Range;

use super::srgb;

/// Rec. 709 weights of red, green and blue in luma and in luminance.
const WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Which tone the dots follow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tone {
    /// Importance follows linear light (luminance), not encoded values (luma).
    pub linear: bool,
    /// Importance is the brightness, not its complement.
    pub invert: bool,
}

/// What a pixel's samples mean, in file order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colors {
    Gray,
    Rgb,
    /// Ink amounts, turned into red, green and blue without a colour profile.
    Cmyk,
    /// Rec. 601 full-range luma and colour differences, as in JPEG.
    YCbCr,
}

impl Colors {
    pub(super) fn count(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::Rgb | Self::YCbCr => 3,
            Self::Cmyk => 4,
        }
    }
}

/// Whether a sample after the colours says how much of the pixel is covered, and how it was applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    None,
    /// Colours are those of the covered part.
    Straight,
    /// Colours are already multiplied by the coverage.
    Associated,
}

/// One sample of a file.
pub(super) trait Sample: Copy {
    /// Whether values are linear light and may lie outside 0 to 1; if not, they are sRGB-encoded.
    const FLOAT: bool;
    /// The value with full scale at 1; for floats, the value.
    fn fraction(self) -> f64;
    /// Index in a table with an entry for each possible value, where such a table is small.
    fn index(self) -> Option<usize>;
}

macro_rules! sample {
    ($type:ty, float: $float:literal, fraction: $fraction:expr, index: $index:expr) => {
        impl Sample for $type {
            const FLOAT: bool = $float;
            fn fraction(self) -> f64 {
                let fraction: fn($type) -> f64 = $fraction;
                fraction(self)
            }
            fn index(self) -> Option<usize> {
                let index: fn($type) -> Option<usize> = $index;
                index(self)
            }
        }
    };
}
sample!(u8, float: false, fraction: |s| f64::from(s) / 255.0, index: |s| Some(usize::from(s)));
sample!(u16, float: false, fraction: |s| f64::from(s) / 65535.0, index: |s| Some(usize::from(s)));
sample!(u32, float: false, fraction: |s| f64::from(s) / f64::from(u32::MAX), index: |_| None);
sample!(u64, float: false, fraction: |s| s as f64 / u64::MAX as f64, index: |_| None);
sample!(exr::prelude::f16, float: true, fraction: |s| s.to_f64(), index: |_| None);
sample!(f32, float: true, fraction: f64::from, index: |_| None);
sample!(f64, float: true, fraction: |s| s, index: |_| None);

/// Turns the pixels of one file into importance.
#[derive(Debug)]
pub(super) struct Toner {
    tone: Tone,
    colors: Colors,
    alpha: Alpha,
    /// Working values of the samples 0, 1, 2 … of an 8- or 16-bit file.
    levels: Vec<f64>,
}

impl Toner {
    /// A converter for samples of type `S`. The table for 16 bits takes half a mebibyte.
    pub(super) fn new<S: Sample>(tone: Tone, colors: Colors, alpha: Alpha) -> Self {
        let table: Range<u32> = match size_of::<S>() {
            _ if S::FLOAT => 0..0,
            1 => 0..1 << 8,
            2 => 0..1 << 16,
            _ => 0..0,
        };
        let top = f64::from(table.end.saturating_sub(1));
        let levels = table.map(|level| tone.working(f64::from(level) / top)).collect();
        Self { tone, colors, alpha, levels }
    }

    /// How many samples a pixel has that count: its colours and its alpha, if any.
    pub(super) fn samples(&self) -> usize {
        self.colors.count() + usize::from(self.alpha != Alpha::None)
    }

    /// Importance, in 0..=1, of a pixel given by its colours and then its alpha, if any; `None` when
    /// one of these is a NaN or an infinity. Samples after those are ignored.
    ///
    /// `pixel` holds at least as many samples as the colours and alpha take.
    pub(super) fn importance<S: Sample>(&self, pixel: &[S]) -> Option<f32> {
        let count = self.colors.count();
        let alpha = match self.alpha {
            Alpha::None => 1.0,
            _ => pixel[count].fraction(),
        };
        if S::FLOAT
            && !(alpha.is_finite() && pixel[..count].iter().all(|s| s.fraction().is_finite()))
        {
            return None;
        }
        let alpha = alpha.clamp(0.0, 1.0);
        let rgb = match self.colors {
            Colors::Gray => [self.light(pixel[0]); 3],
            Colors::Rgb => [self.light(pixel[0]), self.light(pixel[1]), self.light(pixel[2])],
            Colors::Cmyk => {
                let paper = 1.0 - pixel[3].fraction();
                [0, 1, 2].map(|i| self.tone.working((1.0 - pixel[i].fraction()) * paper))
            }
            Colors::YCbCr => {
                let [y, cb, cr] = [0, 1, 2].map(|i| pixel[i].fraction());
                // The zero of a colour difference is half of full scale rounded up.
                let (cb, cr) = (cb - 128.0 / 255.0, cr - 128.0 / 255.0);
                [y + 1.402 * cr, y - 0.344136 * cb - 0.714136 * cr, y + 1.772 * cb]
                    .map(|value| self.tone.working(value.clamp(0.0, 1.0)))
            }
        };
        let shown = |value: f64| {
            let over = match self.alpha {
                Alpha::None => value,
                Alpha::Straight => value * alpha + (1.0 - alpha),
                Alpha::Associated => value + (1.0 - alpha),
            };
            let over = over.min(1.0);
            if S::FLOAT && !self.tone.linear { srgb::encode(over) } else { over }
        };
        let brightness = match self.colors {
            Colors::Gray => shown(rgb[0]),
            _ => {
                let [red, green, blue] = rgb.map(shown);
                WEIGHTS[0] * red + WEIGHTS[1] * green + WEIGHTS[2] * blue
            }
        };
        // Rounded to f32 first, white is exactly 1 and deserves exactly no dots.
        let brightness = brightness as f32;
        let brightness = brightness.min(1.0);
        Some(if self.tone.invert { brightness } else { 1.0 - brightness })
    }

    /// A colour sample as linear light (floats), or in the space that `tone` asks for (integers).
    fn light<S: Sample>(&self, sample: S) -> f64 {
        if S::FLOAT {
            return sample.fraction().max(0.0);
        }
        match sample.index().and_then(|index| self.levels.get(index)) {
            Some(&level) => level,
            None => self.tone.working(sample.fraction()),
        }
    }
}

impl Tone {
    /// An encoded value in the space in which an integer file's colours are mixed.
    fn working(self, encoded: f64) -> f64 {
        if self.linear { srgb::decode(encoded) } else { encoded }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEFAULT: Tone = Tone { linear: false, invert: false };
    const LINEAR: Tone = Tone { linear: true, invert: false };

    fn importance<S: Sample>(tone: Tone, colors: Colors, alpha: Alpha, pixel: &[S]) -> f32 {
        Toner::new::<S>(tone, colors, alpha).importance(pixel).unwrap()
    }

    #[test]
    fn white_is_exactly_zero_and_black_exactly_one_at_every_depth() {
        fn check<S: Sample>(zero: S, full: S) {
            for tone in [DEFAULT, LINEAR] {
                let rgb = Toner::new::<S>(tone, Colors::Rgb, Alpha::None);
                assert_eq!(rgb.importance(&[full; 3]), Some(0.0));
                assert_eq!(rgb.importance(&[zero; 3]), Some(1.0));
                let gray = Toner::new::<S>(tone, Colors::Gray, Alpha::Straight);
                assert_eq!(gray.importance(&[full, full]), Some(0.0));
                assert_eq!(gray.importance(&[zero, full]), Some(1.0));
                assert_eq!(gray.importance(&[zero, zero]), Some(0.0), "transparent is white");
            }
        }
        check(0u8, u8::MAX);
        check(0u16, u16::MAX);
        check(0u32, u32::MAX);
        check(0u64, u64::MAX);
        check(exr::prelude::f16::ZERO, exr::prelude::f16::ONE);
        check(0f32, 1.0);
        check(0f64, 1.0);
    }

    #[test]
    fn the_default_follows_encoded_values_and_linear_follows_light() {
        let gray = |tone| importance(tone, Colors::Gray, Alpha::None, &[188u8]);
        assert_eq!(gray(DEFAULT), 1.0 - 188.0 / 255.0);
        // Encoded 188 is half the light of white (0.5029).
        assert!((gray(LINEAR) - 0.4971).abs() < 1e-3, "{}", gray(LINEAR));
        // The same light in a float file has the same importance as in an 8-bit one.
        let light = [srgb::decode(188.0 / 255.0) as f32];
        for tone in [DEFAULT, LINEAR] {
            let float = importance(tone, Colors::Gray, Alpha::None, &light);
            assert!((float - gray(tone)).abs() < 1e-5);
        }
    }

    #[test]
    fn colours_weigh_as_in_rec_709() {
        for (pixel, weight) in
            [([255u8, 0, 0], 0.2126), ([0, 255, 0], 0.7152), ([0, 0, 255], 0.0722)]
        {
            for tone in [DEFAULT, LINEAR] {
                let dark = importance(tone, Colors::Rgb, Alpha::None, &pixel);
                assert!((f64::from(dark) - (1.0 - weight)).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn half_transparent_black_is_half_gray_in_the_space_followed() {
        for tone in [DEFAULT, LINEAR] {
            let dark = importance(tone, Colors::Gray, Alpha::Straight, &[0u16, 0x8000]);
            assert!((dark - 0.5).abs() < 1e-4);
        }
        // Associated colours are not multiplied again.
        let rgba = [0.25f32, 0.25, 0.25, 0.5];
        assert_eq!(importance(LINEAR, Colors::Rgb, Alpha::Associated, &rgba), 0.25);
        assert_eq!(importance(LINEAR, Colors::Rgb, Alpha::Straight, &rgba), 0.375);
    }

    #[test]
    fn floats_below_zero_are_black_and_above_one_white() {
        for tone in [DEFAULT, LINEAR] {
            assert_eq!(importance(tone, Colors::Gray, Alpha::None, &[-3.0f32]), 1.0);
            assert_eq!(importance(tone, Colors::Gray, Alpha::None, &[7e4f32]), 0.0);
        }
    }

    #[test]
    fn a_nan_or_infinity_in_any_sample_is_no_importance() {
        let toner = Toner::new::<f32>(DEFAULT, Colors::Rgb, Alpha::Straight);
        for place in 0..4 {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut pixel = [0.5; 4];
                pixel[place] = bad;
                assert_eq!(toner.importance(&pixel), None);
            }
        }
    }

    #[test]
    fn invert_is_the_complement() {
        let invert = Tone { invert: true, ..DEFAULT };
        let dark = importance(DEFAULT, Colors::Gray, Alpha::None, &[77u8]);
        let light = importance(invert, Colors::Gray, Alpha::None, &[77u8]);
        assert!((dark + light - 1.0).abs() < 1e-6);
    }

    #[test]
    fn inks_and_colour_differences_become_colours() {
        let cmyk = |pixel: [u8; 4]| importance(DEFAULT, Colors::Cmyk, Alpha::None, &pixel);
        assert_eq!(cmyk([0, 0, 0, 0]), 0.0);
        assert_eq!(cmyk([0, 0, 0, 255]), 1.0);
        assert!((cmyk([255, 255, 0, 0]) - (1.0 - 0.0722)).abs() < 1e-6);
        let ycbcr = |pixel: [u8; 3]| importance(DEFAULT, Colors::YCbCr, Alpha::None, &pixel);
        assert!(ycbcr([255, 128, 128]) < 1e-6);
        // Pure red in JPEG's numbers.
        assert!((ycbcr([76, 85, 255]) - (1.0 - 0.2126)).abs() < 0.01);
    }
}
