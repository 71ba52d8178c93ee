//! Figures 1 and 2: the square-triangle tiling with its dual, two levels superimposed, and points.

use glam::DVec2;
use twelvefold::importance::Constant;
use twelvefold::tiling::{Rules, TileType};
use twelvefold::{Amount, Domain, Placement, Sampling};
use twelvefold_lab::paper::LAMBDA;

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{Window, cell, direction, star, tiles_in};

/// The root of the patches that are shown, and how many levels they lie below it.
const ROOT: TileType = TileType::A;
const LEVELS: usize = 4;

/// The seed of the points of figure 2.
const SEED: u64 = 1;

/// Figure 1: "Triangle-and-squares aperiodic tiling (red lines) and its dual (blue lines)."
pub(super) fn tiling_and_dual(rules: &Rules) -> Result<String> {
    const SCALE: f64 = 52.0;
    // Off the root's center, a six-fold rosette that no typical region has.
    let window = Window { center: DVec2::new(21.5, 12.0), size: DVec2::new(17.0, 11.0) };
    let margin = DVec2::splat(8.0);
    let size = window.size * SCALE;
    let mut page = Canvas::new(
        size + 2.0 * margin,
        "Triangle-and-squares aperiodic tiling (red) and its dual (blue)",
        "A patch of the square-triangle tiling, red, and the hexagons and pentagons of its dual, \
         blue: each is a tile whose center is a vertex of the red tiling.",
    );
    let view = View { scale: SCALE, center: window.center, origin: margin + size / 2.0 };

    page.open_clipped("patch", margin, size, "fill=\"none\" stroke-linejoin=\"round\"");
    // Edges and cells reach one edge past their vertex.
    let tiles = tiles_in(rules, ROOT, LEVELS, &window, 1.0)?;
    page.open("class=\"dual\" stroke=\"#2b5fc4\" stroke-width=\"2\"");
    for ranked in &tiles {
        page.polygon(&view.map_all(&cell(&ranked.tile)), "");
    }
    page.close();
    page.open("class=\"tiling\" stroke=\"#d3312a\" stroke-width=\"1.4\"");
    for ranked in &tiles {
        // Each edge has one end that sees it in a direction below 180°.
        for k in star(&ranked.tile).filter(|k| *k < 6) {
            let ends = [ranked.center(), ranked.center() + direction(k.into())];
            page.polyline(&view.map_all(&ends), "");
        }
    }
    page.close();
    page.close();
    page.rectangle(margin, size, "fill=\"none\" stroke=\"#222\"");
    Ok(page.finish())
}

/// Figure 2: "(left) Two levels consecutive of subdivision) of our dodecagonal tiling, superimposed.
/// (right) A typical distribution of dots obtained with our dodecagonal tiling."
pub(super) fn two_levels_and_points(rules: &Rules) -> Result<String> {
    const SIDE: f64 = 480.0;
    const MARGIN: f64 = 10.0;
    let mut page = Canvas::new(
        DVec2::new(2.0 * SIDE + 3.0 * MARGIN, SIDE + 2.0 * MARGIN),
        "Two consecutive levels superimposed, and a typical distribution of dots",
        "Left: the cells of one level, thick blue, over the cells of the next, thin. Each center of \
         the coarse level, a red ring, is again a center of the fine one, a dot: it becomes the \
         center of a hexagon, yellow. Right: 2000 points.",
    );
    draw_two_levels(&mut page, rules, DVec2::splat(MARGIN), SIDE)?;
    draw_points(&mut page, DVec2::new(2.0 * MARGIN + SIDE, MARGIN), SIDE)?;
    Ok(page.finish())
}

fn draw_two_levels(page: &mut Canvas, rules: &Rules, corner: DVec2, side: f64) -> Result<()> {
    // In edges of the fine level.
    let window = Window { center: DVec2::new(22.0, 13.2), size: DVec2::splat(15.0) };
    let fine =
        View { scale: side / window.size.x, center: window.center, origin: corner + side / 2.0 };
    let coarse = View { scale: fine.scale * LAMBDA, center: fine.center / LAMBDA, ..fine };
    let children = tiles_in(rules, ROOT, LEVELS, &window, 1.0)?;
    let parents = tiles_in(rules, ROOT, LEVELS - 1, &window.in_units_of(1.0 / LAMBDA), 1.0)?;

    page.open_clipped("levels", corner, DVec2::splat(side), "stroke-linejoin=\"round\"");
    page.open("class=\"fine\" stroke=\"#7f8c9b\" stroke-width=\"1\" fill=\"none\"");
    for ranked in &children {
        let is_center = ranked.tile.kind == TileType::A;
        let style = if is_center { "fill=\"#fbe38e\"" } else { "" };
        page.polygon(&fine.map_all(&cell(&ranked.tile)), style);
    }
    page.close();
    page.open("class=\"coarse\" fill=\"none\" stroke=\"#2b5fc4\" stroke-width=\"2.6\"");
    for ranked in &parents {
        page.polygon(&coarse.map_all(&cell(&ranked.tile)), "");
    }
    page.close();
    page.open("class=\"fine-centers\" fill=\"#222\"");
    for ranked in &children {
        page.circle(fine.map(ranked.center()), 1.9, "");
    }
    page.close();
    page.open("class=\"coarse-centers\" fill=\"none\" stroke=\"#d3312a\" stroke-width=\"1.8\"");
    for ranked in &parents {
        page.circle(coarse.map(ranked.center()), 5.2, "");
    }
    page.close();
    page.close();
    page.rectangle(corner, DVec2::splat(side), "fill=\"none\" stroke=\"#222\"");
    Ok(())
}

fn draw_points(page: &mut Canvas, corner: DVec2, side: f64) -> Result<()> {
    let size = DVec2::splat(side);
    let placement = Placement::new(Domain::new(corner, size)?, SEED);
    let sampling = Sampling::new(&placement, &Constant::ONE, Amount::Points(2000.0))?;
    page.open_clipped("points", corner, size, "class=\"points\" fill=\"#111\"");
    for sample in sampling.points::<DVec2>()? {
        page.circle(sample?.position, 2.4, "");
    }
    page.close();
    page.rectangle(corner, size, "fill=\"none\" stroke=\"#222\"");
    Ok(())
}
