//! The command line. Each subcommand's options live in a struct of their own; a new subcommand is a
//! variant of [`Command`], its options struct, and one arm in `main.rs`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use twelvefold::tiling::TileType;

/// The most dots that one run draws.
pub(crate) const MAX_POINTS: u64 = 50_000_000;

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
    /// Train the relaxed offsets of `tables/relaxed.bin`, or measure those of a file.
    Relax(RelaxOptions),
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
    /// Draw the paper's figures, fig1.svg to fig7.svg, from this program's own code.
    Figures(FiguresOptions),
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

/// Options of `twelvefold figures`.
#[derive(Debug, Args)]
pub(crate) struct FiguresOptions {
    /// The folder for the seven files, made if missing; files of the same names are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
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

    /// Where the dots go: a file ending in .svg, .png or .csv, or `-` for CSV on standard output.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// How many dots, at most 50,000,000 [default: one every 3 pixels where the photograph is black,
    /// that is a ninth of the sum of all pixels' darkness from 0 to 1].
    ///
    /// The number drawn is close to this, not equal to it.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=MAX_POINTS))]
    pub(crate) points: Option<u64>,

    /// Chooses which of many equally good arrangements is drawn.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,

    /// A dot's diameter in pixels of the photograph [default: the one at which the dots' areas add up
    /// to the whole area where the photograph is black].
    ///
    /// Of no effect on CSV.
    #[arg(long, value_name = "PIXELS", value_parser = positive)]
    pub(crate) dot_size: Option<f64>,

    /// Put dots where the photograph is light, and draw them white on black.
    #[arg(long)]
    pub(crate) invert: bool,

    /// Follow linear light instead of encoded values: averaged over an area, the dots then reflect as
    /// much light as the photograph.
    #[arg(long)]
    pub(crate) linear: bool,

    /// Size of the SVG or PNG picture, as a multiple of the photograph's; dots grow with it.
    ///
    /// Of no effect on CSV, whose unit is always the photograph's pixel.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    pub(crate) scale: f64,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Options of `twelvefold relax`.
#[derive(Debug, Args)]
pub(crate) struct RelaxOptions {
    /// Where the trained table goes.
    #[arg(short, long, value_name = "FILE", required_unless_present = "measure")]
    pub(crate) output: Option<PathBuf>,

    /// Measure this table instead of training one.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "tiny"])]
    pub(crate) measure: Option<PathBuf>,

    /// A digit assignment in the format of tables/digits.txt [default: the one inside this program].
    #[arg(long, value_name = "FILE")]
    pub(crate) digits: Option<PathBuf>,

    /// Chooses the places that are trained on. The same seed gives the same bytes with any number of
    /// threads.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub(crate) seed: u64,

    /// Threads to train with [default: one a processor].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,

    /// Train for seconds only, on a coarse grid: to try the command, not to use the table.
    #[arg(long)]
    pub(crate) tiny: bool,

    /// Neither show progress nor measure the result.
    #[arg(short, long)]
    pub(crate) quiet: bool,
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
