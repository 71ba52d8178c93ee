//! Writes the speed table (Markdown) and its picture (SVG): every contender of the benches, in one
//! process, one thread, least time of several runs.

mod effort;
mod picture;
mod targets;

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::Command;
use std::time::{Duration, Instant};
use std::{env, fs};

use glam::Vec2;
use twelvefold_files::failure::Failure;
use twelvefold_lab::contenders::{self, Contender};
use twelvefold_lab::maps;

use crate::args::SpeedOptions;

/// Numbers of points of the uniform table.
const UNIFORM: [usize; 6] = [1 << 6, 1 << 10, 1 << 14, 1 << 16, 1 << 20, 1 << 24];

/// Numbers of points of the tables of maps.
const IMAGE: [usize; 8] = [1 << 4, 1 << 6, 1 << 8, 1 << 10, 1 << 12, 1 << 16, 1 << 20, 1 << 24];

/// How long a contender is called before the next one's turn: long enough that
/// threads have woken up and found their cores.
const TURN: Duration = Duration::from_millis(40);

/// Calls that take less, in ns, are made once before the clock runs.
const WARM_UP: f64 = 50e6;

/// Least times of one contender, in ns a point made, by number of points; NaN where it was not run.
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) nanoseconds: Vec<f64>,
}

/// One table.
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) counts: &'static [usize],
    pub(crate) rows: Vec<Row>,
}

impl Table {
    /// ns a point of the first row whose name begins so.
    pub(crate) fn at(&self, name: &str, n: usize) -> f64 {
        let row = self.rows.iter().find(|row| row.name.starts_with(name));
        let column = self.counts.iter().position(|count| *count == n);
        row.zip(column).map_or(f64::NAN, |(row, column)| row.nanoseconds[column])
    }
}

fn measure(title: String, counts: &'static [usize], contenders: &[Contender<'_>]) -> Table {
    let most = counts.iter().copied().max().unwrap_or(0);
    let mut buffer = vec![Vec2::ZERO; most + most / 8 + 64];
    buffer.fill(Vec2::ONE);
    let mut rows: Vec<Row> = contenders
        .iter()
        .map(|contender| Row { name: contender.name.clone(), nanoseconds: Vec::new() })
        .collect();
    for n in counts.iter().copied() {
        let mut run: Vec<_> = contenders
            .iter()
            .map(|contender| (n <= contender.most).then(|| (contender.prepare)(n)))
            .collect();
        let mut least = vec![f64::INFINITY; contenders.len()];
        let mut counted = vec![false; contenders.len()];
        // In turns, so that a disturbance of the machine meets all alike.
        for _ in 0..7 {
            for (i, make) in run.iter_mut().enumerate() {
                let Some(make) = make else { continue };
                if !std::mem::replace(&mut counted[i], true) {
                    contenders[i].assert_count(n, make(&mut buffer));
                }
                // As in a steady loop: not with what the others have left in the caches.
                if least[i] < WARM_UP / n as f64 {
                    make(&mut buffer);
                }
                let (mut made, mut calls) = (0, 0);
                let start = Instant::now();
                while calls == 0 || start.elapsed() < TURN {
                    // Many calls to a look at the clock where calls are short.
                    for _ in 0..(4096 / n).max(1) {
                        made += std::hint::black_box(make(&mut buffer));
                        calls += 1;
                    }
                }
                let nanoseconds = start.elapsed().as_nanos() as f64 / made as f64;
                least[i] = least[i].min(nanoseconds);
            }
        }
        for ((row, least), make) in rows.iter_mut().zip(least).zip(&run) {
            row.nanoseconds.push(if make.is_some() { least } else { f64::NAN });
        }
        eprintln!("{title}: {n} points");
    }
    Table { title, counts, rows }
}

fn markdown(table: &Table) -> String {
    let mut text = format!("### {}\n\nNanoseconds a point.\n\n| |", table.title);
    for n in table.counts {
        let _ = match n {
            0..1024 => write!(text, " {n} |"),
            1024..1_048_576 => write!(text, " {}k |", n >> 10),
            _ => write!(text, " {}M |", n >> 20),
        };
    }
    text += "\n|---|";
    text += &"---:|".repeat(table.counts.len());
    for row in &table.rows {
        let _ = write!(text, "\n| {} |", row.name);
        for nanoseconds in &row.nanoseconds {
            let _ = if nanoseconds.is_nan() {
                write!(text, " |")
            } else {
                write!(text, " {nanoseconds:.*} |", if *nanoseconds < 10.0 { 2 } else { 0 })
            };
        }
    }
    text + "\n\n"
}

/// The first line of a command's output.
fn line_of(command: &str, arguments: &[&str]) -> String {
    let output = Command::new(command).args(arguments).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned());
    text.ok().and_then(|text| text.lines().next().map(str::to_owned)).unwrap_or("unknown".into())
}

fn machine() -> String {
    let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split(':').nth(1)?.trim().to_owned())
    });
    format!(
        "{}, {} {}; {}; twelvefold {}; {}",
        cpu.unwrap_or_else(|| "unknown processor".into()),
        env::consts::OS,
        env::consts::ARCH,
        line_of("rustc", &["--version"]),
        env!("CARGO_PKG_VERSION"),
        line_of("date", &["-u", "+%Y-%m-%d"]),
    )
}

/// Runs the subcommand.
pub(crate) fn run(options: &SpeedOptions) -> Result<(), Failure> {
    let folder = &options.output;
    fs::create_dir_all(folder).map_err(|error| Failure::at(folder, error))?;

    let mut tables = vec![measure("Uniform".into(), &UNIFORM, &contenders::uniform())];
    for map in &maps::all() {
        let title = format!("{} map, largest over mean {:.0}", map.name, map.contrast());
        tables.push(measure(title, &IMAGE, &contenders::image(map)));
    }
    let targets = targets::table(&tables);
    let effort = effort::table();
    let mut text = format!(
        "One thread but where two are named, least of seven runs, construction of tables not counted. \
         {}.\n\n{targets}\n{effort}\n",
        machine()
    );
    for table in &tables {
        text += &markdown(table);
    }
    let (page, svg) = (folder.join("speed.md"), folder.join("speed.svg"));
    fs::write(&page, &text).map_err(|error| Failure::at(&page, error))?;
    picture::draw(&svg, &[&tables[0], &tables[1]])
        .map_err(|error| Failure::about("plot", error))?;
    // Whoever reads it may have gone; the files are there.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Ok(())
}
