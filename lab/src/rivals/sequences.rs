//! Points of the unit square, by index.

use fast_poisson::Poisson2D;
use glam::{DVec2, Vec2};

/// 1/g and 1/g² as fractions of 2⁶⁴, where g³ = g + 1 (M. Roberts, *The unreasonable effectiveness of
/// quasirandom sequences*, 2018).
const R2: [u64; 2] = [0xc13f_a9a9_02a6_328f, 0x91e1_0da5_c79e_7b1d];

/// Point `i` of the Halton sequence in bases 2 and 3.
#[must_use]
pub fn halton(i: u32) -> DVec2 {
    let (mut rest, mut reversed, mut power) = (i, 0u64, 1u64);
    while rest > 0 {
        reversed = reversed * 3 + u64::from(rest % 3);
        rest /= 3;
        power *= 3;
    }
    let two = f64::from(i.reverse_bits()) / (1u64 << 32) as f64;
    DVec2::new(two, reversed as f64 / power as f64)
}

/// Point `i` of R2, from the middle of the square: multiples of 1/g and 1/g², in fixed point.
#[must_use]
pub fn r2(i: u32) -> DVec2 {
    let at = |step: u64| {
        let bits = u64::from(i).wrapping_mul(step).wrapping_add(1 << 63);
        (bits >> 11) as f64 / (1u64 << 53) as f64
    };
    DVec2::new(at(R2[0]), at(R2[1]))
}

/// The same in single precision and 32 bits of fixed point, for speed.
#[must_use]
pub fn r2_single(i: u32) -> Vec2 {
    let at = |step: u64| {
        let bits = i.wrapping_mul((step >> 32) as u32).wrapping_add(1 << 31);
        (bits >> 8) as f32 / (1 << 24) as f32
    };
    Vec2::new(at(R2[0]), at(R2[1]))
}

/// Point `i` of the Owen-scrambled Sobol sequence, whose 65,536 points are taken again under another
/// scrambling past its end. One call makes two coordinates that are used and two that are not.
#[must_use]
pub fn sobol(i: u32, seed: u32) -> Vec2 {
    let [x, y, ..] = sobol_burley::sample_4d(i & 0xffff, 0, seed.wrapping_add(i >> 16));
    Vec2::new(x, y)
}

/// Bridson's Poisson disks, about `n` of them: it takes a radius, so a few tries find the one.
#[must_use]
pub fn poisson_disk(n: usize, seed: u64) -> Poisson2D {
    let of_radius = |radius| Poisson2D::new().with_dimensions([1.0, 1.0], radius).with_seed(seed);
    // The density that the algorithm reaches: 0.7 of the square a radius.
    let mut radius = (0.7 / n.max(1) as f64).sqrt();
    for _ in 0..5 {
        radius *= (of_radius(radius).iter().count() as f64 / n.max(1) as f64).sqrt();
    }
    of_radius(radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_begin_as_published() {
        assert_eq!(halton(0), DVec2::ZERO);
        assert_eq!(halton(5).x, 0.625);
        assert!((halton(5).y - 7.0 / 9.0).abs() < 1e-15);
        let step = (r2(1) - r2(0)).rem_euclid(DVec2::ONE);
        assert!((step - DVec2::new(0.754_877_666, 0.569_840_291)).length() < 1e-8);
        assert!((0..1000).all(|i| (r2_single(i).as_dvec2() - r2(i)).length() < 1e-6));
        assert!((0..70_000).all(|i| sobol(i, 1).cmplt(Vec2::ONE).all()));
        assert_ne!(sobol(3, 1), sobol(3 + (1 << 16), 1));
        assert!(poisson_disk(400, 1).iter().count().abs_diff(400) < 40);
    }
}
