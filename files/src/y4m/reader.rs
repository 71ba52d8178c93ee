//! Frames, one after the other.

use std::io::{self, BufRead, BufReader, Read};

use super::Y4mError;
use super::header::{Header, MAGIC, Rate};
use crate::picture::{Grays, Picture, Tone};

/// The most bytes of a line.
const LONGEST: u64 = 4096;

/// A stream of which frames are read as importance, by their luma.
#[derive(Debug)]
pub struct Reader<R> {
    source: BufReader<R>,
    header: Header,
    grays: Grays,
    frames: usize,
    /// Of one frame.
    luma: Vec<u8>,
}

impl<R: Read> Reader<R> {
    /// Reads what goes before the frames.
    ///
    /// # Errors
    /// [`Y4mError`]; frames that do not fit the memory limit are refused here.
    pub fn new(source: R, tone: Tone) -> Result<Self, Y4mError> {
        let mut source = BufReader::with_capacity(1 << 16, source);
        if source.fill_buf()?.is_empty() {
            return Err(Y4mError::Empty);
        }
        let line = line(&mut source)?.filter(|line| line.starts_with(MAGIC.as_bytes()));
        let header = Header::of(&line.ok_or(Y4mError::NotY4m)?)?;
        let (bits, full) = (header.samples.bits, header.full);
        let grays = Grays::new(header.size, header.aspect, tone, 1 << bits, |sample| {
            // Black and white of 8 bits; of more, as much more.
            let unit = f64::from(1u32 << (bits - 8));
            let (black, white) =
                if full { (0.0, 256.0 * unit - 1.0) } else { (16.0 * unit, 235.0 * unit) };
            (f64::from(sample) - black) / (white - black)
        })?;
        Ok(Self { source, header, grays, frames: 0, luma: Vec::new() })
    }

    /// Frames a second.
    pub fn rate(&self) -> Rate {
        self.header.rate
    }

    /// The next frame; `None` if there are no more.
    ///
    /// # Errors
    /// [`Y4mError`].
    pub fn frame(&mut self) -> Result<Option<Picture>, Y4mError> {
        if self.source.fill_buf()?.is_empty() {
            return Ok(None);
        }
        self.frames += 1;
        let frame = self.frames;
        match line(&mut self.source)? {
            Some(line) if line == b"FRAME" || line.starts_with(b"FRAME ") => {}
            _ => return Err(Y4mError::NoFrame(frame)),
        }
        let Header { size: (width, height), samples, .. } = self.header;
        // Both fit the memory limit.
        let bytes = width * height * samples.bytes();
        self.luma.clear();
        self.source.by_ref().take(bytes as u64).read_to_end(&mut self.luma)?;
        let behind = samples.behind_luma((width, height)).ok_or(Y4mError::Truncated(frame))?;
        let skipped = io::copy(&mut self.source.by_ref().take(behind), &mut io::sink())?;
        if self.luma.len() < bytes || skipped < behind {
            return Err(Y4mError::Truncated(frame));
        }
        let picture = if samples.bytes() == 1 {
            self.grays.picture(self.luma.iter().map(|&byte| usize::from(byte)))
        } else {
            let pairs = self.luma.as_chunks::<2>().0.iter();
            self.grays.picture(pairs.map(|&pair| usize::from(u16::from_le_bytes(pair))))
        };
        Ok(Some(picture?))
    }
}

/// The next line, without its end; `None` if it is too long or has no end.
fn line(source: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut line = Vec::new();
    source.take(LONGEST).read_until(b'\n', &mut line)?;
    Ok((line.pop() == Some(b'\n')).then_some(line))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read(bytes: &[u8]) -> Result<Vec<Picture>, Y4mError> {
        let mut reader = Reader::new(bytes, Tone::default())?;
        let mut frames = Vec::new();
        while let Some(frame) = reader.frame()? {
            frames.push(frame);
        }
        Ok(frames)
    }

    /// Frames of 3 × 2 pixels of these samples, two bytes each if `wide`.
    fn stream(words: &str, frames: &[[u16; 6]], wide: bool, behind: usize) -> Vec<u8> {
        let mut bytes = format!("YUV4MPEG2 W3 H2 {words}\n").into_bytes();
        for frame in frames {
            bytes.extend(b"FRAME Ip\n");
            for sample in frame {
                let pair = sample.to_le_bytes();
                bytes.extend(&pair[..if wide { 2 } else { 1 }]);
            }
            bytes.extend(vec![128; behind]);
        }
        bytes
    }

    #[test]
    fn luma_is_the_tone_of_either_range_and_any_depth() {
        let near = |found: &[f32], expected: [f32; 6]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 3e-5), "{found:?}");
        };
        let half = 1.0 - 109.0 / 219.0;
        let expected = [1.0, 1.0, half, 0.0, 0.0, 1.0];
        let samples = [16, 0, 125, 235, 255, 3];
        for (kind, behind) in
            [("mono XCOLORRANGE=LIMITED", 0), ("420jpeg", 4), ("422", 8), ("444", 12), ("411", 4)]
        {
            let bytes = stream(&format!("C{kind}"), &[samples, samples], false, behind);
            let frames = read(&bytes).unwrap();
            assert_eq!(frames.len(), 2, "{kind}");
            frames.iter().for_each(|frame| near(&frame.importance, expected));
        }
        let wide = samples.map(|sample| sample * 4);
        near(&read(&stream("C420p10", &[wide], true, 8)).unwrap()[0].importance, expected);
        let full = read(&stream("Cmono XCOLORRANGE=FULL", &[samples], false, 0)).unwrap();
        near(&full[0].importance, samples.map(|sample| 1.0 - f32::from(sample) / 255.0));
        let full = read(&stream("Cmono12 XCOLORRANGE=FULL", &[[4095; 6]], true, 0)).unwrap();
        assert_eq!(full[0].importance, [0.0; 6]);
        // More than a sample can be is white as well.
        let full = read(&stream("Cmono12 XCOLORRANGE=FULL", &[[65535; 6]], true, 0)).unwrap();
        assert_eq!(full[0].importance, [0.0; 6]);
    }

    #[test]
    fn pixels_of_another_shape_become_square() {
        let frames = read(&stream("Cmono A2:1", &[[0; 6]], false, 0)).unwrap();
        assert_eq!((frames[0].width, frames[0].height), (6, 2));
        assert_eq!(frames[0].importance, [1.0; 12]);
    }

    #[test]
    fn streams_that_are_none_or_end_early_are_errors_and_never_more() {
        assert!(matches!(read(b""), Err(Y4mError::Empty)));
        assert!(matches!(read(b"RIFF"), Err(Y4mError::NotY4m)));
        assert!(matches!(read(&[b'Y'; 9000]), Err(Y4mError::NotY4m)));
        assert!(matches!(read(b"YUV4MPEG2 W3 H0\n"), Err(Y4mError::Picture(_))));
        assert!(matches!(read(b"YUV4MPEG2 W999999 H999999\n"), Err(Y4mError::Picture(_))));
        assert_eq!(read(b"YUV4MPEG2 W3 H2\n").unwrap().len(), 0);
        assert!(matches!(read(b"YUV4MPEG2 W3 H2\nFRAMES\n"), Err(Y4mError::NoFrame(1))));
        let whole = stream("C420", &[[9; 6], [8; 6]], false, 4);
        let one = whole.len() - (9 + 6 + 4);
        for end in 0..whole.len() {
            let found = read(&whole[..end]);
            let header = b"YUV4MPEG2 W3 H2 C420\n".len();
            match found {
                Ok(frames) => assert!([(header, 0), (one, 1)].contains(&(end, frames.len()))),
                Err(Y4mError::Truncated(frame) | Y4mError::NoFrame(frame)) => {
                    assert!(end > header && frame == if end < one { 1 } else { 2 });
                }
                Err(_) => assert!(end < header),
            }
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_frames_or_an_error(
            words in "[ WHFIACXx0-9:p?tmono]{0,24}", bytes: Vec<u8>,
        ) {
            let line = format!("YUV4MPEG2 W3 H2 {words}\nFRAME\n");
            let _ = read(&[line.as_bytes(), &bytes].concat());
            let _ = read(&bytes);
        }
    }
}
