//! From bytes of samples to a plane, as most decoders have it.

use super::color::Space;
use super::plane::Plane;
use super::{Pixel, Sample, Toner};

/// The space found, or the default with a warning that says so.
pub(super) fn warned(
    what: &str,
    found: Result<Space, String>,
    warnings: &mut Vec<String>,
) -> Space {
    found.unwrap_or_else(|reason| {
        warnings.push(format!("{what} cannot be used ({reason}); sRGB is assumed"));
        Space::default()
    })
}

/// Sets every pixel of `plane` from `bytes`, whose samples are `SIZE` bytes each.
pub(super) fn paint<P: Pixel, S: Sample, const SIZE: usize>(
    plane: &mut Plane<P>,
    width: usize,
    toner: &Toner,
    bytes: &[u8],
    sample: fn([u8; SIZE]) -> S,
) {
    let channels = toner.samples();
    // The most channels are four: red, green, blue and alpha, or inks.
    let mut pixel = [sample([0; SIZE]); 4];
    for (y, row) in bytes.chunks_exact(width * channels * SIZE).enumerate() {
        for (x, stored) in row.chunks_exact(channels * SIZE).enumerate() {
            for (value, &bytes) in pixel.iter_mut().zip(stored.as_chunks::<SIZE>().0) {
                *value = sample(bytes);
            }
            plane.set(x, y, P::of(toner, &pixel[..channels]));
        }
    }
}
