//! Positions against exact arithmetic, at every level down to the last.
//!
//! The exact position of a point is a similarity of its exact coordinates: origin + half edge of the
//! root · λ^−m · (u + v√3, p + q√3), evaluated here in double-double arithmetic (106 bits). Origin and
//! half edge are the placement's own `f64` numbers: they define where the tiling lies.

use std::println;
use std::vec::Vec;

use glam::DVec2;

use crate::placement::Placement;
use crate::position::Scalar;
use crate::random::SplitMix64;
use crate::tables::ExactPoint;
use crate::tiling::MAX_LEVEL;
use crate::tree::node::Node;
use crate::walk::candidates::Candidates;
use crate::{Domain, Tables};

/// The bound that the documentation of [`Sample`](crate::Sample) states, in units of the last place of
/// the domain's diagonal: ε · 2^⌊log₂ diagonal⌋.
const STATED: f64 = 3.0;

/// An unevaluated sum high + low with |low| ≤ half an ulp of high.
#[derive(Clone, Copy)]
struct Wide(f64, f64);

impl Wide {
    /// √3 to 106 bits; the low part is (3 − s²)/(2s) for s the rounded root, s² exact by `mul_add`.
    fn sqrt_3() -> Self {
        let s = 3.0f64.sqrt();
        let square = s * s;
        let square_error = s.mul_add(s, -square);
        Self::sum(s, ((3.0 - square) - square_error) / (2.0 * s))
    }

    fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Self(s, (a - (s - t)) + (b - t))
    }

    fn plus(self, other: Self) -> Self {
        let Self(s, e) = Self::sum(self.0, other.0);
        Self::sum(s, e + self.1 + other.1)
    }

    fn times(self, other: Self) -> Self {
        let p = self.0 * other.0;
        let e = self.0.mul_add(other.0, -p) + (self.0 * other.1 + self.1 * other.0);
        Self::sum(p, e)
    }

    fn negated(self) -> Self {
        Self(-self.0, -self.1)
    }
}

/// 1/λ = 2 − √3.
fn inverse_lambda() -> Wide {
    Wide(2.0, 0.0).plus(Wide::sqrt_3().negated())
}

/// The exact position of a point of `level`, relative to the domain's corner, as (x, y).
fn exact(placement: &Placement<'_>, level: u8, at: ExactPoint) -> [Wide; 2] {
    let whole = |n: i32| Wide(n.into(), 0.0);
    let x = whole(at.u).plus(Wide::sqrt_3().times(whole(at.v)));
    let y = whole(at.p).plus(Wide::sqrt_3().times(whole(at.q)));
    let h = placement.half_edge(0);
    let (mut hx, mut hy) = (Wide(h.x, 0.0), Wide(h.y, 0.0));
    for _ in 0..level {
        (hx, hy) = (hx.times(inverse_lambda()), hy.times(inverse_lambda()));
    }
    let origin = placement.origin();
    [
        Wide(origin.x, 0.0).plus(hx.times(x)).plus(hy.times(y).negated()),
        Wide(origin.y, 0.0).plus(hy.times(x)).plus(hx.times(y)),
    ]
}

/// A node of `level` below a random frontier tile.
fn random_node(placement: &Placement<'_>, random: &mut SplitMix64, level: u8) -> Node {
    let frontier: Vec<_> = placement.frontier().collect();
    let mut node = *frontier[random.next_u64() as usize % frontier.len()];
    while node.level < level {
        let digit = random.next_u64() as usize % 14;
        if let Some(child) = node.child(placement.tables(), digit) {
            node = child;
        }
    }
    node
}

/// The largest error of a coordinate of a point inside the domain, in ulps of the diagonal.
fn largest_error<S: Scalar>(epsilon: f64) -> f64 {
    let mut random = SplitMix64::new(3);
    let mut largest = 0.0f64;
    let depth = Tables::built_in().depth();
    for seed in 0..60u64 {
        let size = [DVec2::ONE, DVec2::new(1e-6, 0.3e-6), DVec2::new(7e8, 1e9)][seed as usize % 3];
        let domain = Domain::new(DVec2::ZERO, size).unwrap();
        let placement = Placement::new(domain, seed);
        let ulp = epsilon * domain.diagonal().log2().floor().exp2();
        for level in 4..=MAX_LEVEL as u8 - depth {
            for _ in 0..8 {
                let node = random_node(&placement, &mut random, level);
                let block = placement.tables().block(node.kind);
                let batch = Candidates { node, start: 0, end: block.len(), ..Candidates::EMPTY };
                let mut next = 0;
                while next < batch.end {
                    let first = next;
                    let (segment, end) = batch.segment::<S>(&placement, first, 256);
                    next = end;
                    let (mut x, mut y) = ([S::default(); 256], [S::default(); 256]);
                    segment.write_columns(&mut x[..end - first], &mut y[..end - first]);
                    for i in 0..end - first {
                        let [x, y] = [x[i], y[i]].map(S::to_f64);
                        if !domain.contains(DVec2::new(x, y)) {
                            continue;
                        }
                        let (level, at) = born(&node, placement.tables(), first + i);
                        let [exact_x, exact_y] = exact(&placement, level, at);
                        let error = |computed: f64, exact: Wide| {
                            ((computed - exact.0) - exact.1).abs() / ulp
                        };
                        largest = largest.max(error(x, exact_x)).max(error(y, exact_y));
                    }
                }
            }
        }
    }
    largest
}

/// Level and exact coordinates at its birth of entry `i` of the node's block.
fn born(node: &Node, tables: &Tables<'_>, i: usize) -> (u8, ExactPoint) {
    let block = tables.block(node.kind);
    let levels = (0..=usize::from(tables.depth())).find(|j| i < block.born_before(j + 1)).unwrap();
    let offset = block.offset(usize::from(node.rotation % 3), i);
    let center = (0..levels).fold(node.center, |center, _| center.finer());
    (node.level + levels as u8, center.plus(offset.turned_back(4 - node.rotation / 3)))
}

#[test]
fn positions_are_within_the_stated_ulps_of_exact_ones_at_every_level() {
    let single = largest_error::<f32>(f32::EPSILON.into());
    let double = largest_error::<f64>(f64::EPSILON);
    println!("largest error in ulps of the diagonal: f32 {single:.2}, f64 {double:.2}");
    assert!(single < STATED && double < STATED, "f32 {single}, f64 {double}");
    // A bound that is far from met says nothing.
    assert!(single > 0.5 * STATED && double > 0.5 * STATED, "f32 {single}, f64 {double}");
}

#[test]
fn the_reference_has_more_than_a_hundred_bits() {
    let square = Wide::sqrt_3().times(Wide::sqrt_3());
    assert!(((square.0 - 3.0) + square.1).abs() < 1e-30);
    let one = inverse_lambda().times(Wide(2.0, 0.0).plus(Wide::sqrt_3()));
    assert!(((one.0 - 1.0) + one.1).abs() < 1e-30);
}
