//! The command line. Each subcommand's options live in a struct of their own; a new subcommand is a
//! variant of [`Command`], its options struct, and one arm in `main.rs`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::DVec2;
use twelvefold::tiling::TileType;
use twelvefold_lab::measure::Window;

use crate::drawing::Format;
use crate::page::length::Length;
use crate::page::options::PaperOptions;

/// The most dots that one run draws.
pub(crate) const MAX_POINTS: u64 = 50_000_000;

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
    Stipple(StippleOptions),
    /// Choose directions towards the light of an environment map, as CSV.
    ///
    /// The columns are x,y,z,pdf,red,green,blue: a direction of length 1, z up; its probability density
    /// per steradian; and the map's radiance there. The light that falls on a surface is estimated by
    /// the sum over all lines of radiance × cosine / (N × pdf).
    ///
    /// The map is a latitude-longitude image: the upper border is +z, and the left border and the
    /// quarter, half and three quarters of the width are +x, +y, -x and -y.
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
    /// digit first; its type; its rotation in units of 30°, 0 to 11; its centre z0 + z1·ζ + z2·ζ² +
    /// z3·ζ³, ζ = e^(iπ/6), in edges of its own level; its rank; rank over the number of tiles; and
    /// the centre again in edges of the root. The root's centre is the origin. Tiles are listed depth
    /// first, children by ascending digit.
    Tiling(TilingOptions),
}

/// Options of `twelvefold measure`.
#[derive(Debug, Args)]
pub(crate) struct MeasureOptions {
    /// The points: one a line, two coordinates, or columns named x and y.
    pub(crate) points: PathBuf,

    /// The rectangle in which the points are measured, as X,Y,WIDTH,HEIGHT [default: the photograph of
    /// --image, or 0,0,1,1]. Points outside serve as neighbours only.
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
    let numbers: Vec<f64> = text.split(',').filter_map(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, width, height]
            if numbers.iter().all(|n| n.is_finite()) && width > 0.0 && height > 0.0 =>
        {
            Ok(Window::new(DVec2::new(x, y), DVec2::new(width, height)))
        }
        _ => Err("not four finite numbers X,Y,WIDTH,HEIGHT with a size above zero".to_owned()),
    }
}

/// Options of `twelvefold envmap`.
#[derive(Debug, Args)]
pub(crate) struct EnvmapOptions {
    /// The environment map: Radiance HDR or OpenEXR, told apart by content.
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

    /// What to do with negative radiance, which resampling leaves in real maps.
    #[arg(long, value_enum, default_value_t = Negative::Reject)]
    pub(crate) negative: Negative,

    /// How directions are chosen.
    #[arg(long, value_enum, default_value_t = Method::Progressive)]
    pub(crate) method: Method,
}

/// A policy for negative radiance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Negative {
    /// It is an error, which names the first pixel.
    Reject,
    /// It counts as zero.
    Zero,
}

/// A way to choose directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// In an order of which each beginning is itself a good set.
    Progressive,
    /// A complete level of the tiling, warped: the least error for this number, in no useful order.
    Warp,
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
    /// The photograph: PNG, JPEG, TIFF, Radiance HDR or OpenEXR, told apart by content.
    ///
    /// Transparent pixels are laid over white. In float files negative values count as zero and
    /// values above one as white; a NaN or an infinity is an error.
    pub(crate) photo: PathBuf,

    /// Where the dots go: a file ending in .svg, .png, .pdf, .csv or .npy, or `-` for standard output, as
    /// CSV unless `--format` says otherwise.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// What to write, whatever the name of the output: a drawing, or a list of places, of which `npy` is an
    /// array of shape (dots, 2) and type float32.
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: Option<Format>,

    /// How many dots, at most 50,000,000 [default: a ninth of the sum of all pixels' darkness from 0 to 1,
    /// that is one every 3 pixels where the photograph is black; at least 3,000 where that many fit four
    /// to a pixel, at most 30,000].
    ///
    /// The number drawn is close to this, not equal to it.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MAX_POINTS))]
    pub(crate) points: Option<u64>,

    /// Exactly N dots, at most 10,000,000. With `--refine 0` they are in an order of which each beginning is
    /// itself a good stippling.
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
    /// With `--pen` only for `--marks ring`. Of no effect on CSV and NPY.
    #[arg(long, value_name = "LENGTH")]
    pub(crate) dot_size: Option<Length>,

    /// How often the dots are moved to draw the picture better, at most 1000; 10 take about 3 microseconds
    /// a dot. 0 leaves them where the tiling puts them, which needs no memory for them.
    ///
    /// [default: 10; 0 from two million dots on]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(..=1000))]
    pub(crate) refine: Option<u16>,

    /// Where dots lie before they are refined: `relaxed`, where they are evenly spread at every density;
    /// `fixed`, at the centers of tiles, where rows and clumps show, but where more dots only ever add
    /// to fewer.
    ///
    /// [default: relaxed; `--exact` begins with fixed ones]
    #[arg(long, value_enum, value_name = "HOW", conflicts_with = "exact")]
    pub(crate) centers: Option<Centers>,

    /// Whether dots allow for the ink that is lost where they overlap: `correct` puts more of them where it
    /// is dark, so that ink covers as much as the photograph asks for; `ignore` puts as many as it asks.
    ///
    /// [default: correct in pictures, ignore in lists of points]
    #[arg(long, value_enum, value_name = "HOW")]
    pub(crate) dot_gain: Option<DotGain>,

    /// Put dots where the photograph is light, and draw them white on black.
    #[arg(long)]
    pub(crate) invert: bool,

    /// Follow linear light instead of encoded values: averaged over an area, the dots then reflect as
    /// much light as the photograph.
    #[arg(long)]
    pub(crate) linear: bool,

    /// Size of the SVG, PNG or PDF picture, as a multiple of the photograph's; dots grow with it.
    ///
    /// Of no effect on CSV and NPY, whose unit without `--page` is always the photograph's pixel.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub(crate) scale: f64,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) paper: PaperOptions,
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
pub(crate) enum Centers {
    /// Moved aside, evenly spread.
    Relaxed,
    /// At the centres of tiles.
    Fixed,
}

/// Reads a finite number above zero.
fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("not a finite number above zero".to_owned()),
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
    fn numbers_must_be_finite_and_above_zero() {
        assert_eq!(positive("2.5"), Ok(2.5));
        for bad in ["0", "-1", "NaN", "inf", "1e999", "", "3px"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
    }
}
