//! Our own variants against each other: time a point, nothing else.

use std::fmt::Write as _;

use glam::{DVec2, Vec2};
use twelvefold::estimate::{Weighting, exactly};
use twelvefold::{
    Amount, Constant, Domain, ImageMap, Importance, Limits, Placement, Position, Sampling, Tables,
    bake,
};

use super::least_time;

/// A Markdown table: nanoseconds a point of each variant, for constant importance and the picture.
///
/// A variant that cannot be made has an empty cell.
pub(crate) fn table(picture: &ImageMap, sizes: &[usize]) -> String {
    let mut text = String::from("| variant |");
    for name in ["constant", "picture"] {
        for n in sizes {
            let _ = write!(text, " {name}, {n} |");
        }
    }
    text += "\n|---|";
    text += &"---:|".repeat(2 * sizes.len());
    text += "\n";
    let rules = Tables::built_in().rules();
    for depth in 1..=bake::MAX_DEPTH {
        let Ok(bytes) = bake::bake(&rules, depth) else { continue };
        let Ok(tables) = Tables::from_bytes(&bytes) else { continue };
        let built_in = depth == Tables::built_in().depth();
        let name = if built_in { " (as built)" } else { "" };
        row(
            &mut text,
            &format!("buffer, f32, depth {depth}{name}"),
            picture,
            sizes,
            tables,
            Way::Fill32,
        );
        if built_in {
            row(&mut text, "buffer, f64", picture, sizes, tables, Way::Fill64);
            row(&mut text, "iterator with ranks, f32", picture, sizes, tables, Way::Iterate);
            row(&mut text, "weighted, f64", picture, sizes, tables, Way::Weighted);
            row(&mut text, "exactly n, f64", picture, sizes, tables, Way::Exactly);
        }
    }
    text + "\n"
}

/// How points are made.
#[derive(Clone, Copy)]
enum Way {
    Fill32,
    Fill64,
    Iterate,
    Weighted,
    Exactly,
}

fn row(
    text: &mut String,
    name: &str,
    picture: &ImageMap,
    sizes: &[usize],
    tables: Tables<'_>,
    way: Way,
) {
    let _ = write!(text, "| {name} |");
    for n in sizes {
        cell(text, nanoseconds(Domain::unit(), &Constant::ONE, *n, tables, way));
    }
    for n in sizes {
        cell(text, nanoseconds(picture.domain(), picture, *n, tables, way));
    }
    *text += "\n";
}

fn cell(text: &mut String, nanoseconds: Option<f64>) {
    let _ = match nanoseconds {
        Some(time) => write!(text, " {time:.1} |"),
        None => write!(text, " |"),
    };
}

/// Time a point of about `n`, without the placement.
fn nanoseconds<I: Importance>(
    domain: Domain,
    importance: &I,
    n: usize,
    tables: Tables<'_>,
    way: Way,
) -> Option<f64> {
    let placement = Placement::with_tables(domain, 1, tables);
    let sampling = Sampling::new(&placement, importance, Amount::Points(n as f64)).ok()?;
    let (found, seconds) = match way {
        Way::Fill32 => fill::<I, Vec2>(&sampling, n)?,
        Way::Fill64 => fill::<I, DVec2>(&sampling, n)?,
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
