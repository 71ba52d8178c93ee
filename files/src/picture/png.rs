//! PNG: 1 to 16 bits, gray, color or palette, with the colors that its chunks say.

use std::io::{Cursor, Read as _, Seek as _, SeekFrom};

use image::metadata::Orientation;
use png::{BitDepth, ColorType, DecodingError, Info, Transformations};

use super::color::{self, Space};
use super::paint::{paint, warned};
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, cicp, exif, limits};

/// Longest chunk beside the pixels whose checksum is looked at.
const LONGEST: u32 = 1 << 20;

/// Chunks that say something of the pixels.
const SAID: [&[u8; 4]; 6] = [b"cICP", b"iCCP", b"sRGB", b"gAMA", b"cHRM", b"pHYs"];

const END_CHUNK: &[u8] = b"\0\0\0\0IEND\xaeB`\x82";

/// Reads a PNG file; of an animation, the picture that programs without animation show.
pub(super) fn read<P: Pixel>(
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let mut chunks = Chunks::scan(&mut source)?;
    if !chunks.ended {
        // The decoder gives no row out before it has seen what follows the pixels.
        let mut bytes = source.into_bytes()?;
        bytes.truncate(usize::try_from(chunks.end).unwrap_or(usize::MAX));
        bytes.extend(END_CHUNK);
        source = Source::Memory(Cursor::new(bytes));
    }
    source.rewind()?;
    let first = match read_chunks(&mut source, &chunks, wanted) {
        Err(error) if !chunks.ended && matches!(error, PictureError::Decode(..)) => {
            return Err(PictureError::Truncated(Format::Png));
        }
        Err(error @ (PictureError::Decode(..) | PictureError::Io(_))) => error,
        result => return result,
    };
    // What is wrong may be a chunk that is not needed.
    let bytes = source.into_bytes()?;
    chunks.seen.clear();
    for transparency in [true, false] {
        let needed =
            |name: &[u8; 4]| name[0].is_ascii_uppercase() || transparency && name == b"tRNS";
        let mut source = Source::Memory(Cursor::new(only(&bytes, needed)));
        if let Ok(mut picture) = read_chunks(&mut source, &chunks, wanted) {
            let what = if transparency { "" } else { ", transparency among them" };
            picture.warnings.push(format!(
                "it is read without the chunks that are not needed{what}, for it is damaged ({})",
                first.reason()
            ));
            return Ok(picture);
        }
    }
    Err(first)
}

/// Reads a file that has been looked at.
fn read_chunks<P: Pixel>(
    source: &mut Source,
    chunks: &Chunks,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let mut decoder =
        png::Decoder::new_with_limits(source, png::Limits { bytes: limits::MEMORY_LIMIT as usize });
    decoder.set_ignore_text_chunk(true);
    // As for one with tRNS and PLTE chunks: samples of 8 or 16 bits that say what they are.
    decoder.set_transformations(Transformations::EXPAND);
    // The decoder begins with buffers for a row, and says of a row too long only that it is.
    let header = decoder.read_header_info().map_err(failure)?;
    let bytes = header.bits_per_pixel().div_ceil(8) + size_of::<P>() - size_of::<f32>();
    limits::check(header.width as usize, header.height as usize, bytes)?;
    let mut reader = decoder.read_info().map_err(failure)?;

    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let (color, depth) = reader.output_color_type();
    let channels = color.samples();
    let bytes = channels * if depth == BitDepth::Sixteen { 2 } else { 1 };
    limits::check(width, height, bytes + size_of::<P>() - size_of::<f32>())?;
    let length = reader.output_buffer_size().unwrap_or(usize::MAX);
    let mut buffer = Vec::new();
    buffer.try_reserve_exact(length).map_err(|_| limits::too_large(width, height, bytes))?;
    buffer.resize(length, 0);
    reader.next_frame(&mut buffer).map_err(failure)?;

    let gray = matches!(color, ColorType::Grayscale | ColorType::GrayscaleAlpha);
    let colors = if gray { Colors::Gray } else { Colors::Rgb };
    let transparent = matches!(color, ColorType::GrayscaleAlpha | ColorType::Rgba);
    let alpha = if transparent { Alpha::Straight } else { Alpha::None };
    let mut warnings = Vec::new();
    let space = space(reader.info(), chunks, colors, &mut warnings);
    let orientation = match &chunks.exif {
        Some(exif) => exif::orientation(exif, &mut warnings),
        None => Orientation::NoTransforms,
    };
    let mut plane = Plane::new((width, height), orientation, P::NOTHING)?;
    match reader.info().pixel_dims {
        Some(size) => plane.set_aspect(f64::from(size.yppu) / f64::from(size.xppu)),
        None if chunks.seen.contains(b"pHYs") => warnings.push(malformed("pHYs")),
        None => {}
    }
    if !chunks.ended {
        warnings.push("it has no end chunk, but all its pixels".to_owned());
    }
    if let Some(name) = &chunks.damaged {
        let name = String::from_utf8_lossy(name).into_owned();
        warnings.push(format!("its chunk {name} is damaged"));
    }
    plane.warn(warnings);
    if depth == BitDepth::Sixteen {
        let toner = Toner::new::<u16>(wanted.tone, colors, alpha, space);
        paint(&mut plane, width, &toner, &buffer, u16::from_be_bytes);
        plane.finish(Some(&toner))
    } else {
        let toner = Toner::new::<u8>(wanted.tone, colors, alpha, space);
        paint(&mut plane, width, &toner, &buffer, |[byte]| byte);
        plane.finish(Some(&toner))
    }
}

/// The colors that the chunks say, the best-known first.
fn space(info: &Info<'_>, chunks: &Chunks, colors: Colors, warnings: &mut Vec<String>) -> Space {
    let gamma = info.gama_chunk.map(|gamma| f64::from(gamma.into_scaled()) / 1e5);
    let gamma = gamma.filter(|gamma| (0.01..=100.0).contains(gamma));
    let primaries = info.chrm_chunk.map(|points| {
        [points.white, points.red, points.green, points.blue]
            .map(|(x, y)| [x, y].map(|value| f64::from(value.into_scaled()) / 1e5))
    });
    let primaries = primaries.filter(|primaries| color::luminance(primaries).is_some());
    for (name, found) in [
        (b"cICP", info.coding_independent_code_points.is_some()),
        (b"iCCP", info.icc_profile.is_some()),
        (b"sRGB", info.srgb.is_some()),
        (b"gAMA", gamma.is_some()),
        (b"cHRM", primaries.is_some()),
    ] {
        if chunks.seen.contains(name) && !found {
            warnings.push(malformed(&String::from_utf8_lossy(name)));
        }
    }
    if let Some(points) = info.coding_independent_code_points {
        let found = cicp::space(
            points.color_primaries,
            points.transfer_function,
            points.is_video_full_range_image,
        );
        return warned("its cICP chunk", found, warnings);
    }
    if let Some(profile) = &info.icc_profile {
        let found = color::profile(profile, colors.count());
        return warned("its color profile", found, warnings);
    }
    if info.srgb.is_some() {
        return Space::default();
    }
    let space = match gamma {
        // What writers of sRGB give, by that chunk's own definition.
        Some(gamma) if (gamma - 0.45455).abs() > 0.0005 => Space::of_curve(color::power(gamma)),
        _ => Space::default(),
    };
    match primaries {
        Some(primaries) if colors == Colors::Rgb => {
            space.with_primaries(&primaries).curved_if_mixed()
        }
        _ => space,
    }
}

fn malformed(name: &str) -> String {
    let assumed =
        if name == "iCCP" { "; sRGB is assumed where no other chunk says more" } else { "" };
    format!("its chunk {name} is malformed and passed over{assumed}")
}

/// The signature and the chunks whose names are needed.
fn only(bytes: &[u8], needed: impl Fn(&[u8; 4]) -> bool) -> Vec<u8> {
    let (signature, mut rest) = bytes.split_at_checked(8).unwrap_or((bytes, &[]));
    let mut kept = signature.to_vec();
    while let [a, b, c, d, e, f, g, h, ..] = *rest {
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let (chunk, after) = rest.split_at_checked(12 + length).unwrap_or((rest, &[]));
        if needed(&[e, f, g, h]) {
            kept.extend(chunk);
        }
        rest = after;
    }
    kept
}

/// What the decoder does not tell of a file's chunks.
#[derive(Default)]
struct Chunks {
    /// The Exif data.
    exif: Option<Vec<u8>>,
    /// Which of [`SAID`] are there and whole.
    seen: Vec<[u8; 4]>,
    ended: bool,
    /// Where the last whole chunk ends.
    end: u64,
    /// The name of one with a wrong checksum that is not needed.
    damaged: Option<[u8; 4]>,
}

impl Chunks {
    fn scan(source: &mut Source) -> Result<Self, PictureError> {
        let mut found = Self::default();
        let mut place = 8;
        loop {
            found.end = place;
            source.seek(SeekFrom::Start(place))?;
            let mut head = Vec::with_capacity(8);
            source.by_ref().take(8).read_to_end(&mut head)?;
            let &[a, b, c, d, ref name @ ..] = &head[..] else { return Ok(found) };
            let Ok(name) = <[u8; 4]>::try_from(name) else { return Ok(found) };
            let length = u32::from_be_bytes([a, b, c, d]);
            if &name == b"IEND" {
                found.ended = true;
                return Ok(found);
            }
            let needed = name[0].is_ascii_uppercase();
            if !needed && length <= LONGEST {
                let mut body = Vec::new();
                source.by_ref().take(u64::from(length) + 4).read_to_end(&mut body)?;
                if let Some((data, sum)) = body.split_at_checked(length as usize) {
                    let mut hasher = crc32fast::Hasher::new();
                    hasher.update(&name);
                    hasher.update(data);
                    let whole = hasher.finalize().to_be_bytes() == sum;
                    if !whole {
                        found.damaged = Some(name);
                    } else if &name == b"eXIf" {
                        found.exif = Some(data.to_vec());
                    } else if SAID.contains(&&name) && !found.seen.contains(&name) {
                        found.seen.push(name);
                    }
                }
            }
            place += 12 + u64::from(length);
        }
    }
}

fn failure(error: DecodingError) -> PictureError {
    match error {
        DecodingError::IoError(error) => super::ended(error, Format::Png),
        DecodingError::Format(error) => {
            let reason = error.to_string();
            // What the decoder says of a file that ends early.
            if reason.contains("Unexpected end of data") || reason.contains("unexpected end") {
                return PictureError::Truncated(Format::Png);
            }
            PictureError::Decode(Format::Png, reason.into())
        }
        error => PictureError::Decode(Format::Png, Box::new(error)),
    }
}
