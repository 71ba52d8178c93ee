//! The command line: each subcommand's options live in a struct of their own.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

/// Studies of twelvefold: reports, figures, and the training of its tables.
#[derive(Debug, Parser)]
#[command(name = "twelvefold-lab", version, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Train the relaxed offsets of `tables/relaxed.bin`, or measure those of a file.
    Train(TrainOptions),
    /// Measure error and time of this program's samples and of others in use.
    ///
    /// Writes report.md, report.csv and a picture for each scene. Takes some minutes.
    Report(ReportOptions),
    /// Draw the paper's figures, fig1.svg to fig7.svg, from this program's own code.
    Figures(FiguresOptions),
    /// Measure nanoseconds a point, ours and rivals', on one thread and two.
    ///
    /// Writes speed.md and speed.svg, and the former to standard output. Takes some ten minutes.
    Speed(SpeedOptions),
    /// Measure how even uniform point sets are, ours and rivals': the worst of a few sets a line.
    ///
    /// Power at low frequency (white noise = 1), mean and least nearest distance (hexagonal lattice = 1).
    Evenness(EvennessOptions),
    /// Measure how even dots of several classes are, all together and those of each class: bands of rank, a
    /// random split, classes exchanged between neighbors, and refined.
    ///
    /// The columns are those of evenness, of dots on even ground.
    Classes(ClassesOptions),
    /// Measure how well dots draw photographs, and in what time: ours, weighted and linked Voronoi stippling,
    /// error diffusion, and dots of other programs in files.
    ///
    /// Means over the photographs: tone error after a blur of 1, 2 and 4 spacings; PSNR and structural similarity;
    /// first percentile and mean of nearest distances (hexagonal = 1).
    Stipplers(StipplersOptions),
}

/// Options of `twelvefold-lab report`.
#[derive(Debug, Args)]
pub(crate) struct ReportOptions {
    /// The folder for the report, made if missing; files of the same names are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,

    /// Environment maps, beside three built-in skies; negative radiance counts as zero.
    #[arg(long = "environment", value_name = "MAP")]
    pub(crate) environments: Vec<PathBuf>,

    /// The photograph whose tone is followed [default: a drawing].
    #[arg(long, value_name = "PHOTO")]
    pub(crate) photo: Option<PathBuf>,

    /// The greatest number of samples: smaller is sooner done.
    #[arg(long, value_name = "N", default_value_t = 65_536)]
    pub(crate) samples: usize,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Options of `twelvefold-lab figures`.
#[derive(Debug, Args)]
pub(crate) struct FiguresOptions {
    /// The folder for the seven files, made if missing; files of the same names are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// Options of `twelvefold-lab speed`.
#[derive(Debug, Args)]
pub(crate) struct SpeedOptions {
    /// The folder for the report, made if missing; files of the same names are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// Options of `twelvefold-lab evenness`.
#[derive(Debug, Args)]
pub(crate) struct EvennessOptions {
    /// Points a set; the time is O(n²).
    #[arg(long, value_name = "N", default_value_t = 16_384, value_parser = clap::value_parser!(u32).range(64..=1 << 20))]
    pub(crate) points: u32,
}

/// Options of `twelvefold-lab classes`.
#[derive(Debug, Args)]
pub(crate) struct ClassesOptions {
    /// Dots of all classes together, about; the time is O(n²).
    #[arg(long, value_name = "N", default_value_t = 8000, value_parser = clap::value_parser!(u32).range(2000..=1 << 18))]
    pub(crate) points: u32,

    /// Iterations with both energies.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(..=1000))]
    pub(crate) iterations: u16,
}

/// Options of `twelvefold-lab stipplers`.
#[derive(Debug, Args)]
pub(crate) struct StipplersOptions {
    /// The photographs.
    #[arg(required = true, value_name = "PHOTO")]
    pub(crate) photos: Vec<PathBuf>,

    /// Dots, about.
    #[arg(short = 'n', long, value_name = "N", default_value_t = 15_000, value_parser = clap::value_parser!(u32).range(100..=1 << 20))]
    pub(crate) points: u32,

    /// Dots of another program, in pixels of the photograph: a list for each photograph, in their order. Named
    /// after the first list.
    #[arg(long = "list", value_name = "FILE")]
    pub(crate) lists: Vec<PathBuf>,
}

/// Options of `twelvefold-lab train`.
#[derive(Debug, Args)]
pub(crate) struct TrainOptions {
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
