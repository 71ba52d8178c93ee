//! The irrational numbers of the geometry, each once: √3 and what is made of it.

/// √3 rounded to the nearest `f64`. The only irrational number in the whole geometry.
pub const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// λ = 2 + √3: how much longer the edges of one level are than those of the next.
pub const LAMBDA: f64 = 2.0 + SQRT_3;

/// δ = λ² = 7 + 4√3: how many times more tiles the next level has, in the limit.
pub const DELTA: f64 = 7.0 + 4.0 * SQRT_3;

/// No descendant of a tile is farther from its center than this many of its edges: children are at
/// most 2 cos 15° child edges away, and 2 cos 15°/(λ − 1) = 1/√2 exactly.
pub const REACH: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// cos of k·30°.
const COSINES: [f64; 12] = {
    const H: f64 = 0.5 * SQRT_3;
    [1.0, H, 0.5, 0.0, -0.5, -H, -1.0, -H, -0.5, 0.0, 0.5, H]
};

/// (cos, sin) of `k`·30°.
#[must_use]
pub const fn direction(k: u8) -> [f64; 2] {
    let k = (k % 12) as usize;
    [COSINES[k], COSINES[(k + 9) % 12]]
}

/// λ^n = a + b√3 with integers a, b: the sum of two positive terms, accurate to an ulp.
#[must_use]
pub fn lambda_power(n: usize) -> f64 {
    let (mut a, mut b) = (1i64, 0i64);
    for _ in 0..n {
        (a, b) = (2 * a + 3 * b, a + 2 * b);
    }
    a as f64 + SQRT_3 * b as f64
}

/// A rotation by a multiple of 30° in single precision: cosine and sine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation([f32; 2]);

impl Rotation {
    /// By `k`·30°, `k` below 12.
    #[inline(always)]
    pub(crate) fn new(k: u8) -> Self {
        // Of a power of two, so that no index is out of range.
        const ROTATIONS: [Rotation; 16] = {
            let mut rotations = [Rotation([1.0, 0.0]); 16];
            let mut k = 0;
            while k < 12 {
                let [cos, sin] = direction(k as u8);
                rotations[k] = Rotation([cos as f32, sin as f32]);
                k += 1;
            }
            rotations
        };
        ROTATIONS[usize::from(k % 16)]
    }

    /// The vector rotated.
    #[inline(always)]
    pub(crate) fn rotated(self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [c, s] = self.0;
        [c * x + -s * y, s * x + c * y]
    }
}
