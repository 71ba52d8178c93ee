//! TIFF directories, of TIFF files and of Exif data: numbered entries, of either byte order, with offsets
//! of 32 or of 64 bits.

use std::io::{self, Read, Seek, SeekFrom};

/// Entries looked at in a directory.
const MOST_ENTRIES: u64 = 4096;

/// How a structure writes its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Form {
    big_endian: bool,
    /// Whether offsets have 64 bits.
    pub(super) long: bool,
}

impl Form {
    /// The form of a structure, with the offset of its first directory; `None` if it is none.
    pub(super) fn read(source: &mut (impl Read + Seek)) -> Option<(Self, u64)> {
        source.seek(SeekFrom::Start(0)).ok()?;
        let start: [u8; 4] = bytes(source).ok()?;
        let (big_endian, long) = match &start {
            b"II*\0" => (false, false),
            b"MM\0*" => (true, false),
            b"II+\0" => (false, true),
            b"MM\0+" => (true, true),
            _ => return None,
        };
        let form = Self { big_endian, long };
        // The longer header says that its offsets have eight bytes.
        if long && form.number(&bytes::<4>(source).ok()?) != if big_endian { 8 << 16 } else { 8 } {
            return None;
        }
        let offset = form.offset(source).ok()?;
        Some((form, offset))
    }

    /// The place of the offset of the first directory.
    pub(super) fn first(self) -> u64 {
        if self.long { 8 } else { 4 }
    }

    /// The bytes of an offset, or of a count.
    pub(super) fn word(self, value: u64) -> Vec<u8> {
        self.stored(value, if self.long { 8 } else { 4 })
    }

    /// A number of so many bytes.
    pub(super) fn stored(self, value: u64, size: usize) -> Vec<u8> {
        if self.big_endian {
            value.to_be_bytes()[8 - size..].to_vec()
        } else {
            value.to_le_bytes()[..size].to_vec()
        }
    }

    /// The number that up to eight bytes hold.
    fn number(self, bytes: &[u8]) -> u64 {
        let digit = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        if self.big_endian {
            bytes.iter().fold(0, digit)
        } else {
            bytes.iter().rev().fold(0, digit)
        }
    }

    fn offset(self, source: &mut impl Read) -> io::Result<u64> {
        if self.long {
            Ok(self.number(&bytes::<8>(source)?))
        } else {
            Ok(self.number(&bytes::<4>(source)?))
        }
    }
}

/// An entry of a directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) tag: u16,
    kind: u16,
    count: u64,
    /// Where the entry lies.
    pub(super) place: u64,
    /// Where its first value lies.
    value: u64,
}

impl Entry {
    /// Bytes of a value; `None` for what holds no unsigned integers.
    fn size(&self) -> Option<usize> {
        match self.kind {
            1 | 2 | 6 | 7 => Some(1),
            3 | 8 => Some(2),
            4 | 9 | 13 => Some(4),
            16..=18 => Some(8),
            _ => None,
        }
    }
}

/// A directory: what is said of one picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Directory {
    pub(super) form: Form,
    pub(super) offset: u64,
    pub(super) entries: Vec<Entry>,
    /// Where the next directory lies; 0 if this is the last.
    pub(super) next: u64,
}

impl Directory {
    /// Where the first directory lies.
    pub(super) fn first(source: &mut (impl Read + Seek)) -> Option<u64> {
        Form::read(source).map(|(_, offset)| offset)
    }

    /// The directory at `offset`, as far as it is there; `None` if nothing of it is.
    pub(super) fn read(source: &mut (impl Read + Seek), form: Form, offset: u64) -> Option<Self> {
        source.seek(SeekFrom::Start(offset)).ok()?;
        let (count, head, size, inline) = if form.long {
            (form.number(&bytes::<8>(source).ok()?), 8, 20, 8)
        } else {
            (form.number(&bytes::<2>(source).ok()?), 2, 12, 4)
        };
        let mut directory = Self { form, offset, entries: Vec::new(), next: 0 };
        for index in 0..count.min(MOST_ENTRIES) {
            let place = offset.checked_add(head + size * index)?;
            let Ok(head) = bytes::<4>(source) else { return Some(directory) };
            let Ok(count) = form.offset(source) else { return Some(directory) };
            let Ok(value) = form.offset(source) else { return Some(directory) };
            let (tag, kind) = (form.number(&head[..2]) as u16, form.number(&head[2..]) as u16);
            let mut entry = Entry { tag, kind, count, place, value };
            // What fits the entry lies in it.
            let size = entry.size().unwrap_or(usize::MAX) as u64;
            if count.checked_mul(size).is_some_and(|bytes| bytes <= inline) {
                entry.value = place + 4 + inline;
            }
            directory.entries.push(entry);
        }
        if count <= MOST_ENTRIES {
            directory.next = form.offset(source).unwrap_or(0);
        }
        Some(directory)
    }

    pub(super) fn entry(&self, tag: u16) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.tag == tag)
    }

    /// The integers of an entry, at most so many; none if there is no such entry or it holds no integers.
    pub(super) fn numbers(
        &self,
        source: &mut (impl Read + Seek),
        tag: u16,
        most: usize,
    ) -> Vec<u64> {
        let Some(entry) = self.entry(tag) else { return Vec::new() };
        let Some(size) = entry.size() else { return Vec::new() };
        if source.seek(SeekFrom::Start(entry.value)).is_err() {
            return Vec::new();
        }
        let mut numbers = Vec::new();
        let mut value = [0; 8];
        while numbers.len() < most && (numbers.len() as u64) < entry.count {
            if source.read_exact(&mut value[..size]).is_err() {
                break;
            }
            numbers.push(self.form.number(&value[..size]));
        }
        numbers
    }

    /// The first integer of an entry.
    pub(super) fn number(&self, source: &mut (impl Read + Seek), tag: u16) -> Option<u64> {
        self.numbers(source, tag, 1).first().copied()
    }
}

fn bytes<const N: usize>(source: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    source.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A file of one directory, with a short number in place and two long ones elsewhere.
    fn file(form: Form) -> Vec<u8> {
        let mut bytes = match (form.big_endian, form.long) {
            (false, false) => b"II*\0".to_vec(),
            (true, false) => b"MM\0*".to_vec(),
            (false, true) => b"II+\0\x08\0\0\0".to_vec(),
            (true, true) => b"MM\0+\0\x08\0\0".to_vec(),
        };
        let first = bytes.len() + form.word(0).len();
        bytes.extend(form.word(first as u64));
        bytes.extend(form.stored(2, if form.long { 8 } else { 2 }));
        for (tag, kind, count, value) in [(262, 3u64, 1, 5), (273, 4, 3, 200)] {
            bytes.extend(form.stored(tag, 2));
            bytes.extend(form.stored(kind, 2));
            bytes.extend(form.word(count));
            let mut value = form.stored(value, if kind == 3 { 2 } else { form.word(0).len() });
            value.resize(form.word(0).len(), 0);
            bytes.extend(value);
        }
        bytes.extend(form.word(77));
        bytes.resize(200, 0);
        for value in [8, 1 << 20, u64::from(u32::MAX)] {
            bytes.extend(form.stored(value, 4));
        }
        bytes
    }

    #[test]
    fn numbers_are_found_in_every_form() {
        for (big_endian, long) in [(false, false), (true, false), (false, true), (true, true)] {
            let form = Form { big_endian, long };
            let bytes = file(form);
            let mut source = Cursor::new(&bytes);
            let (found, first) = Form::read(&mut source).unwrap();
            assert_eq!(found, form);
            let directory = Directory::read(&mut source, form, first).unwrap();
            assert_eq!(directory.next, 77);
            assert_eq!(directory.number(&mut source, 262), Some(5));
            let all = directory.numbers(&mut source, 273, 9);
            assert_eq!(all, [8, 1 << 20, u64::from(u32::MAX)]);
            assert_eq!(directory.numbers(&mut source, 273, 2), [8, 1 << 20]);
            assert_eq!(directory.number(&mut source, 1), None);
            for end in 0..bytes.len() {
                let mut source = Cursor::new(&bytes[..end]);
                let Some((form, first)) = Form::read(&mut source) else { continue };
                let Some(directory) = Directory::read(&mut source, form, first) else { continue };
                assert!(directory.numbers(&mut source, 273, 9).len() <= 3);
            }
        }
    }
}
