//! From coordinates to integers by additions alone, as vector instructions can.

/// 2⁵²: from here to 2⁵³ the `f64` are the integers, so that adding it to a smaller number rounds that to
/// an integer, which the lowest bits then hold.
pub(super) const INTEGERS: f64 = 4_503_599_627_370_496.0;

/// The same for `f32`: 2²³.
pub(super) const INTEGERS_SINGLE: f32 = 8_388_608.0;

/// ⌊t⌋ clamped to 0..=last, `last` an integer below 2³²; 0 for NaN.
#[inline(always)]
pub(super) fn floor_within(t: f64, last: f64) -> f64 {
    floor(clamp(t, last))
}

/// t clamped to 0..=last, 0 for NaN.
#[inline(always)]
pub(super) fn clamp(t: f64, last: f64) -> f64 {
    let t = if t > 0.0 { t } else { 0.0 };
    if t < last { t } else { last }
}

/// ⌊t⌋, 0 ≤ t < 2⁵¹.
#[inline(always)]
pub(super) fn floor(t: f64) -> f64 {
    let nearest = t + INTEGERS - INTEGERS;
    nearest - if nearest > t { 1.0 } else { 0.0 }
}

/// The same in single precision, `last` < 2²².
#[inline(always)]
pub(super) fn floor_within_single(t: f32, last: f32) -> f32 {
    let t = if t > 0.0 { t } else { 0.0 };
    let t = if t < last { t } else { last };
    let nearest = t + INTEGERS_SINGLE - INTEGERS_SINGLE;
    nearest - if nearest > t { 1.0 } else { 0.0 }
}
