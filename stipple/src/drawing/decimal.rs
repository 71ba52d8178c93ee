//! Decimal numbers in text, as short as they can be.
//!
//! The standard library does the same in several times the time, which would be most of a run.

/// How many decimals keep the rounding error under a hundredth of `length`.
pub(super) fn decimals(length: f64) -> usize {
    let (mut decimals, mut error) = (0, 0.5);
    // A 32-bit float below one pixel has no more than nine decimals that mean anything.
    while error >= length / 100.0 && decimals < 9 {
        decimals += 1;
        error /= 10.0;
    }
    decimals
}

/// Appends `number` / 10^`decimals`, without zeros that mean nothing, as `.5`, `-12.25` or `0`.
pub(super) fn push(text: &mut Vec<u8>, number: i64, decimals: usize) {
    if number < 0 {
        text.push(b'-');
    }
    // A 64-bit number has at most twenty digits, and a point.
    let mut digits = [0; 32];
    let mut start = digits.len();
    let mut rest = number.unsigned_abs();
    let mut written = 0;
    let mut meaningful = false;
    while rest > 0 || written < decimals {
        let digit = (rest % 10) as u8;
        rest /= 10;
        meaningful |= digit > 0 || written >= decimals;
        if meaningful {
            start -= 1;
            digits[start] = b'0' + digit;
        }
        written += 1;
        if written == decimals && meaningful {
            start -= 1;
            digits[start] = b'.';
        }
    }
    if start == digits.len() {
        text.push(b'0');
    }
    text.extend_from_slice(&digits[start..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(number: i64, decimals: usize) -> String {
        let mut text = Vec::new();
        push(&mut text, number, decimals);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn just_enough_decimals() {
        // Two decimals are off by up to 0.005 pixels.
        for (spacing, expected) in [(3.0, 2), (0.6, 2), (0.5, 3), (0.3, 3), (60.0, 0), (40.0, 1)] {
            assert_eq!(decimals(spacing), expected, "{spacing}");
        }
        assert_eq!(decimals(0.0), 9);
    }

    #[test]
    fn numbers_read_back_and_have_no_idle_zeros() {
        for (number, decimals, expected) in [
            (0, 0, "0"),
            (0, 3, "0"),
            (5, 1, ".5"),
            (-5, 1, "-.5"),
            (50, 1, "5"),
            (12_250, 3, "12.25"),
            (-7, 3, "-.007"),
            (100, 0, "100"),
            (100, 2, "1"),
            (1010, 2, "10.1"),
            (10, 9, ".00000001"),
        ] {
            assert_eq!(text(number, decimals), expected);
        }
        let mut number = 1i64;
        for _ in 0..1000 {
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let shorter = number >> 13;
            for decimals in 0..=9 {
                let read: f64 = text(shorter, decimals).parse().unwrap();
                assert_eq!(read, shorter as f64 / 10f64.powi(decimals as i32));
            }
        }
        assert_eq!(text(i64::MIN, 0), i64::MIN.to_string());
    }
}
