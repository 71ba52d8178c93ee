//! The options of `twelvefold frames`.

use std::path::PathBuf;

use clap::Args;
use twelvefold_files::y4m::Rate;

use crate::args::{DotGain, MAX_POINTS};
use crate::part::Part;
use crate::tone::{ToneOptions, positive};

/// Options of `twelvefold frames`.
#[derive(Debug, Args)]
pub(crate) struct FramesOptions {
    /// The frames: numbered photographs, such as in/%04d.png, of which the number has at least four digits; a file
    /// ending in .y4m; or `-` for such a stream on standard input, as `ffmpeg -i VIDEO -f yuv4mpegpipe -` makes it.
    ///
    /// Of a stream the luma is drawn, of 8 to 16 bits; that of streams with color is taken as 16 to 235, of 8 bits, unless
    /// they say XCOLORRANGE=FULL. A % that is part of a name is written %%.
    #[arg(value_name = "FRAMES")]
    pub(crate) input: PathBuf,

    #[command(flatten)]
    pub(crate) tone: ToneOptions,

    /// Which layer of OpenEXR files is drawn [default: the one without a name, or the only one].
    #[arg(long, value_name = "NAME")]
    pub(crate) layer: Option<String>,

    /// Where the frames go: numbered files such as out/%04d.svg, ending in .svg, .png, .pdf, .csv or .npy; a file
    /// ending in .y4m; or `-` for such a stream on standard output.
    ///
    /// Numbers are those of the photographs, or count from 1. Each file appears when it is complete. A stream has a
    /// picture as of PNG, without color.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// How many dots the first frame has that is not blank, at most 4,000,000,000; 50,000,000 that are refined
    /// or in PDF and NPY [default: as of `stipple`]. Others have as many more or fewer as they are darker or lighter.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_POINTS))]
    pub(crate) points: Option<u64>,

    /// Chooses which of many equally good arrangements is drawn, of all frames the same.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// How often the dots are moved to draw each frame better, at most 1000.
    ///
    /// Without, dots stay to the bit where nothing changes within some 30 spacings, and nearly all do nearer by. Refined
    /// dots are evener, but each is moved by all others, so that many tremble: see docs/frames.md.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(..=1000))]
    pub(crate) refine: u16,

    /// A dot's diameter, in pixels of the frames [default: the one at which the dots' areas add up to the whole area
    /// where a frame is black]. Not for CSV and NPY.
    #[arg(long, value_name = "PIXELS", value_parser = positive)]
    pub(crate) dot_size: Option<f64>,

    /// Whether dots allow for the ink that is lost where they overlap, as of `stipple`.
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) dot_gain: Option<DotGain>,

    /// Size of the frames that are drawn, as a multiple of those that are read; dots grow with it [default: 1]. Not for
    /// CSV and NPY.
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) scale: Option<f64>,

    /// The number of the first photograph [default: the least there is].
    #[arg(long, value_name = "NUMBER")]
    pub(crate) first: Option<u64>,

    /// The number of the last photograph [default: the one before the first that is missing].
    #[arg(long, value_name = "NUMBER")]
    pub(crate) last: Option<u64>,

    /// Draw the I-th of N parts of the frames, as one of several machines: I from 1 to N, photographs to numbered files.
    #[arg(long, value_name = "I/N")]
    pub(crate) part: Option<Part>,

    /// Frames a second of the stream that is written, such as 25 or 30000/1001 [default: those of the stream that is
    /// read, or 25].
    #[arg(long, value_name = "RATE")]
    pub(crate) rate: Option<Rate>,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
