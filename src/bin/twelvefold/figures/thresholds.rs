//! Figure 6: a tile subdivided twice with thresholds as gray, and the zoom into it.

use glam::DVec2;
use twelvefold::paper::LAMBDA;
use twelvefold::tiling::{Rules, TileCounts, TileType};

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{Ranked, Window, cell, tiles_in, tiles_of};

const ROOT: TileType = TileType::A;
const WIDTH: f64 = 1000.0;
const MARGIN: f64 = 14.0;

/// Side of the square that the lower row starts with, in root edges, and its centre: all of its
/// subdivisions descend from the root.
const ZOOMED: Window = Window { centre: DVec2::new(0.062, 0.105), size: DVec2::splat(0.3) };

/// Figure 6: a tile of type `a` subdivided two times, the normalized threshold as a number and as
/// gray; below, zooming into the red square, subdividing, and zooming again.
pub(super) fn thresholds(rules: &Rules) -> Result<String> {
    let column = (WIDTH - 2.0 * MARGIN) / 3.0;
    let top_height = column * 1.12;
    let gap = 16.0;
    let side = (WIDTH - 2.0 * MARGIN - 3.0 * gap) / 4.0;
    let strip = 22.0;
    let lower = top_height + 56.0;
    let mut page = Canvas::new(
        DVec2::new(WIDTH, lower + side + strip + 52.0),
        "A tile of type a subdivided two times, and the zoom into it",
        "Above: the tile, its 13 children and their 181 children; gray is the normalized threshold \
         from 0, black, to 1, white. Below: the red square enlarged, subdivided, and again; the bar \
         under each shows the thresholds of the tiles in the square in ascending order.",
    );

    // The root's children reach 0.71 root edges from its centre.
    let scale = column / 1.42;
    for levels in 0..=2 {
        let origin = DVec2::new(MARGIN + column * (levels as f64 + 0.5), 12.0 + top_height / 2.0);
        let view = View { scale, centre: DVec2::ZERO, origin };
        draw_whole(&mut page, rules, levels, &view)?;
    }

    let inner = Window { centre: ZOOMED.centre + DVec2::new(0.03, -0.02), size: ZOOMED.size / LAMBDA };
    let panels = [(2, ZOOMED, None), (3, ZOOMED, Some(inner)), (3, inner, None), (4, inner, None)];
    for (i, (levels, window, square)) in panels.into_iter().enumerate() {
        let corner = DVec2::new(MARGIN + (side + gap) * i as f64, lower);
        let panel = Panel { id: i, corner, side, strip };
        draw_zoomed(&mut page, rules, levels, &window, square.as_ref(), &panel)?;
    }
    Ok(page.finish())
}

/// The threshold of a tile as it is drawn: rank over the number of tiles of its level.
fn threshold(ranked: &Ranked, tiles: u64) -> f64 {
    ranked.rank as f64 / tiles as f64
}

/// Black at 0, white at 1.
fn gray(threshold: f64) -> String {
    let level = (threshold * 255.0).round() as u8;
    format!("#{level:02x}{level:02x}{level:02x}")
}

/// The whole tile subdivided `levels` times; numbers where there is room.
fn draw_whole(page: &mut Canvas, rules: &Rules, levels: usize, view: &View) -> Result<()> {
    let tiles = TileCounts::of(ROOT).at(levels)?;
    let fine = View { scale: view.scale / LAMBDA.powi(levels as i32), ..*view };
    page.open("stroke=\"#55606e\" stroke-width=\"0.7\" stroke-linejoin=\"round\"");
    let patch = tiles_of(rules, ROOT, levels)?;
    for ranked in &patch {
        let fill = gray(threshold(ranked, tiles));
        page.polygon(&fine.map_all(&cell(&ranked.tile)), &format!("fill=\"{fill}\""));
    }
    page.close();
    if levels < 2 {
        page.open("text-anchor=\"middle\" font-size=\"14\"");
        for ranked in &patch {
            let threshold = threshold(ranked, tiles);
            let ink = if threshold < 0.5 { "#fff" } else { "#000" };
            page.text(
                fine.map(ranked.centre()) + DVec2::new(0.0, 5.0),
                &format!("{threshold:.3}"),
                &format!("fill=\"{ink}\""),
            );
        }
        page.close();
    } else {
        draw_square(page, view, &ZOOMED);
    }
    page.text(
        DVec2::new(view.origin.x, view.origin.y + view.scale * 0.8),
        &match levels {
            0 => "the tile".to_owned(),
            1 => format!("subdivided once: {tiles} tiles"),
            _ => format!("subdivided twice: {tiles} tiles"),
        },
        "text-anchor=\"middle\" font-size=\"14\" fill=\"#222\"",
    );
    Ok(())
}

fn draw_square(page: &mut Canvas, view: &View, window: &Window) {
    let half = window.size / 2.0;
    let corners = [
        window.centre - half,
        window.centre + DVec2::new(half.x, -half.y),
        window.centre + half,
        window.centre + DVec2::new(-half.x, half.y),
    ];
    page.polygon(&view.map_all(&corners), "fill=\"none\" stroke=\"#e02020\" stroke-width=\"2.4\"");
}

/// Where one picture of the lower row stands.
struct Panel {
    id: usize,
    corner: DVec2,
    side: f64,
    strip: f64,
}

/// The tiles of a level in a window (in root edges), and their thresholds in ascending order.
fn draw_zoomed(
    page: &mut Canvas,
    rules: &Rules,
    levels: usize,
    window: &Window,
    square: Option<&Window>,
    panel: &Panel,
) -> Result<()> {
    let tiles = TileCounts::of(ROOT).at(levels)?;
    let edges = LAMBDA.powi(levels as i32);
    let view = View {
        scale: panel.side / window.size.x,
        centre: window.centre,
        origin: panel.corner + DVec2::splat(panel.side / 2.0),
    };
    let fine = View { scale: view.scale / edges, centre: view.centre * edges, origin: view.origin };
    let in_edges = window.in_units_of(edges);
    let patch = tiles_in(rules, ROOT, levels, &in_edges, 1.0)?;
    page.open_clipped(
        &format!("zoom{}", panel.id),
        panel.corner,
        DVec2::splat(panel.side),
        "stroke=\"#55606e\" stroke-width=\"0.7\" stroke-linejoin=\"round\"",
    );
    for ranked in &patch {
        let fill = gray(threshold(ranked, tiles));
        page.polygon(&fine.map_all(&cell(&ranked.tile)), &format!("fill=\"{fill}\""));
    }
    page.close();
    page.rectangle(
        panel.corner,
        DVec2::splat(panel.side),
        if levels == 2 || square.is_none() && panel.id == 2 {
            "fill=\"none\" stroke=\"#e02020\" stroke-width=\"2.4\""
        } else {
            "fill=\"none\" stroke=\"#222\" stroke-width=\"1\""
        },
    );
    if let Some(square) = square {
        draw_square(page, &view, square);
    }
    Ok(())
}
