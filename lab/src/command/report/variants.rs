//! Our own variants against each other: time a point, and the error that they leave.

use std::fmt::Write as _;

use glam::{DVec2, Vec2};
use twelvefold::estimate::{Weighting, exactly};
use twelvefold::{
    Amount, Constant, Domain, ImageMap, Importance, InvalidPixels, Limits, Placement, Position,
    Probed, Sampling, Scalar as _, StippleMap, Tables, bake,
};

use super::scenes::PLANES;
use super::{Gathered, least_time, tone};

/// The number of points at which the table states errors.
const SIZE: usize = 16_384;

/// Placements for an error.
const SEEDS: u64 = 8;

/// How points are made.
#[derive(Clone, Copy)]
enum Way {
    Fill32,
    Fill64,
    Iterate,
    Weighted,
    Exactly,
    /// Relaxed offsets, on the picture as it is.
    Relaxed32,
    Relaxed64,
    /// Relaxed offsets, on the picture made ready for them, as the program stipples.
    Stipple32,
    /// Bounds probed at seven points of a tile, as in the paper, instead of proven.
    Probed32,
}

/// A Markdown table: for constant importance and the picture, nanoseconds a point of each variant at
/// `sizes`, and its error.
///
/// What a variant cannot make, or what would only repeat a cell above, is empty.
pub(crate) fn table(picture: &ImageMap, sizes: &[usize]) -> String {
    let mut text = String::from("| variant |");
    for (name, error) in [("constant", "error of the bump"), ("picture", "tone error")] {
        for n in sizes {
            let _ = write!(text, " {name}, {n} |");
        }
        let _ = write!(text, " {error} |");
    }
    text += "\n|---|";
    text += &"---:|".repeat(2 * sizes.len() + 2);
    text += "\n";
    let built_in = Tables::built_in();
    let displacements = built_in.to_relaxation();
    for depth in 1..=bake::MAX_DEPTH {
        let Ok(bytes) = bake::bake(&built_in.rules(), depth, displacements.as_ref()) else {
            continue;
        };
        let Ok(tables) = Tables::from_bytes(&bytes) else { continue };
        let as_built = depth == built_in.depth();
        let mut rows = vec![("fixed, f32", Way::Fill32), ("relaxed, f32", Way::Relaxed32)];
        if as_built {
            rows.extend([
                ("fixed, f64", Way::Fill64),
                ("relaxed, f64", Way::Relaxed64),
                ("relaxed stipple map, f32", Way::Stipple32),
                ("fixed, few-probe bounds, f32", Way::Probed32),
                ("iterator with ranks, f32", Way::Iterate),
                ("weighted, f64", Way::Weighted),
                ("exactly n, f64", Way::Exactly),
            ]);
        }
        for (name, way) in rows {
            let built = if as_built { " (as built)" } else { "" };
            let _ = write!(text, "| {name}, depth {depth}{built} |");
            row(&mut text, picture, sizes, tables, way);
        }
    }
    text + "\n"
}

fn row(text: &mut String, picture: &ImageMap, sizes: &[usize], tables: Tables<'_>, way: Way) {
    let constant = Domain::UNIT;
    for n in sizes {
        // Without texture there is nothing to make ready, and every bound is exact.
        let same = matches!(way, Way::Stipple32 | Way::Probed32);
        let time =
            (!same).then(|| nanoseconds(constant, &Constant::ONE, *n, tables, way)).flatten();
        cell(text, time, 1);
    }
    let bump = |set: &[DVec2], seed: u64| {
        let (function, integral) = (PLANES[0].instance)(seed);
        let estimate = set.iter().map(|p| function(*p)).sum::<f64>() / SIZE as f64;
        estimate / integral - 1.0
    };
    let made = |seed| positions(constant, &Constant::ONE, seed, tables, way);
    let same = matches!(way, Way::Stipple32 | Way::Probed32 | Way::Iterate | Way::Weighted);
    cell(text, (!same).then(|| rms(made, bump)).flatten(), 3);

    let shades = |dots: &[DVec2], _| tone::error(picture, dots, SIZE);
    match way {
        Way::Stipple32 => {
            let stipple = |n: usize| {
                let ((width, height), pixels) = (picture.size(), picture.pixels().to_vec());
                StippleMap::new(width, height, pixels, InvalidPixels::Reject, n as f64).ok()
            };
            for n in sizes {
                let map = stipple(*n);
                cell(text, map.and_then(|m| nanoseconds(m.domain(), &m, *n, tables, way)), 1);
            }
            let error = stipple(SIZE).and_then(|map| {
                rms(|seed| positions(map.domain(), &map, seed, tables, way), shades)
            });
            cell(text, error, 3);
        }
        Way::Probed32 => {
            let map = Probed::new(picture, picture.domain(), 1.0);
            follow(text, picture.domain(), &map, sizes, tables, way, shades);
        }
        _ => follow(text, picture.domain(), picture, sizes, tables, way, shades),
    }
    *text += "\n";
}

/// Times and tone error of an importance that does not depend on the number of points.
fn follow<I: Importance>(
    text: &mut String,
    domain: Domain,
    importance: &I,
    sizes: &[usize],
    tables: Tables<'_>,
    way: Way,
    error: impl Fn(&[DVec2], u64) -> f64,
) {
    for n in sizes {
        cell(text, nanoseconds(domain, importance, *n, tables, way), 1);
    }
    let same = matches!(way, Way::Iterate | Way::Weighted);
    let made = |seed| positions(domain, importance, seed, tables, way);
    cell(text, (!same).then(|| rms(made, error)).flatten(), 3);
}

/// Root-mean-square error over the seeds, in percent.
fn rms(
    make: impl Fn(u64) -> Option<Vec<DVec2>>,
    error: impl Fn(&[DVec2], u64) -> f64,
) -> Option<f64> {
    let mut gathered = Gathered::default();
    for seed in 0..SEEDS {
        gathered.add(error(&make(seed)?, seed), 0.0);
    }
    gathered.measured(SIZE).map(|measured| 100.0 * measured.error)
}

fn cell(text: &mut String, number: Option<f64>, digits: usize) {
    let _ = match number {
        Some(number) => write!(text, " {number:.digits$} |"),
        None => write!(text, " |"),
    };
}

/// The set of about [`SIZE`] points that this way makes.
fn positions<I: Importance>(
    domain: Domain,
    importance: &I,
    seed: u64,
    tables: Tables<'_>,
    way: Way,
) -> Option<Vec<DVec2>> {
    let placement = Placement::new_in(domain, seed, tables);
    let amount = Amount::Points(SIZE as f64);
    let sampling = Sampling::new(&placement, importance, amount).ok()?;
    match way {
        Way::Fill32 | Way::Iterate | Way::Probed32 => filled::<I, Vec2>(&sampling),
        Way::Fill64 | Way::Weighted => filled::<I, DVec2>(&sampling),
        Way::Relaxed32 | Way::Stipple32 => filled::<I, Vec2>(&sampling.relaxed().ok()?),
        Way::Relaxed64 => filled::<I, DVec2>(&sampling.relaxed().ok()?),
        Way::Exactly => {
            let points = exactly(&placement, importance, SIZE, Limits::default()).ok()?;
            Some(points.into_iter().map(|point| point.position).collect())
        }
    }
}

fn filled<I: Importance, P: Position>(sampling: &Sampling<'_, I>) -> Option<Vec<DVec2>> {
    let mut buffer = vec![P::default(); 2 * SIZE];
    let filled = sampling.fill(&mut buffer).ok()?;
    let double = |position: &P| {
        let [x, y] = position.xy();
        DVec2::new(x.to_f64(), y.to_f64())
    };
    Some(buffer[..filled.written].iter().map(double).collect())
}

/// Time a point of about `n`, without the placement.
fn nanoseconds<I: Importance>(
    domain: Domain,
    importance: &I,
    n: usize,
    tables: Tables<'_>,
    way: Way,
) -> Option<f64> {
    let placement = Placement::new_in(domain, 1, tables);
    let sampling = Sampling::new(&placement, importance, Amount::Points(n as f64)).ok()?;
    let (found, seconds) = match way {
        Way::Fill32 | Way::Probed32 => fill::<I, Vec2>(&sampling, n)?,
        Way::Fill64 => fill::<I, DVec2>(&sampling, n)?,
        Way::Relaxed32 | Way::Stipple32 => fill::<I, Vec2>(&sampling.relaxed().ok()?, n)?,
        Way::Relaxed64 => fill::<I, DVec2>(&sampling.relaxed().ok()?, n)?,
        Way::Iterate => least_time(|| {
            sampling.points::<Vec2>().map_or(0, |points| points.filter(Result::is_ok).count())
        }),
        Way::Weighted => least_time(|| {
            let points = sampling.weighted(Weighting::Density);
            points.map_or(0, |points| points.filter(Result::is_ok).count())
        }),
        Way::Exactly => least_time(|| {
            exactly(&placement, importance, n, Limits::default()).map_or(0, |points| points.len())
        }),
    };
    (found > 0).then(|| 1e9 * seconds / found as f64)
}

fn fill<I: Importance, P: Position>(sampling: &Sampling<'_, I>, n: usize) -> Option<(usize, f64)> {
    let mut buffer = vec![P::default(); 2 * n + 64];
    let (found, seconds) =
        least_time(|| sampling.fill(&mut buffer).map_or(0, |filled| filled.written));
    (found > 0).then_some((found, seconds))
}
