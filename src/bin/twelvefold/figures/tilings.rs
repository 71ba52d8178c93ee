//! Figures 1 and 2: the square-triangle tiling with its dual, two levels superimposed, and points.

use glam::DVec2;
use twelvefold::paper::LAMBDA;
use twelvefold::tiling::{Rules, TileType};

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{Window, cell, direction, star, tiles_in};

/// The root of the patches that are shown, and how many levels they lie below it.
const ROOT: TileType = TileType::A;
const LEVELS: usize = 4;

/// Figure 1: "Triangle-and-squares aperiodic tiling (red lines) and its dual (blue lines)."
pub(super) fn tiling_and_dual(rules: &Rules) -> Result<String> {
    const SCALE: f64 = 52.0;
    // Off the root's centre, a six-fold rosette that no typical region has.
    let window = Window { centre: DVec2::new(21.5, 12.0), size: DVec2::new(17.0, 11.0) };
    let margin = DVec2::splat(8.0);
    let size = window.size * SCALE;
    let mut page = Canvas::new(
        size + 2.0 * margin,
        "Triangle-and-squares aperiodic tiling (red) and its dual (blue)",
        "A patch of the square-triangle tiling, red, and the hexagons and pentagons of its dual, \
         blue: each is a tile whose centre is a vertex of the red tiling.",
    );
    let view = View { scale: SCALE, centre: window.centre, origin: margin + size / 2.0 };

    page.open_clipped("patch", margin, size, "fill=\"none\" stroke-linejoin=\"round\"");
    // Edges and cells reach one edge past their vertex.
    let tiles = tiles_in(rules, ROOT, LEVELS, &window, 1.0)?;
    page.open("stroke=\"#2b5fc4\" stroke-width=\"2\"");
    for ranked in &tiles {
        page.polygon(&view.map_all(&cell(&ranked.tile)), "");
    }
    page.close();
    page.open("stroke=\"#d3312a\" stroke-width=\"1.4\"");
    for ranked in &tiles {
        // Each edge has one end that sees it in a direction below 180°.
        for k in star(&ranked.tile).filter(|k| *k < 6) {
            let ends = [ranked.centre(), ranked.centre() + direction(k.into())];
            page.polyline(&view.map_all(&ends), "");
        }
    }
    page.close();
    page.close();
    page.rectangle(margin, size, "fill=\"none\" stroke=\"#222\"");
    Ok(page.finish())
}

/// Figure 2, left: two consecutive levels superimposed.
pub(super) fn two_levels(rules: &Rules) -> Result<String> {
    let side = 460.0;
    let mut page = Canvas::new(DVec2::splat(side + 16.0), "Two levels", "x");
    let window = Window { centre: DVec2::new(5.6, 3.7) * LAMBDA, size: DVec2::splat(19.0) };
    let corner = DVec2::splat(8.0);
    let fine = View { scale: side / window.size.x, centre: window.centre, origin: corner + side / 2.0 };
    let coarse = View { scale: fine.scale * LAMBDA, centre: fine.centre / LAMBDA, ..fine };
    let children = tiles_in(rules, ROOT, LEVELS, &window, 1.0)?;
    let parents = tiles_in(rules, ROOT, LEVELS - 1, &window.in_units_of(1.0 / LAMBDA), 1.0)?;

    page.open_clipped("levels", corner, DVec2::splat(side), "stroke-linejoin=\"round\"");
    page.open("stroke=\"#7f8c9b\" stroke-width=\"1\" fill=\"#fff\"");
    for ranked in &children {
        let style = if ranked.tile.kind == TileType::A { "fill=\"#fdeeb5\"" } else { "" };
        page.polygon(&fine.map_all(&cell(&ranked.tile)), style);
    }
    page.close();
    page.open("fill=\"none\" stroke=\"#2b5fc4\" stroke-width=\"2.4\"");
    for ranked in &parents {
        page.polygon(&coarse.map_all(&cell(&ranked.tile)), "");
    }
    page.close();
    page.open("fill=\"#333\"");
    for ranked in &children {
        page.circle(fine.map(ranked.centre()), 1.7, "");
    }
    page.close();
    page.open("fill=\"none\" stroke=\"#d3312a\" stroke-width=\"1.6\"");
    for ranked in &parents {
        page.circle(coarse.map(ranked.centre()), 4.6, "");
    }
    page.close();
    page.close();
    page.rectangle(corner, DVec2::splat(side), "fill=\"none\" stroke=\"#222\"");
    Ok(page.finish())
}
