//! Points that follow a map.

use rustfft::num_traits::Float;
use twelvefold::ImageMap;

/// A piecewise-constant distribution inverted as in pbrt: a row by the marginal distribution, then a
/// column by the row's own, each by binary search over cumulative sums of precision `T`.
#[derive(Clone, Debug)]
pub struct InverseCdf<T> {
    width: usize,
    /// Shares of the rows before each; the last is 1.
    marginal: Vec<T>,
    /// Shares of the pixels before each in its row: width + 1 numbers a row.
    conditional: Vec<T>,
}

impl<T: Float> InverseCdf<T> {
    /// Of a map that is not 0 everywhere.
    #[must_use]
    pub fn new(map: &ImageMap) -> Self {
        let (width, height) = map.size();
        let mut conditional = Vec::with_capacity((width + 1) * height);
        let mut rows = Vec::with_capacity(height);
        for row in map.pixels().chunks_exact(width) {
            let weights = row.iter().map(|pixel| f64::from(*pixel));
            rows.push(weights.clone().sum::<f64>());
            conditional.extend(shares::<T>(weights));
        }
        Self { width, marginal: shares(rows.into_iter()).collect(), conditional }
    }

    /// The position, in pixels, to which a point of [0, 1)² goes.
    #[must_use]
    pub fn position(&self, [u, v]: [T; 2]) -> [T; 2] {
        let (row, y) = invert(&self.marginal, v);
        let stride = self.width + 1;
        let (column, x) = invert(&self.conditional[row * stride..][..stride], u);
        [exact::<T>(column) + x, exact::<T>(row) + y]
    }
}

fn exact<T: Float>(i: usize) -> T {
    T::from(i).unwrap_or_else(T::nan)
}

/// 0, then the sum of the weights so far over the sum of all (NaN where that is 0: never chosen).
fn shares<T: Float>(weights: impl Iterator<Item = f64> + Clone) -> impl Iterator<Item = T> {
    let total: f64 = weights.clone().sum();
    let sums = weights.scan(0.0, |sum, weight| {
        *sum += weight;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).map(move |sum| T::from(sum / total).unwrap_or_else(T::nan))
}

/// The interval of cumulative shares that holds `u`, and where in it, in [0, 1).
fn invert<T: Float>(shares: &[T], u: T) -> (usize, T) {
    let interval = shares.partition_point(|share| *share <= u).clamp(1, shares.len() - 1) - 1;
    let (low, high) = (shares[interval], shares[interval + 1]);
    let place = if high > low {
        ((u - low) / (high - low)).min(T::one() - T::epsilon())
    } else {
        T::zero()
    };
    (interval, place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use twelvefold::InvalidPixels;

    #[test]
    fn inversion_follows_the_map() {
        let pixels: Vec<f32> = vec![0.0, 1.0, 2.0, 0.0, 5.0, 0.0, 0.0, 3.0];
        let map = ImageMap::new(4, 2, pixels.clone(), InvalidPixels::Reject).unwrap();
        let (double, single) = (InverseCdf::<f64>::new(&map), InverseCdf::<f32>::new(&map));
        let mut random = Random::new(1, &[]);
        let mut counts = [0.0; 8];
        let n = 50_000;
        for _ in 0..n {
            let point = random.point();
            let at = double.position(point.to_array());
            counts[at[1] as usize * 4 + at[0] as usize] += 11.0 / f64::from(n);
            let near = single.position(point.as_vec2().to_array());
            assert!((f64::from(near[1]) - at[1]).abs() < 1e-5);
        }
        for (pixel, count) in pixels.iter().zip(counts) {
            assert!((f64::from(*pixel) - count).abs() < 0.15, "{pixel} {count}");
        }
    }
}
