//! Rows of pixels: checked, counted as the policy says, and summed.

use super::InvalidPixels;

/// Whether all are finite and not negative. One pass, no branch a pixel.
#[inline(always)]
pub(super) fn are_valid(row: &[f32]) -> bool {
    row.iter().fold(true, |all, v| all & (*v >= 0.0) & (*v < f32::INFINITY))
}

/// Whether a pixel that is no importance counts as 0 under the policy.
fn counts_as_zero(value: f32, invalid: InvalidPixels) -> bool {
    match invalid {
        InvalidPixels::ZeroAll => true,
        InvalidPixels::ZeroNegative => value < 0.0 && value.is_finite(),
        InvalidPixels::Reject => false,
    }
}

/// The first column that the policy does not admit, and its value.
#[inline(always)]
pub(super) fn first_refused(row: &[f32], invalid: InvalidPixels) -> Option<(usize, f32)> {
    if are_valid(row) {
        return None;
    }
    let refused = |(_, value): &(usize, f32)| {
        !are_valid(core::slice::from_ref(value)) && !counts_as_zero(*value, invalid)
    };
    row.iter().copied().enumerate().find(refused)
}

/// Replaces what is no importance by 0, in a row of which nothing is refused.
#[inline(always)]
pub(super) fn replace(row: &mut [f32]) {
    for pixel in row {
        *pixel = if (*pixel >= 0.0) & (*pixel < f32::INFINITY) { *pixel } else { 0.0 };
    }
}

/// Replaces what the policy replaces, or the first column that it does not admit, and its value.
pub(super) fn admit(row: &mut [f32], invalid: InvalidPixels) -> Result<(), (usize, f32)> {
    match first_refused(row, invalid) {
        Some(refused) => Err(refused),
        None => {
            if invalid != InvalidPixels::Reject {
                replace(row);
            }
            Ok(())
        }
    }
}

/// Σ, in a fixed order that vector instructions can follow: lane i adds up the numbers i, i + 16, …;
/// then the halves of the lanes are added until one is left.
#[inline(always)]
pub(super) fn sum<T: Copy + Into<f64>>(numbers: &[T]) -> f64 {
    let mut lanes = [0.0f64; 16];
    let (runs, rest) = numbers.as_chunks::<16>();
    for run in runs {
        for (lane, number) in lanes.iter_mut().zip(run) {
            *lane += (*number).into();
        }
    }
    for (lane, number) in lanes.iter_mut().zip(rest) {
        *lane += (*number).into();
    }
    let mut width = 8;
    while width > 0 {
        for i in 0..width {
            lanes[i] += lanes[i + width];
        }
        width /= 2;
    }
    lanes[0]
}
