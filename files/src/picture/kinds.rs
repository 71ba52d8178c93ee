//! Kinds of TIFF files that the decoder does not read: each made here, byte by byte.

use std::fs;
use std::path::Path;

use super::cases::{darkness, of_bytes, picture, sample};
use super::*;

const WIDTH: usize = 20;
const HEIGHT: usize = 12;

/// A number for each pixel, below `top`.
fn number(x: usize, y: usize, top: usize) -> usize {
    (x * 7 + y * 3) % top
}

fn pixels<T>(of: impl Fn(usize, usize) -> T) -> Vec<T> {
    (0..WIDTH * HEIGHT).map(|i| of(i % WIDTH, i / WIDTH)).collect()
}

/// An entry of a directory: its tag, the bytes of a value, and its values.
pub(super) type Entry = (usize, usize, Vec<usize>);

/// How a file writes its numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Form {
    pub(super) big_endian: bool,
    long: bool,
}

pub(super) const FORMS: [Form; 4] = [
    Form { big_endian: false, long: false },
    Form { big_endian: true, long: false },
    Form { big_endian: false, long: true },
    Form { big_endian: true, long: true },
];

impl Form {
    pub(super) fn put(self, out: &mut Vec<u8>, value: usize, size: usize) {
        let bytes = (value as u64).to_be_bytes();
        if self.big_endian {
            out.extend(&bytes[8 - size..]);
        } else {
            out.extend(bytes[8 - size..].iter().rev());
        }
    }

    pub(super) fn word(self) -> usize {
        if self.long { 8 } else { 4 }
    }

    /// The start of a file, with the place where the first directory's is to be written.
    pub(super) fn start(self) -> (Vec<u8>, usize) {
        let mut out = match (self.big_endian, self.long) {
            (false, false) => b"II*\0".to_vec(),
            (true, false) => b"MM\0*".to_vec(),
            (false, true) => b"II+\0\x08\0\0\0".to_vec(),
            (true, true) => b"MM\0+\0\x08\0\0".to_vec(),
        };
        let first = out.len();
        self.put(&mut out, 0, self.word());
        (out, first)
    }

    /// Writes a directory, which is the last one, and says where it lies.
    pub(super) fn directory(self, out: &mut Vec<u8>, entries: &[Entry]) -> usize {
        let mut stored = Vec::new();
        for (tag, size, values) in entries {
            let mut bytes = Vec::new();
            values.iter().for_each(|&value| self.put(&mut bytes, value, *size));
            if bytes.len() > self.word() {
                let place = out.len();
                out.extend(bytes);
                bytes = Vec::new();
                self.put(&mut bytes, place, self.word());
            }
            bytes.resize(self.word(), 0);
            let (kind, count) = match (tag, size) {
                // Resolutions are fractions.
                (282 | 283, _) => (5, 1),
                (_, 1) => (1, values.len()),
                (_, 2) => (3, values.len()),
                (_, 4) => (4, values.len()),
                _ => (16, values.len()),
            };
            stored.push((*tag, kind, count, bytes));
        }
        stored.sort_by_key(|entry| entry.0);
        let place = out.len();
        self.put(out, stored.len(), if self.long { 8 } else { 2 });
        for (tag, kind, count, bytes) in stored {
            self.put(out, tag, 2);
            self.put(out, kind, 2);
            self.put(out, count, self.word());
            out.extend(bytes);
        }
        self.put(out, 0, self.word());
        place
    }

    /// Writes where the first directory lies.
    pub(super) fn begin(self, out: &mut [u8], first: usize, place: usize) {
        let mut offset = Vec::new();
        self.put(&mut offset, place, self.word());
        out[first..first + offset.len()].copy_from_slice(&offset);
    }

    /// A file of these directories, each with its entries and its one strip; the later ones are within the first.
    fn file(self, pages: &[(Vec<Entry>, &[u8])]) -> Vec<u8> {
        let (mut out, first) = self.start();
        let mut within = Vec::new();
        for (page, (entries, strip)) in pages.iter().enumerate().rev() {
            let mut entries = entries.clone();
            entries.push((273, self.word(), vec![out.len()]));
            entries.push((279, 4, vec![strip.len()]));
            if page == 0 && !within.is_empty() {
                entries.push((330, self.word(), within.clone()));
            }
            out.extend(*strip);
            let place = self.directory(&mut out, &entries);
            within.push(place);
            if page == 0 {
                self.begin(&mut out, first, place);
            }
        }
        out
    }

    /// The head of a file whose one directory has these entries, and strips or tiles of these lengths, which lie
    /// behind it one after the other.
    pub(super) fn head(self, entries: &[Entry], tiled: bool, lengths: &[usize]) -> Vec<u8> {
        let of = |start: usize| {
            let (mut out, first) = self.start();
            let mut end = start;
            let mut offsets = Vec::new();
            for length in lengths {
                offsets.push(end);
                end += length;
            }
            let tags = if tiled { (324, 325) } else { (273, 279) };
            let mut entries = entries.to_vec();
            entries.push((tags.0, self.word(), offsets));
            entries.push((tags.1, 4, lengths.to_vec()));
            let place = self.directory(&mut out, &entries);
            self.begin(&mut out, first, place);
            out
        };
        of(of(0).len())
    }
}

/// Entries of a picture of so many bits and samples.
fn entries(photometric: usize, bits: usize, samples: usize) -> Vec<Entry> {
    vec![
        (256, 2, vec![WIDTH]),
        (257, 2, vec![HEIGHT]),
        (258, 2, vec![bits; samples]),
        (259, 2, vec![1]),
        (262, 2, vec![photometric]),
        (277, 2, vec![samples]),
        (278, 2, vec![HEIGHT]),
    ]
}

/// Rows of samples of a few bits each, each row beginning on a byte.
pub(super) fn packed(row: usize, bits: usize, numbers: &[usize]) -> Vec<u8> {
    let mut out = Vec::new();
    for row in numbers.chunks(row) {
        let mut text: String = row.iter().map(|number| format!("{number:0bits$b}")).collect();
        text.extend(std::iter::repeat_n('0', (8 - text.len() % 8) % 8));
        let byte = |byte: &[u8]| u8::from_str_radix(str::from_utf8(byte).unwrap(), 2).unwrap();
        out.extend(text.as_bytes().chunks(8).map(byte));
    }
    out
}

fn importance(bytes: &[u8]) -> Vec<f32> {
    let found = of_bytes(bytes, |path| read(path, Tone::default())).unwrap();
    assert_eq!((found.width, found.height, found.warnings.len()), (WIDTH, HEIGHT, 0));
    found.importance
}

fn assert_near(found: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found} {expected}");
    }
}

fn dark([red, green, blue]: [usize; 3]) -> f32 {
    let [red, green, blue] = [red, green, blue].map(|value| value as f32 / 65535.0);
    1.0 - (0.2126 * red + 0.7152 * green + 0.0722 * blue)
}

#[test]
fn palettes_of_tiff_files_are_their_colors() {
    for form in FORMS {
        for bits in [1usize, 2, 4, 8, 16] {
            let count = 1 << bits;
            let color =
                |index: usize| [index * 65535 / (count - 1), index * 7919 % 65536, 65535 - index];
            let map: Vec<usize> =
                (0..3).flat_map(|part| (0..count).map(move |i| color(i)[part])).collect();
            let numbers = pixels(|x, y| number(x, y, count.min(400)));
            let mut strip = Vec::new();
            if bits == 16 {
                numbers.iter().for_each(|&number| form.put(&mut strip, number, 2));
            } else {
                strip = packed(WIDTH, bits, &numbers);
            }
            let mut page = entries(3, bits, 1);
            page.push((320, 2, map));
            let expected: Vec<f32> = numbers.iter().map(|&number| dark(color(number))).collect();
            assert_near(&importance(&form.file(&[(page, &strip)])), &expected, 1e-5);
        }
    }
}

#[test]
fn a_palette_of_eight_bits_is_stretched() {
    let numbers = pixels(|x, y| number(x, y, 16));
    let mut page = entries(3, 4, 1);
    page.push((320, 2, (0..48).map(|i| i % 16 * 17).collect()));
    let strip = packed(WIDTH, 4, &numbers);
    let expected: Vec<f32> = numbers.iter().map(|&n| 1.0 - n as f32 / 15.0).collect();
    assert_near(&importance(&FORMS[0].file(&[(page, &strip)])), &expected, 1e-5);
}

#[test]
fn samples_of_any_number_of_bits_are_read_with_either_end_as_white() {
    for form in FORMS {
        for (photometric, bits, samples) in [
            (1usize, 12usize, 1usize),
            (0, 12, 1),
            (1, 10, 1),
            (1, 24, 1),
            (0, 6, 1),
            (2, 12, 3),
            (2, 4, 3),
            (2, 5, 4),
            (5, 2, 4),
        ] {
            let top = (1usize << bits) - 1;
            let numbers: Vec<usize> = pixels(|x, y| number(x, y, 57) * top / 56)
                .into_iter()
                .flat_map(|n| (0..samples).map(move |i| if i == 3 { 0 } else { n }))
                .collect();
            let strip = packed(WIDTH * samples, bits, &numbers);
            let expected: Vec<f32> = numbers
                .chunks(samples)
                .map(|pixel| {
                    let part = pixel[0] as f32 / top as f32;
                    if matches!(photometric, 0 | 5) { part } else { 1.0 - part }
                })
                .collect();
            let file = form.file(&[(entries(photometric, bits, samples), &strip)]);
            assert_near(&importance(&file), &expected, 2e-5);
        }
    }
}

#[test]
fn bytes_that_begin_with_their_last_bit_are_turned() {
    for bits in [1usize, 8] {
        let top = (1usize << bits) - 1;
        let numbers = pixels(|x, y| number(x, y, top + 1));
        let strip: Vec<u8> =
            packed(WIDTH, bits, &numbers).iter().map(|byte| byte.reverse_bits()).collect();
        let mut page = entries(1, bits, 1);
        page.push((266, 2, vec![2]));
        let expected: Vec<f32> = numbers.iter().map(|&n| 1.0 - n as f32 / top as f32).collect();
        assert_near(&importance(&FORMS[1].file(&[(page, &strip)])), &expected, 1e-5);
    }
}

#[test]
fn lightness_of_lab_is_the_tone_and_its_hue_the_color() {
    for form in FORMS {
        for (photometric, zero) in [(8usize, 0usize), (9, 128)] {
            for size in [1usize, 2] {
                let unit = if size == 1 { 1 } else { 256 };
                let mut strip = Vec::new();
                for lightness in pixels(|x, y| number(x, y, 256)) {
                    form.put(&mut strip, lightness * if size == 1 { 1 } else { 257 }, size);
                    form.put(&mut strip, zero * unit, size);
                    form.put(&mut strip, zero * unit, size);
                }
                let expected: Vec<f32> = pixels(|x, y| {
                    let root = (number(x, y, 256) as f64 / 2.55 + 16.0) / 116.0;
                    1.0 - srgb::encode(color::of_root(root)) as f32
                });
                let file = form.file(&[(entries(photometric, 8 * size, 3), &strip)]);
                assert_near(&importance(&file), &expected, 1e-5);
            }
        }
    }
    // sRGB's red.
    let strip = [138u8, 81, 70].repeat(WIDTH * HEIGHT);
    let file = FORMS[0].file(&[(entries(8, 8, 3), &strip)]);
    let found = of_bytes(&file, |path| read_color(path, Tone::default(), None)).unwrap();
    let [red, green, blue, alpha] = found.pixels[0];
    assert!(red > 0.97 && green < 0.01 && blue < 0.01 && alpha == 1.0, "{:?}", found.pixels[0]);
}

#[test]
fn a_larger_picture_within_a_thumbnail_is_shown() {
    let strip = pixels(|x, y| number(x, y, 256) as u8);
    let mut thumbnail = entries(1, 8, 1);
    thumbnail.retain(|entry| !matches!(entry.0, 256 | 257));
    thumbnail.extend([(254, 4, vec![1]), (256, 2, vec![2]), (257, 2, vec![2])]);
    for form in FORMS {
        let file = form.file(&[(thumbnail.clone(), &[9; 4]), (entries(1, 8, 1), &strip)]);
        let expected: Vec<f32> = strip.iter().map(|&n| 1.0 - f32::from(n) / 255.0).collect();
        assert_near(&importance(&file), &expected, 1e-5);
    }
}

#[test]
fn files_of_cameras_are_named_and_their_thumbnails_not_drawn() {
    let make = |name: &str| (271, 1, name.bytes().map(usize::from).collect::<Vec<_>>());
    let mut thumbnail = entries(1, 8, 1);
    thumbnail.push((254, 4, vec![1]));
    for (name, photometric, compression, expected) in [
        ("NIKON CORPORATION\0", 32803, 34713, "NEF"),
        ("SONY\0", 32803, 32767, "ARW"),
        ("PENTAX\0", 1, 65535, "PEF"),
        ("SAMSUNG\0", 32803, 1, "SRW"),
        ("Leaf\0", 32803, 1, "camera's raw"),
    ] {
        let mut raw = entries(photometric, 12, 1);
        raw.retain(|entry| entry.0 != 259);
        raw.extend([(259, 2, vec![compression]), make(name)]);
        for form in FORMS {
            let file = form.file(&[(thumbnail.clone(), &[9; WIDTH * HEIGHT]), (raw.clone(), &[0])]);
            let error = of_bytes(&file, |path| read(path, Tone::default())).unwrap_err();
            let text = error.to_string();
            assert!(text.contains(expected) && text.contains("develop it"), "{text}");
        }
    }
    let mut canon = FORMS[0].file(&[(thumbnail.clone(), &[9; WIDTH * HEIGHT])]);
    canon[8..10].copy_from_slice(b"CR");
    let error = of_bytes(&canon, |path| read(path, Tone::default())).unwrap_err();
    assert!(error.to_string().contains("CR2"), "{error}");
    let mut dng = thumbnail;
    dng.push((50706, 1, vec![1, 4, 0, 0]));
    let dng = FORMS[1].file(&[(dng, &[9; WIDTH * HEIGHT])]);
    let error = of_bytes(&dng, |path| read(path, Tone::default())).unwrap_err();
    assert!(error.to_string().contains("DNG"), "{error}");
}

#[test]
fn no_cut_or_flipped_file_of_these_kinds_crashes() {
    let strip = packed(WIDTH, 4, &pixels(|x, y| number(x, y, 16)));
    let mut palette = entries(3, 4, 1);
    palette.push((320, 2, (0..48).map(|i| i * 1000).collect()));
    let mut files = vec![
        FORMS[0].file(&[(palette, &strip)]),
        FORMS[3].file(&[(entries(8, 8, 3), &[99; 3 * WIDTH * HEIGHT])]),
        FORMS[1].file(&[(entries(2, 12, 3), &[99; 54 * 20])]),
    ];
    for name in ["yc_none.exr", "yc_zip.exr", "yc_piz.exr", "progressive.jpg"] {
        files.push(fs::read(sample(name)).unwrap());
    }
    let mut state = 7u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    let mut drawn = 0;
    for whole in files {
        let tried = |bytes: &[u8]| of_bytes(bytes, |path: &Path| read(path, Tone::default()));
        assert!(tried(&whole).is_ok());
        for part in 0..20 {
            let _ = tried(&whole[..whole.len() * part / 20]);
        }
        for _ in 0..30 {
            let mut bytes = whole.clone();
            for _ in 0..=random(3) {
                let place = random(bytes.len());
                bytes[place] = [0, 0xff, 0x7f, 0x80, random(256) as u8][random(5)];
            }
            drawn += usize::from(tried(&bytes).is_ok());
        }
    }
    assert!(drawn > 20, "{drawn}");
    assert!(darkness(&picture("progressive.jpg", Tone::default())) > 0.2);
}
