//! What Exif data say of a picture: a TIFF directory in memory.

use std::io::Cursor;

use image::metadata::Orientation;

use super::directory::{Directory, Form};

const ORIENTATION: u16 = 0x112;

/// How a picture with these Exif data is to be turned; upright if they do not say. Data that are none are a
/// warning.
pub(super) fn orientation(exif: &[u8], warnings: &mut Vec<String>) -> Orientation {
    // Some writers keep what JPEG puts before.
    let mut exif = Cursor::new(exif.strip_prefix(b"Exif\0\0").unwrap_or(exif));
    let directory =
        Form::read(&mut exif).and_then(|(form, first)| Directory::read(&mut exif, form, first));
    let Some(directory) = directory else {
        warnings.push("its Exif data are malformed, so that it is taken as upright".to_owned());
        return Orientation::NoTransforms;
    };
    directory
        .number(&mut exif, ORIENTATION)
        .and_then(|number| Orientation::from_exif(u8::try_from(number).ok()?))
        .unwrap_or(Orientation::NoTransforms)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exif data with one entry before and the orientation in this type.
    fn exif(big_endian: bool, kind: u16, value: u32, offset: u32) -> Vec<u8> {
        let short = |n: u16| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let long = |n: u32| if big_endian { n.to_be_bytes() } else { n.to_le_bytes() };
        let mut bytes = if big_endian { b"MM\0*".to_vec() } else { b"II*\0".to_vec() };
        bytes.extend(long(offset));
        bytes.extend(short(2));
        for (tag, kind, value) in [(0x100, 4, 77), (ORIENTATION, kind, value)] {
            bytes.extend(short(tag));
            bytes.extend(short(kind));
            bytes.extend(long(1));
            match kind {
                1 => bytes.extend([value as u8, 0, 0, 0]),
                3 => bytes.extend([short(value as u16), [0; 2]].concat()),
                _ => bytes.extend(long(value)),
            }
        }
        bytes.extend([0; 4]);
        bytes
    }

    fn upright(exif: &[u8]) -> Orientation {
        orientation(exif, &mut Vec::new())
    }

    #[test]
    fn the_orientation_is_found_in_every_integer_type_and_byte_order() {
        for big_endian in [false, true] {
            for kind in [1, 3, 4] {
                for value in 1..=8 {
                    let bytes = exif(big_endian, kind, value, 8);
                    let expected = Orientation::from_exif(value as u8).unwrap();
                    assert_eq!(upright(&bytes), expected);
                    assert_eq!(upright(&[b"Exif\0\0", &bytes[..]].concat()), expected);
                }
            }
        }
    }

    #[test]
    fn broken_exif_data_turn_nothing() {
        let whole = exif(true, 3, 6, 8);
        for bytes in [exif(true, 4, 0, 8), exif(false, 4, 99, 8), exif(false, 3, 6, u32::MAX)] {
            assert_eq!(upright(&bytes), Orientation::NoTransforms);
        }
        let mut warnings = Vec::new();
        orientation(b"not Exif", &mut warnings);
        assert!(warnings[0].contains("malformed"));
        for end in 0..whole.len() - 8 {
            assert_eq!(upright(&whole[..end]), Orientation::NoTransforms);
        }
    }
}
