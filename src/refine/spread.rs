//! Dots where they belong: as many on each island of ink as its share asks for, which no small moves could bring
//! about, and, if they come badly spread, as many everywhere.

use alloc::vec::Vec;

use super::cells::Dot;
use super::error::{RefineError, reserve};
use super::ink::Ink;

/// Columns or rows of pixels, half-open.
type Range = core::ops::Range<usize>;

/// The picture is cut in two, where there is least ink to cut through, and each half gets its share of the dots; then
/// each half is cut again:
///
/// ```text
///  dots in a corner        cut, 4 : 4                  again, the other way, until one is left
/// ┌────────┐             ┌──╥─────┐                             ┌──╥─────┐
/// │....    │             │. ║  .  │   2 : 2 on either side      │. ║  .  │
/// │....  ▓▓│  ────►      │. ║ .   │   ────►                     ╞══╣ .   │
/// │     ▓▓▓│             │..║ . . │                             │..╠═════╡
/// └────────┘             └──╨─────┘                             └──╨─────┘
/// ```
///
/// Dots keep their order across each cut, and one that ends in the part that it is in stays where it is. Unless
/// it is to be `exact`, a half that has about its share keeps what it has, so that evenly spread dots stay.
///
/// Every level reads each pixel once; there are about as many levels as the dots' number has bits.
pub(super) fn spread(ink: &Ink<'_>, exact: bool, dots: &mut [Dot]) -> Result<(), RefineError> {
    let [left, right] = ink.columns;
    let [top, bottom] = ink.rows;
    let sums = reserve(ink.width.max(ink.height))?;
    Spread { ink, exact, sums }.hand_out(left..right, top..bottom, dots);
    Ok(())
}

/// So few dots stay as they are where they are all in their part of the picture.
const FEW: usize = 3;
/// Ink along a cut, as a share of what other lines have, below which it goes through white.
const CLOSED: f64 = 0.1;
/// How many dots a part may have more or less than its share. Across white, no more than rounding makes: of dots in
/// large and small letters 7 % too few and 5 % too many become .2 and .3 %. Across ink, dots even out themselves; at 1
/// photographs lose evenness.
const ACROSS_WHITE: f64 = 0.6;
const ACROSS_INK: f64 = 2.0;

/// A cut before a column or row.
struct Cut {
    at: usize,
    /// Share of the ink before it.
    share: f64,
    /// Ink along it, as a share of the mean line's.
    open: f64,
}

struct Spread<'a> {
    ink: &'a Ink<'a>,
    exact: bool,
    /// Ink of each column or row, where the next cut is sought.
    sums: Vec<f64>,
}

impl Spread<'_> {
    fn hand_out(&mut self, columns: Range, rows: Range, dots: &mut [Dot]) {
        let lone = columns.len() <= 1 && rows.len() <= 1;
        let home =
            |dot: &Dot| columns.contains(&(dot.x as usize)) && rows.contains(&(dot.y as usize));
        match dots {
            [] => {}
            dots if !self.exact && dots.len() <= FEW && dots.iter().all(home) => {}
            dots if lone => within_pixel(columns.start, rows.start, dots),
            [dot] => {
                if !home(dot) {
                    self.place(columns, rows, dot);
                }
            }
            dots => {
                let upright = columns.len() >= rows.len();
                let along = |dot: &Dot| if upright { dot.x } else { dot.y };
                let cut = self.cut(&columns, &rows, upright, dots.len());
                let now = dots.iter().filter(|dot| along(dot) < cut.at as f32).count();
                let first = self.part(&cut, now, dots.len());
                if first > 0 && first < dots.len() {
                    dots.select_nth_unstable_by(first, |one, other| {
                        along(one).total_cmp(&along(other)).then(one.index.cmp(&other.index))
                    });
                }
                let (before, after) = dots.split_at_mut(first);
                if upright {
                    self.hand_out(columns.start..cut.at, rows.clone(), before);
                    self.hand_out(cut.at..columns.end, rows, after);
                } else {
                    self.hand_out(columns.clone(), rows.start..cut.at, before);
                    self.hand_out(columns, cut.at..rows.end, after);
                }
            }
        }
    }

    /// How many of `dots` go before a cut that now has `now` before it.
    fn part(&self, cut: &Cut, now: usize, dots: usize) -> usize {
        let fair = cut.share * dots as f64;
        let tolerance = match cut.open {
            _ if self.exact || cut.share <= 0.0 || cut.share >= 1.0 => 0.0,
            open if open < CLOSED => ACROSS_WHITE,
            _ => ACROSS_INK,
        };
        if (now as f64 - fair).abs() <= tolerance { now } else { (fair.round() as usize).min(dots) }
    }

    /// Where to cut columns (or rows): through as little ink as possible, with no less than a quarter of the ink on either
    /// side, or else next to half of it.
    fn cut(&mut self, columns: &Range, rows: &Range, upright: bool, dots: usize) -> Cut {
        let start = if upright { columns.start } else { rows.start };
        let len = if upright { columns.len() } else { rows.len() };
        self.sums.clear();
        self.sums.resize(len, 0.0);
        for row in rows.clone() {
            let pixels = &self.ink.pixels[row * self.ink.width..][columns.clone()];
            if upright {
                for (sum, pixel) in self.sums.iter_mut().zip(pixels) {
                    *sum += f64::from(*pixel);
                }
            } else {
                self.sums[row - start] = pixels.iter().map(|pixel| f64::from(*pixel)).sum();
            }
        }
        // what flows across each cut, as a share of the mean line
        let total: f64 = self.sums.iter().sum();
        let mean = total / len as f64;
        let mut before = 0.0;
        let mut best = Cut { at: start + 1, share: 0.0, open: 0.0 };
        let mut least = f64::INFINITY;
        for (line, pair) in self.sums.windows(2).enumerate() {
            before += pair[0];
            let open = pair[0].min(pair[1]) / mean;
            let share = before / total;
            let uneven = (share - 0.5).abs();
            let fair = share * dots as f64;
            let over = if self.exact { (fair - fair.round()).abs() } else { 0.0 };
            let score = if uneven > 0.25 { 4.0 + uneven } else { open.min(1.0) + uneven + over };
            // of cuts through nothing, the one next to the ink, or they would be made one by one
            if score < least || score == least && share < 0.5 {
                least = score;
                best = Cut { at: start + line + 1, share, open };
            }
        }
        best
    }

    /// Puts a dot where half of the ink is above, and half of that row's on the left.
    fn place(&self, columns: Range, rows: Range, dot: &mut Dot) {
        let row = |row: usize| &self.ink.pixels[row * self.ink.width..][columns.clone()];
        let ink = |row: usize| row_ink(self.ink, &columns, row);
        let total: f64 = rows.clone().map(ink).sum();
        let mut above = 0.0;
        let mut place = None;
        for y in rows {
            let here = ink(y);
            above += here;
            if here > 0.0 {
                let mut left = 0.0;
                let x = row(y).iter().position(|pixel| {
                    left += f64::from(*pixel);
                    left >= 0.5 * here && *pixel > 0.0
                });
                place = x.map(|x| (columns.start + x, y)).or(place);
            }
            if above >= 0.5 * total && place.is_some() {
                break;
            }
        }
        if let Some((x, y)) = place {
            (dot.x, dot.y) = (x as f32 + 0.5, y as f32 + 0.5);
        }
    }
}

fn row_ink(ink: &Ink<'_>, columns: &Range, row: usize) -> f64 {
    let pixels = &ink.pixels[row * ink.width..][columns.clone()];
    pixels.iter().map(|pixel| f64::from(*pixel)).sum()
}

/// Steps of a sequence that fills a square evenly: 1/p and 1/p², where p³ = p + 1, in 2⁻³².
const STEPS: [u32; 2] = [3_242_174_889, 2_447_445_414];

/// Spreads dots evenly over one pixel, in the order of their numbers.
fn within_pixel(x: usize, y: usize, dots: &mut [Dot]) {
    dots.sort_unstable_by_key(|dot| dot.index);
    let share = |step: u32, k: u32| {
        let turns = step.wrapping_mul(k).wrapping_add(1 << 31);
        // 20 bits: the sum with the pixel is rounded down, never up to the next pixel, below
        (turns >> 12) as f32 / (1 << 20) as f32
    };
    for (k, dot) in (0_u32..).zip(dots) {
        let (u, v) = (x as f32 + share(STEPS[0], k), y as f32 + share(STEPS[1], k));
        if u as usize == x && v as usize == y {
            (dot.x, dot.y) = (u, v);
        } else {
            (dot.x, dot.y) = (x as f32, y as f32);
        }
    }
}
