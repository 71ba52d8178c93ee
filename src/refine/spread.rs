//! Bad starts made fair: dots handed out to halves of the picture by what is to be drawn there, and to halves of those.

use alloc::vec::Vec;

use super::cells::Dot;
use super::error::{RefineError, reserve};
use super::ink::Ink;

/// Columns and rows of pixels, half-open.
type Range = core::ops::Range<usize>;

/// Gives every part of the picture as many of the dots as its share of the ink asks for, to the single dot where
/// there are fewer of them than pixels. Dots keep their order along each cut; those already in the part that they end
/// in stay where they are.
///
/// ```text
///  all dots        cut where half of the ink lies       and again, the other way, until one is left
/// ┌────────┐             ┌──╥─────┐                             ┌──╥─────┐
/// │....    │  4 : 4      │. ║  .  │   2 : 2 on either side      │. ║  .  │
/// │....  ▓▓│  ────►      │. ║ .   │   ────►                     ╞══╣ .   │
/// │     ▓▓▓│             │..║ . . │                             │..╠═════╡
/// └────────┘             └──╨─────┘                             └──╨─────┘
/// ```
///
/// Every level reads each pixel once; there are about as many levels as the dots' number has bits.
pub(super) fn spread(ink: &Ink<'_>, tolerance: f64, dots: &mut [Dot]) -> Result<(), RefineError> {
    let [left, right] = ink.columns;
    let [top, bottom] = ink.rows;
    let sums = reserve(ink.width.max(ink.height))?;
    Spread { ink, tolerance, sums }.hand_out(left..right, top..bottom, dots);
    Ok(())
}

/// Dots that need not be handed out further if they are where they should be and some tolerance is allowed.
const FEW: usize = 3;

struct Spread<'a> {
    ink: &'a Ink<'a>,
    tolerance: f64,
    /// Ink up to and with each column or row, where the next cut is sought.
    sums: Vec<f64>,
}

impl Spread<'_> {
    fn hand_out(&mut self, columns: Range, rows: Range, dots: &mut [Dot]) {
        let lone = columns.len() <= 1 && rows.len() <= 1;
        let home =
            |dot: &Dot| columns.contains(&(dot.x as usize)) && rows.contains(&(dot.y as usize));
        match dots {
            [] => {}
            dots if self.tolerance > 0.0 && dots.len() <= FEW && dots.iter().all(home) => {}
            dots if lone => within_pixel(columns.start, rows.start, dots),
            [dot] => {
                if !home(dot) {
                    self.place(columns, rows, dot);
                }
            }
            dots => {
                let upright = columns.len() >= rows.len();
                let along = |dot: &Dot| if upright { dot.x } else { dot.y };
                let (at, share) = self.cut(&columns, &rows, upright, dots.len());
                let now = dots.iter().filter(|dot| along(dot) < at as f32).count();
                let first = self.part(share, now, dots.len());
                if first > 0 && first < dots.len() {
                    dots.select_nth_unstable_by(first, |one, other| {
                        along(one).total_cmp(&along(other)).then(one.index.cmp(&other.index))
                    });
                }
                let (before, after) = dots.split_at_mut(first);
                if upright {
                    self.hand_out(columns.start..at, rows.clone(), before);
                    self.hand_out(at..columns.end, rows, after);
                } else {
                    self.hand_out(columns.clone(), rows.start..at, before);
                    self.hand_out(columns, at..rows.end, after);
                }
            }
        }
    }

    /// How many of `dots` go before a cut that has `share` of the ink before it, and `now` of the dots.
    fn part(&self, share: f64, now: usize, dots: usize) -> usize {
        let fair = share * dots as f64;
        let (least, most) = (fair - self.tolerance, fair + self.tolerance);
        let now = now as f64;
        let part = if now < least {
            least.ceil()
        } else if now > most {
            most.floor()
        } else {
            now
        };
        let none_where_no_ink = share > 0.0 && share < 1.0;
        if none_where_no_ink && least.ceil() <= most.floor() {
            (part as usize).min(dots)
        } else {
            (fair.round() as usize).min(dots)
        }
    }

    /// Where to cut columns (or rows) in two, next to where half of the ink lies, and the share of it before
    /// the cut. Of the cuts that are about as good, the one that leaves the least part of a dot over.
    fn cut(&mut self, columns: &Range, rows: &Range, upright: bool, dots: usize) -> (usize, f64) {
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
        let mut total = 0.0;
        for sum in &mut self.sums {
            total += *sum;
            *sum = total;
        }
        let dots_before = |line: usize| self.sums[line] / total * dots as f64;
        let half = self.sums[..len - 1].partition_point(|sum| *sum < 0.5 * total);
        let near = half.saturating_sub(2)..(half + 2).min(len - 1);
        let score = |line: &usize| {
            let before = dots_before(*line);
            let over = (before - before.round()).abs();
            // a cut that is further from half than this is for one heavy line only
            let uneven = (before / dots as f64 - 0.5).abs();
            over + if uneven > 0.25 { 2.0 } else { 0.0 } + uneven
        };
        let best = near.min_by(|one, other| score(one).total_cmp(&score(other))).unwrap_or(0);
        (start + best + 1, self.sums[best] / total)
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
