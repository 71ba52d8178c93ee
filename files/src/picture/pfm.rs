//! Portable float maps: gray or color, from the bottom row up, of either byte order.

use std::io::{BufRead as _, Read as _};

use image::metadata::Orientation;

use super::color::Space;
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, limits};

/// Longest number in a header.
const LONGEST: usize = 64;

/// Reads a PFM file.
pub(super) fn read<P: Pixel>(
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let malformed = || PictureError::Decode(Format::Pfm, "the header is malformed".into());
    let colors = match word(&mut source)?.as_str() {
        "PF" => Colors::Rgb,
        "Pf" => Colors::Gray,
        _ => return Err(malformed()),
    };
    let width: usize = word(&mut source)?.parse().map_err(|_| malformed())?;
    let height: usize = word(&mut source)?.parse().map_err(|_| malformed())?;
    let scale: f64 = word(&mut source)?.parse().map_err(|_| malformed())?;
    if !scale.is_finite() || scale == 0.0 {
        return Err(malformed());
    }
    limits::check(width, height, size_of::<P>())?;
    let toner = Toner::new::<f32>(wanted.tone, colors, Alpha::None, Space::default());
    let mut plane = Plane::new((width, height), Orientation::FlipVertical, P::NOTHING)?;
    let mut row = vec![0; width * colors.count() * 4];
    let mut samples = vec![0f32; width * colors.count()];
    for y in 0..height {
        source.read_exact(&mut row).map_err(|error| super::ended(error, Format::Pfm))?;
        for (sample, &bytes) in samples.iter_mut().zip(row.as_chunks::<4>().0) {
            // A negative scale says that the least byte comes first.
            *sample =
                if scale < 0.0 { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) };
        }
        for (x, pixel) in samples.chunks_exact(colors.count()).enumerate() {
            plane.set(x, y, P::of(&toner, pixel));
        }
    }
    plane.finish(Some(&toner))
}

/// The next word of a header, with the one space after it.
fn word(source: &mut Source) -> Result<String, PictureError> {
    let mut word = String::new();
    loop {
        let Some(&byte) = source.fill_buf()?.first() else {
            return Err(PictureError::Truncated(Format::Pfm));
        };
        source.consume(1);
        match byte {
            _ if byte.is_ascii_whitespace() && word.is_empty() => {}
            _ if byte.is_ascii_whitespace() => return Ok(word),
            _ if word.len() < LONGEST => word.push(char::from(byte)),
            _ => return Err(PictureError::Decode(Format::Pfm, "the header is malformed".into())),
        }
    }
}
