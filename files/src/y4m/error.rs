//! Why a stream cannot be read.

use std::error::Error;
use std::fmt;
use std::io;

use crate::picture::PictureError;

/// Why a YUV4MPEG2 stream cannot be read, or not further.
#[derive(Debug)]
#[non_exhaustive]
pub enum Y4mError {
    /// The system's.
    Io(io::Error),
    /// There is nothing at all.
    Empty,
    /// The first line is another one.
    NotY4m,
    /// The first line says this, which means nothing or is said without need twice.
    Malformed(String),
    /// The first line does not say how large frames are.
    NoSize,
    /// Frames are made of two fields, by this letter.
    Interlaced(char),
    /// Samples are of this kind.
    Samples(String),
    /// A frame, counted from 1, does not begin where it should.
    NoFrame(usize),
    /// The stream ends within a frame, counted from 1.
    Truncated(usize),
    /// A frame has no pixels, or more than memory is allowed for.
    Picture(PictureError),
}

impl fmt::Display for Y4mError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(out, "cannot be read: {error}"),
            Self::Empty => out.write_str("is empty"),
            Self::NotY4m => out.write_str(
                "is not a YUV4MPEG2 stream, as `ffmpeg -i VIDEO -f yuv4mpegpipe -` makes one",
            ),
            Self::Malformed(word) => write!(out, "has a malformed header, at {word:?}"),
            Self::NoSize => out.write_str("has a header without width and height"),
            Self::Interlaced(letter) => write!(
                out,
                "is interlaced (I{letter}), so that each frame shows two moments; deinterlace it first, as \
                 `ffmpeg -vf bwdif` does"
            ),
            Self::Samples(kind) => write!(
                out,
                "has samples of kind C{kind}, which are not read; `ffmpeg -pix_fmt gray` or `yuv420p` makes others"
            ),
            Self::NoFrame(frame) => {
                write!(out, "has no FRAME line where frame {frame} should begin")
            }
            Self::Truncated(frame) => write!(out, "ends within frame {frame}"),
            Self::Picture(error) => error.fmt(out),
        }
    }
}

impl Error for Y4mError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Picture(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for Y4mError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<PictureError> for Y4mError {
    fn from(error: PictureError) -> Self {
        Self::Picture(error)
    }
}
