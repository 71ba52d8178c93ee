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
}
