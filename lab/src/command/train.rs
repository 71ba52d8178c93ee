//! `twelvefold-lab train`: trains the relaxed offsets that `build.rs` bakes, and measures them.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, ErrorKind, IsTerminal as _, Write as _};
use std::path::Path;
use std::time::Instant;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use twelvefold::Tables;
use twelvefold::bake::displacement::Displacements;
use twelvefold::tiling::{Digits, OutOfRange, Rules};
use twelvefold_lab::measure::Evenness;
use twelvefold_lab::train::{Recipe, evaluate};

use crate::args::TrainOptions;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::Output;

/// Phases and places a phase that the report measures.
const PHASES: usize = 16;
const PLACES: u64 = 3;

/// Dots on the report's images.
const IMAGE_POINTS: f64 = 65536.0;

/// The report's places; training's come from other streams of other seeds.
const REPORT_SEED: u64 = 0x7265_706f_7274;

/// Runs the subcommand.
pub(crate) fn run(options: &TrainOptions) -> Result<(), Failure> {
    let rules = rules(options.digits.as_deref())?;
    let threads = options.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::about("--threads", error))?;
    let table = match (&options.measure, &options.output) {
        (Some(path), _) => read(path, &rules)?,
        (None, Some(path)) => train(options, path, &rules, &pool)?,
        // The parser asks for one of the two.
        (None, None) => return Err(Failure::about("--output", "missing")),
    };
    if options.quiet {
        return Ok(());
    }
    let text = pool
        .install(|| description(&rules, &table))
        .map_err(|error| Failure::about("the report", error))?;
    match io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| Failure::about("standard output", error)),
    }
}

fn rules(digits: Option<&Path>) -> Result<Rules, Failure> {
    let Some(path) = digits else { return Ok(Tables::built_in().rules()) };
    let text = fs::read_to_string(path).map_err(|error| Failure::at(path, error))?;
    let digits = Digits::parse(&text).map_err(|error| Failure::at(path, error))?;
    Rules::new(&digits).map_err(|error| Failure::at(path, error))
}

fn read(path: &Path, rules: &Rules) -> Result<Displacements, Failure> {
    let bytes = fs::read(path).map_err(|error| Failure::at(path, error))?;
    let table = Displacements::from_bytes(&bytes).map_err(|error| Failure::at(path, error))?;
    if !table.fits(rules.digits()) {
        return Err(Failure::at(path, "trained for another digit assignment"));
    }
    Ok(table)
}

fn train(
    options: &TrainOptions,
    path: &Path,
    rules: &Rules,
    pool: &rayon::ThreadPool,
) -> Result<Displacements, Failure> {
    let recipe = if options.tiny { Recipe::tiny() } else { Recipe::standard() };
    // Before minutes of work rather than after.
    let mut output = Output::create(path).map_err(|error| Failure::at(path, error))?;
    let bar = bar(recipe.sweeps(), options.quiet);
    let start = Instant::now();
    let provenance = format!(
        "twelvefold {} relax{} --seed {}",
        env!("CARGO_PKG_VERSION"),
        if options.tiny { " --tiny" } else { "" },
        options.seed,
    );
    let table = pool
        .install(|| recipe.train(rules, options.seed, provenance, &mut || bar.inc(1)))
        .map_err(|error| Failure::about("training", error))?;
    bar.finish_and_clear();
    let bytes = table.to_bytes().map_err(|error| Failure::about("training", error))?;
    output.write_all(&bytes).map_err(|error| Failure::at(path, error))?;
    output.commit().map_err(|error| Failure::at(path, error))?;
    if !options.quiet {
        let seconds = start.elapsed().as_secs_f64();
        let _ = writeln!(io::stderr(), "{} bytes in {seconds:.0} s", bytes.len());
    }
    Ok(table)
}

fn bar(sweeps: usize, quiet: bool) -> ProgressBar {
    if quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(sweeps as u64), ProgressDrawTarget::stderr());
    // A template that does not parse leaves the plain style, which is a bar as well.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos} of {len} sweeps, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}

/// The figures of the table beside those of fixed centers, on places that training never saw.
fn description(rules: &Rules, table: &Displacements) -> Result<String, OutOfRange> {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "provenance  {}", table.provenance);
    for (name, layer) in [("smooth", Some(&table.smooth)), ("rough", table.rough.as_ref())] {
        if let Some(layer) = layer {
            let vectors: usize = layer.slots().iter().map(|slot| slot.vectors.len()).sum();
            let _ = writeln!(
                text,
                "{name:<10}  {} slots, {vectors} vectors, longest {:.2} edges",
                layer.slots().len(),
                layer.longest(1.0, f64::INFINITY),
            );
        }
    }
    let _ = writeln!(
        text,
        "\nuniform density, the worst of {PLACES} windows of {} points\n\
         \x20                 relaxed                    fixed centers\n\
         \x20  tau    lowE  dmean  dmin      lowE  dmean  dmin",
        evaluate::WINDOW_POINTS
    );
    let sweep = |table| evaluate::uniform_sweep(rules, table, PHASES, PLACES, REPORT_SEED);
    let (relaxed, fixed) = (sweep(Some(table))?, sweep(None)?);
    let line = |e: Option<Evenness>| {
        e.map_or(String::from("too few points"), |e| {
            format!("{:.4}  {:.3}  {:.3}", e.low_frequency, e.mean_distance, e.least_distance)
        })
    };
    for ((tau, relaxed), (_, fixed)) in relaxed.iter().zip(&fixed) {
        let (relaxed, fixed) = (line(evaluate::worst(relaxed)), line(evaluate::worst(fixed)));
        let _ = writeln!(text, "{tau:6.3}   {relaxed}    {fixed}");
    }
    let all =
        |sweep: &[(f64, Vec<Evenness>)]| line(evaluate::worst(sweep.iter().flat_map(|s| &s.1)));
    let _ = writeln!(text, " worst   {}    {}", all(&relaxed), all(&fixed));

    let _ = writeln!(
        text,
        "\nimages, mean of 4 phases, {IMAGE_POINTS} points\n\
         \x20                  variance  nn mean  nn 1 %  wrong side of an edge"
    );
    let side = evaluate::TEST_IMAGE_SIDE;
    for (name, values) in [("test", evaluate::test_image()), ("edges", evaluate::edge_image())] {
        for (kind, table) in [("relaxed", Some(table)), ("fixed", None)] {
            let measured =
                evaluate::image_sweep(rules, table, &values, side, IMAGE_POINTS, 4, REPORT_SEED)?;
            let mean = |figure: &dyn Fn(&(_, f64)) -> f64| {
                measured.iter().map(figure).sum::<f64>() / measured.len() as f64
            };
            let _ = writeln!(
                text,
                "{name:<6} {kind:<8}    {:.4}    {:.3}    {:.3}   {:.5}",
                mean(
                    &|(f, _): &(twelvefold_lab::measure::fidelity::Fidelity, f64)| f.block_variance
                ),
                mean(&|(f, _)| f.mean_distance),
                mean(&|(f, _)| f.first_percentile),
                mean(&|(_, wrong)| *wrong),
            );
        }
    }
    Ok(text)
}
