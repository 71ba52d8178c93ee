//! Results and how they are shown: curves of error and time, as CSV, Markdown and SVG.

use std::error::Error;
use std::fmt::Write as _;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::samplers::Kind;

/// Error and time of one sampler at one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measured {
    pub(crate) n: usize,
    /// Root-mean-square error over the seeds, relative to the mean integral.
    pub(crate) error: f64,
    /// Least time to make the set, in seconds.
    pub(crate) seconds: f64,
}

/// One sampler's results on a scene.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    pub(crate) sampler: &'static str,
    pub(crate) kind: Kind,
    pub(crate) points: Vec<Measured>,
}

/// All samplers' results on a scene.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) curves: Vec<Curve>,
}

impl Curve {
    /// The exponent a of error ∝ n^a, by least squares of the logarithms over sizes from 256 on.
    pub(crate) fn slope(&self) -> Option<f64> {
        let large: Vec<(f64, f64)> = self
            .points
            .iter()
            .filter(|m| m.n >= 256 && m.error > 0.0)
            .map(|m| ((m.n as f64).ln(), m.error.ln()))
            .collect();
        let n = large.len() as f64;
        let (mx, my) = large.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
        let (sxy, sxx) = large.iter().fold((0.0, 0.0), |(xy, xx), p| {
            (xy + (p.0 - mx) * (p.1 - my), xx + (p.0 - mx) * (p.0 - mx))
        });
        (large.len() >= 2 && sxx > 0.0).then(|| sxy / sxx)
    }

    fn at(&self, n: usize) -> Option<&Measured> {
        self.points.iter().find(|m| m.n == n)
    }
}

impl Scene {
    /// Error in percent at each size, the slope, and nanoseconds a sample at the sizes `timed`.
    pub(crate) fn markdown(&self, sizes: &[usize], timed: &[usize]) -> String {
        let mut text = format!("### {}\n\n| sampler |", self.name);
        for n in sizes {
            let _ = write!(text, " {n} |");
        }
        text += " slope |";
        for n in timed {
            let _ = write!(text, " ns at {n} |");
        }
        text += "\n|---|";
        text += &"---:|".repeat(sizes.len() + 1 + timed.len());
        text += "\n";
        for curve in &self.curves {
            let _ = write!(text, "| {} |", curve.sampler);
            for n in sizes {
                let cell = curve.at(*n).map(|m| percent(100.0 * m.error)).unwrap_or_default();
                // The least error of the column stands out.
                let best = self.curves.iter().filter_map(|c| c.at(*n)).map(|m| m.error);
                let best = best.fold(f64::INFINITY, f64::min);
                let bold = curve.at(*n).is_some_and(|m| m.error <= best);
                let _ = write!(text, " {0}{cell}{0} |", if bold { "**" } else { "" });
            }
            let _ = match curve.slope() {
                Some(slope) => write!(text, " {slope:.2} |"),
                None => write!(text, " |"),
            };
            for n in timed {
                let cell = curve.at(*n).map(|m| format!("{:.0}", 1e9 * m.seconds / m.n as f64));
                let _ = write!(text, " {} |", cell.unwrap_or_default());
            }
            text += "\n";
        }
        text += "\n";
        text
    }

    /// Lines group,scene,sampler,n,error,seconds.
    pub(crate) fn csv(&self, group: &str, text: &mut String) {
        for curve in &self.curves {
            for Measured { n, error, seconds } in &curve.points {
                let (scene, sampler) = (&self.name, curve.sampler);
                let _ =
                    writeln!(text, "{group},\"{scene}\",\"{sampler}\",{n},{error:e},{seconds:e}");
            }
        }
    }

    /// Error against samples and against time, side by side, on logarithmic axes; beside each name, the
    /// slope of the former.
    ///
    /// # Errors
    /// The plotter's, which writes to memory only.
    pub(crate) fn svg(&self) -> Result<String, Box<dyn Error>> {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, (1260, 520)).into_drawing_area();
            area.fill(&WHITE)?;
            let area = area.titled(&self.name, ("sans-serif", 20))?;
            let (left, rest) = area.split_horizontally(520);
            let (right, legend) = rest.split_horizontally(490);
            self.plot(&left, "samples", |m| m.n as f64)?;
            self.plot(&right, "seconds a set", |m| m.seconds)?;
            for (i, curve) in self.curves.iter().enumerate() {
                let y = 20 + 20 * i as i32;
                legend.draw(&PathElement::new(vec![(0, y), (22, y)], style(i, curve)))?;
                let name = match curve.slope() {
                    Some(slope) => format!("{} ({slope:.2})", curve.sampler),
                    None => curve.sampler.to_owned(),
                };
                legend.draw(&Text::new(name, (28, y - 6), ("sans-serif", 13)))?;
            }
            area.present()?;
        }
        Ok(text)
    }

    fn plot(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
        x_name: &str,
        x: impl Fn(&Measured) -> f64,
    ) -> Result<(), Box<dyn Error>> {
        let shown = || {
            let all = self.curves.iter().flat_map(|curve| &curve.points);
            all.filter(|m| m.error > 0.0 && x(m) > 0.0)
        };
        let range = |of: &dyn Fn(&Measured) -> f64| {
            let (low, high) = shown()
                .map(of)
                .fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
            if low < high { 0.8 * low..1.25 * high } else { 0.1..1.0 }
        };
        let mut errors = range(&|m| m.error);
        if 100.0 * errors.start > errors.end {
            // The plotter labels nothing below the least power of ten: a short axis begins before one.
            errors.start = 0.8 * 10f64.powf(errors.start.log10().floor());
        }
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(34)
            .y_label_area_size(64)
            .build_cartesian_2d(range(&x).log_scale(), errors.log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(BLACK.mix(0.06))
            .bold_line_style(BLACK.mix(0.15))
            .x_desc(x_name)
            .y_desc("relative RMS error")
            .x_label_formatter(&|v| if *v >= 1.0 { format!("{v:.0}") } else { format!("{v:.0e}") })
            .y_label_formatter(&|v| format!("{v:.0e}"))
            .draw()?;
        for (i, curve) in self.curves.iter().enumerate() {
            let style = style(i, curve);
            let visible: Vec<(f64, f64)> = curve
                .points
                .iter()
                .filter(|m| m.error > 0.0 && x(m) > 0.0)
                .map(|m| (x(m), m.error))
                .collect();
            chart.draw_series(LineSeries::new(visible, style).point_size(2))?;
        }
        Ok(())
    }
}

/// Colors that are told apart on white; ours are drawn thick.
fn style(i: usize, curve: &Curve) -> ShapeStyle {
    const COLORS: [(u8, u8, u8); 16] = [
        (0xd6, 0x27, 0x28),
        (0xff, 0x7f, 0x0e),
        (0xbc, 0x9d, 0x00),
        (0x2c, 0xa0, 0x2c),
        (0x8c, 0x56, 0x4b),
        (0x1f, 0x4e, 0xb4),
        (0x00, 0xa0, 0xb0),
        (0x94, 0x67, 0xbd),
        (0xe3, 0x77, 0xc2),
        (0x77, 0x77, 0x77),
        (0x4c, 0x9f, 0xe0),
        (0x8a, 0xa0, 0x30),
        (0x17, 0x5e, 0x3c),
        (0x00, 0x00, 0x00),
        (0xd8, 0xa0, 0x60),
        (0x9e, 0xb9, 0xf3),
    ];
    let (red, green, blue) = COLORS[i % COLORS.len()];
    let width = if curve.kind != Kind::Rival { 4 } else { 2 };
    RGBColor(red, green, blue).stroke_width(width)
}

/// Three digits, as in a table.
fn percent(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 10.0 => format!("{v:.1}"),
        v if v >= 1.0 => format!("{v:.2}"),
        v if v >= 0.1 => format!("{v:.3}"),
        v => format!("{v:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let points = |exponent: f64| {
            [16, 256, 1024, 4096]
                .map(|n| Measured { n, error: (n as f64).powf(exponent), seconds: 1e-8 * n as f64 })
                .to_vec()
        };
        Scene {
            name: "test".to_owned(),
            curves: vec![
                Curve { sampler: "ours", kind: Kind::Ours, points: points(-0.75) },
                Curve { sampler: "white", kind: Kind::Rival, points: points(-0.5) },
            ],
        }
    }

    #[test]
    fn slopes_are_exponents() {
        let scene = scene();
        assert!((scene.curves[0].slope().unwrap() + 0.75).abs() < 1e-12);
        assert!((scene.curves[1].slope().unwrap() + 0.5).abs() < 1e-12);
    }

    #[test]
    fn the_best_stands_out_and_pictures_hold_every_sampler() {
        let scene = scene();
        let table = scene.markdown(&[16, 65_536], &[256]);
        assert!(table.contains("| ours | **12.5** |  | -0.75 | 10 |"), "{table}");
        assert!(table.contains("| white | 25.0 |"), "{table}");
        let svg = scene.svg().unwrap();
        assert!(svg.contains("<svg") && svg.contains("white") && svg.contains("ours"));
        let mut csv = String::new();
        scene.csv("group", &mut csv);
        assert_eq!(csv.lines().count(), 8);
    }
}
