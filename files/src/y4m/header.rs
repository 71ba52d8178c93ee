//! The first line of a stream.

use std::fmt;
use std::str::FromStr;

use super::Y4mError;

/// What a stream begins with.
pub(super) const MAGIC: &str = "YUV4MPEG2";

/// Frames a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rate {
    /// At least 1, like the one below it.
    above: u32,
    below: u32,
}

impl Default for Rate {
    /// 25.
    fn default() -> Self {
        Self { above: 25, below: 1 }
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}", self.above, self.below)
    }
}

impl FromStr for Rate {
    type Err = &'static str;

    /// Reads 25, 30000:1001 or 30000/1001.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (above, below) = text.split_once([':', '/']).unwrap_or((text, "1"));
        match (above.parse(), below.parse()) {
            (Ok(above @ 1..), Ok(below @ 1..)) => Ok(Self { above, below }),
            _ => Err("not frames a second, such as 25 or 30000/1001"),
        }
    }
}

/// How a frame's samples lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Samples {
    /// Of a sample, 8 to 16; more than 8 are two bytes, the lesser first.
    pub(super) bits: u32,
    /// Pixels across and down for one sample of each of two color differences; `None` without any.
    chroma: Option<(usize, usize)>,
    /// Whether a plane of opacity follows.
    alpha: bool,
}

impl Samples {
    /// The kind called so.
    fn of(name: &str) -> Option<Self> {
        let (base, bits) = match name {
            // Where color differences lie between pixels is of no consequence.
            "420jpeg" | "420mpeg2" | "420paldv" => ("420", 8),
            "mono" | "420" | "422" | "444" | "411" | "410" | "444alpha" => (name, 8),
            _ => {
                let (base, bits) = match name.strip_prefix("mono") {
                    Some(bits) => ("mono", bits),
                    None => name.split_once('p')?,
                };
                match (base, bits.parse()) {
                    ("mono" | "420" | "422" | "444", Ok(bits @ (9 | 10 | 12 | 14 | 16))) => {
                        (base, bits)
                    }
                    _ => return None,
                }
            }
        };
        let chroma = match base {
            "mono" => None,
            "420" => Some((2, 2)),
            "422" => Some((2, 1)),
            "411" => Some((4, 1)),
            "410" => Some((4, 4)),
            _ => Some((1, 1)),
        };
        Some(Self { bits, chroma, alpha: base == "444alpha" })
    }

    /// Bytes of a sample.
    pub(super) fn bytes(self) -> usize {
        if self.bits > 8 { 2 } else { 1 }
    }

    /// The bytes behind the luma of a frame of this size; `None` past all numbers.
    pub(super) fn behind_luma(self, (width, height): (usize, usize)) -> Option<u64> {
        let chroma = match self.chroma {
            None => 0,
            Some((across, down)) => {
                let plane = width.div_ceil(across).checked_mul(height.div_ceil(down))?;
                plane.checked_mul(2)?
            }
        };
        let alpha = if self.alpha { width.checked_mul(height)? } else { 0 };
        let bytes = chroma.checked_add(alpha)?.checked_mul(self.bytes())?;
        u64::try_from(bytes).ok()
    }
}

/// What the first line says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Header {
    pub(super) size: (usize, usize),
    pub(super) rate: Rate,
    /// Width of a pixel over its height.
    pub(super) aspect: f64,
    pub(super) samples: Samples,
    /// Whether black is 0 and white as much as can be; if not, they are 16 and 235, of 8 bits.
    pub(super) full: bool,
}

impl Header {
    /// Reads the line, without its end.
    pub(super) fn of(line: &[u8]) -> Result<Self, Y4mError> {
        let line = String::from_utf8_lossy(line);
        let mut words = line.split(' ');
        if words.next() != Some(MAGIC) {
            return Err(Y4mError::NotY4m);
        }
        let (mut width, mut height) = (None, None);
        // Unknown things are as nearly all streams have them.
        let (mut rate, mut aspect, mut full) = (Rate::default(), 1.0, None);
        let mut samples = Samples { bits: 8, chroma: Some((2, 2)), alpha: false };
        for word in words.filter(|word| !word.is_empty()) {
            let malformed = || Y4mError::Malformed(word.to_owned());
            let mut letters = word.chars();
            let letter = letters.next();
            let value = letters.as_str();
            match letter {
                Some('W') => width = Some(value.parse().map_err(|_| malformed())?),
                Some('H') => height = Some(value.parse().map_err(|_| malformed())?),
                Some('F') if value == "0:0" => {}
                Some('F') => rate = value.parse().map_err(|_| malformed())?,
                Some('I') => match value {
                    "p" | "?" => {}
                    "t" | "b" | "m" => {
                        return Err(Y4mError::Interlaced(value.chars().next().unwrap_or('m')));
                    }
                    _ => return Err(malformed()),
                },
                Some('A') => {
                    let parts = value.split_once(':').ok_or_else(malformed)?;
                    let number = |text: &str| text.parse::<u32>().map_err(|_| malformed());
                    let (across, down) = (number(parts.0)?, number(parts.1)?);
                    if across > 0 && down > 0 {
                        aspect = f64::from(across) / f64::from(down);
                    }
                }
                Some('C') => {
                    samples =
                        Samples::of(value).ok_or_else(|| Y4mError::Samples(value.to_owned()))?;
                }
                Some('X') => match value {
                    "COLORRANGE=FULL" => full = Some(true),
                    "COLORRANGE=LIMITED" => full = Some(false),
                    _ => {}
                },
                _ => return Err(malformed()),
            }
        }
        let (Some(width), Some(height)) = (width, height) else { return Err(Y4mError::NoSize) };
        // Without color, ffmpeg's are of the full range, and older ones do not say so.
        let full = full.unwrap_or(samples.chroma.is_none());
        Ok(Self { size: (width, height), rate, aspect, samples, full })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<Header, Y4mError> {
        Header::of(line.as_bytes())
    }

    #[test]
    fn headers_of_known_programs_are_read() {
        let plain = of("YUV4MPEG2 W352 H288").unwrap();
        assert_eq!((plain.size, plain.aspect, plain.full), ((352, 288), 1.0, false));
        assert_eq!((plain.rate, plain.samples.bits), (Rate::default(), 8));
        let found =
            of("YUV4MPEG2 W5 H3 F30000:1001 Ip A128:117 C420p10 XYSCSS=420P10 XCOLORRANGE=FULL")
                .unwrap();
        assert_eq!((found.size, found.rate.to_string()), ((5, 3), "30000:1001".to_owned()));
        assert!((found.aspect - 128.0 / 117.0).abs() < 1e-12 && found.full);
        assert_eq!((found.samples.bits, found.samples.bytes()), (10, 2));
        assert_eq!(of("YUV4MPEG2 W5 H3 F0:0 I? A0:0").unwrap().rate, Rate::default());
        let full = |words: &str| of(&format!("YUV4MPEG2 W5 H3 {words}")).unwrap().full;
        assert!(full("Cmono") && full("XCOLORRANGE=FULL Cmono10 Xother") && !full("C444"));
        assert!(!full("Cmono XCOLORRANGE=LIMITED") && full("XCOLORRANGE=FULL C420"));
    }

    #[test]
    fn kinds_of_samples_have_so_many_bytes_behind_the_luma() {
        for (name, bytes) in [
            ("420", 2 * 3 * 2),
            ("420jpeg", 2 * 3 * 2),
            ("420p12", 2 * 2 * 3 * 2),
            ("422", 2 * 3 * 3),
            ("444", 2 * 5 * 3),
            ("444alpha", 3 * 5 * 3),
            ("411", 2 * 2 * 3),
            ("410", 2 * 2),
            ("mono", 0),
            ("mono16", 0),
        ] {
            let samples = of(&format!("YUV4MPEG2 W5 H3 C{name}")).unwrap().samples;
            assert_eq!(samples.behind_luma((5, 3)), Some(bytes), "{name}");
            assert_eq!(samples.behind_luma((usize::MAX, 9)).is_none(), !name.starts_with("mono"));
        }
    }

    #[test]
    fn what_is_no_header_is_named() {
        let said = |line: &str| of(line).unwrap_err().to_string();
        assert!(said("YUV4MPEG W5 H3").contains("not a YUV4MPEG2 stream"));
        assert!(said("").contains("not a YUV4MPEG2 stream"));
        assert!(said("YUV4MPEG2 W5").contains("without width and height"));
        for word in ["W-5", "Wx", "F25:0", "F", "A1", "A1:x", "Ix", "Q7"] {
            assert!(
                said(&format!("YUV4MPEG2 W5 H3 {word}")).contains(&format!("{word:?}")),
                "{word}"
            );
        }
        for letter in ["t", "b", "m"] {
            assert!(said(&format!("YUV4MPEG2 W5 H3 I{letter}")).contains("interlaced"));
        }
        for kind in ["420p11", "440", "mono8", "444p", ""] {
            let text = said(&format!("YUV4MPEG2 W5 H3 C{kind}"));
            assert!(text.contains(&format!("kind C{kind},")), "{text}");
        }
    }
}
