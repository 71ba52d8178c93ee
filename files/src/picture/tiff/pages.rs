//! Which of a TIFF file's pictures is shown, and whether they are pictures yet.

use std::io::{Read as _, Seek as _, SeekFrom};

use super::super::directory::{Directory, Form};
use super::super::source::Source;
use super::{PictureError, unsupported};
use crate::picture::format::DEVELOP;

/// Pictures looked at, and those within one of them.
const MOST_PAGES: usize = 1000;
const MOST_PARTS: usize = 16;

/// `NewSubfileType` bits of a picture that is a smaller version of another, and of one that is a mask;
/// `SubfileType`'s number for the former.
const REDUCED: u64 = 1;
const MASK: u64 = 4;
const OLD_REDUCED: u64 = 2;

const SUBFILE_TYPE: u16 = 255;
const NEW_SUBFILE_TYPE: u16 = 254;
const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const COMPRESSION: u16 = 259;
const PHOTOMETRIC: u16 = 262;
const MAKE: u16 = 271;
const PARTS: u16 = 330;
const DNG_VERSION: u16 = 50706;

/// Photometric interpretations of light behind a filter of colors, and of light of a camera's own colors.
const FILTERED: [u64; 2] = [32803, 34892];

/// How cameras of Sony, Nikon and Pentax press what lies behind the filter.
const PRESSED: [u64; 3] = [32767, 34713, 65535];

/// Finds the largest picture that is not marked as a smaller version of another or as a mask; `None` if the
/// first one cannot be read.
///
/// # Errors
/// [`PictureError::Foreign`] for files of cameras.
pub(super) fn choose(source: &mut Source) -> Result<Option<Directory>, PictureError> {
    let Some((form, first)) = Form::read(source) else { return Ok(None) };
    let mut offset = first;
    let mut best: Option<(u64, Directory)> = None;
    let mut fallback = None;
    let (mut seen, mut count) = (Vec::new(), 0);
    while offset != 0 && seen.len() < MOST_PAGES && !seen.contains(&offset) {
        seen.push(offset);
        // A picture that cannot be read ends the list; those before it can be shown.
        let Some(page) = Directory::read(source, form, offset) else { break };
        offset = page.next;
        let parts = page.numbers(source, PARTS, MOST_PARTS);
        let parts: Vec<_> =
            parts.iter().filter_map(|&offset| Directory::read(source, form, offset)).collect();
        for page in std::iter::once(page).chain(parts) {
            if let Some(name) = raw(source, &page) {
                return Err(PictureError::Foreign { name, advice: DEVELOP });
            }
            count += 1;
            let part =
                page.number(source, NEW_SUBFILE_TYPE).is_some_and(|b| b & (REDUCED | MASK) != 0)
                    || page.number(source, SUBFILE_TYPE) == Some(OLD_REDUCED);
            let sides = [WIDTH, HEIGHT].map(|tag| page.number(source, tag).unwrap_or(0));
            let area = sides[0].saturating_mul(sides[1]);
            if part {
                fallback.get_or_insert(page);
            } else if area > 0 && best.as_ref().is_none_or(|&(most, _)| area > most) {
                best = Some((area, page));
            }
        }
    }
    match best {
        Some((_, page)) => Ok(Some(page)),
        None if count > 1 => Err(unsupported("files of nothing but thumbnails and masks")),
        None => Ok(fallback),
    }
}

/// The name of a camera's file, if this picture is of one.
fn raw(source: &mut Source, page: &Directory) -> Option<&'static str> {
    if page.entry(DNG_VERSION).is_some() {
        return Some("a DNG");
    }
    let of = |source: &mut Source, tag| page.number(source, tag).unwrap_or(0);
    if !FILTERED.contains(&of(source, PHOTOMETRIC)) && !PRESSED.contains(&of(source, COMPRESSION)) {
        return canon(source).then_some("a Canon raw (CR2)");
    }
    let make = page.numbers(source, MAKE, 8).into_iter().map(|byte| byte as u8);
    let make: String = make.map(|byte| char::from(byte.to_ascii_lowercase())).collect();
    let names = [
        ("nikon", "a Nikon raw (NEF)"),
        ("sony", "a Sony raw (ARW)"),
        ("pentax", "a Pentax raw (PEF)"),
        ("ricoh", "a Pentax raw (PEF)"),
        ("samsung", "a Samsung raw (SRW)"),
        ("hasselbl", "a Hasselblad raw (3FR)"),
    ];
    let known = names.iter().find(|(start, _)| make.starts_with(start));
    Some(known.map_or("a camera's raw", |&(_, name)| name))
}

/// Whether Canon's mark follows the header.
fn canon(source: &mut Source) -> bool {
    let mut mark = [0; 2];
    let found = source.seek(SeekFrom::Start(8)).and_then(|_| source.read_exact(&mut mark));
    found.is_ok() && &mark == b"CR"
}
