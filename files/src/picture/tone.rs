//! From a pixel's samples to how many dots it deserves: its importance, from 0 (none) to 1 (most); or
//! to its light.

use std::cell::Cell;
use std::sync::Arc;

use super::color::{self, Curve, LUMINANCE, Space};
use super::sample::{Alpha, Colors, Sample};
use super::srgb;

/// Which tone the dots follow.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tone {
    /// Importance follows linear light (luminance), not encoded values (luma).
    pub linear: bool,
    /// Importance is the brightness, not its complement.
    pub invert: bool,
    /// Brightness is stretched so.
    pub levels: Option<Levels>,
    /// The light of a float file is multiplied by two to this power.
    pub exposure: Option<f64>,
}

/// Which encoded brightness, of 255, becomes black and which white, and how the middle moves.
///
/// Under `linear` the light of these values becomes black and white.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// At least 0.
    pub black: f64,
    /// Above `black`, at most 255.
    pub white: f64,
    /// Stretched brightness is raised to one over this: above 1 lightens the middle.
    pub gamma: f64,
}

impl Default for Levels {
    fn default() -> Self {
        Self { black: 0.0, white: 255.0, gamma: 1.0 }
    }
}

/// Turns the pixels of one file into what is asked for.
pub(super) struct Toner {
    pub(super) tone: Tone,
    pub(super) colors: Colors,
    alpha: Alpha,
    pub(super) space: Space,
    /// Working values of the samples 0, 1, 2 … of an 8- or 16-bit file; of red, of green and of blue
    /// where their curves differ.
    levels: [Arc<[f64]>; 3],
    /// What float samples are multiplied by.
    exposure: f64,
    /// Light to encoded values, where colors are mixed in light and followed encoded.
    encode: Option<srgb::Encoder>,
    /// The least and greatest brightness of a float file so far.
    range: Cell<(f64, f64)>,
}

impl Toner {
    /// A converter for samples of type `S`. A table for 16 bits takes half a mebibyte.
    pub(super) fn new<S: Sample>(tone: Tone, colors: Colors, alpha: Alpha, space: Space) -> Self {
        let count: u32 = match size_of::<S>() {
            _ if S::FLOAT => 0,
            1 => 1 << 8,
            2 => 1 << 16,
            _ => 0,
        };
        let top = f64::from(count.saturating_sub(1));
        let mixed = space.matrix.is_some();
        let table = |curve: Option<&Curve>| -> Arc<[f64]> {
            (0..count)
                .map(|level| {
                    let value = f64::from(level) / top;
                    match curve {
                        None => tone.working(value),
                        Some(curve) if mixed => curve(value),
                        Some(curve) => tone.shown(curve(value).clamp(0.0, 1.0)),
                    }
                })
                .collect()
        };
        let levels = match &space.curves {
            None => {
                let all = table(None);
                [all.clone(), all.clone(), all]
            }
            Some([red, green, blue]) => {
                let first = table(Some(red));
                let of = |curve: &Curve| {
                    if Arc::ptr_eq(curve, red) { first.clone() } else { table(Some(curve)) }
                };
                [first.clone(), of(green), of(blue)]
            }
        };
        let encode = (mixed && !tone.linear && !S::FLOAT).then(srgb::Encoder::new);
        let exposure = libm::exp2(tone.exposure.unwrap_or(0.0));
        let range = Cell::new((f64::INFINITY, f64::NEG_INFINITY));
        Self { tone, colors, alpha, space, levels, exposure, encode, range }
    }

    /// How many samples a pixel has that count: its colors and its alpha, if any.
    pub(super) fn samples(&self) -> usize {
        self.colors.count() + usize::from(self.alpha != Alpha::None)
    }

    /// The space, for a converter that has seen nothing yet.
    pub(super) fn into_space(self) -> Space {
        self.space
    }

    /// The least and greatest brightness of a float file, if any of its pixels was seen.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let (least, greatest) = self.range.get();
        (least <= greatest).then_some((least, greatest))
    }

    /// Importance, in 0..=1, of a pixel given by its colors and then its alpha, if any; `None` when
    /// one of these is a NaN or an infinity. Samples after those are ignored.
    ///
    /// What is not covered is paper: white, or black when dots are white.
    ///
    /// `pixel` holds at least as many samples as the colors and alpha take.
    pub(super) fn importance<S: Sample>(&self, pixel: &[S]) -> Option<f32> {
        let (rgb, alpha) = self.working(pixel)?;
        if S::FLOAT {
            let brightness = self.mean(rgb);
            let (least, greatest) = self.range.get();
            self.range.set((least.min(brightness), greatest.max(brightness)));
        }
        if let Some(levels) = self.tone.levels {
            let brightness = self.mean(self.uncovered(rgb, alpha).map(|value| {
                let value = value.min(1.0);
                if S::FLOAT && !self.tone.linear { srgb::encode(value) } else { value }
            }));
            let brightness = self.tone.leveled(levels, brightness) as f32;
            let dark = if self.tone.invert { brightness } else { 1.0 - brightness };
            return Some(dark * alpha as f32);
        }
        let paper = if self.tone.invert { 0.0 } else { 1.0 - alpha };
        let shown = |value: f64| {
            let over = match self.alpha {
                Alpha::None => value,
                Alpha::Straight => value * alpha + paper,
                Alpha::Associated => value + paper,
            };
            let over = over.min(1.0);
            if S::FLOAT && !self.tone.linear { srgb::encode(over) } else { over }
        };
        // Rounded to f32 first, white is exactly 1 and deserves exactly no dots.
        let brightness = match self.colors {
            Colors::Gray => shown(rgb[0]),
            _ => self.mean(rgb.map(shown)),
        } as f32;
        let brightness = brightness.min(1.0);
        Some(if self.tone.invert { brightness } else { 1.0 - brightness })
    }

    /// The color of the covered part in the working space, and how much is covered.
    pub(super) fn straight<S: Sample>(&self, pixel: &[S]) -> Option<([f64; 3], f64)> {
        let (rgb, alpha) = self.working(pixel)?;
        Some((self.uncovered(rgb, alpha), alpha))
    }

    /// Colors without the coverage that they are multiplied by.
    fn uncovered(&self, rgb: [f64; 3], alpha: f64) -> [f64; 3] {
        if self.alpha == Alpha::Associated && alpha > 0.0 {
            rgb.map(|value| value / alpha)
        } else {
            rgb
        }
    }

    fn mean(&self, [red, green, blue]: [f64; 3]) -> f64 {
        match self.colors {
            Colors::Gray => red,
            _ => LUMINANCE[0] * red + LUMINANCE[1] * green + LUMINANCE[2] * blue,
        }
    }

    /// Colors as light (floats), or in the space that `tone` asks for (integers); and alpha.
    fn working<S: Sample>(&self, pixel: &[S]) -> Option<([f64; 3], f64)> {
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
        Some((self.color(pixel), alpha.clamp(0.0, 1.0)))
    }

    fn color<S: Sample>(&self, pixel: &[S]) -> [f64; 3] {
        if let Some(table) = &self.space.table {
            let mut device = [0f32; 4];
            let count = self.colors.count();
            for (value, sample) in device.iter_mut().zip(&pixel[..count]) {
                *value = sample.fraction().clamp(0.0, 1.0) as f32;
            }
            let mut encoded = [0f32; 3];
            // Fails only for slices of lengths that do not match.
            let _ = table.transform(&device[..count], &mut encoded);
            return encoded.map(|value| {
                let value = if value.is_finite() { f64::from(value).clamp(0.0, 1.0) } else { 0.0 };
                if S::FLOAT {
                    srgb::decode(value) * self.exposure
                } else {
                    self.tone.working(value)
                }
            });
        }
        let rgb = match self.colors {
            Colors::Gray => [self.value(0, pixel[0]); 3],
            Colors::Rgb => [0, 1, 2].map(|i| self.value(i, pixel[i])),
            Colors::Cmyk => {
                let paper = 1.0 - pixel[3].fraction();
                [0, 1, 2].map(|i| self.encoded(i, (1.0 - pixel[i].fraction()) * paper))
            }
            Colors::YCbCr => {
                let [y, cb, cr] = [0, 1, 2].map(|i| pixel[i].fraction());
                // The zero of a color difference is half of full scale rounded up.
                let (cb, cr) = (cb - 128.0 / 255.0, cr - 128.0 / 255.0);
                let rgb = [y + 1.402 * cr, y - 0.344136 * cb - 0.714136 * cr, y + 1.772 * cb];
                [0, 1, 2].map(|i| self.encoded(i, rgb[i].clamp(0.0, 1.0)))
            }
        };
        let Some(matrix) = &self.space.matrix else { return rgb };
        let light = color::apply(matrix, rgb).map(|value| value.max(0.0));
        match &self.encode {
            _ if S::FLOAT => light,
            Some(encoder) => light.map(|value| encoder.encode(value)),
            None => light.map(|value| value.min(1.0)),
        }
    }

    /// A color sample as light (floats or where colors are mixed), or in the space of `tone`.
    fn value<S: Sample>(&self, channel: usize, sample: S) -> f64 {
        if S::FLOAT {
            let value = sample.fraction().max(0.0);
            return self.exposure
                * match &self.space.curves {
                    // Above white a curve says nothing.
                    Some(curves) if value <= 1.0 => curves[channel](value),
                    _ => value,
                };
        }
        match sample.index().and_then(|index| self.levels[channel].get(index)) {
            Some(&level) => level,
            None => self.encoded(channel, sample.fraction()),
        }
    }

    /// As [`Self::value`], of an encoded value in 0..=1.
    fn encoded(&self, channel: usize, value: f64) -> f64 {
        match &self.space.curves {
            None => self.tone.working(value),
            Some(curves) if self.space.matrix.is_some() => curves[channel](value),
            Some(curves) => self.tone.shown(curves[channel](value).clamp(0.0, 1.0)),
        }
    }
}

impl Tone {
    /// An encoded value in the space in which an integer file's colors are mixed.
    fn working(self, encoded: f64) -> f64 {
        if self.linear { srgb::decode(encoded) } else { encoded }
    }

    /// Light in 0..=1, in that space.
    fn shown(self, light: f64) -> f64 {
        if self.linear { light } else { srgb::encode(light) }
    }

    /// The light of a value in that space.
    pub(super) fn light(self, working: f64) -> f64 {
        if self.linear { working } else { srgb::decode(working.clamp(0.0, 1.0)) }
    }

    /// Brightness in 0..=1, stretched.
    fn leveled(self, levels: Levels, brightness: f64) -> f64 {
        let [black, white] = [levels.black, levels.white].map(|value| self.working(value / 255.0));
        let stretched = ((brightness - black) / (white - black)).clamp(0.0, 1.0);
        if levels.gamma == 1.0 { stretched } else { libm::pow(stretched, 1.0 / levels.gamma) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::pixel::Pixel;
    use super::*;

    const DEFAULT: Tone = Tone { linear: false, invert: false, levels: None, exposure: None };
    const LINEAR: Tone = Tone { linear: true, ..DEFAULT };

    fn importance<S: Sample>(tone: Tone, colors: Colors, alpha: Alpha, pixel: &[S]) -> f32 {
        Toner::new::<S>(tone, colors, alpha, Space::default()).importance(pixel).unwrap()
    }

    #[test]
    fn white_is_exactly_zero_and_black_exactly_one_at_every_depth() {
        fn check<S: Sample>(zero: S, full: S) {
            for tone in [DEFAULT, LINEAR] {
                let rgb = Toner::new::<S>(tone, Colors::Rgb, Alpha::None, Space::default());
                assert_eq!(rgb.importance(&[full; 3]), Some(0.0));
                assert_eq!(rgb.importance(&[zero; 3]), Some(1.0));
                let gray = Toner::new::<S>(tone, Colors::Gray, Alpha::Straight, Space::default());
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
    fn colors_weigh_as_in_rec_709() {
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
        // Associated colors are not multiplied again.
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
        let toner = Toner::new::<f32>(DEFAULT, Colors::Rgb, Alpha::Straight, Space::default());
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
    fn inks_and_color_differences_become_colors() {
        let cmyk = |pixel: [u8; 4]| importance(DEFAULT, Colors::Cmyk, Alpha::None, &pixel);
        assert_eq!(cmyk([0, 0, 0, 0]), 0.0);
        assert_eq!(cmyk([0, 0, 0, 255]), 1.0);
        assert!((cmyk([255, 255, 0, 0]) - (1.0 - 0.0722)).abs() < 1e-6);
        let ycbcr = |pixel: [u8; 3]| importance(DEFAULT, Colors::YCbCr, Alpha::None, &pixel);
        assert!(ycbcr([255, 128, 128]) < 1e-6);
        // Pure red in JPEG's numbers.
        assert!((ycbcr([76, 85, 255]) - (1.0 - 0.2126)).abs() < 0.01);
    }

    #[test]
    fn transparent_is_nothing_in_both_senses() {
        for tone in [DEFAULT, LINEAR] {
            for invert in [false, true] {
                let tone = Tone { invert, ..tone };
                for level in [0u8, 77, 255] {
                    let found = importance(tone, Colors::Gray, Alpha::Straight, &[level, 0]);
                    assert_eq!(found, 0.0);
                    let float = [f32::from(level), 0.0];
                    assert_eq!(importance(tone, Colors::Gray, Alpha::Straight, &float), 0.0);
                }
            }
        }
    }

    #[test]
    fn levels_stretch_and_their_gamma_moves_the_middle() {
        let levels = |black, white, gamma| Some(Levels { black, white, gamma });
        for linear in [false, true] {
            let tone = Tone { linear, levels: levels(10.0, 250.0, 1.0), ..DEFAULT };
            let at = |tone, level: u8| importance(tone, Colors::Gray, Alpha::None, &[level]);
            assert_eq!((at(tone, 250), at(tone, 255)), (0.0, 0.0));
            assert_eq!((at(tone, 10), at(tone, 0)), (1.0, 1.0));
            assert!(at(tone, 128) > 0.0 && at(tone, 128) < 1.0);
            let lighter = Tone { levels: levels(10.0, 250.0, 2.0), ..tone };
            assert!(at(lighter, 128) < at(tone, 128));
            let same = Tone { levels: Some(Levels::default()), ..tone };
            let plain = Tone { levels: None, ..tone };
            assert!((at(same, 99) - at(plain, 99)).abs() < 1e-6);
        }
    }

    #[test]
    fn exposure_doubles_light_by_the_stop() {
        let tone = Tone { exposure: Some(-2.0), ..LINEAR };
        assert_eq!(importance(tone, Colors::Gray, Alpha::None, &[2.0f32]), 0.5);
    }

    #[test]
    fn a_curve_and_a_matrix_are_followed_at_every_depth() {
        fn check<S: Sample>(half: S) {
            // Linear samples: half is encoded .735.
            let space = Space::of_curve(Arc::new(|value| value));
            for mixed in [false, true] {
                let matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                let space = Space { matrix: mixed.then_some(matrix), ..space.clone() };
                for (tone, dark) in [(DEFAULT, 1.0 - srgb::encode(0.5)), (LINEAR, 0.5)] {
                    let toner = Toner::new::<S>(tone, Colors::Rgb, Alpha::None, space.clone());
                    let found = f64::from(toner.importance(&[half; 3]).unwrap());
                    assert!((found - dark).abs() < 3e-3, "{found} {dark}");
                    let light = <[f32; 4]>::of(&toner, &[half; 3]).unwrap();
                    assert!((light[1] - 0.5).abs() < 3e-3 && light[3] == 1.0);
                }
            }
        }
        check(128u8);
        check(32768u16);
        check(1u32 << 31);
        check(0.5f32);
    }
}
