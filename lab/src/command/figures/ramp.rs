//! Figure 5: a gray ramp and its dots.

use glam::DVec2;
use twelvefold::importance::Function;
use twelvefold::tiling::Rules;
use twelvefold::{Amount, Disc, Domain, Placement, Sampling};

use super::Result;
use super::canvas::Canvas;

const SIZE: DVec2 = DVec2::new(1000.0, 160.0);
const POINTS: f64 = 6400.0;
const MARGIN: f64 = 8.0;

/// Figure 5: "A grayscale ramp (top) sampled with our method (bottom)."
pub(super) fn ramp(_: &Rules) -> Result<String> {
    let mut page = Canvas::new(
        DVec2::new(SIZE.x + 2.0 * MARGIN, 2.0 * SIZE.y + 3.0 * MARGIN),
        "A grayscale ramp (top) sampled with the dodecagonal tiling (bottom)",
        "Above, a ramp from white to black. Below, equal dots whose number in any small area is \
         proportional to the ramp's darkness there.",
    );
    page.linear_gradient("ramp", "#fff", "#000");
    page.rectangle(DVec2::splat(MARGIN), SIZE, "fill=\"url(#ramp)\" stroke=\"#222\"");

    let corner = DVec2::new(MARGIN, 2.0 * MARGIN + SIZE.y);
    let domain = Domain::new(corner, SIZE)?;
    let darkness = |x: f64| ((x - corner.x) / SIZE.x).clamp(0.0, 1.0);
    let importance = Function::new(
        |at: DVec2| darkness(at.x),
        |region: &Disc| darkness(region.center.x + region.radius),
    )
    .with_integral(domain.area() / 2.0);
    let placement = Placement::new(domain, 3);
    let sampling = Sampling::new(&placement, &importance, Amount::Points(POINTS))?;
    // Where the ramp is black the dots cover half of the area, so that each is seen.
    let radius = (0.5 / (sampling.density() * std::f64::consts::PI)).sqrt();
    page.rectangle(corner, SIZE, "fill=\"none\" stroke=\"#222\"");
    page.open_clipped("dots", corner, SIZE, "class=\"points\" fill=\"#000\"");
    for sample in sampling.points::<DVec2>()? {
        page.circle(sample?.position, radius, "");
    }
    page.close();
    Ok(page.finish())
}
