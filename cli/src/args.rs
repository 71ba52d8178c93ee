//! The command line. Each subcommand's options live in a struct of their own; a new subcommand is a
//! variant of [`Command`], its options struct, and one arm in `main.rs`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::DVec2;
use twelvefold::light::{Frame, InfiniteRadiance};
use twelvefold::tiling::TileType;
use twelvefold_lab::measure::Window;

use crate::format::Format;
use crate::frames::options::FramesOptions;
use crate::page::options::PaperOptions;
use crate::part::Part;
use crate::tone::{ToneOptions, positive};
use twelvefold_stipple::page::length::Length;
use twelvefold_stipple::wish::Centers;

/// The most dots that are drawn.
pub(crate) const MAX_POINTS: u64 = 4_000_000_000;

/// The most that are held in memory: to be refined, or for a file that begins with their number.
pub(crate) const MAX_HELD: u64 = 50_000_000;

/// The most points that are counted exactly: they are sorted in memory, some 90 bytes each.
pub(crate) const MAX_EXACT: u64 = 10_000_000;

/// Well-spread points with a density you control, from a dodecagonal aperiodic tiling.
#[derive(Debug, Parser)]
#[command(name = "twelvefold", version, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw a photograph with equal dots, dense where it is dark.
    Stipple(Box<StippleOptions>),
    /// Draw moving pictures with equal dots, which stay where nothing moves.
    ///
    /// How many dots a darkness gets is fixed by the first frame that is not blank. Where a frame is as the one before,
    /// so are its dots: all frames have one seed, and a dot depends on what is around it only.
    Frames(FramesOptions),
    /// Say of a photograph what its parts must know: how large it is, how dark, and how bright.
    ///
    /// For `stipple --part --survey`: it is read once, instead of once a part.
    Survey(SurveyOptions),
    /// Put the parts of a drawing together.
    ///
    /// CSV and SVG parts are written one after the other; of NPY parts one array is made. What is no part of one
    /// file, or out of order as far as can be seen, is an error.
    Merge(MergeOptions),
    /// Choose directions towards the light of an environment map, as CSV.
    ///
    /// The columns are x,y,z,pdf,red,green,blue: a direction of length 1; its probability density per
    /// steradian; and the map's radiance there. The light that falls on a surface is estimated by the
    /// sum over all lines of radiance × cosine / (N × pdf).
    ///
    /// The map is a latitude-longitude image, twice as wide as high; --frame says which way it faces.
    Envmap(EnvmapOptions),
    /// Measure how even a list of points is, as CSV.
    ///
    /// The table has the columns measure,value: star and L2 star discrepancy; least, first-percentile and
    /// mean distance to the nearest point, in units of the hexagonal lattice's; mean power below half
    /// the principal frequency, white noise = 1. With --image also, relative to the photograph's
    /// darkness: the variance of counts in blocks of 64 points, Poisson = 1, and local distances.
    Measure(MeasureOptions),
    /// Say what the tables inside this program hold.
    Tables,
    /// List every tile of one level of the tiling as CSV.
    ///
    /// The columns are fcode,tile,rotation,z0,z1,z2,z3,rank,threshold,x,y: the tile's address, newest
    /// digit first; its type; its rotation in units of 30°, 0 to 11; its center z0 + z1·ζ + z2·ζ² +
    /// z3·ζ³, ζ = e^(iπ/6), in edges of its own level; its rank; rank over the number of tiles; and
    /// the center again in edges of the root. The root's center is the origin. Tiles are listed depth
    /// first, children by ascending digit.
    Tiling(TilingOptions),
}

/// Options of `twelvefold measure`.
#[derive(Debug, Args)]
pub(crate) struct MeasureOptions {
    /// The points: one a line, two coordinates, or columns named x and y.
    pub(crate) points: PathBuf,

    /// The rectangle in which the points are measured, as X,Y,WIDTH,HEIGHT [default: the photograph of
    /// --image, or 0,0,1,1]. Points outside serve as neighbors only.
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = window, allow_hyphen_values = true)]
    pub(crate) window: Option<Window>,

    /// A photograph whose darkness the points should follow.
    #[arg(long, value_name = "PHOTO")]
    pub(crate) image: Option<PathBuf>,

    /// The points follow the photograph's light parts.
    #[arg(long, requires = "image")]
    pub(crate) invert: bool,

    /// The points follow linear light.
    #[arg(long, requires = "image")]
    pub(crate) linear: bool,

    /// Where the table goes [default: standard output].
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,

    /// Also draw the periodogram as a PNG picture: up to twice the principal frequency on each axis.
    #[arg(long, value_name = "FILE")]
    pub(crate) spectrum: Option<PathBuf>,

    /// Also write the periodogram's radial mean as CSV.
    #[arg(long, value_name = "FILE")]
    pub(crate) rings: Option<PathBuf>,
}

/// Reads a rectangle.
fn window(text: &str) -> Result<Window, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, width, height]) => {
            Window::new(DVec2::new(x, y), DVec2::new(width, height)).map_err(|e| e.to_string())
        }
        _ => Err("not four numbers X,Y,WIDTH,HEIGHT".to_owned()),
    }
}

/// Options of `twelvefold envmap`.
#[derive(Debug, Args)]
pub(crate) struct EnvmapOptions {
    /// The environment map, or `-` for standard input: Radiance HDR, OpenEXR, PFM or float TIFF, told
    /// apart by content.
    pub(crate) map: PathBuf,

    /// How many directions, at most 10,000,000. Exactly as many are chosen.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MAX_EXACT))]
    pub(crate) directions: u64,

    /// Where the table goes, or `-` for standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Chooses which of many equally good sets is taken.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// Which way the image faces: the coordinates of a renderer.
    #[arg(long, value_enum, default_value_t = FrameName::Pbrt)]
    pub(crate) frame: FrameName,

    /// Turns the surroundings about the frame's up axis, as a rotation by so many degrees in that
    /// renderer's scene would: counterclockwise seen from above, clockwise in pbrt's left-handed
    /// coordinates.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = finite, allow_hyphen_values = true)]
    pub(crate) rotate: f64,

    /// What to do with negative radiance, which resampling leaves in real maps.
    #[arg(long, value_enum, default_value_t = Negative::Reject)]
    pub(crate) negative: Negative,

    /// What to do with infinite radiance, as of a sun that overflowed: `reject`, `zero`, or `clamp=V`,
    /// which takes V (in the map's units) for it.
    #[arg(long, value_name = "HOW", default_value = "reject", value_parser = infinite)]
    pub(crate) infinite: InfiniteRadiance,

    /// What to do with radiance that is not a number.
    #[arg(long, value_enum, default_value_t = Nan::Reject)]
    pub(crate) nan: Nan,

    /// How directions are chosen.
    #[arg(long, value_enum, default_value_t = Method::Sobol)]
    pub(crate) method: Method,

    /// How the map is read between its pixels' centers. `bilinear` is for `--method sobol` only.
    #[arg(long, value_enum, default_value_t = FilterName::Nearest)]
    pub(crate) filter: FilterName,
}

/// A convention for latitude-longitude images.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrameName {
    /// z up, left-handed; the image's center is -x, right of it -y.
    Pbrt,
    /// y up, right-handed; the image's center is +z, right of it -x.
    Mitsuba,
    /// z up, right-handed; the image's center is +x, right of it -y. Cycles' as well.
    #[value(alias = "cycles")]
    Blender,
    /// y up, right-handed; the image's center is +x, right of it +z. three.js' as well.
    #[value(alias = "threejs", alias = "three.js")]
    Gltf,
    /// y up, right-handed; the image's center is +z, right of it -x. USD's as well.
    #[value(alias = "usd")]
    Openexr,
}

impl FrameName {
    /// The frame of this name.
    pub(crate) fn frame(self) -> Frame {
        match self {
            Self::Pbrt => Frame::PBRT,
            Self::Mitsuba => Frame::MITSUBA,
            Self::Blender => Frame::BLENDER,
            Self::Gltf => Frame::GLTF,
            Self::Openexr => Frame::OPENEXR,
        }
    }
}

/// A policy for negative radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Negative {
    /// It is an error, which names the first pixel.
    Reject,
    /// It counts as zero.
    Zero,
}

/// A policy for radiance that is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Nan {
    /// It is an error, which names the first pixel.
    Reject,
    /// It counts as zero.
    Zero,
}

/// Reads a policy for infinite radiance.
fn infinite(text: &str) -> Result<InfiniteRadiance, String> {
    match text {
        "reject" => Ok(InfiniteRadiance::Reject),
        "zero" => Ok(InfiniteRadiance::Zero),
        _ => match text.strip_prefix("clamp=").map(str::parse::<f32>) {
            Some(Ok(value)) if value.is_finite() && value >= 0.0 => {
                Ok(InfiniteRadiance::Clamp(value))
            }
            Some(_) => Err("clamp= takes a finite number that is not negative".to_owned()),
            None => Err("is none of reject, zero and clamp=V".to_owned()),
        },
    }
}

/// Reads a finite number.
fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("not a finite number".to_owned()),
    }
}

/// A way to choose directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Scrambled Sobol points, warped: the least error for any number, the fastest below some 100, and
    /// each beginning is itself a good set, best with 2^k directions.
    Sobol,
    /// The tiling's points, thresholded by the map, in an order of which each beginning is itself a good
    /// set: where the map does not change from frame to frame, neither do its directions.
    Progressive,
    /// A complete level of the tiling, warped, in no useful order: evenest in all directions alike,
    /// level with Sobol where occluders have edges at any angle.
    Warp,
}

/// A way to read between pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FilterName {
    /// A pixel's radiance holds over the whole pixel.
    Nearest,
    /// Radiance is interpolated between the pixels' centers, over the seam and the poles.
    Bilinear,
}

/// Options of `twelvefold tiling`.
#[derive(Debug, Args)]
pub(crate) struct TilingOptions {
    /// The type of the root tile.
    #[arg(long, value_name = "TYPE", value_parser = tile_type())]
    pub(crate) root: TileType,

    /// How many times the root is subdivided, at most 16.
    #[arg(long, value_name = "K")]
    pub(crate) levels: usize,

    /// Where the list goes [default: standard output, as for `-`].
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// Reads the letter of a tile type.
fn tile_type() -> impl TypedValueParser<Value = TileType> {
    PossibleValuesParser::new(["a", "b", "c", "d"]).try_map(|name| {
        name.chars().next().and_then(TileType::from_letter).ok_or("not a tile type")
    })
}

/// Options of `twelvefold stipple`.
#[derive(Debug, Args)]
pub(crate) struct StippleOptions {
    /// The photograph, or `-` for standard input: PNG, JPEG, TIFF, WebP, GIF, BMP, PNM, PFM, Targa,
    /// QOI, farbfeld, Radiance HDR or OpenEXR, told apart by content.
    ///
    /// Color profiles are followed, and the photograph is turned upright. Transparent pixels get no
    /// dots. In float files negative values count as zero and values above one as white; a NaN or an
    /// infinity is an error.
    pub(crate) photo: PathBuf,

    #[command(flatten)]
    pub(crate) tone: ToneOptions,

    /// Which layer of an OpenEXR file is drawn, such as ViewLayer.Combined [default: the one without a
    /// name, or the only one].
    #[arg(long, value_name = "NAME")]
    pub(crate) layer: Option<String>,

    /// Where the dots go: a file ending in .svg, .png, .pdf, .csv or .npy, or `-` for standard output, as
    /// CSV unless `--format` says otherwise.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// What to write, whatever the name of the output: a drawing, or a list of places, of which `npy` is an
    /// array of shape (dots, 2) and type float32, with `--pens` (dots, 3).
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: Option<Format>,

    /// How many dots, at most 4,000,000,000; 50,000,000 that are refined, or in PDF and NPY [default: a ninth of
    /// the sum of all pixels' darkness from 0 to 1, that is one every 3 pixels where the photograph is black; at
    /// least 3,000 where that many fit four to a pixel, at most 30,000].
    ///
    /// The number drawn is close to this, not equal to it.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MAX_POINTS))]
    pub(crate) points: Option<u64>,

    /// Exactly N dots, at most 10,000,000. With `--refine 0 --centers fixed` they are in an order of which each
    /// beginning is itself the stippling with so many dots.
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "points",
        value_parser = clap::value_parser!(u64).range(..=MAX_EXACT)
    )]
    pub(crate) exact: Option<u64>,

    /// Chooses which of many equally good arrangements is drawn.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// A dot's diameter, or the width of the line, in pixels of the photograph; with `--page` in mm, or in
    /// inches as in 0.02in [default: the one at which the dots' areas add up to the whole area where the
    /// photograph is black; of a line, the one at which it covers 0.8 of that].
    ///
    /// With `--pen` only for `--marks ring`. Not for CSV and NPY without pens.
    #[arg(long, value_name = "LENGTH")]
    pub(crate) dot_size: Option<Length>,

    /// How often the dots are moved to draw the picture better, at most 1000; 10 take about 3 microseconds
    /// a dot. 0 leaves them where the tiling puts them, which needs no memory for them.
    ///
    /// [default: 10; 0 from two million dots on]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(..=1000))]
    pub(crate) refine: Option<u16>,

    /// Moves the refined dots once more, each to the center of a cell that holds as much of the photograph as
    /// every other: the best there is, in about four times the time.
    ///
    /// Not with `--refine 0`.
    #[arg(long)]
    pub(crate) best: bool,

    /// Where dots lie before they are refined: `relaxed`, where they are evenly spread at every density;
    /// `fixed`, at the centers of tiles, where rows and clumps show, but where more dots only ever add
    /// to fewer.
    #[arg(long, value_enum, value_name = "HOW", default_value_t = CentersName::Relaxed)]
    pub(crate) centers: CentersName,

    /// Whether dots allow for the ink that is lost where they overlap: `correct` puts more of them where it
    /// is dark, so that ink covers as much as the photograph asks for; `ignore` puts as many as it asks.
    ///
    /// [default: correct in pictures, ignore in lists of points]
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) dot_gain: Option<DotGain>,

    /// Size of the SVG, PNG or PDF picture, as a multiple of the photograph's; dots grow with it [default: 1].
    ///
    /// Not for CSV and NPY, whose unit without `--page` is always the photograph's pixel.
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) scale: Option<f64>,

    /// Draw the I-th of N parts of the dots, as one of several machines: I from 1 to N, CSV, SVG or NPY, `--refine 0`.
    ///
    /// All parts of CSV or SVG, one after the other, are the file that would be written without this; `twelvefold
    /// merge` puts parts of all three together. Of a TIFF or OpenEXR file that is stored in strips or tiles, a part
    /// reads what it needs. See docs/farm.md.
    #[arg(
        long,
        value_name = "I/N",
        conflicts_with_all = ["best", "exact", "pen", "pens", "line", "marks", "order"]
    )]
    pub(crate) part: Option<Part>,

    /// What `twelvefold survey` wrote about the photograph, with the same options for its tone. Without it, each part
    /// reads all of the photograph first.
    #[arg(long, value_name = "FILE", requires = "part")]
    pub(crate) survey: Option<PathBuf>,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) paper: PaperOptions,
}

/// Options of `twelvefold survey`.
#[derive(Debug, Args)]
pub(crate) struct SurveyOptions {
    /// The photograph.
    pub(crate) photo: PathBuf,

    #[command(flatten)]
    pub(crate) tone: ToneOptions,

    /// Which layer of an OpenEXR file is drawn.
    #[arg(long, value_name = "NAME")]
    pub(crate) layer: Option<String>,

    /// Where the survey goes, or `-` for standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Options of `twelvefold merge`.
#[derive(Debug, Args)]
pub(crate) struct MergeOptions {
    /// All parts, the first one first.
    #[arg(required = true, num_args = 1..)]
    pub(crate) parts: Vec<PathBuf>,

    /// Where the file goes, or `-` for standard output.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

/// What is done about ink that overlaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum DotGain {
    /// More dots where it is dark.
    Correct,
    /// Nothing.
    Ignore,
}

/// Where dots lie before they are refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum CentersName {
    /// Moved aside, evenly spread.
    Relaxed,
    /// At the centers of tiles.
    Fixed,
}

impl CentersName {
    /// The centers of this name.
    pub(crate) fn centers(self) -> Centers {
        match self {
            Self::Relaxed => Centers::Relaxed,
            Self::Fixed => Centers::Fixed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_well_formed() {
        use clap::CommandFactory as _;
        Arguments::command().debug_assert();
    }

    #[test]
    fn policies_for_infinities_have_names() {
        assert_eq!(infinite("zero"), Ok(InfiniteRadiance::Zero));
        assert_eq!(infinite("clamp=65504"), Ok(InfiniteRadiance::Clamp(65504.0)));
        for bad in ["", "clamp", "clamp=", "clamp=-1", "clamp=inf", "clamp=NaN", "Zero"] {
            assert!(infinite(bad).is_err(), "{bad}");
        }
    }
}
