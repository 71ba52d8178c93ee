//! Pictures that the decoder does not read: their directory is written anew in memory, so that it hands
//! their samples over as plain numbers, whose meaning is then kept here.

use std::io::Cursor;

use super::super::directory::{Directory, Entry};
use super::super::source::Source;
use super::lab::Lab;
use super::{Alpha, Colors, PictureError, limits, unsupported};

const WIDTH: u16 = 256;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const PHOTOMETRIC: u16 = 262;
const FILL_ORDER: u16 = 266;
const STRIPS: u16 = 273;
const SAMPLES: u16 = 277;
const STRIP_BYTES: u16 = 279;
const PLANAR: u16 = 284;
const PREDICTOR: u16 = 317;
const MAP: u16 = 320;
const TILE_WIDTH: u16 = 322;
const TILES: u16 = 324;
const TILE_BYTES: u16 = 325;
const EXTRA: u16 = 338;
const FORMAT: u16 = 339;

/// A tag that nobody reads.
const NOTHING: u64 = 65535;

const JPEG: u64 = 7;

/// What samples are.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Meaning {
    /// What the decoder says.
    Stored,
    /// Numbers of colors of 16 bits.
    Palette(Vec<[u16; 3]>),
    Lab(Lab),
    /// Rows of bits, each row beginning on a byte, that the decoder takes for bytes.
    Bits(Bits),
}

/// Rows of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Bits {
    /// Of a sample, at most 32.
    pub(super) bits: usize,
    /// Of a pixel.
    pub(super) samples: usize,
    /// Whether 0 is white.
    pub(super) inverted: bool,
    pub(super) colors: Colors,
    pub(super) alpha: Alpha,
    /// Pixels of a picture's row, and of that of a strip or tile.
    pub(super) width: usize,
    pub(super) chunk: usize,
}

impl Bits {
    /// The bytes of a row of a strip or tile.
    pub(super) fn row(&self) -> usize {
        row_bytes(self.chunk, self.bits * self.samples)
    }
}

fn row_bytes(width: usize, bits: usize) -> usize {
    (width.saturating_mul(bits)).div_ceil(8)
}

/// The file as the decoder reads it, its first picture that of `page`; and what its samples are.
///
/// # Errors
/// [`PictureError`] for kinds that are not read.
pub(super) fn relabeled(
    mut source: Source,
    page: &Directory,
) -> Result<(Source, Meaning), PictureError> {
    let first = Directory::first(&mut source).is_some_and(|offset| offset == page.offset);
    let of = |source: &mut Source, tag, default| page.number(source, tag).unwrap_or(default);
    let (bits, samples) = (of(&mut source, BITS, 1), of(&mut source, SAMPLES, 1));
    let photometric = of(&mut source, PHOTOMETRIC, 1);
    let compression = of(&mut source, COMPRESSION, 1);
    let mut changes = Vec::new();
    let meaning = match (photometric, bits, samples) {
        (3, 1 | 2 | 4 | 8 | 16, 1) => {
            changes.push((PHOTOMETRIC, 1));
            Meaning::Palette(palette(&mut source, page, bits))
        }
        (3, ..) => return Err(unsupported("palettes of other than 1 to 16 bits")),
        (8 | 9, 8 | 16, 3..) => {
            changes.extend([(PHOTOMETRIC, 2), (FORMAT, 1)]);
            Meaning::Lab(Lab::new(photometric == 8))
        }
        (8..=10, ..) => return Err(unsupported("Lab colors of this kind")),
        (4, ..) => return Err(unsupported("masks without their picture")),
        (32844 | 32845, ..) => return Err(unsupported("LogLuv colors")),
        (_, 8 | 16 | 32 | 64, _) | (0 | 1, 1 | 2 | 4, 1) => Meaning::Stored,
        _ => {
            let kind = bits_of(&mut source, page, [photometric, bits, samples, compression])?;
            changes.extend([(BITS, 8), (SAMPLES, 1), (PHOTOMETRIC, 1), (FORMAT, 1)]);
            let rows = kind.width.div_ceil(kind.chunk) * kind.row();
            changes.extend([(WIDTH, rows as u64), (TILE_WIDTH, kind.row() as u64)]);
            Meaning::Bits(kind)
        }
    };
    let reversed = of(&mut source, FILL_ORDER, 1) == 2 && compression != JPEG;
    if first && !reversed && meaning == Meaning::Stored {
        return Ok((source, meaning));
    }
    let chunks = if reversed { chunks(&mut source, page) } else { Vec::new() };
    let mut bytes = source.into_bytes()?;
    for (place, length) in chunks {
        let end = place.saturating_add(length).min(bytes.len());
        let chunk = bytes.get_mut(place.min(end)..end).unwrap_or_default();
        chunk.iter_mut().for_each(|byte| *byte = byte.reverse_bits());
    }
    for (tag, value) in changes {
        if let Some(entry) = page.entry(tag) {
            write(&mut bytes, page, entry, value);
        }
    }
    if let (Meaning::Bits(_), Some(extra)) = (&meaning, page.entry(EXTRA)) {
        put(&mut bytes, extra.place, &page.form.stored(NOTHING, 2));
    }
    put(&mut bytes, page.form.first(), &page.form.word(page.offset));
    Ok((Source::Memory(Cursor::new(bytes)), meaning))
}

/// The colors of a palette.
fn palette(source: &mut Source, page: &Directory, bits: u64) -> Vec<[u16; 3]> {
    let count = 1usize << bits;
    let mut map = page.numbers(source, MAP, 3 * count);
    map.resize(3 * count, 0);
    // Some writers give eight bits where sixteen are asked for.
    let factor = if map.iter().all(|&value| value < 256) { 257 } else { 1 };
    let at = |index: usize| (map[index] * factor).min(65535) as u16;
    (0..count).map(|index| [at(index), at(count + index), at(2 * count + index)]).collect()
}

/// Rows of bits, of these numbers: photometric interpretation, bits, samples, compression.
fn bits_of(
    source: &mut Source,
    page: &Directory,
    [photometric, bits, samples, compression]: [u64; 4],
) -> Result<Bits, PictureError> {
    let mut of = |tag, default| page.number(source, tag).unwrap_or(default);
    let plain = of(FORMAT, 1) == 1 && of(PREDICTOR, 1) == 1 && compression != JPEG;
    let extra = of(EXTRA, 0);
    let colors = match photometric {
        0 | 1 => Some(Colors::Gray),
        2 => Some(Colors::Rgb),
        5 => Some(Colors::Cmyk),
        _ => None,
    };
    let (Some(colors), true, 1..=32, true) =
        (colors, plain, bits, of(PLANAR, 1) == 1 || samples == 1)
    else {
        return Err(unsupported(&format!("samples of {bits} bits of this kind")));
    };
    let count = colors.count();
    let width = of(WIDTH, 0);
    let (Ok(width), Ok(chunk), Ok(samples)) =
        (usize::try_from(width), usize::try_from(of(TILE_WIDTH, width)), usize::try_from(samples))
    else {
        return Err(unsupported("a picture of this size"));
    };
    if width == 0 || chunk == 0 {
        return Err(PictureError::Empty);
    }
    if samples < count {
        return Err(unsupported("fewer samples than colors"));
    }
    let alpha = match extra {
        1 if samples > count => Alpha::Associated,
        2 if samples > count => Alpha::Straight,
        _ => Alpha::None,
    };
    // The wider picture of bytes is within the limits as well.
    limits::check(width, 1, samples.saturating_mul(4))?;
    limits::check(chunk, 1, samples.saturating_mul(4))?;
    let bits = bits as usize;
    Ok(Bits { bits, samples, inverted: photometric == 0, colors, alpha, width, chunk })
}

/// Where strips or tiles lie, and their lengths.
fn chunks(source: &mut Source, page: &Directory) -> Vec<(usize, usize)> {
    let most = limits::MEMORY_LIMIT as usize / 64;
    let mut of = |tags: [u16; 2]| {
        let tag = tags.into_iter().find(|&tag| page.entry(tag).is_some()).unwrap_or(0);
        page.numbers(source, tag, most)
    };
    let (places, lengths) = (of([STRIPS, TILES]), of([STRIP_BYTES, TILE_BYTES]));
    let whole = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
    places.into_iter().map(whole).zip(lengths.into_iter().map(whole)).collect()
}

/// Makes an entry hold one number.
fn write(bytes: &mut [u8], page: &Directory, entry: &Entry, value: u64) {
    const SHORT: u64 = 3;
    const LONG: u64 = 4;
    let form = page.form;
    let (kind, size) = if value < 1 << 16 { (SHORT, 2) } else { (LONG, 4) };
    let mut stored = form.stored(kind, 2);
    stored.extend(form.word(1));
    let mut value = form.stored(value, size);
    value.resize(form.word(0).len(), 0);
    stored.extend(value);
    put(bytes, entry.place + 2, &stored);
}

fn put(bytes: &mut [u8], place: u64, new: &[u8]) {
    let place = usize::try_from(place).unwrap_or(usize::MAX);
    if let Some(old) = bytes.get_mut(place..place.saturating_add(new.len())) {
        old.copy_from_slice(new);
    }
}

/// Samples of up to 32 bits, as many as `width` in each of `height` rows of `stride` bytes, stretched to `full`.
pub(super) fn unpacked(
    packed: &[u8],
    [stride, width, height]: [usize; 3],
    bits: usize,
    full: u64,
) -> Vec<u16> {
    let top = (1u64 << bits) - 1;
    let mut samples = Vec::with_capacity(width * height);
    for row in packed.chunks(stride.max(1)).take(height) {
        samples.extend((0..width).map(|x| {
            let (start, last) = (x * bits / 8, ((x + 1) * bits - 1) / 8);
            let bytes = row.get(start..=last).unwrap_or_default();
            let number = bytes.iter().fold(0u64, |number, &byte| number << 8 | u64::from(byte));
            let sample = number >> (7 - ((x + 1) * bits - 1) % 8) & top;
            // At most `full`, rounded.
            ((sample * full + top / 2) / top) as u16
        }));
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_samples_are_stretched_row_by_row() {
        let of = |packed: &[u8], stride, bits| unpacked(packed, [stride, 3, 2], bits, 255);
        assert_eq!(of(&[0b1010_0000, 0b0100_0000], 1, 1), [255, 0, 255, 0, 255, 0]);
        assert_eq!(of(&[0b0001_1011, 0b1110_0100], 1, 2), [0, 85, 170, 255, 170, 85]);
        assert_eq!(of(&[0x0f, 0x80, 0x12, 0x30], 2, 4), [0, 255, 136, 17, 34, 51]);
        let wide = [0xff, 0xf0, 0x01, 0x80, 0x00, 0x00, 0x07, 0xff, 0xff, 0xf0];
        assert_eq!(unpacked(&wide, [5, 3, 2], 12, 4095), [4095, 1, 2048, 0, 2047, 4095]);
        assert_eq!(unpacked(&[0xff; 8], [8, 2, 1], 32, 65535), [65535; 2]);
        // What is missing is zero.
        assert_eq!(unpacked(&[0xff], [2, 2, 1], 8, 255), [255, 0]);
    }
}
