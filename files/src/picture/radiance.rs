//! Radiance HDR: its header, its eight orders of pixels and its run lengths, a row at a time.

use std::io::{BufRead as _, Read as _};

use image::metadata::Orientation;

use super::color::Space;
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, limits};

/// Longest line of a header; the oldest commands of a long history are cut by writers at 4 KiB.
const LONGEST_LINE: usize = 1 << 16;
const MOST_LINES: usize = 1 << 16;

/// What a header says.
struct Header {
    width: usize,
    height: usize,
    orientation: Orientation,
    /// What stored values were multiplied by, color by color.
    factor: [f64; 3],
    gamma: f64,
    /// Height of a pixel over its width.
    aspect: f64,
    space: Space,
}

/// Reads a Radiance HDR file.
pub(super) fn read<P: Pixel>(
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let header = Header::read(&mut source)?;
    let (width, height) = (header.width, header.height);
    limits::check(width, height, size_of::<P>())?;
    let toner = Toner::new::<f32>(wanted.tone, Colors::Rgb, Alpha::None, header.space.clone());
    let mut plane = Plane::new((width, height), header.orientation, P::NOTHING)?;
    // Stored pixels of a file whose columns come first lie on their side.
    let turned = header.orientation.to_exif() > 4;
    plane.set_aspect(if turned { header.aspect } else { 1.0 / header.aspect });
    let mut row = vec![[0u8; 4]; width];
    for y in 0..height {
        scanline(&mut source, &mut row)?;
        for (x, pixel) in row.iter().enumerate() {
            plane.set(x, y, P::of(&toner, &header.light(*pixel)));
        }
    }
    plane.finish(Some(&toner))
}

impl Header {
    fn read(source: &mut Source) -> Result<Self, PictureError> {
        let mut header = Self {
            width: 0,
            height: 0,
            orientation: Orientation::NoTransforms,
            factor: [1.0; 3],
            gamma: 1.0,
            aspect: 1.0,
            space: Space::default(),
        };
        let mut xyz = false;
        for _ in 0..MOST_LINES {
            let line = line(source)?;
            if line.is_empty() {
                header.resolution(&self::line(source)?)?;
                if xyz {
                    let third = 1.0 / 3.0;
                    let axes = [[third; 2], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];
                    header.space = Space::default().with_primaries(&axes);
                }
                return Ok(header);
            }
            let Some((key, value)) = line.split_once('=') else { continue };
            let numbers: Vec<f64> = value
                .split_whitespace()
                .filter_map(|word| word.parse().ok())
                .filter(|number: &f64| number.is_finite())
                .collect();
            let positive = numbers.iter().all(|&number| number > 0.0);
            match (key.trim(), &numbers[..]) {
                ("FORMAT", _) => match value.trim() {
                    "32-bit_rle_rgbe" => xyz = false,
                    "32-bit_rle_xyze" => xyz = true,
                    other => return Err(malformed(&format!("pixels of the kind {other}"))),
                },
                // Each program that changed the file added its own.
                ("EXPOSURE", &[factor]) if positive => {
                    header.factor = header.factor.map(|value| value * factor);
                }
                ("COLORCORR", &[red, green, blue]) if positive => {
                    let [r, g, b] = header.factor;
                    header.factor = [r * red, g * green, b * blue];
                }
                ("GAMMA", &[gamma]) if positive => header.gamma = gamma,
                ("PIXASPECT", &[aspect]) if positive => header.aspect *= aspect,
                ("PRIMARIES", &[a, b, c, d, e, f, g, h]) => {
                    let primaries = [[g, h], [a, b], [c, d], [e, f]];
                    header.space = Space::default().with_primaries(&primaries);
                }
                _ => {}
            }
        }
        Err(malformed("a header without an end"))
    }

    /// Reads the line that says the size and the order of the pixels, such as `-Y 480 +X 640`.
    fn resolution(&mut self, line: &str) -> Result<(), PictureError> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let &[slow, rows, fast, columns] = &words[..] else {
            return Err(malformed("a resolution that is not two axes and two numbers"));
        };
        let length = |word: &str| word.parse().map_err(|_| malformed("a size that is no number"));
        (self.height, self.width) = (length(rows)?, length(columns)?);
        // +Y is up, and so is stored order from the bottom.
        self.orientation = match (slow, fast) {
            ("-Y", "+X") => Orientation::NoTransforms,
            ("-Y", "-X") => Orientation::FlipHorizontal,
            ("+Y", "-X") => Orientation::Rotate180,
            ("+Y", "+X") => Orientation::FlipVertical,
            ("+X", "-Y") => Orientation::Rotate90FlipH,
            ("-X", "-Y") => Orientation::Rotate90,
            ("-X", "+Y") => Orientation::Rotate270FlipH,
            ("+X", "+Y") => Orientation::Rotate270,
            _ => return Err(malformed("a resolution without X and Y")),
        };
        Ok(())
    }

    /// The light of a stored pixel.
    fn light(&self, [red, green, blue, exponent]: [u8; 4]) -> [f32; 3] {
        if exponent == 0 {
            return [0.0; 3];
        }
        let unit = libm::ldexp(1.0, i32::from(exponent) - 136);
        let mut light = [red, green, blue].map(|mantissa| f64::from(mantissa) * unit);
        if self.gamma != 1.0 {
            // Stored values are light to the power of 1/gamma.
            light = light.map(|value| libm::pow(value, self.gamma));
        }
        // A quotient beyond the greatest float is the greatest.
        let most = f64::from(f32::MAX);
        [0, 1, 2].map(|i| (light[i] / self.factor[i]).min(most) as f32)
    }
}

/// The next line of a header without its end, of either kind.
fn line(source: &mut Source) -> Result<String, PictureError> {
    let mut bytes = Vec::new();
    source.by_ref().take(LONGEST_LINE as u64).read_until(b'\n', &mut bytes)?;
    match bytes.pop() {
        Some(b'\n') => {}
        Some(_) if bytes.len() + 1 == LONGEST_LINE => return Err(malformed("an endless line")),
        _ => return Err(PictureError::Truncated(Format::Hdr)),
    }
    if bytes.last() == Some(&b'\r') {
        bytes.pop();
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Reads one row of pixels: each component's runs apart, or pixels with runs of the last one, or plain.
fn scanline(source: &mut Source, row: &mut [[u8; 4]]) -> Result<(), PictureError> {
    let mut next = || -> Result<[u8; 4], PictureError> {
        let mut pixel = [0; 4];
        source.read_exact(&mut pixel).map_err(|error| super::ended(error, Format::Hdr))?;
        Ok(pixel)
    };
    let first = next()?;
    let width = row.len();
    let length = usize::from(first[2]) << 8 | usize::from(first[3]);
    if first[..2] == [2, 2] && first[2] < 128 && (8..0x8000).contains(&width) {
        if length != width {
            return Err(malformed("a row of another length than the picture's"));
        }
        return components(source, row);
    }
    let mut pixel = first;
    let (mut x, mut shift) = (0usize, 0u32);
    loop {
        if pixel[..3] == [1, 1, 1] && x > 0 {
            // A run of the pixel before; runs that follow each other are digits of one number.
            let run = usize::from(pixel[3]).checked_shl(shift).unwrap_or(usize::MAX);
            let end = x.saturating_add(run);
            let before = row[x - 1];
            row.get_mut(x..end).ok_or_else(|| malformed("a run beyond its row"))?.fill(before);
            x = end;
            shift = (shift + 8).min(24);
        } else {
            row[x] = pixel;
            x += 1;
            shift = 0;
        }
        if x >= width {
            return Ok(());
        }
        pixel = next()?;
    }
}

/// Reads the four components of a row, each in runs of its own.
fn components(source: &mut Source, row: &mut [[u8; 4]]) -> Result<(), PictureError> {
    let mut byte = || -> Result<u8, PictureError> {
        let mut byte = [0];
        source.read_exact(&mut byte).map_err(|error| super::ended(error, Format::Hdr))?;
        Ok(byte[0])
    };
    for component in 0..4 {
        let mut x = 0;
        while x < row.len() {
            let code = byte()?;
            let run = code > 128;
            let count = usize::from(if run { code - 128 } else { code });
            let Some(part) = row.get_mut(x..x + count).filter(|_| count > 0) else {
                return Err(malformed("a run beyond its row"));
            };
            let mut value = if run { byte()? } else { 0 };
            for pixel in part {
                if !run {
                    value = byte()?;
                }
                pixel[component] = value;
            }
            x += count;
        }
    }
    Ok(())
}

fn malformed(what: &str) -> PictureError {
    PictureError::Decode(Format::Hdr, format!("it has {what}").into())
}
