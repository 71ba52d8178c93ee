//! Time against number of points, both logarithmic, a panel a table.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use super::Table;

/// Those of ten kinds that can be told apart, without the red of ours.
const COLORS: [RGBColor; 9] = [
    RGBColor(127, 127, 127),
    RGBColor(255, 127, 14),
    RGBColor(31, 119, 180),
    RGBColor(188, 189, 34),
    RGBColor(148, 103, 189),
    RGBColor(44, 160, 44),
    RGBColor(140, 86, 75),
    RGBColor(227, 119, 194),
    RGBColor(23, 190, 207),
];

/// Draws the tables side by side.
pub(crate) fn draw(path: &Path, tables: &[&Table]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(path, (1200, 520)).into_drawing_area();
    root.fill(&WHITE)?;
    for (area, table) in root.split_evenly((1, tables.len())).iter().zip(tables) {
        let times = |row: &super::Row| -> Vec<(f64, f64)> {
            let points = table.counts.iter().zip(&row.nanoseconds);
            let timed = points.filter(|(_, nanoseconds)| !nanoseconds.is_nan());
            timed.map(|(n, nanoseconds)| (*n as f64, *n as f64 * nanoseconds / 1e9)).collect()
        };
        let first = table.counts.first().copied().unwrap_or(1) as f64;
        let last = table.counts.last().copied().unwrap_or(2) as f64;
        let mut chart = ChartBuilder::on(area)
            .caption(&table.title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(60)
            .build_cartesian_2d((first..last).log_scale(), (1e-8..10.0f64).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(BLACK.mix(0.04))
            .x_desc("points")
            .y_desc("seconds")
            .x_label_formatter(&|n| format!("{n:.0}"))
            .y_label_formatter(&|t| format!("{t:.0e}"))
            .draw()?;
        // One thread only: more lines are a tangle.
        let rows = table.rows.iter().filter(|row| !row.name.starts_with("two threads"));
        for (i, row) in rows.enumerate() {
            // The default depth stands out.
            let ours = matches!(row.name.as_str(), "twelvefold" | "twelvefold, baked depth 3");
            let color = if ours { RED.mix(1.0) } else { COLORS[i % COLORS.len()].mix(1.0) };
            let style = color.stroke_width(if ours { 3 } else { 1 });
            chart
                .draw_series(LineSeries::new(times(row), style).point_size(2))?
                .label(&row.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.2))
            .draw()?;
    }
    root.present()?;
    Ok(())
}
