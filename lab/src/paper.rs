//! The paper's own numbers, by the paper's own formulas.
//!
//! They are here to be compared with, drawn and cited. Nothing in the sampler depends on them: the
//! sampler's [`FCode::rank`] is exact where equations 4 and 5 are not, and it compares integers where
//! the paper takes logarithms.

use twelvefold::tiling::{FCode, MAX_LEVEL, RankError, TileCounts};

/// λ = 2 + √3, the linear scaling factor of one subdivision.
pub const LAMBDA: f64 = 2.0 + twelvefold::tiling::numbers::SQRT_3;

/// δ = λ² = 7 + 4√3, the area scaling factor; also λ₁ of equations 6 and 7.
pub const DELTA: f64 = 7.0 + 4.0 * twelvefold::tiling::numbers::SQRT_3;

/// λ₂ = 7 − 4√3 = 1/δ, written as the quotient because the difference cancels.
const LAMBDA_2: f64 = 1.0 / DELTA;

/// σ₁⁽ⁱ⁾ = 1, 13, 181, …: tiles under a root `a`, by recurrence, i = 0 … 16.
///
/// # Errors
/// [`RankError::TooDeep`] for i > [`MAX_LEVEL`].
pub fn sigma_1(i: usize) -> Result<u64, RankError> {
    TileCounts::HEXAGON.at(i)
}

/// σ₂⁽ⁱ⁾ = 1, 14, 195, …: tiles under a pentagonal root, by recurrence, i = 0 … 16.
///
/// # Errors
/// [`RankError::TooDeep`] for i > [`MAX_LEVEL`].
pub fn sigma_2(i: usize) -> Result<u64, RankError> {
    TileCounts::PENTAGON.at(i)
}

/// λ₁ⁿ and λ₂ⁿ by repeated multiplication.
fn powers(n: usize) -> (f64, f64) {
    (0..n).fold((1.0, 1.0), |(p, q), _| (p * DELTA, q * LAMBDA_2))
}

/// Equation 6 in floating point. The paper indexes it from 1 while its lists start at 0, so this is
/// the equation at i + 1: equal to [`sigma_1`] up to rounding.
#[must_use]
pub fn sigma_1_closed_form(i: usize) -> f64 {
    let (p, q) = powers(i);
    ((DELTA - 1.0) * p + (1.0 / LAMBDA_2 - 1.0) * q * LAMBDA_2) / (DELTA - LAMBDA_2)
}

/// Equation 7 in floating point, at i + 1 as for [`sigma_1_closed_form`].
#[must_use]
pub fn sigma_2_closed_form(i: usize) -> f64 {
    let (p, q) = powers(i + 1);
    (p - q) / (DELTA - LAMBDA_2)
}

/// S_n⁽ⁱ⁾ of equation 5: n·σ₁ for n < 2, otherwise σ₁ + (n − 1)·σ₂. (The paper's condition reads m
/// where n is meant.)
///
/// # Errors
/// [`RankError::TooDeep`] when the value leaves `u64`: for every digit n < 14 that is past i = 15.
pub fn s(n: u8, i: usize) -> Result<u64, RankError> {
    let (sigma_1, sigma_2) = (sigma_1(i)?, sigma_2(i)?);
    if n < 2 {
        return Ok(u64::from(n) * sigma_1);
    }
    sigma_2
        .checked_mul(u64::from(n - 1))
        .and_then(|rest| rest.checked_add(sigma_1))
        .ok_or(RankError::TooDeep { level: i })
}

/// The paper's routine DODECATODECIMAL: Σ S_{digit i}⁽ⁱ⁾ (equation 4), the newest digit most
/// significant.
///
/// This is **not** a numbering, whatever the paper says: it has gaps and collisions. Under root `a`
/// the 181 tiles of level 2 get values up to 193; under root `b` the 195 tiles of level 2 get only 194
/// distinct values; under root `a` the 35,113 tiles of level 4 get 34,789. Use [`FCode::rank`].
///
/// # Errors
/// [`RankError::TooDeep`] when the sum leaves `u64`.
pub fn dodecatodecimal(code: &FCode) -> Result<u64, RankError> {
    code.oldest_first().enumerate().try_fold(0u64, |sum, (i, digit)| {
        sum.checked_add(s(digit, i)?).ok_or(RankError::TooDeep { level: i })
    })
}

/// The code read as a fraction of the δ-system (equation 3): Σ dₖ·δ^−(k+1), k = 0 for the newest
/// digit. In [0, 1.006): a word of repeated D exceeds 1 slightly, as digits of a non-integer base do.
#[must_use]
pub fn delta_fraction(code: &FCode) -> f64 {
    code.oldest_first().fold(0.0, |fraction, digit| (fraction + f64::from(digit)) / DELTA)
}

/// The normalized threshold: exact rank over the number of tiles of the level, in [0, 1).
#[must_use]
pub fn normalized_threshold(code: &FCode) -> f64 {
    // A code has at most MAX_LEVEL digits, so the count exists. From level 14 on the last ranks round
    // to the count itself.
    TileCounts::of(code.root())
        .at(code.level())
        .map_or(0.0, |tiles| (code.rank() as f64 / tiles as f64).min(JUST_BELOW_ONE))
}

/// The largest `f64` below 1.
const JUST_BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// Ψ(x) = log_δ(x) mod 1 in [0, 1) for positive finite x: how far a density lies between two whole
/// levels. `None` for anything else.
///
/// The level, where Ψ falls from 1 to 0, is decided exactly for every `f64`, subnormal ones included:
/// the whole part is found by comparing with powers of δ of twice the precision. A logarithm gets it
/// wrong at one ulp either side of δ^k for most k.
#[must_use]
pub fn psi(x: f64) -> Option<f64> {
    if !(x > 0.0 && x.is_finite()) {
        return None;
    }
    let psi = libm::log(reduce_to_one_level(x)) / libm::log(DELTA);
    // x/δ^k rounds to δ when x lies an ulp below δ^(k+1), and may round below 1 at δ^k itself.
    Some(psi.clamp(0.0, JUST_BELOW_ONE))
}

/// x/δ^k for the k that puts it in [1, δ) before rounding.
fn reduce_to_one_level(x: f64) -> f64 {
    // A power of two takes x so far from the ends of the exponent range that no product of the search
    // overflows or loses its low part.
    let step = if x < 1.0 { Power::INVERSE_OF_DELTA } else { Power::DELTA };
    let scale = if x < 1.0 { SCALE } else { 1.0 / SCALE };
    let scaled = x * scale;
    let mut power = Power { high: scale, low: 0.0 };
    if x < 1.0 {
        while !power.is_at_most(scaled) {
            power = power.times(step);
        }
    } else {
        loop {
            let next = power.times(step);
            if !next.is_at_most(scaled) {
                break;
            }
            power = next;
        }
    }
    scaled / power.high
}

/// 2⁵¹².
const SCALE: f64 = f64::from_bits((1023 + 512) << 52);

/// A power of δ as the unevaluated sum of a rounded value and its rounding error.
#[derive(Clone, Copy)]
struct Power {
    high: f64,
    low: f64,
}

impl Power {
    const DELTA: Self = Self { high: DELTA, low: 4.014_033_688_722_761e-16 };
    /// 7 − 4√3.
    const INVERSE_OF_DELTA: Self = Self { high: LAMBDA_2, low: 1.052_477_554_343_139_8e-18 };

    /// The product, with a relative error near 2⁻¹⁰⁴.
    fn times(self, other: Self) -> Self {
        let product = self.high * other.high;
        let error = libm::fma(self.high, other.high, -product)
            + (self.high * other.low + self.low * other.high);
        let high = product + error;
        Self { high, low: error - (high - product) }
    }

    /// Whether the power is at most `x`. `high` is the `f64` nearest to the power, so the sign of `low`
    /// matters only when `high` is `x`. The tolerance exceeds the errors of the 270 products that a
    /// search takes at most; a test proves that the only power of δ within it of an `f64` is δ¹⁴, which
    /// is δ^−14 below an integer.
    fn is_at_most(self, x: f64) -> bool {
        const TOLERANCE: f64 = f64::from_bits((1023 - 95) << 52);
        self.high < x || (self.high == x && self.low <= TOLERANCE * self.high)
    }
}

/// The paper's κ of equation 8 with the exact tile counts in place of powers of δ: the first level
/// with at least `x` tiles under root `a`, hence 0 for x ≤ 1.
///
/// # Errors
/// [`RankError::TooDeep`] when no level within [`MAX_LEVEL`] has that many, or `x` is not a number.
pub fn kappa(x: f64) -> Result<usize, RankError> {
    TileCounts::HEXAGON
        .all()
        .iter()
        // The conversion saturates at u64::MAX, past every count, so huge `x` match none. In floating
        // point the counts from level 14 on would be rounded.
        .position(|tiles| !x.is_nan() && *tiles >= libm::ceil(x) as u64)
        .ok_or(RankError::TooDeep { level: MAX_LEVEL + 1 })
}
