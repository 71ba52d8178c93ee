//! The Owen-scrambled Sobol sequence of the square.

/// The greatest number below 1.
const UNITS: f64 = 1.0 / (1u64 << 53) as f64;

/// A sequence of points of [0, 1)²: Sobol's, with nested uniform scrambling (A. B. Owen, *Randomly
/// permuted (t,m,s)-nets*, 1995) from a seed.
///
/// The first 2^k points, and any aligned run of 2^k after them, have exactly one point in every
/// rectangle 2^−i × 2^(i−k): no strip along the axes is favoured, which is what a warp along the axes
/// rewards. Every point alone is uniform, so that estimates are unbiased over seeds.
///
/// The scrambling is by hash (S. Laine and T. Karras, *Stratified Sampling for Stochastic
/// Transparency*, 2011, with the constants of B. Burley, *Practical Hash-based Owen Scrambling*, 2020):
/// a few nanoseconds a point, in any order, without state. 2³² points of 53 bits each: crates in use
/// end at 65,536 points of 24 bits, too few and too coarse for a sun of a few pixels in a large map.
///
/// ```
/// use twelvefold::light::Sobol;
/// let sobol = Sobol::new(7);
/// // Sixteen points, one in each cell of a 4 × 4 grid.
/// let mut found = [0; 16];
/// for i in 0..16 {
///     let [x, y] = sobol.point(i);
///     found[(4.0 * x) as usize + 4 * (4.0 * y) as usize] += 1;
/// }
/// assert_eq!(found, [1; 16]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sobol {
    seeds: [u64; 2],
}

impl Sobol {
    /// The sequence of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        let x = mix(seed ^ 0x6a09_e667_f3bc_c908);
        Self { seeds: [x, mix(x)] }
    }

    /// Point `i`, each coordinate a multiple of 2⁻⁵³ in [0, 1).
    #[must_use]
    pub const fn point(&self, i: u32) -> [f64; 2] {
        // The first direction numbers are the identity read backwards, so that the scrambled bits of x
        // from the least on are those of i. y's are Pascal's triangle modulo 2.
        [coordinate(i, self.seeds[0]), coordinate(pascal(i), self.seeds[1])]
    }
}

/// SplitMix64's finalizer.
const fn mix(state: u64) -> u64 {
    let z = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The second coordinate's digits, least first: bit j is the sum modulo 2 of C(k, j) over the bits k of
/// i, which Lucas' theorem does in five steps: C(k, j) is odd where j's bits are among k's.
const fn pascal(i: u32) -> u32 {
    let i = i ^ ((i >> 1) & 0x5555_5555);
    let i = i ^ ((i >> 2) & 0x3333_3333);
    let i = i ^ ((i >> 4) & 0x0f0f_0f0f);
    let i = i ^ ((i >> 8) & 0x00ff_00ff);
    i ^ (i >> 16)
}

/// Scrambles the binary fraction whose digits are the bits of `digits`, least first.
const fn coordinate(digits: u32, seed: u64) -> f64 {
    // Each step adds to a bit a function of the bits below it only: a flip that depends on the digits
    // before, which is what Owen's scrambling is.
    let x = digits.wrapping_add(seed as u32);
    let x = x ^ x.wrapping_mul(0x6c50_b47c);
    let x = x ^ x.wrapping_mul(0xb82f_1e52);
    let x = x ^ x.wrapping_mul(0xc7af_e638);
    let x = x ^ x.wrapping_mul(0x8d22_f6e6);
    let high = x.reverse_bits();
    // All digits past the 32nd are 0 before and anything after, the same for the same 32 before them.
    let low = mix(seed ^ ((high as u64) << 32)) >> (64 - 21);
    (((high as u64) << 21) | low) as f64 * UNITS
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;

    #[test]
    fn every_elementary_rectangle_of_every_aligned_run_has_one_point() {
        for seed in 0..4 {
            let sobol = Sobol::new(seed);
            for (power, start) in [(0u32, 5u32), (4, 0), (6, 192), (10, 0), (10, 1 << 31)] {
                for wide in 0..=power {
                    let (columns, rows) = (1u32 << wide, 1u32 << (power - wide));
                    let mut found = vec![false; 1 << power];
                    for i in start..start + (1 << power) {
                        let [x, y] = sobol.point(i);
                        assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y));
                        let column = (x * f64::from(columns)) as u32;
                        let row = (y * f64::from(rows)) as u32;
                        let cell = &mut found[(row * columns + column) as usize];
                        assert!(!*cell, "seed {seed}, {columns} x {rows}");
                        *cell = true;
                    }
                }
            }
        }
    }

    #[test]
    fn the_second_coordinate_is_sobols_matrix() {
        // Bit j of the digits of i = 2^k is C(k, j) modulo 2, by Pascal's rule.
        let mut row: alloc::vec::Vec<u32> = vec![1];
        for k in 0..32 {
            let digits: u32 = row.iter().enumerate().map(|(j, odd)| odd << j).sum();
            assert_eq!(pascal(1 << k), digits);
            let padded: alloc::vec::Vec<u32> =
                [0].into_iter().chain(row.iter().copied()).chain([0]).collect();
            row = padded.windows(2).map(|pair| (pair[0] + pair[1]) % 2).collect();
        }
        assert_eq!(pascal(0b1011), pascal(8) ^ pascal(2) ^ pascal(1));
    }

    /// Over seeds, each point is uniform and the two coordinates, and two points, are independent
    /// enough: means of products within four standard errors.
    #[test]
    fn points_are_uniform_over_seeds() {
        let seeds = 4000u32;
        for i in [0u32, 1, 2, 7, 1000] {
            let mut cells = [0u32; 64];
            let (mut product, mut next) = (0.0, 0.0);
            for seed in 0..seeds {
                let sobol = Sobol::new(seed.into());
                let [x, y] = sobol.point(i);
                cells[(8.0 * x) as usize + 8 * (8.0 * y) as usize] += 1;
                product += (x - 0.5) * (y - 0.5);
                // Independent of the point after but for lying in another half.
                next += (x - 0.5) * (sobol.point(i ^ 1)[1] - 0.5);
            }
            let expected = f64::from(seeds) / 64.0;
            let chi: f64 =
                cells.iter().map(|n| (f64::from(*n) - expected).powi(2) / expected).sum();
            // 63 degrees of freedom: 63 ± 11.
            assert!(chi < 63.0 + 5.0 * 11.3, "point {i}: {chi}");
            let error = libm::sqrt(f64::from(seeds)) / 12.0;
            assert!(product.abs() < 4.0 * error && next.abs() < 4.0 * error, "{product} {next}");
        }
    }
}
