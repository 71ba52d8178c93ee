//! A tour made shorter by exchanging edges with near dots, until no exchange helps.
//!
//! 2-opt: two edges ab, cd become ac, bd. Or-opt: up to three dots in a row go in between two others.
//! Both only try edges to near dots that are shorter than one that is given up, and only around dots where
//! something has changed (Bentley, *Fast algorithms for geometric traveling salesman problems*, 1992).

use std::collections::VecDeque;

use glam::DVec2;

use super::near::nearest;
use super::tour::Tour;

/// Near dots that are tried. From 8 to 10 the way is a quarter of a percent shorter.
const NEAR: usize = 8;

/// The most dots in a row that are moved at once.
const LONGEST_ROW: usize = 3;

/// Exchanges that turn around more dots are left alone: with a million dots they would take most of the time
/// and gain a hundredth of a percent.
const MOST_EFFORT: usize = 50_000;

/// An exchange must gain this part of the edge it gives up, well above rounding.
const LEAST_GAIN: f64 = 1e-9;

/// Shortens `tour` through `dots`.
pub(super) fn improve(tour: &mut Tour, dots: &[DVec2]) {
    if dots.len() < 5 {
        return;
    }
    let near = nearest(dots, NEAR);
    let queue: VecDeque<u32> = tour.order().iter().copied().collect();
    let waiting = vec![true; dots.len()];
    let mut search = Search { tour, dots, near, queue, waiting };
    while let Some(dot) = search.queue.pop_front() {
        search.waiting[dot as usize] = false;
        while search.two_opt(dot) || search.or_opt(dot) {}
    }
}

struct Search<'a> {
    tour: &'a mut Tour,
    dots: &'a [DVec2],
    near: Vec<u32>,
    /// Dots around which an exchange may help.
    queue: VecDeque<u32>,
    waiting: Vec<bool>,
}

/// A way along the tour.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Forwards,
    Backwards,
}

impl Search<'_> {
    fn distance(&self, a: u32, b: u32) -> f64 {
        self.dots[a as usize].distance(self.dots[b as usize])
    }

    fn near(&self, dot: u32, k: usize) -> Option<u32> {
        let count = NEAR.min(self.dots.len() - 1);
        (k < count).then(|| self.near[dot as usize * count + k])
    }

    fn after(&self, dot: u32, way: Way) -> u32 {
        match way {
            Way::Forwards => self.tour.next(dot),
            Way::Backwards => self.tour.previous(dot),
        }
    }

    fn wake(&mut self, dots: &[u32]) {
        for &dot in dots {
            if !std::mem::replace(&mut self.waiting[dot as usize], true) {
                self.queue.push_back(dot);
            }
        }
    }

    /// Makes the first exchange of two edges found that gives up one at `a`; says whether there was one.
    fn two_opt(&mut self, a: u32) -> bool {
        for way in [Way::Forwards, Way::Backwards] {
            let b = self.after(a, way);
            let given = self.distance(a, b);
            for k in 0.. {
                let Some(c) = self.near(a, k) else { break };
                let taken = self.distance(a, c);
                if taken >= given {
                    break;
                }
                let d = self.after(c, way);
                let gain = given + self.distance(c, d) - taken - self.distance(b, d);
                let effort = match way {
                    Way::Forwards => self.tour.effort(b, c),
                    Way::Backwards => self.tour.effort(a, d),
                };
                if gain > LEAST_GAIN * given && effort <= MOST_EFFORT {
                    self.tour.exchange([a, b, c, d]);
                    self.wake(&[a, b, c, d]);
                    return true;
                }
            }
        }
        false
    }

    /// Moves the first row found that begins or ends with `a` and lies better next to a near dot.
    fn or_opt(&mut self, a: u32) -> bool {
        for way in [Way::Forwards, Way::Backwards] {
            // The row runs from `a` that way to `z`; o comes before it and p after it.
            let other = if way == Way::Forwards { Way::Backwards } else { Way::Forwards };
            let o = self.after(a, other);
            let mut row = [a; LONGEST_ROW];
            for length in 1..=LONGEST_ROW {
                if length > 1 {
                    row[length - 1] = self.after(row[length - 2], way);
                }
                let row = &row[..length];
                let z = row[length - 1];
                let p = self.after(z, way);
                if row.contains(&p) || row.contains(&o) || o == p {
                    break;
                }
                let given = self.distance(o, a) + self.distance(z, p) - self.distance(o, p);
                for k in 0.. {
                    let Some(c) = self.near(a, k) else { break };
                    let taken = self.distance(a, c);
                    if taken >= given {
                        break;
                    }
                    if row.contains(&c) {
                        continue;
                    }
                    // `a` goes next to c, z next to d.
                    for beside in [way, other] {
                        let d = self.after(c, beside);
                        // The edge at which the row already is.
                        if row.contains(&d) {
                            continue;
                        }
                        let gain = given + self.distance(c, d) - taken - self.distance(z, d);
                        if gain > LEAST_GAIN * given
                            && self.tour.effort(c, a).max(self.tour.effort(a, c)) <= 2 * MOST_EFFORT
                        {
                            self.move_row([o, a, z, p], [c, d], beside == way);
                            self.wake(&[o, a, z, p, c, d]);
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Takes the row a … z from between o and p and puts it between c and d, `a` next to c. Along the tour,
    /// in one direction, they come as o a … z p, and c d if `ahead`, else d c.
    fn move_row(&mut self, [o, a, z, p]: [u32; 4], [c, d]: [u32; 2], ahead: bool) {
        // In that direction: x before y.
        let (x, y) = if ahead { (c, d) } else { (d, c) };
        // o a … z p … x y  →  o x … p z … a y  →  o p … x z … a y
        self.tour.exchange([o, a, x, y]);
        if x != p {
            self.tour.exchange([o, x, p, z]);
        }
        if ahead && a != z {
            // a next to x = c.
            self.tour.exchange([x, z, a, y]);
        }
    }
}
