//! How much memory a picture may take, decided from its header before anything is allocated.

use super::PictureError;

/// The most bytes that the decoded pixels and their importance may take together: one gibibyte, which
/// is 150 million pixels of 8-bit color.
pub(super) const MEMORY_LIMIT: u64 = 1 << 30;

/// The number of pixels, when decoding them to `bytes_per_pixel` bytes each, beside four bytes each of
/// importance, stays within [`MEMORY_LIMIT`].
///
/// # Errors
/// [`PictureError::Empty`] when either dimension is zero, [`PictureError::TooLarge`].
pub(super) fn check(
    width: usize,
    height: usize,
    bytes_per_pixel: usize,
) -> Result<usize, PictureError> {
    if width == 0 || height == 0 {
        return Err(PictureError::Empty);
    }
    match bytes(width, height, bytes_per_pixel) {
        // Four bytes a pixel fit, so the product fits any usize of 32 bits or more.
        Some(bytes) if bytes <= MEMORY_LIMIT => Ok(width * height),
        _ => Err(too_large(width, height, bytes_per_pixel)),
    }
}

/// Whether so many bytes, beside a window of this size and four bytes a pixel, stay within [`MEMORY_LIMIT`]: those of
/// a strip, tile or block of a file, `part` pixels across and down, decoded one at a time.
///
/// # Errors
/// [`PictureError::Empty`], and of whichever is larger [`PictureError::TooLarge`] or
/// [`PictureError::LargeParts`].
#[cfg(feature = "every-format")]
pub(super) fn check_beside(
    (width, height): (usize, usize),
    part: (usize, usize),
    bytes_per_pixel: usize,
) -> Result<(), PictureError> {
    check(width, height, 0)?;
    let window = bytes(width, height, 0).unwrap_or(u64::MAX);
    let (across, down) = (part.0 as u64, part.1 as u64);
    let beside =
        across.checked_mul(down).and_then(|count| count.checked_mul(bytes_per_pixel as u64));
    match beside.and_then(|beside| beside.checked_add(window)) {
        Some(bytes) if bytes <= MEMORY_LIMIT => Ok(()),
        bytes if beside.is_none_or(|beside| beside > window) => {
            Err(PictureError::LargeParts { width: part.0, height: part.1, bytes })
        }
        bytes => Err(PictureError::TooLarge { width, height, bytes }),
    }
}

/// The error for a picture of this size.
pub(super) fn too_large(width: usize, height: usize, bytes_per_pixel: usize) -> PictureError {
    PictureError::TooLarge { width, height, bytes: bytes(width, height, bytes_per_pixel) }
}

fn bytes(width: usize, height: usize, bytes_per_pixel: usize) -> Option<u64> {
    let pixels = (width as u64).checked_mul(height as u64)?;
    pixels.checked_mul(bytes_per_pixel as u64 + size_of::<f32>() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_on_bytes_not_on_sides() {
        assert_eq!(check(1 << 27, 1, 3).unwrap(), 1 << 27);
        assert!(matches!(check((1 << 28) + 1, 1, 0), Err(PictureError::TooLarge { .. })));
        assert!(matches!(check(1 << 14, 1 << 14, 1), Err(PictureError::TooLarge { .. })));
        assert!(matches!(check(usize::MAX, usize::MAX, 16), Err(PictureError::TooLarge { .. })));
        assert!(matches!(check(0, 5, 3), Err(PictureError::Empty)));
    }

    #[cfg(feature = "every-format")]
    #[test]
    fn parts_count_beside_the_window() {
        use PictureError::{Empty, LargeParts, TooLarge};
        let side = 1 << 13;
        assert!(check_beside((side, side), (side, side), 12).is_ok());
        let large =
            |bytes| LargeParts { width: side, height: side, bytes: Some(bytes) }.to_string();
        let of_part = check_beside((side, side), (side, side), 13).unwrap_err();
        assert_eq!(of_part.to_string(), large(17 << 26));
        let window = check_beside((2 * side, 2 * side), (side, side), 1);
        assert!(matches!(window, Err(TooLarge { bytes: Some(_), .. })));
        let endless = check_beside((1, 1), (usize::MAX, usize::MAX), 2);
        assert!(matches!(endless, Err(LargeParts { bytes: None, .. })));
        assert!(matches!(check_beside((0, 1), (1, 1), 1), Err(Empty)));
    }
}
