//! How much of each pen makes a color.
//!
//! Dots of all pens lie side by side and do not overlap, so that from afar light adds up by area: a place
//! whose share a_k is covered with ink k reflects paper + Σ a_k (ink_k − paper), in linear light. The
//! amounts that come nearest to the wanted light, none negative and all together no more than fits,
//! are a small quadratic problem with one optimum for each color:
//!
//! minimise |Σ a_k d_k − (light − paper)|² + Σ c_k a_k,  a ≥ 0, Σ a ≤ most,  d_k = ink_k − paper.
//!
//! Discs that do not overlap cover less than all of an area. Amounts that do not fit are scaled down together,
//! which mixes the color with that of the paper: its hue stays.
//!
//! The small cost c decides where several mixtures make one color (gray from black alone, or from
//! colored inks and less black). It is solved once on a lattice of colors; between its nodes amounts
//! are interpolated, which keeps them positive and within what fits, since both are convex.

use clap::ValueEnum;

use super::{MAX_PENS, Pen};
use twelvefold_stipple::page::color::Color;

/// Nodes of the lattice a side. The nodes are even in the square root of light, close to how the eye
/// divides it; at 33 the greatest error of interpolation is below .01 of light (see the tests).
const SIDE: usize = 33;

/// What becomes of colors that are darker than dots which lie apart can make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shadows {
    /// As dark as can be, in their hue; all lighter colors come back as they are.
    Clip,
    /// They keep their differences: everything is drawn lighter, black as dark as can be.
    Keep,
}

/// The cost of ink beside an error of light 1, squared: too little to change what can be made exactly.
const INK_COST: f64 = 1e-3;

/// How much dearer an error of the sum is than one of light.
const SUM_WEIGHT: f64 = 30.0;

/// The share of an area that each pen covers, in the order of the pens; the rest is 0.
pub(crate) type Amounts = [f32; MAX_PENS];

/// Amounts for every color, on a lattice.
#[derive(Debug)]
pub(crate) struct Separation {
    nodes: Vec<Amounts>,
}

/// Light (linear, 0..=1 for each of red, green and blue) of an encoded sRGB color.
fn light_of(Color([red, green, blue]): Color) -> [f64; 3] {
    [red, green, blue].map(|c| twelvefold_files::picture::srgb::decode(f64::from(c) / 255.0))
}

impl Separation {
    /// Prepares all colors for these pens on a paper.
    ///
    /// `most` is the share of an area that dots of all pens together may cover, in (0, 1]; `shadows` says what
    /// becomes of colors that take more. `gray` from 0
    /// to 1 says how far the darkest pen replaces colored ones that together make gray: 1, as far as it
    /// can; 0, only where the others cannot.
    pub(crate) fn new(pens: &[Pen], paper: Color, most: f64, shadows: Shadows, gray: f64) -> Self {
        let paper = light_of(paper);
        let inks: Vec<[f64; 3]> = pens
            .iter()
            .map(|pen| {
                let ink = light_of(pen.color);
                [0, 1, 2].map(|c| ink[c] - paper[c])
            })
            .collect();
        let sum = |ink: &[f64; 3]| ink.iter().sum::<f64>();
        let darkest = (0..inks.len()).min_by(|&i, &k| sum(&inks[i]).total_cmp(&sum(&inks[k])));
        // Per share of area: equal at gray = 1, where the pen that does the most with the least area
        // wins, which is the darkest; dear at gray = 0. Bare paper is free.
        let costs = |gray: f64| -> Vec<f64> {
            let dear = |k| if Some(k) == darkest { 1.0 + 8.0 * (1.0 - gray) } else { 1.0 };
            (0..inks.len()).map(|k| INK_COST * dear(k)).chain([0.0]).collect()
        };
        let columns = inks
            .iter()
            .chain([&[0.0; 3]])
            .map(|ink| [ink[0], ink[1], ink[2], SUM_WEIGHT])
            .collect();
        let least = Problem { columns, costs: costs(1.0), most: 1.0 };
        let (columns, costs) = (least.columns.clone(), costs(gray));
        let most_here = if shadows == Shadows::Keep { 1.0 } else { most };
        let asked = Problem { columns, costs, most: most_here };
        let value = |i: usize| {
            let root = i as f64 / (SIDE - 1) as f64;
            root * root
        };
        let nodes = (0..SIDE * SIDE * SIDE)
            .map(|i| {
                let light = [value(i / (SIDE * SIDE)), value(i / SIDE % SIDE), value(i % SIDE)];
                let change = [0, 1, 2].map(|c| light[c] - paper[c]);
                let scaled = |amounts: Amounts, scale: f64| amounts.map(|a| a * scale as f32);
                if shadows == Shadows::Keep {
                    return scaled(asked.solve(change), most);
                }
                // The least area that makes this color. If it fits, so does what was asked for; if it does
                // not quite, nothing else would.
                let amounts = least.solve(change);
                let sum: f64 = amounts.iter().map(|amount| f64::from(*amount)).sum();
                if sum > most {
                    scaled(amounts, most / sum)
                } else if gray < 1.0 {
                    asked.solve(change)
                } else {
                    amounts
                }
            })
            .collect();
        Self { nodes }
    }

    /// The amounts for a light (linear red, green and blue; what is outside 0..=1 counts as its nearest).
    pub(crate) fn amounts(&self, light: [f32; 3]) -> Amounts {
        // Tetrahedra rather than cubes: four nodes a color, and grays stay on their diagonal.
        let mut base = [0; 3];
        let mut rest = [0.0f32; 3];
        for c in 0..3 {
            let place = light[c].clamp(0.0, 1.0).sqrt() * (SIDE - 1) as f32;
            base[c] = (place as usize).min(SIDE - 2);
            rest[c] = place - base[c] as f32;
        }
        let step = [SIDE * SIDE, SIDE, 1];
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| rest[b].total_cmp(&rest[a]));
        let mut node = base[0] * step[0] + base[1] * step[1] + base[2];
        let mut amounts = [0.0; MAX_PENS];
        let mut before = 1.0;
        for i in 0..4 {
            let after = if i < 3 { rest[axes[i]] } else { 0.0 };
            let weight = before - after;
            for (amount, at_node) in amounts.iter_mut().zip(&self.nodes[node]) {
                *amount += weight * at_node;
            }
            if i < 3 {
                node += step[axes[i]];
            }
            before = after;
        }
        amounts
    }
}

/// The quadratic problem of one set of pens, bare paper among them: as many unknowns as pens and one, whose
/// sum is `most`.
struct Problem {
    /// Light taken away (or added) by a full cover of each ink, the paper's 0 last; and the weight of the
    /// sum.
    columns: Vec<[f64; 4]>,
    costs: Vec<f64>,
    most: f64,
}

impl Problem {
    /// The amounts nearest to the change of light `wanted`: the active-set method of Lawson and Hanson
    /// (1974), with a linear cost.
    fn solve(&self, wanted: [f64; 3]) -> Amounts {
        let goal = [wanted[0], wanted[1], wanted[2], SUM_WEIGHT * self.most];
        let count = self.columns.len();
        let mut amounts = vec![0.0; count];
        let mut used: Vec<usize> = Vec::new();
        // Each round adds one unknown and lowers the error, so that no set comes twice; the bound is for
        // rounding.
        for _ in 0..4 * count {
            let mut rest = goal;
            for (column, amount) in self.columns.iter().zip(&amounts) {
                rest.iter_mut().zip(column).for_each(|(r, d)| *r -= amount * d);
            }
            let gain = |k: usize| dot(&self.columns[k], &rest) - 0.5 * self.costs[k];
            let best = (0..count)
                .filter(|k| !used.contains(k))
                .max_by(|&i, &k| gain(i).total_cmp(&gain(k)));
            match best {
                Some(k) if gain(k) > 1e-9 => used.push(k),
                _ => break,
            }
            // Back to where all are positive, if some are not.
            loop {
                let solved = self.unconstrained(&used, &goal);
                let limit = used
                    .iter()
                    .zip(&solved)
                    .filter(|(_, value)| **value <= 0.0)
                    .map(|(&k, value)| amounts[k] / (amounts[k] - value))
                    .fold(1.0, f64::min);
                for (&k, value) in used.iter().zip(&solved) {
                    amounts[k] += limit * (value - amounts[k]);
                }
                if limit >= 1.0 {
                    break;
                }
                used.retain(|&k| amounts[k] > 1e-12);
                (0..count).filter(|k| !used.contains(k)).for_each(|k| amounts[k] = 0.0);
            }
        }
        // The weight leaves the sum a little off.
        let total: f64 = amounts[..count - 1].iter().sum();
        let shrink = if total > self.most { self.most / total } else { 1.0 };
        let mut found = [0.0; MAX_PENS];
        for (to, from) in found.iter_mut().zip(&amounts[..count - 1]) {
            *to = (shrink * from) as f32;
        }
        found
    }

    /// The best amounts of some inks, negative ones allowed: the normal equations, by elimination. The
    /// ridge keeps inks apart that look alike.
    fn unconstrained(&self, used: &[usize], goal: &[f64; 4]) -> Vec<f64> {
        let n = used.len();
        let mut rows: Vec<Vec<f64>> = used
            .iter()
            .map(|&i| {
                let right = dot(&self.columns[i], goal) - 0.5 * self.costs[i];
                let left = used.iter().map(|&k| dot(&self.columns[i], &self.columns[k]));
                left.chain([right]).collect()
            })
            .collect();
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] += 1e-9;
        }
        // Symmetric and positive: no pivoting.
        for i in 0..n {
            let (above, below) = rows.split_at_mut(i + 1);
            for row in below {
                let factor = row[i] / above[i][i];
                (i..=n).for_each(|k| row[k] -= factor * above[i][k]);
            }
        }
        let mut solved = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| rows[i][k] * solved[k]).sum();
            solved[i] = (rows[i][n] - known) / rows[i][i];
        }
        solved
    }
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::super::Pens;
    use super::*;

    const WHITE: Color = Color::WHITE;

    fn parse(text: &str) -> Vec<Pen> {
        text.parse::<Pens>().unwrap().on(WHITE).unwrap()
    }

    /// What the amounts reflect.
    fn mixed(pens: &[Pen], amounts: &Amounts) -> [f64; 3] {
        let mut light = [1.0; 3];
        for (pen, amount) in pens.iter().zip(amounts) {
            let ink = light_of(pen.color);
            for c in 0..3 {
                light[c] += f64::from(*amount) * (ink[c] - 1.0);
            }
        }
        light
    }

    fn noise(i: u32) -> f64 {
        f64::from(i.wrapping_mul(2_654_435_761).rotate_left(9).wrapping_mul(2_246_822_519) >> 8)
            / f64::from(1u32 << 24)
    }

    #[test]
    fn one_black_pen_covers_what_is_dark() {
        let pens = parse("black");
        let separation = Separation::new(&pens, WHITE, 1.0, Shadows::Clip, 1.0);
        for gray in [0.0f32, 0.01, 0.2, 0.5, 0.75, 1.0] {
            let [black, ..] = separation.amounts([gray; 3]);
            assert!((black - (1.0 - gray)).abs() < 2e-3, "{gray}: {black}");
        }
    }

    #[test]
    fn mixtures_of_the_inks_come_back() {
        for list in ["cmyk", "black,#c33,teal", "red,green,blue,yellow,black"] {
            let pens = parse(list);
            let separation = Separation::new(&pens, WHITE, 1.0, Shadows::Clip, 1.0);
            for i in 0..200 {
                // A mixture that fits.
                let mut amounts = [0.0f32; MAX_PENS];
                let mut total = 0.0;
                for (k, amount) in amounts.iter_mut().take(pens.len()).enumerate() {
                    *amount = noise(i * 16 + k as u32) as f32;
                    total += *amount;
                }
                amounts.iter_mut().for_each(|amount| *amount /= total.max(1.0) * 1.05);
                let light = mixed(&pens, &amounts);
                let found = separation.amounts(light.map(|c| c as f32));
                let again = mixed(&pens, &found);
                for c in 0..3 {
                    assert!((again[c] - light[c]).abs() < 0.015, "{list} {light:?} {again:?}");
                }
                assert!(found.iter().all(|amount| *amount >= 0.0));
                assert!(found.iter().sum::<f32>() <= 1.0 + 1e-4);
            }
        }
    }

    #[test]
    fn no_more_is_covered_than_may_be_and_white_is_left_alone() {
        let pens = parse("cmyk");
        let separation = Separation::new(&pens, WHITE, 0.8, Shadows::Clip, 0.5);
        for i in 0..500 {
            let light = [0, 1, 2].map(|c| noise(3 * i + c) as f32);
            let total: f32 = separation.amounts(light).iter().sum();
            assert!(total <= 0.8 + 1e-4, "{light:?}: {total}");
        }
        assert_eq!(separation.amounts([1.0; 3]), [0.0; MAX_PENS]);
        let [_, _, _, black, ..] = separation.amounts([0.0; 3]);
        assert!(black > 0.75);
    }

    #[test]
    fn gray_of_colored_inks_leaves_room_for_what_fits() {
        let pens = parse("cmyk");
        for gray in [0.0, 0.5, 1.0] {
            let separation = Separation::new(&pens, WHITE, 0.75, Shadows::Clip, gray);
            for light in [[0.3; 3], [0.5; 3], [0.9, 0.5, 0.4], [0.5, 0.55, 0.5]] {
                let again = mixed(&pens, &separation.amounts(light.map(|c| c as f32)));
                for c in 0..3 {
                    assert!((again[c] - light[c]).abs() < 0.015, "{gray} {light:?} {again:?}");
                }
            }
        }
    }

    #[test]
    fn gray_is_black_where_asked_for_and_colors_where_not() {
        let pens = parse("cmyk");
        let black =
            |gray| Separation::new(&pens, WHITE, 1.0, Shadows::Clip, gray).amounts([0.7; 3])[3];
        assert!(black(1.0) > black(0.0) + 0.05, "{} {}", black(1.0), black(0.0));
    }
}
