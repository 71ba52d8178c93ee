//! From a number in [0, 1) to a place in a triangle, neighbors to neighbors, and equal shares of the number
//! to equal shares of the density.
//!
//! Sierpiński's curve: from corner a to corner b the triangle is halved from c to the middle m of the side
//! ab, and the curve goes through (a, c, m) and then (c, b, m), each from the first corner to the second.

/// Halvings: pieces of 2⁻⁴⁰ of the triangle's area.
const HALVINGS: u32 = 40;

/// A corner: weights of the triangle's corners, and the density.
type Corner = ([f64; 3], f64);

/// The weights of the corners at `along` the curve from the first corner to the second, with densities at the
/// corners that are linear in between, not all 0.
pub(super) fn weights(densities: [f64; 3], along: f64) -> [f64; 3] {
    let [mut a, mut b, mut c]: [Corner; 3] = [
        ([1.0, 0.0, 0.0], densities[0]),
        ([0.0, 1.0, 0.0], densities[1]),
        ([0.0, 0.0, 1.0], densities[2]),
    ];
    let mut along = along;
    for _ in 0..HALVINGS {
        let m = (core::array::from_fn(|i| 0.5 * (a.0[i] + b.0[i])), 0.5 * (a.1 + b.1));
        // Halves have the same area, and the mean density of their corners.
        let first = a.1 + c.1 + m.1;
        let second = c.1 + b.1 + m.1;
        let share = along * (first + second);
        if share < first || second <= 0.0 {
            along = share / first;
            (b, c) = (c, m);
        } else {
            along = (share - first) / second;
            (a, c) = (c, m);
        }
        if along >= 1.0 || along.is_nan() {
            along = 1.0 - f64::EPSILON;
        }
        if a.1 + b.1 + c.1 <= 0.0 {
            break;
        }
    }
    core::array::from_fn(|i| (a.0[i] + b.0[i] + c.0[i]) / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_curve_are_shares_of_the_density() {
        let densities = [0.0, 1.0, 4.0];
        let n = 60_000;
        let mut mean = [0.0; 3];
        let mut before = [1.0, 0.0, 0.0];
        for i in 0..n {
            let weights = weights(densities, (f64::from(i) + 0.5) / f64::from(n));
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(weights.iter().all(|w| *w >= 0.0));
            let step = weights.iter().zip(before).map(|(w, b)| (w - b).abs()).fold(0.0, f64::max);
            // The place moves on by little, but where density is next to 0.
            assert!(step < 0.03, "{i}: {step}");
            before = weights;
            for k in 0..3 {
                mean[k] += weights[k] / f64::from(n);
            }
        }
        // ∫ λ_k·density / ∫ density = (Σ d + d_k)/(4·Σ d).
        for k in 0..3 {
            assert!((mean[k] - (5.0 + densities[k]) / 20.0).abs() < 1e-4, "{mean:?}");
        }
    }
}
