//! Figure 4: the function Ψ.

use std::error::Error;

use plotters::prelude::*;
use twelvefold::paper::{self, DELTA};
use twelvefold::tiling::Rules;

use super::Result;

const SIZE: (u32, u32) = (900, 360);

/// Figure 4: "Function Ψ(x)", on a linear axis through δ² and on a logarithmic one.
pub(super) fn psi(_: &Rules) -> Result<String> {
    let mut text = String::new();
    draw(&mut text).map_err(|error| error.to_string())?;
    // The library has no call for the title and the description.
    let end_of_tag = text.find('>').ok_or("no SVG element")? + 1;
    text.insert_str(
        end_of_tag,
        "\n<title>Function Ψ(x)</title>\n<desc>Ψ(x) = log_δ(x) mod 1 rises from 0 to 1 between two \
         powers of δ = 7 + 4√3 ≈ 13.93 and falls back to 0 at each. Left: x from 0 to 200. Right: \
         the same on a logarithmic axis.</desc>",
    );
    Ok(text)
}

fn draw(text: &mut String) -> std::result::Result<(), Box<dyn Error + '_>> {
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let (left, right) = area.split_horizontally(450);
    let mut chart = ChartBuilder::on(&left)
        .margin(14)
        .x_label_area_size(40)
        .y_label_area_size(46)
        .build_cartesian_2d(0.0..200.0, 0.0..1.0)?;
    chart
        .configure_mesh()
        .x_desc("x")
        .y_desc("Ψ(x)")
        .label_style(("sans-serif", 13))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for branch in branches(0.01, 200.0) {
        chart.draw_series(LineSeries::new(branch, BLUE.stroke_width(2)))?;
    }
    let mut chart = ChartBuilder::on(&right)
        .margin(14)
        .x_label_area_size(40)
        .y_label_area_size(46)
        .build_cartesian_2d((0.01..10000.0).log_scale(), 0.0..1.0)?;
    chart
        .configure_mesh()
        .x_desc("x")
        .label_style(("sans-serif", 13))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for branch in branches(0.01, 10000.0) {
        chart.draw_series(LineSeries::new(branch, BLUE.stroke_width(2)))?;
    }
    area.present()?;
    Ok(())
}

/// Points of Ψ between `from` and `to`, one list a branch.
fn branches(from: f64, to: f64) -> Vec<Vec<(f64, f64)>> {
    let mut starts = vec![from];
    for k in -8..8 {
        let power = DELTA.powi(k);
        if power > from && power < to {
            starts.push(power);
        }
    }
    let ends = starts[1..].iter().copied().chain([to]);
    starts
        .iter()
        .zip(ends)
        .map(|(&start, end)| {
            (0..=60)
                .map(|i| (start * (end / start).powf(f64::from(i) / 60.0)).clamp(start * (1.0 + 1e-9), end * (1.0 - 1e-9)))
                .filter_map(|x| paper::psi(x).map(|y| (x, y)))
                .collect()
        })
        .collect()
}
