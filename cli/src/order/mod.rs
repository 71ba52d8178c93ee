//! The order in which a pen visits dots, and the line that it may draw through them.
//!
//! `curve` gives a first tour, `near` says who is close to whom, `tour` is a closed way that can be turned
//! around in parts, `improve` shortens it, and `uncross` takes the crossings out of a line. Only +, −, ×, ÷
//! and √ decide: the same dots are visited in the same order on every machine.

mod curve;
mod improve;
mod near;
#[cfg(test)]
mod tests;
mod tour;
mod uncross;

use glam::DVec2;

pub(crate) use near::Grid;
use tour::Tour;

/// Sorts dots so that the way from the first to the last is short: some 3 to 7 % above the shortest closed tour
/// through evenly spread dots. Begins near the least coordinates. About 2 microseconds a dot, up to a million.
pub(crate) fn short(dots: &mut [DVec2]) {
    let mut tour = Tour::new(curve::along(dots));
    improve::improve(&mut tour, dots);
    sort(dots, &opened(tour, dots));
}

/// Sorts dots so that the line from the first through all others to the last never meets itself, and is
/// short. Dots in one place become one. Coordinates count up to a thousandth, to which they are rounded.
pub(crate) fn line(dots: &mut Vec<DVec2>) {
    let mut places = uncross::Places::new(dots);
    *dots = places.dots();
    let mut tour = Tour::new(curve::along(dots));
    improve::improve(&mut tour, dots);
    let order = uncross::uncrossed(opened(tour, dots), &mut places);
    *dots = places.dots();
    sort(dots, &order);
}

/// The tour without its longest edge, from whichever end is nearer to the least coordinates.
fn opened(tour: Tour, dots: &[DVec2]) -> Vec<u32> {
    let mut order = tour.into_order();
    let count = order.len();
    let at = |index: u32| dots[index as usize];
    let edge = |i: usize| at(order[i]).distance(at(order[(i + 1) % count]));
    let mut longest = 0;
    for i in 1..count {
        if edge(i) > edge(longest) {
            longest = i;
        }
    }
    if count > 0 {
        order.rotate_left((longest + 1) % count);
    }
    let start = dots.iter().fold(DVec2::INFINITY, |least, dot| least.min(*dot));
    if let [first, .., last] = order[..]
        && at(last).distance(start) < at(first).distance(start)
    {
        order.reverse();
    }
    order
}

fn sort(dots: &mut [DVec2], order: &[u32]) {
    let sorted: Vec<DVec2> = order.iter().map(|&index| dots[index as usize]).collect();
    dots.copy_from_slice(&sorted);
}
