//! Exact plane coordinates: the ring Z\[ζ\], ζ = e^(iπ/6).
//!
//! Every tile center is an integer combination of 1, ζ, ζ², ζ³ (ζ⁴ = ζ² − 1), in units of the edge of
//! its own level. Going one level down multiplies by λ = 2 + √3, which is a unit of the ring, so no
//! rounding ever happens.

use core::fmt;

use super::numbers::SQRT_3;

/// A coordinate left the range of `i64` (level about 33 when starting from a root at 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutOfRange;

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an exact tile coordinate does not fit 64 bits: the level is too deep")
    }
}

impl core::error::Error for OutOfRange {}

/// a₀ + a₁ζ + a₂ζ² + a₃ζ³, a point of the plane with exact coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Cyclotomic(pub [i64; 4]);

impl Cyclotomic {
    /// The origin.
    pub const ZERO: Self = Self([0; 4]);

    /// ζ^k, the unit vector at k·30°, for any integer `k`.
    #[must_use]
    pub const fn zeta_power(k: i32) -> Self {
        let mut z = Self([1, 0, 0, 0]);
        let mut i = k.rem_euclid(12);
        while i > 0 {
            // All coefficients stay within ±1.
            z = Self([-z.0[3], z.0[0], z.0[1] + z.0[3], z.0[2]]);
            i -= 1;
        }
        z
    }

    /// The sum, or [`OutOfRange`].
    pub fn checked_add(self, other: Self) -> Result<Self, OutOfRange> {
        let mut sum = [0; 4];
        for ((s, a), b) in sum.iter_mut().zip(self.0).zip(other.0) {
            *s = a.checked_add(b).ok_or(OutOfRange)?;
        }
        Ok(Self(sum))
    }

    /// The difference, or [`OutOfRange`].
    pub fn checked_sub(self, other: Self) -> Result<Self, OutOfRange> {
        let mut difference = [0; 4];
        for ((d, a), b) in difference.iter_mut().zip(self.0).zip(other.0) {
            *d = a.checked_sub(b).ok_or(OutOfRange)?;
        }
        Ok(Self(difference))
    }

    /// Turned by `k`·30° about the origin: multiplication by ζ^k.
    pub fn checked_rotate(self, k: u8) -> Result<Self, OutOfRange> {
        let mut z = self.0;
        for _ in 0..k % 12 {
            z = [
                z[3].checked_neg().ok_or(OutOfRange)?,
                z[0],
                z[1].checked_add(z[3]).ok_or(OutOfRange)?,
                z[2],
            ];
        }
        Ok(Self(z))
    }

    /// Multiplied by √3 = 2ζ − ζ³.
    fn checked_mul_sqrt3(self) -> Result<Self, OutOfRange> {
        let turned = self.checked_rotate(1)?;
        let turned_thrice = self.checked_rotate(3)?;
        turned.checked_add(turned)?.checked_sub(turned_thrice)
    }

    /// The same point in edges one level finer: multiplication by λ = 2 + √3.
    pub fn checked_mul_lambda(self) -> Result<Self, OutOfRange> {
        self.checked_add(self)?.checked_add(self.checked_mul_sqrt3()?)
    }

    /// The same point in edges one level coarser: multiplication by 1/λ = 2 − √3, exact because λ is
    /// a unit of the ring.
    pub fn checked_div_lambda(self) -> Result<Self, OutOfRange> {
        self.checked_add(self)?.checked_sub(self.checked_mul_sqrt3()?)
    }

    /// Cartesian coordinates, still exact.
    ///
    /// x = a₀ + (√3/2)·a₁ + a₂/2 and y = a₁/2 + (√3/2)·a₂ + a₃.
    pub fn to_surds(self) -> Result<[Surd; 2], OutOfRange> {
        let [a0, a1, a2, a3] = self.0;
        let twice_plus = |whole: i64, half: i64| {
            whole.checked_mul(2).and_then(|w| w.checked_add(half)).ok_or(OutOfRange)
        };
        Ok([
            Surd { whole: twice_plus(a0, a2)?, root: a1 },
            Surd { whole: twice_plus(a3, a1)?, root: a2 },
        ])
    }

    /// Cartesian coordinates, each rounded a few times: error below 4 units in the last place of the
    /// largest coefficient.
    #[must_use]
    pub fn to_f64(self) -> [f64; 2] {
        let [a0, a1, a2, a3] = self.0.map(|a| a as f64);
        [a0 + 0.5 * a2 + 0.5 * SQRT_3 * a1, a3 + 0.5 * a1 + 0.5 * SQRT_3 * a2]
    }

    /// The squared length |z|², exact, as a [`Surd`].
    pub fn squared_length(self) -> Result<Surd, OutOfRange> {
        // ζ^j·conj(ζ^k) has real part cos 30°(j − k): 1, √3/2, 1/2, 0. Coefficients past 2⁴⁸ have
        // squares far outside i64, so refusing them first keeps the i128 sums in range.
        if self.0.iter().any(|a| a.unsigned_abs() >> 48 != 0) {
            return Err(OutOfRange);
        }
        let [a, b, c, d] = self.0.map(i128::from);
        let whole = 2 * (a * a + b * b + c * c + d * d) + 2 * (a * c + b * d);
        let root = 2 * (a * b + b * c + c * d);
        Ok(Surd {
            whole: i64::try_from(whole).map_err(|_| OutOfRange)?,
            root: i64::try_from(root).map_err(|_| OutOfRange)?,
        })
    }
}

/// (whole + root·√3) / 2, an exact Cartesian coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Surd {
    /// Twice the rational part.
    pub whole: i64,
    /// Twice the coefficient of √3.
    pub root: i64,
}

impl Surd {
    /// The integer `n`.
    #[must_use]
    pub const fn integer(n: i32) -> Self {
        Self { whole: 2 * n as i64, root: 0 }
    }

    /// −1, 0 or 1, decided without rounding: whole² is compared with 3·root² in 128 bits.
    #[must_use]
    pub fn signum(self) -> i32 {
        let (w, r) = (self.whole, self.root);
        let (whole, root) = (u128::from(w.unsigned_abs()), u128::from(r.unsigned_abs()));
        // At most 3·2¹²⁶ < 2¹²⁸. Never equal unless both are 0: √3 is irrational.
        let whole_is_larger = whole * whole > 3 * root * root;
        if w == 0 || (r != 0 && !whole_is_larger) { r.signum() as i32 } else { w.signum() as i32 }
    }

    /// Rounded to `f64`.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        0.5 * (self.whole as f64 + SQRT_3 * self.root as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_turns_are_the_identity_and_six_negate() {
        let z = Cyclotomic([3, -1, 4, 15]);
        assert_eq!(z.checked_rotate(6).unwrap().0, z.0.map(|a| -a));
        assert_eq!(z.checked_rotate(5).unwrap().checked_rotate(7).unwrap(), z);
        for k in 0..12 {
            let unit = Cyclotomic::zeta_power(k);
            assert_eq!(unit.squared_length().unwrap(), Surd::integer(1));
            assert_eq!(Cyclotomic([1, 0, 0, 0]).checked_rotate(k as u8).unwrap(), unit);
            let [x, y] = unit.to_f64();
            let angle = f64::from(k) * core::f64::consts::PI / 6.0;
            assert!((x - libm::cos(angle)).abs() < 1e-15 && (y - libm::sin(angle)).abs() < 1e-15);
        }
    }

    #[test]
    fn lambda_is_a_unit_and_stretches_by_two_plus_root_three() {
        let z = Cyclotomic([7, -2, 5, 1]);
        let finer = z.checked_mul_lambda().unwrap();
        assert_eq!(finer.checked_div_lambda().unwrap(), z);
        let ([x, y], [fx, fy]) = (z.to_f64(), finer.to_f64());
        assert!((fx - x * (2.0 + SQRT_3)).abs() < 1e-12 && (fy - y * (2.0 + SQRT_3)).abs() < 1e-12);
    }

    #[test]
    fn signs_are_exact_where_floats_are_not() {
        // Convergents of √3: 2·18817² … |p² − 3q²| = 1 although p − q√3 is far below one ulp.
        let (mut p, mut q) = (2i64, 1i64);
        for _ in 0..30 {
            (p, q) = (2 * p + 3 * q, p + 2 * q);
            assert_eq!(Surd { whole: p, root: -q }.signum(), 1);
            assert_eq!(Surd { whole: -p, root: q }.signum(), -1);
        }
        assert_eq!(Surd { whole: 0, root: 0 }.signum(), 0);
        assert_eq!(Surd { whole: i64::MIN, root: i64::MAX }.signum(), 1);
    }

    #[test]
    fn leaving_the_range_is_an_error() {
        let huge = Cyclotomic([i64::MAX, 0, 0, 0]);
        assert_eq!(huge.checked_add(huge), Err(OutOfRange));
        assert_eq!(huge.checked_mul_lambda(), Err(OutOfRange));
        assert_eq!(huge.to_surds(), Err(OutOfRange));
        assert_eq!(huge.squared_length(), Err(OutOfRange));
        assert_eq!(Cyclotomic([0, 0, 0, i64::MIN]).checked_rotate(1), Err(OutOfRange));
    }
}
