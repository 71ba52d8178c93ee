//! Where the bytes come from: a file, or standard input held in memory.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use super::{PictureError, limits};

/// Bytes that can be read again.
#[derive(Debug)]
pub(super) enum Source {
    File(BufReader<File>),
    Memory(Cursor<Vec<u8>>),
    #[cfg(test)]
    Watched(watched::Watched),
}

impl Source {
    /// The regular file at `path`, or for `-` all of standard input, at most the memory limit.
    pub(super) fn open(path: &Path) -> Result<Self, PictureError> {
        if path.as_os_str() == "-" {
            return Self::collect(io::stdin().lock());
        }
        // Opening a pipe would wait for somebody to write to it.
        let metadata = fs::metadata(path)?;
        if !metadata.is_file() {
            return Err(PictureError::NotAFile);
        }
        Ok(Self::File(BufReader::new(File::open(path)?)))
    }

    /// That there are no more bytes than the memory limit: some decoders hold the whole file, or a header as long
    /// as the file.
    pub(super) fn check(&mut self) -> Result<(), PictureError> {
        match self.length()? {
            bytes if bytes > limits::MEMORY_LIMIT => Err(PictureError::TooLong { bytes }),
            _ => Ok(()),
        }
    }

    /// The number of bytes.
    pub(super) fn length(&mut self) -> Result<u64, PictureError> {
        let place = self.stream_position()?;
        let end = self.seek(SeekFrom::End(0))?;
        self.seek(SeekFrom::Start(place))?;
        Ok(end)
    }

    /// What a file would hold; at most the memory limit.
    pub(super) fn of_bytes(bytes: Vec<u8>) -> Result<Self, PictureError> {
        let length = bytes.len() as u64;
        if length > limits::MEMORY_LIMIT {
            return Err(PictureError::TooLong { bytes: length });
        }
        Ok(Self::Memory(Cursor::new(bytes)))
    }

    /// All that a stream gives.
    fn collect(stream: impl Read) -> Result<Self, PictureError> {
        let mut bytes = Vec::new();
        let mut stream = stream.take(limits::MEMORY_LIMIT + 1);
        let mut part = vec![0; 1 << 16];
        loop {
            let count = match stream.read(&mut part) {
                Ok(0) => break,
                Ok(count) => count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error.into()),
            };
            let length = bytes.len() as u64 + count as u64;
            if length > limits::MEMORY_LIMIT || bytes.try_reserve(count).is_err() {
                return Err(PictureError::TooLong { bytes: length });
            }
            bytes.extend_from_slice(&part[..count]);
        }
        Ok(Self::Memory(Cursor::new(bytes)))
    }

    /// All bytes, from the first one; at most the memory limit.
    pub(super) fn into_bytes(mut self) -> Result<Vec<u8>, PictureError> {
        self.check()?;
        self.rewind()?;
        match self {
            Self::Memory(cursor) => Ok(cursor.into_inner()),
            Self::File(mut file) => {
                let mut bytes = Vec::new();
                file.read_to_end(&mut bytes)?;
                Ok(bytes)
            }
            #[cfg(test)]
            Self::Watched(mut file) => {
                let mut bytes = Vec::new();
                file.read_to_end(&mut bytes)?;
                Ok(bytes)
            }
        }
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.read(buffer),
            Self::Memory(bytes) => bytes.read(buffer),
            #[cfg(test)]
            Self::Watched(file) => file.read(buffer),
        }
    }
}

impl BufRead for Source {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        match self {
            Self::File(file) => file.fill_buf(),
            Self::Memory(bytes) => bytes.fill_buf(),
            #[cfg(test)]
            Self::Watched(file) => file.fill_buf(),
        }
    }

    fn consume(&mut self, amount: usize) {
        match self {
            Self::File(file) => file.consume(amount),
            Self::Memory(bytes) => bytes.consume(amount),
            #[cfg(test)]
            Self::Watched(file) => file.consume(amount),
        }
    }
}

impl Seek for Source {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::File(file) => file.seek(to),
            Self::Memory(bytes) => bytes.seek(to),
            #[cfg(test)]
            Self::Watched(file) => file.seek(to),
        }
    }
}

/// A file that knows which of its bytes were read.
#[cfg(test)]
pub(super) mod watched {
    use std::io::{self, BufRead, Cursor, Read, Seek, SeekFrom};
    use std::sync::{Arc, Mutex};

    /// Bytes in memory, and whether each was read.
    #[derive(Debug)]
    pub(in super::super) struct Watched {
        bytes: Cursor<Vec<u8>>,
        pub(in super::super) seen: Arc<Mutex<Vec<bool>>>,
    }

    impl Watched {
        pub(in super::super) fn new(bytes: Vec<u8>) -> Self {
            let seen = Arc::new(Mutex::new(vec![false; bytes.len()]));
            Self { bytes: Cursor::new(bytes), seen }
        }

        /// Notes that the bytes from here to the present place were read.
        fn see(&self, start: u64) {
            let end = self.bytes.position() as usize;
            let mut seen = self.seen.lock().unwrap();
            let length = seen.len();
            seen[(start as usize).min(length)..end.min(length)].fill(true);
        }
    }

    impl Read for Watched {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let start = self.bytes.position();
            let count = self.bytes.read(buffer)?;
            self.see(start);
            Ok(count)
        }
    }

    impl BufRead for Watched {
        fn fill_buf(&mut self) -> io::Result<&[u8]> {
            self.bytes.fill_buf()
        }

        fn consume(&mut self, amount: usize) {
            let start = self.bytes.position();
            self.bytes.consume(amount);
            self.see(start);
        }
    }

    impl Seek for Watched {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.bytes.seek(to)
        }
    }
}
