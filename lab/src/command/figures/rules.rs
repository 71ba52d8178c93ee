//! Figure 3: the production rules, with the geometry that the paper's text lacks.

use glam::DVec2;
use twelvefold::tiling::{Child, Rules, Tile, TileType};
use twelvefold_lab::paper::LAMBDA;

use super::Result;
use super::canvas::{Canvas, View};
use super::cells::{cell, center, direction, star};

const WIDTH: f64 = 1000.0;
const LEGEND_HEIGHT: f64 = 236.0;
const FOOT: f64 = 34.0;
const PANEL: DVec2 = DVec2::new(WIDTH / 2.0, 480.0);

/// The fill of a tile of this type, apart in hue and in lightness.
fn fill(kind: TileType) -> &'static str {
    match kind {
        TileType::A => "#f7dc6f",
        TileType::B => "#aed6f1",
        TileType::C => "#c9ead3",
        TileType::D => "#f5b7a0",
    }
}

/// Figure 3: "Production rules used in dodecagonal aperiodic tiling."
pub(super) fn production_rules(rules: &Rules) -> Result<String> {
    let mut page = Canvas::new(
        DVec2::new(WIDTH, LEGEND_HEIGHT + 2.0 * PANEL.y + FOOT),
        "Production rules used in dodecagonal aperiodic tiling",
        "Above, the four tile types with the edges of the square-triangle tiling that meet in them. \
         Below, each type subdivided: its outline, and its children with type, digit and a wedge \
         that shows their rotation.",
    );
    for kind in TileType::ALL {
        draw_type(&mut page, kind);
    }
    for kind in TileType::ALL {
        let (column, row) = (kind.index() % 2, kind.index() / 2);
        let corner = DVec2::new(PANEL.x * column as f64, LEGEND_HEIGHT + PANEL.y * row as f64);
        draw_rule(&mut page, rules, kind, corner)?;
    }
    page.text(
        DVec2::new(WIDTH / 2.0, LEGEND_HEIGHT + 2.0 * PANEL.y + 22.0),
        "Blue: the outline of the parent. Wedge: a tile’s own direction 0. \
         The children of the neighbors fill the gaps.",
        "text-anchor=\"middle\" font-size=\"14\" fill=\"#333\"",
    );
    Ok(page.finish())
}

/// One type by itself: cell, star, wedge, name.
fn draw_type(page: &mut Canvas, kind: TileType) {
    let tile = Tile::root(kind);
    let column = WIDTH / 4.0;
    let origin = DVec2::new(column * (kind.index() as f64 + 0.5), 106.0);
    let view = View { scale: 86.0, center: DVec2::ZERO, origin };
    page.polygon(
        &view.map_all(&cell(&tile)),
        &format!("fill=\"{}\" stroke=\"#222\" stroke-width=\"1.6\"", fill(kind)),
    );
    page.open("stroke=\"#d3312a\" stroke-width=\"1.2\" stroke-dasharray=\"4 3\"");
    for k in star(&tile) {
        let ends = [0.25, 1.0].map(|distance| distance * direction(k.into()));
        page.polyline(&view.map_all(&ends), "");
    }
    page.close();
    wedge(page, &view, &tile);
    let middle = "text-anchor=\"middle\"";
    page.text(
        origin + DVec2::new(0.0, 8.0),
        &kind.letter().to_string(),
        &format!("{middle} font-size=\"24\" font-style=\"italic\""),
    );
    let (shape, vertex) = match kind {
        TileType::A => ("hexagon", "3⁶"),
        TileType::B => ("pentagon", "3³·4²"),
        TileType::C => ("pentagon", "3²·4·3·4"),
        TileType::D => ("pentagon", "3²·4·3·4"),
    };
    page.text(
        DVec2::new(origin.x, 218.0),
        &format!("{shape}, vertex {vertex}, parity {}", kind.parity()),
        &format!("{middle} font-size=\"13\" fill=\"#333\""),
    );
}

/// One type subdivided: heading, children, outline of the parent.
fn draw_rule(page: &mut Canvas, rules: &Rules, kind: TileType, corner: DVec2) -> Result<()> {
    page.rectangle(corner, PANEL, "fill=\"none\" stroke=\"#ccc\"");
    page.text(
        corner + DVec2::new(18.0, 30.0),
        &heading(rules, kind),
        "font-size=\"17\" fill=\"#111\" xml:space=\"preserve\"",
    );
    page.open(&format!("class=\"rule-{}\"", kind.letter()));
    let origin = corner + DVec2::new(PANEL.x / 2.0, PANEL.y / 2.0 + 18.0);
    let view = View { scale: 81.0, center: DVec2::ZERO, origin };
    let parent = Tile::root(kind);
    let children: Vec<_> = (0..kind.child_count() as u8)
        .map(|digit| rules.child_of(&parent, digit)?.ok_or_else(|| "no such child".into()))
        .collect::<Result<_>>()?;
    for child in &children {
        page.polygon(
            &view.map_all(&cell(child)),
            &format!("fill=\"{}\" stroke=\"#222\" stroke-width=\"1.2\"", fill(child.kind)),
        );
    }
    let outline: Vec<_> = cell(&parent).into_iter().map(|corner| corner * LAMBDA).collect();
    page.polygon(
        &view.map_all(&outline),
        "fill=\"none\" stroke=\"#2b5fc4\" stroke-width=\"3\" stroke-linejoin=\"round\"",
    );
    for (digit, child) in children.iter().enumerate() {
        wedge(page, &view, child);
        page.text(
            view.map(center(child)) + DVec2::new(0.0, 7.0),
            &format!("{}_{digit:X}", child.kind.letter()),
            // A halo in the cell's color keeps the parent's outline out of the letters.
            &format!(
                "text-anchor=\"middle\" font-size=\"22\" paint-order=\"stroke\" \
                 stroke=\"{}\" stroke-width=\"5\" stroke-linejoin=\"round\"",
                fill(child.kind)
            ),
        );
    }
    page.close();
    Ok(())
}

/// A wedge at the edge of the cell that the tile's own direction 0 crosses.
fn wedge(page: &mut Canvas, view: &View, tile: &Tile) {
    let ahead = direction(tile.rotation.into());
    let aside = ahead.perp();
    let corners = [0.48 * ahead, 0.31 * ahead + 0.05 * aside, 0.31 * ahead - 0.05 * aside];
    let corners = corners.map(|corner| center(tile) + corner);
    page.polygon(&view.map_all(&corners), "fill=\"#222\"");
}

/// The rule as equation 1 writes it: children by type, digits as subscripts.
fn heading(rules: &Rules, parent: TileType) -> String {
    let groups = TileType::ALL.map(|kind| {
        let of_kind = |(digit, child): (usize, &Child)| {
            (child.kind == kind).then(|| format!("{}_{digit:X}", kind.letter()))
        };
        let children = rules.children(parent).iter().enumerate().filter_map(of_kind);
        children.collect::<Vec<_>>().join(" ")
    });
    let [a, b, c, d] = groups;
    let listed: Vec<_> = [a, c, b, d].into_iter().filter(|group| !group.is_empty()).collect();
    format!("{} ↦ {}", parent.letter(), listed.join("  "))
}
