//! Rival sequences and inversions, in their usual textbook forms.

use glam::DVec2;
use twelvefold::ImageMap;

/// Uniform numbers, SplitMix64.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The numbers of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0xd134_2543_de82_ef95) ^ 0x5851_f42d_4c95_7f2d)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [0, 1)².
    pub fn point(&mut self) -> DVec2 {
        DVec2::new(self.unit(), self.unit())
    }
}

/// The Halton sequence in bases 2 and 3.
#[must_use]
pub fn halton(i: usize) -> DVec2 {
    let two = (i as u64).reverse_bits() >> 11;
    let (mut rest, mut three, mut place) = (i, 0.0, 1.0);
    while rest > 0 {
        place /= 3.0;
        three += (rest % 3) as f64 * place;
        rest /= 3;
    }
    DVec2::new(two as f64 / (1u64 << 53) as f64, three)
}

/// The R2 sequence (M. Roberts): multiples of 1/g and 1/g², g³ = g + 1.
#[must_use]
pub fn plastic(i: usize) -> DVec2 {
    const G: f64 = 1.324_717_957_244_746;
    (i as f64 * DVec2::new(1.0 / G, 1.0 / (G * G))).fract()
}

/// The Owen-scrambled Sobol sequence, up to 65,536 points.
#[must_use]
pub fn sobol(i: usize, seed: u64) -> DVec2 {
    let coordinate = |dimension| sobol_burley::sample(i as u32, dimension, seed as u32);
    DVec2::new(coordinate(0).into(), coordinate(1).into())
}

/// Inversion of the marginal of the rows, then of the row (as in pbrt's piecewise-constant
/// distributions).
#[derive(Clone, Debug)]
pub struct InverseCdf {
    width: usize,
    /// Sums of the rows before each.
    rows: Vec<f64>,
    /// Sums of the pixels before each in its row, width + 1 a row.
    columns: Vec<f64>,
}

impl InverseCdf {
    /// Of a map's pixels.
    #[must_use]
    pub fn new(map: &ImageMap) -> Self {
        let (width, height) = map.size();
        let mut columns = Vec::with_capacity((width + 1) * height);
        let mut rows = vec![0.0];
        let mut total = 0.0;
        for row in map.pixels().chunks_exact(width) {
            let mut sum = 0.0;
            columns.push(sum);
            for pixel in row {
                sum += f64::from(*pixel);
                columns.push(sum);
            }
            total += sum;
            rows.push(total);
        }
        Self { width, rows, columns }
    }

    /// The position, in pixels, to which a point of [0, 1)² goes.
    #[must_use]
    pub fn position(&self, at: DVec2) -> DVec2 {
        let (row, y) = invert(&self.rows, at.y);
        let stride = self.width + 1;
        let (column, x) = invert(&self.columns[row * stride..][..stride], at.x);
        DVec2::new(column as f64 + x, row as f64 + y)
    }
}

/// The interval of the cumulative `sums` that holds the fraction `u` of the last, and where in it.
fn invert(sums: &[f64], u: f64) -> (usize, f64) {
    let last = sums.len() - 1;
    let target = u * sums[last];
    let interval = sums.partition_point(|sum| *sum <= target).clamp(1, last) - 1;
    let (low, high) = (sums[interval], sums[interval + 1]);
    (interval, ((target - low) / (high - low)).clamp(0.0, 1.0f64.next_down()))
}

/// Vose's alias table: a pixel with probability in proportion to its value, in constant time.
#[derive(Clone, Debug)]
pub struct Alias {
    keep: Vec<f64>,
    other: Vec<u32>,
}

impl Alias {
    /// Of these values, which are not all 0.
    #[must_use]
    pub fn new(values: &[f32]) -> Self {
        let total: f64 = values.iter().map(|value| f64::from(*value)).sum();
        let scale = values.len() as f64 / total;
        let mut keep: Vec<f64> = values.iter().map(|value| f64::from(*value) * scale).collect();
        let mut other: Vec<u32> = (0..values.len() as u32).collect();
        let (mut small, mut large): (Vec<u32>, Vec<u32>) =
            other.iter().partition(|i| keep[**i as usize] < 1.0);
        while let (Some(few), Some(many)) = (small.pop(), large.pop()) {
            other[few as usize] = many;
            keep[many as usize] -= 1.0 - keep[few as usize];
            if keep[many as usize] < 1.0 { &mut small } else { &mut large }.push(many);
        }
        // What is left is 1 but for rounding.
        for i in small.into_iter().chain(large) {
            keep[i as usize] = 1.0;
        }
        Self { keep, other }
    }

    /// The index of one of the values.
    #[must_use]
    pub fn draw(&self, random: &mut Random) -> usize {
        let at = random.unit() * self.keep.len() as f64;
        let i = at as usize;
        if at - (i as f64) < self.keep[i] { i } else { self.other[i] as usize }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twelvefold::InvalidPixels;

    #[test]
    fn inversion_and_alias_follow_the_map() {
        let pixels: Vec<f32> = vec![0.0, 1.0, 2.0, 0.0, 5.0, 0.0, 0.0, 3.0];
        let map = ImageMap::new(4, 2, pixels.clone(), InvalidPixels::Reject).unwrap();
        let (inverse, alias) = (InverseCdf::new(&map), Alias::new(&pixels));
        let mut random = Random::new(1);
        let (mut inverted, mut aliased) = ([0.0; 8], [0.0; 8]);
        let n = 100_000;
        for _ in 0..n {
            let at = inverse.position(random.point());
            inverted[at.y as usize * 4 + at.x as usize] += 11.0 / f64::from(n);
            aliased[alias.draw(&mut random)] += 11.0 / f64::from(n);
        }
        for ((pixel, a), b) in pixels.iter().zip(inverted).zip(aliased) {
            assert!((f64::from(*pixel) - a).abs() < 0.1 && (f64::from(*pixel) - b).abs() < 0.1);
        }
    }

    #[test]
    fn sequences_begin_as_published() {
        assert_eq!(halton(0), DVec2::ZERO);
        assert_eq!(halton(5).x, 0.625);
        assert!((halton(5).y - 7.0 / 9.0).abs() < 1e-15);
        assert!((plastic(1) - DVec2::new(0.754_877_666, 0.569_840_291)).length() < 1e-8);
    }
}
