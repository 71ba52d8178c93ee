//! Figure 6: a tile subdivided twice with thresholds as gray, and the zoom into it.

use glam::DVec2;
use twelvefold::tiling::{Rules, Tile, TileCounts, TileType};
use twelvefold_lab::paper::LAMBDA;

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{Ranked, Window, cell, tiles_in, tiles_of};

const ROOT: TileType = TileType::A;

/// The red square of the top row, in root edges. Within 0.2929 edges of the root's center, where every
/// level descends from the root without a gap.
const OUTER: Window = Window { center: DVec2::new(0.05, 0.06), size: DVec2::splat(0.26) };

/// The red square of the lower row, one linear scaling factor smaller.
const INNER: Window = Window { center: DVec2::new(0.077, 0.04), size: DVec2::splat(0.26 / LAMBDA) };

const WIDTH: f64 = 1000.0;
const MARGIN: f64 = 14.0;
/// A picture of the top row.
const COLUMN: f64 = (WIDTH - 2.0 * MARGIN) / 3.0;
const TOP_HEIGHT: f64 = 1.12 * COLUMN;
/// The four pictures of the lower row, with the bars under them.
const GAP: f64 = 16.0;
const SIDE: f64 = (WIDTH - 2.0 * MARGIN - 3.0 * GAP) / 4.0;
const BAR: f64 = 22.0;

const CELL: &str = "stroke=\"#55606e\" stroke-width=\"0.7\" stroke-linejoin=\"round\"";
const FRAME: &str = "fill=\"none\" stroke=\"#222\"";
const RED_FRAME: &str = "fill=\"none\" stroke=\"#e02020\" stroke-width=\"2.4\"";
const LABEL: &str = "text-anchor=\"middle\" font-size=\"14\" fill=\"#222\"";

/// Figure 6: "(Top row) A tile of type 'a' subdivided two times, applying production rules (1). The
/// normalized threshold is shown as a real number in the range [0..1]. (low row) Zooming into the red
/// square of the top row, then subdividing and zooming".
pub(super) fn thresholds(rules: &Rules) -> Result<String> {
    let lower_row = TOP_HEIGHT + 56.0;
    let mut page = Canvas::new(
        DVec2::new(WIDTH, lower_row + SIDE + BAR + 52.0),
        "A tile of type a subdivided two times, and the zoom into it",
        "Above: the tile, its 13 children and their 181 children; gray is the normalized threshold \
         from 0, black, to 1, white. Below: the red square enlarged, subdivided, and again; the bar \
         under each shows the thresholds of the tiles in the square in ascending order.",
    );
    for levels in 0..=2 {
        let origin = DVec2::new(MARGIN + COLUMN * (levels as f64 + 0.5), 12.0 + TOP_HEIGHT / 2.0);
        // Descendants reach 0.71 root edges from the center.
        let view = View { scale: COLUMN / 1.42, center: DVec2::ZERO, origin };
        draw_whole(&mut page, rules, levels, &view)?;
    }
    let steps = [
        Step { levels: 2, window: OUTER, frame: RED_FRAME, square: None },
        Step { levels: 3, window: OUTER, frame: FRAME, square: Some(INNER) },
        Step { levels: 3, window: INNER, frame: RED_FRAME, square: None },
        Step { levels: 4, window: INNER, frame: FRAME, square: None },
    ];
    for (i, step) in steps.iter().enumerate() {
        let corner = DVec2::new(MARGIN + (SIDE + GAP) * i as f64, lower_row);
        step.draw(&mut page, rules, corner, &format!("step{i}"))?;
    }
    Ok(page.finish())
}

/// The threshold as it is drawn: rank over the number of tiles of the level.
fn threshold(ranked: &Ranked, tiles: u64) -> f64 {
    ranked.rank as f64 / tiles as f64
}

/// Black at 0, white at 1.
fn gray(threshold: f64) -> String {
    let level = (threshold * 255.0).round() as u8;
    format!("#{level:02x}{level:02x}{level:02x}")
}

/// The view of root edges as a view of level edges.
fn finer(view: &View, levels: usize) -> View {
    let edges = LAMBDA.powi(levels as i32);
    View { scale: view.scale / edges, center: view.center * edges, ..*view }
}

fn draw_cells(page: &mut Canvas, patch: &[Ranked], tiles: u64, view: &View) {
    for ranked in patch {
        let fill = format!("fill=\"{}\"", gray(threshold(ranked, tiles)));
        page.polygon(&view.map_all(&cell(&ranked.tile)), &fill);
    }
}

/// The whole tile subdivided `levels` times; numbers where there is room.
fn draw_whole(page: &mut Canvas, rules: &Rules, levels: usize, view: &View) -> Result<()> {
    let tiles = TileCounts::of(ROOT).at(levels)?;
    let patch = tiles_of(rules, ROOT, levels)?;
    let fine = finer(view, levels);
    page.open(&format!("class=\"level-{levels}\" {CELL}"));
    draw_cells(page, &patch, tiles, &fine);
    page.close();
    page.polygon(
        &view.map_all(&cell(&Tile::root(ROOT))),
        "fill=\"none\" stroke=\"#2b5fc4\" stroke-width=\"2\"",
    );
    let name = match levels {
        0 => "the tile".to_owned(),
        1 => format!("subdivided once: {tiles} tiles"),
        _ => format!("subdivided twice: {tiles} tiles"),
    };
    page.text(DVec2::new(view.origin.x, view.origin.y + view.scale * 0.8), &name, LABEL);
    if levels < 2 {
        draw_numbers(page, &patch, tiles, &fine);
    } else {
        draw_square(page, view, &OUTER);
    }
    Ok(())
}

fn draw_numbers(page: &mut Canvas, patch: &[Ranked], tiles: u64, view: &View) {
    page.open(
        "class=\"numbers\" text-anchor=\"middle\" font-size=\"14\" stroke-width=\"4\" \
         paint-order=\"stroke\"",
    );
    for ranked in patch {
        let threshold = threshold(ranked, tiles);
        let ink = if threshold < 0.5 { "#fff" } else { "#000" };
        page.text(
            view.map(ranked.center()) + DVec2::new(0.0, 5.0),
            &format!("{threshold:.3}"),
            // The halo keeps the tile's outline out of the number.
            &format!("fill=\"{ink}\" stroke=\"{}\"", gray(threshold)),
        );
    }
    page.close();
}

fn draw_square(page: &mut Canvas, view: &View, window: &Window) {
    let half = window.size / 2.0;
    let upper_left = view.map(window.center + DVec2::new(-half.x, half.y));
    page.rectangle(upper_left, window.size * view.scale, RED_FRAME);
}

/// One picture of the lower row: the tiles of a level in a window given in root edges.
struct Step {
    levels: usize,
    window: Window,
    frame: &'static str,
    /// The part that the next picture enlarges.
    square: Option<Window>,
}

impl Step {
    fn draw(&self, page: &mut Canvas, rules: &Rules, corner: DVec2, id: &str) -> Result<()> {
        let tiles = TileCounts::of(ROOT).at(self.levels)?;
        let size = DVec2::splat(SIDE);
        let view = View {
            scale: SIDE / self.window.size.x,
            center: self.window.center,
            origin: corner + size / 2.0,
        };
        let window = self.window.in_units_of(LAMBDA.powi(self.levels as i32));
        // Cells reach less than an edge past their centers.
        let patch = tiles_in(rules, ROOT, self.levels, &window, 1.0)?;
        page.open_clipped(id, corner, size, &format!("class=\"zoomed\" {CELL}"));
        draw_cells(page, &patch, tiles, &finer(&view, self.levels));
        page.close();
        page.rectangle(corner, size, self.frame);
        if let Some(square) = &self.square {
            draw_square(page, &view, square);
        }

        let inside = patch.iter().filter(|ranked| window.distance(ranked.center()) == 0.0);
        let mut thresholds: Vec<f64> = inside.map(|ranked| threshold(ranked, tiles)).collect();
        thresholds.sort_unstable_by(f64::total_cmp);
        draw_sorted(page, &thresholds, corner + DVec2::new(0.0, SIDE + 10.0));
        Ok(())
    }
}

/// Thresholds in ascending order side by side: an even ramp where they are spread evenly.
fn draw_sorted(page: &mut Canvas, thresholds: &[f64], corner: DVec2) {
    let width = SIDE / thresholds.len() as f64;
    for (i, threshold) in thresholds.iter().enumerate() {
        let left = width * i as f64;
        // Each reaches to the right end, under the next, so that no seam shows.
        page.rectangle(
            corner + DVec2::new(left, 0.0),
            DVec2::new(SIDE - left, BAR),
            &format!("fill=\"{}\"", gray(*threshold)),
        );
    }
    page.rectangle(corner, DVec2::new(SIDE, BAR), FRAME);
    page.text(
        corner + DVec2::new(SIDE / 2.0, BAR + 19.0),
        &format!("{} thresholds, sorted", thresholds.len()),
        LABEL,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_squares_lie_where_no_tile_is_missing() {
        for window in [OUTER, INNER] {
            let half = window.size / 2.0;
            // With room for the cells of level 2 that reach into the square from outside.
            let farthest = (window.center.abs() + half).length() + 0.35 / LAMBDA.powi(2);
            assert!(farthest < 1.0 - std::f64::consts::FRAC_1_SQRT_2, "{farthest}");
        }
        assert!((INNER.center - OUTER.center).abs().max_element() < 0.13 - INNER.size.x / 2.0);
    }

    #[test]
    fn any_square_holds_thresholds_spread_almost_evenly() {
        // What the caption says: sorted, the thresholds in the square stay close to a straight line.
        let tables = twelvefold::Tables::built_in();
        for (levels, window) in [(3, OUTER), (4, INNER), (5, INNER)] {
            let tiles = TileCounts::of(ROOT).at(levels).unwrap();
            let window = window.in_units_of(LAMBDA.powi(levels as i32));
            let mut thresholds: Vec<f64> = tiles_in(&tables.rules(), ROOT, levels, &window, 0.0)
                .unwrap()
                .iter()
                .map(|ranked| threshold(ranked, tiles))
                .collect();
            thresholds.sort_unstable_by(f64::total_cmp);
            let count = thresholds.len() as f64;
            for (i, threshold) in thresholds.iter().enumerate() {
                let error = (threshold - (i as f64 + 0.5) / count).abs();
                // 195 random thresholds would stray by 0.06 in the mean, 0.1 once in twenty times.
                assert!(error < 0.03, "level {levels}, {i} of {count}: {error}");
            }
        }
    }
}
