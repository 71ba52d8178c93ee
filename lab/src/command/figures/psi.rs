//! Figure 4: the function Ψ.

use glam::DVec2;
use twelvefold::tiling::Rules;
use twelvefold_lab::paper::{self, DELTA};

use super::Result;
use super::canvas::Canvas;

const SIZE: DVec2 = DVec2::new(1000.0, 400.0);
const PLOT: DVec2 = DVec2::new(420.0, 290.0);
const TOP: f64 = 44.0;
const SMALL: &str = "font-size=\"14\" fill=\"#222\" text-anchor=\"middle\"";

/// Figure 4: "Function Ψ(x)", on a linear axis past δ² and on a logarithmic one.
pub(super) fn psi(_: &Rules) -> Result<String> {
    let mut page = Canvas::new(
        SIZE,
        "Function Ψ(x)",
        "Ψ(x) = log_δ(x) mod 1 rises from 0 to 1 between two powers of δ = 7 + 4√3 ≈ 13.93 and \
         starts again from 0 at each. Left: x to 200. Right: x from 0.01 to 10,000, logarithmic.",
    );
    let linear = Axis {
        left: 62.0,
        position: |x| x / 200.0,
        from: 0.001,
        to: 200.0,
        ticks: &[(0.0, "0"), (50.0, "50"), (100.0, "100"), (150.0, "150"), (200.0, "200")],
        // Smaller powers crowd together at 0.
        powers: 1..=2,
    };
    let logarithmic = Axis {
        left: 556.0,
        position: |x| (x.log10() + 2.0) / 6.0,
        from: 0.01,
        to: 10_000.0,
        ticks: &[
            (0.01, "10⁻²"),
            (0.1, "10⁻¹"),
            (1.0, "1"),
            (10.0, "10"),
            (100.0, "10²"),
            (1000.0, "10³"),
            (10_000.0, "10⁴"),
        ],
        powers: -1..=3,
    };
    linear.draw(&mut page);
    logarithmic.draw(&mut page);
    page.text(
        DVec2::new(20.0, TOP + PLOT.y / 2.0),
        "Ψ(x)",
        &format!(
            "font-size=\"17\" text-anchor=\"middle\" transform=\"rotate(-90 20 {})\"",
            TOP + PLOT.y / 2.0
        ),
    );
    Ok(page.finish())
}

/// A plot of Ψ over one horizontal axis.
struct Axis {
    /// The page's x at the plot's left side.
    left: f64,
    /// Where an x lies between the plot's sides, 0 to 1.
    position: fn(f64) -> f64,
    from: f64,
    to: f64,
    ticks: &'static [(f64, &'static str)],
    /// The exponents k whose δ^k are named.
    powers: std::ops::RangeInclusive<i32>,
}

impl Axis {
    fn at(&self, x: f64, psi: f64) -> DVec2 {
        DVec2::new(self.left + PLOT.x * (self.position)(x), TOP + PLOT.y * (1.0 - psi))
    }

    fn draw(&self, page: &mut Canvas) {
        for (psi, name) in [(0.0, "0"), (0.25, "¼"), (0.5, "½"), (0.75, "¾"), (1.0, "1")] {
            let y = TOP + PLOT.y * (1.0 - psi);
            let ends = [self.left, self.left + PLOT.x].map(|x| DVec2::new(x, y));
            page.polyline(&ends, "stroke=\"#ddd\"");
            page.text(DVec2::new(self.left - 14.0, y + 5.0), name, SMALL);
        }
        for (x, name) in self.ticks {
            let foot = DVec2::new(self.left + PLOT.x * (self.position)(*x), TOP + PLOT.y);
            page.polyline(&[foot, foot + DVec2::new(0.0, 6.0)], "stroke=\"#222\"");
            page.text(foot + DVec2::new(0.0, 23.0), name, SMALL);
        }
        for k in self.powers.clone() {
            let x = power_of_delta(k);
            let ends = [self.at(x, 0.0), self.at(x, 1.0) - DVec2::new(0.0, 8.0)];
            page.polyline(&ends, "stroke=\"#d3312a\" stroke-dasharray=\"3 4\"");
            let name = ["δ⁻¹", "1", "δ", "δ²", "δ³"][(k + 1) as usize];
            page.text(
                ends[1] - DVec2::new(0.0, 7.0),
                name,
                "font-size=\"15\" fill=\"#d3312a\" text-anchor=\"middle\"",
            );
        }
        page.rectangle(DVec2::new(self.left, TOP), PLOT, "fill=\"none\" stroke=\"#222\"");
        let foot = DVec2::new(self.left + PLOT.x / 2.0, TOP + PLOT.y + 50.0);
        page.text(foot, "x", "font-size=\"17\" text-anchor=\"middle\"");
        page.open("class=\"psi\" fill=\"none\" stroke=\"#2b5fc4\" stroke-width=\"2.2\" stroke-linejoin=\"round\"",
        );
        for branch in branches(self.from, self.to) {
            let points: Vec<_> = branch.iter().map(|(x, psi)| self.at(*x, *psi)).collect();
            page.polyline(&points, "");
        }
        page.close();
    }
}

fn power_of_delta(k: i32) -> f64 {
    let power = (0..k.abs()).fold(1.0, |power, _| power * DELTA);
    if k < 0 { 1.0 / power } else { power }
}

/// (x, Ψ(x)) between `from` and `to`, one list for each rise from 0 to 1.
fn branches(from: f64, to: f64) -> Vec<Vec<(f64, f64)>> {
    const SAMPLES: i32 = 100;
    (-8..8)
        .filter_map(|k| {
            // Inside the rise by far less than a line's width.
            let low = from.max(power_of_delta(k) * (1.0 + 1e-9));
            let high = to.min(power_of_delta(k + 1) * (1.0 - 1e-9));
            (low < high).then(|| {
                let x = |i| low * (high / low).powf(f64::from(i) / f64::from(SAMPLES));
                (0..=SAMPLES).filter_map(|i| paper::psi(x(i)).map(|psi| (x(i), psi))).collect()
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rise_runs_from_0_to_1() {
        let branches = branches(0.001, 200.0);
        // Starting in [δ^−3, δ^−2): rises end at δ^−2, δ^−1, 1, δ, δ², and one is cut short.
        assert_eq!(branches.len(), 6);
        for (i, branch) in branches.iter().enumerate() {
            assert!(branch.is_sorted_by(|a, b| a.0 < b.0 && a.1 <= b.1));
            assert!(i == 0 || branch[0].1 < 1e-8);
            assert!(i == 5 || branch.last().unwrap().1 > 1.0 - 1e-8);
        }
    }
}
