//! What Exif data say of a picture: a TIFF directory in memory, of either byte order.

use image::metadata::Orientation;

const ORIENTATION: u16 = 0x112;

/// A TIFF structure in memory.
pub(super) struct Directory<'a> {
    bytes: &'a [u8],
    big_endian: bool,
}

impl<'a> Directory<'a> {
    /// The structure that begins with `bytes`, if one does; a leading `Exif\0\0` is skipped.
    pub(super) fn new(bytes: &'a [u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(b"Exif\0\0").unwrap_or(bytes);
        let big_endian = match bytes.get(..4)? {
            b"II*\0" => false,
            b"MM\0*" => true,
            _ => return None,
        };
        Some(Self { bytes, big_endian })
    }

    pub(super) fn short(&self, at: usize) -> Option<u16> {
        let bytes = self.bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if self.big_endian { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    pub(super) fn long(&self, at: usize) -> Option<u32> {
        let bytes = self.bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// The number in the entry `tag` of the first directory, whatever integer type it has.
    fn number(&self, tag: u16) -> Option<u32> {
        const BYTE: u16 = 1;
        const SHORT: u16 = 3;
        const LONG: u16 = 4;
        let start = self.long(4)? as usize;
        let entries = usize::from(self.short(start)?);
        let entry = (0..entries)
            .map(|index| start.saturating_add(2 + 12 * index))
            .find(|&entry| self.short(entry) == Some(tag))?;
        // An array lies elsewhere, unless it fits the four bytes; its first element will do.
        let count = self.long(entry + 4)? as usize;
        let kind = self.short(entry + 2)?;
        let size = match kind {
            BYTE | 6 | 7 => 1,
            SHORT | 8 => 2,
            LONG | 9 | 13 => 4,
            _ => return None,
        };
        let place = match count {
            0 => return None,
            _ if count.saturating_mul(size) <= 4 => entry + 8,
            _ => self.long(entry + 8)? as usize,
        };
        match size {
            1 => self.bytes.get(place).map(|&byte| u32::from(byte)),
            2 => self.short(place).map(u32::from),
            _ => self.long(place),
        }
    }
}

/// How a picture with these Exif data is to be turned; upright if they do not say.
pub(super) fn orientation(exif: &[u8]) -> Orientation {
    Directory::new(exif)
        .and_then(|directory| directory.number(ORIENTATION))
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

    #[test]
    fn the_orientation_is_found_in_every_integer_type_and_byte_order() {
        for big_endian in [false, true] {
            for kind in [1, 3, 4] {
                for value in 1..=8 {
                    let bytes = exif(big_endian, kind, value, 8);
                    let expected = Orientation::from_exif(value as u8).unwrap();
                    assert_eq!(orientation(&bytes), expected);
                    assert_eq!(orientation(&[b"Exif\0\0", &bytes[..]].concat()), expected);
                }
            }
        }
    }

    #[test]
    fn broken_exif_data_turn_nothing() {
        let whole = exif(true, 3, 6, 8);
        for bytes in [exif(true, 4, 0, 8), exif(false, 4, 99, 8), exif(false, 3, 6, u32::MAX)] {
            assert_eq!(orientation(&bytes), Orientation::NoTransforms);
        }
        for end in 0..whole.len() - 8 {
            assert_eq!(orientation(&whole[..end]), Orientation::NoTransforms);
        }
    }
}
