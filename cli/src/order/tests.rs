use glam::DVec2;
use proptest::prelude::*;

use super::{improve, line, near, short};

fn length(dots: &[DVec2]) -> f64 {
    dots.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

fn sorted(dots: &[DVec2]) -> Vec<[u64; 2]> {
    let mut bits: Vec<_> = dots.iter().map(|dot| [dot.x.to_bits(), dot.y.to_bits()]).collect();
    bits.sort_unstable();
    bits
}

/// A jittered grid, the same on every run.
fn scattered(side: u32) -> Vec<DVec2> {
    let mut state = 1u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    (0..side * side)
        .map(|i| DVec2::new(f64::from(i % side) + random(), f64::from(i / side) + random()))
        .collect()
}

/// Whether two closed segments with whole ends have a point in common.
fn meet(a: [i64; 2], b: [i64; 2], c: [i64; 2], d: [i64; 2]) -> bool {
    let side = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
    };
    let within = |p: [i64; 2], q: [i64; 2], r: [i64; 2]| {
        (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]))
    };
    let (e, f, g, h) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    (e * f < 0 && g * h < 0)
        || (e == 0 && within(a, b, c))
        || (f == 0 && within(a, b, d))
        || (g == 0 && within(c, d, a))
        || (h == 0 && within(c, d, b))
}

/// Whether the line through dots meets itself anywhere but where one stroke ends and the next begins; looks
/// at every pair.
fn meets_itself(dots: &[DVec2]) -> bool {
    let whole: Vec<[i64; 2]> = dots
        .iter()
        .map(|dot| [(dot.x * 1e3).round() as i64, (dot.y * 1e3).round() as i64])
        .collect();
    let edges: Vec<_> = whole.windows(2).map(|pair| (pair[0], pair[1])).collect();
    (0..edges.len())
        .any(|i| (i + 2..edges.len()).any(|j| meet(edges[i].0, edges[i].1, edges[j].0, edges[j].1)))
}

#[test]
fn the_way_through_even_dots_is_short() {
    let mut dots = scattered(40);
    let before = sorted(&dots);
    short(&mut dots);
    assert_eq!(sorted(&dots), before);
    // The shortest tour through 1,600 random dots is about 0.7124·√(n·A)·(1 + 0.33/n) = 1,140; through
    // these, which are more even, it is longer.
    assert!(length(&dots) < 1_430.0, "{}", length(&dots));
    let again = dots.clone();
    short(&mut dots);
    assert!(length(&dots) <= length(&again) * 1.03);
}

#[test]
fn the_line_does_not_meet_itself() {
    let mut dots = scattered(30);
    line(&mut dots);
    assert_eq!(dots.len(), 900);
    assert!(!meets_itself(&dots));
}

#[test]
fn few_dots_and_dots_in_one_place_are_ordered_too() {
    for count in 0..8 {
        for spread in [0.0, 1.0] {
            let dots: Vec<DVec2> =
                (0..count).map(|i| DVec2::new(f64::from(i * i % 5), 1.0) * spread).collect();
            let mut short_dots = dots.clone();
            short(&mut short_dots);
            assert_eq!(sorted(&short_dots), sorted(&dots));
            let mut line_dots = dots;
            line(&mut line_dots);
            assert!(line_dots.len() <= count as usize);
        }
    }
}

#[test]
fn a_tour_that_is_improved_stays_a_tour() {
    let dots = scattered(12);
    let order: Vec<u32> = (0..144).map(|i| i * 89 % 144).collect();
    let mut tour = super::tour::Tour::new(order);
    improve::improve(&mut tour, &dots);
    let mut found = tour.into_order();
    found.sort_unstable();
    assert!(found.into_iter().eq(0..144));
    assert_eq!(near::nearest(&dots, 3).len(), 3 * 144);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Few places, so that many dots lie on one line or in one place.
    #[test]
    fn any_dots_are_all_visited_and_their_line_does_not_meet_itself(
        places in prop::collection::vec((0u8..12, 0u8..12), 0..70),
    ) {
        let dots: Vec<DVec2> = places.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
        let mut ordered = dots.clone();
        short(&mut ordered);
        prop_assert_eq!(sorted(&ordered), sorted(&dots));

        let mut different: Vec<_> = places.clone();
        different.sort_unstable();
        different.dedup();
        let mut drawn = dots;
        line(&mut drawn);
        prop_assert_eq!(drawn.len(), different.len());
        prop_assert!(!meets_itself(&drawn), "{:?}", drawn);
    }
}
