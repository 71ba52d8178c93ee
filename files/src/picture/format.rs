//! Which format a file has, told by its first bytes; also of those that are only named.

use std::fmt;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::Path;

use super::PictureError;
use super::source::Source;

/// What to do with light that is no picture yet.
pub(super) const DEVELOP: &str = "develop it to TIFF, PNG or JPEG first";

/// The bytes at a file's start that are looked at: a drawing may begin with a comment.
const START: usize = 4096;

/// The formats read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Png,
    Jpeg,
    Tiff,
    Hdr,
    OpenExr,
    WebP,
    Gif,
    Bmp,
    Pnm,
    Pfm,
    Tga,
    Qoi,
    Farbfeld,
}

impl Format {
    /// The format of a file that begins with `start`.
    pub(super) fn of(start: &[u8]) -> Option<Self> {
        const SIGNATURES: [(&[u8], Format); 12] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"II*\0", Format::Tiff),
            (b"MM\0*", Format::Tiff),
            (b"II+\0", Format::Tiff),
            (b"MM\0+", Format::Tiff),
            (b"\x76\x2f\x31\x01", Format::OpenExr),
            (b"GIF87a", Format::Gif),
            (b"GIF89a", Format::Gif),
            (b"BM", Format::Bmp),
            (b"qoif", Format::Qoi),
            (b"farbfeld", Format::Farbfeld),
        ];
        let known = SIGNATURES.iter().find(|(signature, _)| start.starts_with(signature));
        if let Some(&(_, format)) = known {
            return Some(format);
        }
        match start {
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(Self::WebP),
            [b'#', b'?', name, ..] if name.is_ascii_alphabetic() => Some(Self::Hdr),
            [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace() => Some(Self::Pfm),
            [b'P', b'1'..=b'7', after, ..] if after.is_ascii_whitespace() || *after == b'#' => {
                Some(Self::Pnm)
            }
            _ => None,
        }
    }

    /// The format of `source`, which is left at its start. Targa files have no signature: a header that makes
    /// sense tells them, with a footer, the ending of the name, or just as many bytes as it asks for.
    pub(super) fn detect(source: &mut Source, path: &Path) -> Result<Self, PictureError> {
        let mut start = Vec::with_capacity(START);
        source.by_ref().take(START as u64).read_to_end(&mut start)?;
        let found = match Self::of(&start) {
            Some(format) => Some(format),
            None => match foreign(&start) {
                Some((name, advice)) => return Err(PictureError::Foreign { name, advice }),
                None => (plausible_targa(&start)
                    && (named_targa(path)
                        || footed_targa(source)?
                        || as_long_as_targa(source, &start)?))
                .then_some(Self::Tga),
            },
        };
        source.rewind()?;
        found.ok_or(PictureError::UnknownFormat)
    }
}

/// A name on standard input tells nothing.
fn named_targa(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| {
        ["tga", "icb", "vda", "vst", "targa"]
            .iter()
            .any(|name| extension.eq_ignore_ascii_case(name))
    })
}

fn footed_targa(source: &mut Source) -> Result<bool, PictureError> {
    const FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";
    let end = source.seek(SeekFrom::End(0))?;
    let Some(place) = end.checked_sub(FOOTER.len() as u64) else { return Ok(false) };
    source.seek(SeekFrom::Start(place))?;
    let mut footer = Vec::with_capacity(FOOTER.len());
    source.by_ref().take(FOOTER.len() as u64).read_to_end(&mut footer)?;
    Ok(footer == FOOTER)
}

/// Whether the file is as long as this header says, of pixels that are not run-length encoded; of others, whether
/// it it holds just as many runs as make the picture.
fn as_long_as_targa(source: &mut Source, start: &[u8]) -> Result<bool, PictureError> {
    let Some(header) = start.get(..18) else { return Ok(false) };
    let short = |at: usize| u64::from(u16::from_le_bytes([header[at], header[at + 1]]));
    let map = short(5) * u64::from(header[7]).div_ceil(8) * u64::from(header[1] & 1);
    let pixel = u64::from(header[16]).div_ceil(8);
    let pixels = short(12) * short(14);
    let begin = 18 + u64::from(header[0]) + map;
    let end = source.seek(SeekFrom::End(0))?;
    if header[2] < 8 {
        return Ok(begin + pixels * pixel == end);
    }
    source.seek(SeekFrom::Start(begin))?;
    let mut rest = pixels;
    while rest > 0 {
        let mut code = [0];
        if source.read_exact(&mut code).is_err() {
            return Ok(false);
        }
        let count = u64::from(code[0] & 127) + 1;
        let values = if code[0] < 128 { count } else { 1 };
        let skipped = io::copy(&mut source.by_ref().take(values * pixel), &mut io::sink())?;
        if count > rest || skipped < values * pixel {
            return Ok(false);
        }
        rest -= count;
    }
    Ok(source.stream_position()? == end)
}

/// Whether `start` reads as the header of a Targa file.
fn plausible_targa(start: &[u8]) -> bool {
    let Some(header) = start.get(..18) else { return false };
    let kind = matches!((header[1], header[2]), (0 | 1, 2 | 3 | 10 | 11) | (1, 1 | 9));
    kind && matches!(header[16], 8 | 15 | 16 | 24 | 32)
        && header[12..14] != [0, 0]
        && header[14..16] != [0, 0]
}

/// The name of a format that is not read, with what its owner can do.
fn foreign(start: &[u8]) -> Option<(&'static str, &'static str)> {
    const CONVERT: &str = "save it as PNG or JPEG first";
    const ONE: &str = "save one picture of it as PNG first";
    const UNPACK: &str = "unpack it first";
    const RENDER: &str = "render it to PNG first";
    if start.get(4..8) == Some(b"ftyp") {
        // The major brand, and after four bytes of version the compatible ones.
        let brands = || start[8..].as_chunks::<4>().0.iter();
        let any = |names: &[&[u8; 4]]| brands().any(|brand| names.contains(&brand));
        return Some(match () {
            () if any(&[b"crx "]) => ("a Canon raw (CR3)", DEVELOP),
            () if any(&[b"jxl "]) => ("a JPEG XL", CONVERT),
            () if any(&[b"avif", b"avis"]) => ("an AVIF", CONVERT),
            () if any(&[b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1"]) => {
                ("a HEIC", "export it as JPEG or PNG first")
            }
            () => ("a video or another ISO media", ONE),
        });
    }
    let signatures: [(&[u8], &str, &str); 40] = [
        (b"\xff\x0a", "a JPEG XL", CONVERT),
        (b"\0\0\0\x0cJXL \r\n\x87\n", "a JPEG XL", CONVERT),
        (b"\0\0\0\x0cjP  \r\n\x87\n", "a JPEG 2000", CONVERT),
        (b"\xff\x4f\xff\x51", "a JPEG 2000", CONVERT),
        (b"8BPS", "a Photoshop", CONVERT),
        (b"%PDF", "a PDF", RENDER),
        (b"%!PS", "a PostScript", RENDER),
        (b"gimp xcf", "a GIMP", CONVERT),
        (b"DDS ", "a DirectDraw surface", CONVERT),
        (b"\0\0\x01\0", "an icon", CONVERT),
        (b"FUJIFILMCCD-RAW", "a Fujifilm raw (RAF)", DEVELOP),
        (b"IIRO", "an Olympus raw (ORF)", DEVELOP),
        (b"IIRS", "an Olympus raw (ORF)", DEVELOP),
        (b"MMOR", "an Olympus raw (ORF)", DEVELOP),
        (b"IIU\0", "a Panasonic raw (RW2)", DEVELOP),
        (b"II\x1a\0\0\0HEAPCCDR", "a Canon raw (CRW)", DEVELOP),
        (b"\0MRM", "a Minolta raw (MRW)", DEVELOP),
        (b"FOVb", "a Sigma raw (X3F)", DEVELOP),
        (b"II\xbc\x01", "a JPEG XR", CONVERT),
        (b"\x8aMNG", "an MNG", ONE),
        (b"\x8bJNG", "a JNG", CONVERT),
        (b"SDPX", "a DPX", CONVERT),
        (b"XPDS", "a DPX", CONVERT),
        (b"\x80\x2a\x5f\xd7", "a Cineon", CONVERT),
        (b"\x01\xda", "an SGI", CONVERT),
        (b"\x59\xa6\x6a\x95", "a Sun raster", CONVERT),
        (b"SIMPLE  =", "a FITS", CONVERT),
        (b"/* XPM */", "an XPM", CONVERT),
        (b"#define ", "an XBM", CONVERT),
        (b"id=ImageMagick", "an ImageMagick (MIFF)", CONVERT),
        (b"AT&TFORM", "a DjVu", CONVERT),
        (b"icns", "an Apple icon", CONVERT),
        (b"\xd7\xcd\xc6\x9a", "a Windows metafile", RENDER),
        (b"\x1f\x8b", "a gzip", UNPACK),
        (b"PK\x03\x04", "a zip", UNPACK),
        (b"BZh", "a bzip2", UNPACK),
        (b"\xfd7zXZ\0", "an xz", UNPACK),
        (b"\x28\xb5\x2f\xfd", "a Zstandard", UNPACK),
        (b"\x1a\x45\xdf\xa3", "a Matroska or WebM video", ONE),
        (b"BPG\xfb", "a BPG", CONVERT),
    ];
    let known = signatures.iter().find(|(signature, ..)| start.starts_with(signature));
    if let Some(&(_, name, advice)) = known {
        return Some((name, advice));
    }
    match start {
        [b'R', b'I', b'F', b'F', _, _, _, _, b'A', b'V', b'I', ..] => return Some(("an AVI", ONE)),
        [10, 0 | 2..=5, 1, 1 | 2 | 4 | 8, ..] => return Some(("a PCX", CONVERT)),
        _ => {}
    }
    let text = String::from_utf8_lossy(start);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let begins = ["<svg", "<?xml", "<!--", "<!DOCTYPE svg"].iter().any(|tag| text.starts_with(tag));
    let drawing = begins && text.contains("<svg");
    drawing.then_some(("an SVG", RENDER))
}

impl fmt::Display for Format {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Tiff => "TIFF",
            Self::Hdr => "Radiance HDR",
            Self::OpenExr => "OpenEXR",
            Self::WebP => "WebP",
            Self::Gif => "GIF",
            Self::Bmp => "BMP",
            Self::Pnm => "PNM",
            Self::Pfm => "PFM",
            Self::Tga => "Targa",
            Self::Qoi => "QOI",
            Self::Farbfeld => "farbfeld",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_their_first_bytes() {
        assert_eq!(Format::of(b"\x89PNG\r\n\x1a\n...."), Some(Format::Png));
        assert_eq!(Format::of(b"#?RGBE\n"), Some(Format::Hdr));
        assert_eq!(Format::of(b"MM\0*"), Some(Format::Tiff));
        assert_eq!(Format::of(b"P5 1 1 255"), Some(Format::Pnm));
        assert_eq!(Format::of(b"RIFF....WEBPVP8 "), Some(Format::WebP));
        for none in [&b""[..], b"\x89PN", b"GIF", b"P8 1 1 255", b"RIFF....WAVE"] {
            assert_eq!(Format::of(none), None);
        }
    }

    #[test]
    fn formats_that_are_not_read_have_names() {
        for (start, name) in [
            (&b"\0\0\0\x1cftypheic\0\0\0\0mif1heic"[..], "HEIC"),
            (b"\0\0\0\x1cftypmif1\0\0\0\0avifmif1", "AVIF"),
            (b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom", "CR3"),
            (b"\xff\x0a\0\0", "JPEG XL"),
            (b"8BPS\0\x01", "Photoshop"),
            (b"<?xml version='1.0'?>\n<svg xmlns=''>", "SVG"),
            (b"%PDF-1.7", "PDF"),
        ] {
            assert!(foreign(start).unwrap().0.contains(name), "{name}");
        }
        assert!(foreign(b"plain text").is_none());
    }
}
