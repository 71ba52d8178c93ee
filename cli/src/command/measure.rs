//! `twelvefold measure`: how even a list of points is, and how well it follows a photograph.

use std::fs;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

use glam::DVec2;
use twelvefold_lab::measure::discrepancy::{self, Bounds};
use twelvefold_lab::measure::nearest::{self, Summary};
use twelvefold_lab::measure::periodogram::Periodogram;
use twelvefold_lab::measure::{MeasureError, Window, fidelity, hexagonal_distance, spectrum};

use crate::args::MeasureOptions;
use crate::report;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_files::picture::{self, Tone};
use twelvefold_files::point_list;

/// Longest list of points read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Most points for which the exact low-frequency sum, O(n²), is made.
const SPECTRUM_LIMIT: usize = 65_536;

/// Runs the subcommand.
pub(crate) fn run(options: &MeasureOptions) -> Result<(), Failure> {
    let of_list = |reason: Box<dyn std::error::Error>| Failure::at(&options.points, reason);
    let bytes = fs::metadata(&options.points).map_err(|error| of_list(error.into()))?.len();
    if bytes > MAX_BYTES {
        return Err(of_list("is longer than 1 GiB".into()));
    }
    let text = fs::read_to_string(&options.points).map_err(|error| of_list(error.into()))?;
    let points = point_list::parse(&text).map_err(|error| of_list(error.into()))?;

    let image = match &options.image {
        None => None,
        Some(path) => {
            let tone = Tone { linear: options.linear, invert: options.invert, ..Tone::default() };
            let picture =
                picture::read(path, tone).map_err(|error| report::of_input(path, error))?;
            report::warn(path, &picture.warnings);
            Some(picture)
        }
    };
    let window = match (options.window, &image) {
        (Some(window), _) => window,
        (None, Some(image)) => {
            Window::new(DVec2::ZERO, DVec2::new(image.width as f64, image.height as f64))
                .map_err(|error| of_list(error.into()))?
        }
        (None, None) => Window::UNIT,
    };
    let inside: Vec<DVec2> = points.iter().copied().filter(|p| window.contains(*p)).collect();
    if inside.len() < 2 {
        let (min, size) = (window.min(), window.size());
        let reason = format!(
            "has {} points, {} of them in the window {},{},{},{}; two are needed (see --window)",
            points.len(),
            inside.len(),
            min.x,
            min.y,
            size.x,
            size.y
        );
        return Err(of_list(reason.into()));
    }

    let mut table = uniform(&points, &inside, window).map_err(|error| of_list(error.into()))?;
    if let Some(image) = &image {
        let found = fidelity::Raster::new(image.width, &image.importance)
            .and_then(|raster| fidelity::fidelity(&points, &raster));
        match found {
            Ok(found) => {
                table.push(("block variance", found.block_variance));
                table.push(("local nearest mean", found.mean_distance));
                table.push(("local nearest 1 %", found.first_percentile));
            }
            // A short list, or a picture of nothing, has the other measures.
            Err(MeasureError::TooFew { .. } | MeasureError::AllZero) => {}
            Err(error) => return Err(of_list(error.into())),
        }
    }

    // Tables may go to standard output, pictures may not.
    let target = options.output.as_deref().unwrap_or(Path::new("-"));
    write_file(target, |out| {
        writeln!(out, "measure,value")?;
        table.iter().try_for_each(|(name, value)| writeln!(out, "{name},{value}"))
    })?;
    if options.spectrum.is_some() || options.rings.is_some() {
        let periodogram =
            Periodogram::new(&points, window).map_err(|error| of_list(error.into()))?;
        if let Some(path) = &options.rings {
            write_file(path, |out| {
                writeln!(out, "frequency,power,anisotropy")?;
                periodogram.rings().iter().try_for_each(|ring| {
                    writeln!(out, "{},{},{}", ring.frequency, ring.power, ring.anisotropy)
                })
            })?;
        }
        if let Some(path) = &options.spectrum {
            write_file(path, |out| out.write_all(&spectrum_picture(&periodogram)))?;
        }
    }
    Ok(())
}

/// The measures that take the density as constant.
fn uniform(
    points: &[DVec2],
    inside: &[DVec2],
    window: Window,
) -> Result<Vec<(&'static str, f64)>, MeasureError> {
    let mut table = vec![("points", inside.len() as f64)];
    let unit: Vec<DVec2> = inside.iter().map(|p| (*p - window.min()) / window.size()).collect();
    let Bounds { lower, upper } = discrepancy::star(&unit)?;
    if lower == upper {
        table.push(("star discrepancy", lower));
    } else {
        table.push(("star discrepancy at least", lower));
        table.push(("star discrepancy at most", upper));
    }
    table.push(("L2 star discrepancy", discrepancy::l2_star(&unit)?));
    let hexagonal = hexagonal_distance(inside.len() as f64 / window.area());
    let distances = nearest::distances(points, inside)?.iter().map(|d| d / hexagonal).collect();
    let summary = Summary::new(distances)?;
    table.push(("nearest least", summary.least()));
    table.push(("nearest 1 %", summary.percentile(0.01)));
    table.push(("nearest mean", summary.mean()));
    // Short lists and narrow windows have none.
    if inside.len() <= SPECTRUM_LIMIT
        && let Ok(power) = spectrum::low_frequency_power(points, window)
    {
        table.push(("low-frequency power", power));
    }
    Ok(table)
}

/// Writes a file as a whole, or standard output for `-`.
fn write_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let standard = path.as_os_str() == "-";
    let failed = |error: OutputError| {
        if standard { Failure::about("standard output", error) } else { Failure::at(path, error) }
    };
    let mut output =
        if standard { Output::standard() } else { Output::create(path).map_err(failed)? };
    let mut out = BufWriter::new(&mut output);
    let written = content(&mut out).and_then(|()| out.flush());
    drop(out);
    match written.map_err(OutputError::from).and_then(|()| output.commit()) {
        Err(OutputError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(failed),
    }
}

/// The periodogram as a gray PNG: black 0, white 4 times white noise, the zero frequency in the middle.
fn spectrum_picture(periodogram: &Periodogram) -> Vec<u8> {
    let side = 2 * periodogram.limit() as u32 + 1;
    let pixels = periodogram.power().iter().map(|power| {
        // The square root shows the dark disc in the middle as well as the ring around it.
        (255.0 * (power / 4.0).min(1.0).sqrt()) as u8
    });
    let mut bytes = io::Cursor::new(Vec::new());
    let image = image::GrayImage::from_raw(side, side, pixels.collect());
    if let Some(image) = image {
        // A gray picture of this size always has an encoding.
        let _ = image.write_to(&mut bytes, image::ImageFormat::Png);
    }
    bytes.into_inner()
}
