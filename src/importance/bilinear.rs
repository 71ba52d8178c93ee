//! Importance from pixels, interpolated between their centers.

use glam::DVec2;

use super::raster::{Grid, RUN};
use super::{ImageMap, Importance};
use crate::domain::{Disc, Domain};
use crate::position::Scalar;

/// An [`ImageMap`] read bilinearly: each pixel's value holds at its center, and between four centers the
/// importance is interpolated. Beyond the outermost centers the border pixels continue, or, where it is
/// [`seamless`](Self::seamless), those of the opposite border follow.
///
/// Smooth where the piecewise-constant map has steps, at about twice the cost of a value; a sharp
/// detail is spread over two pixels. The integral over the map's domain is the same, Σ pixels.
#[derive(Clone, Debug)]
pub struct BilinearMap {
    map: ImageMap,
    wraps: bool,
}

impl BilinearMap {
    /// The map's pixels, interpolated over the map's domain.
    #[must_use]
    pub const fn new(map: ImageMap) -> Self {
        Self { map, wraps: false }
    }

    /// The same without a border, for a [`seamless`](crate::Placement::seamless) placement of the map's
    /// domain: interpolated between the last pixel of a row or column and its first as well.
    ///
    /// ```
    /// use glam::DVec2;
    /// use twelvefold::{BilinearMap, ImageMap, Importance as _, InvalidPixels, Pixels};
    /// let map = ImageMap::new(Pixels::new(4, 1, vec![1.0, 2.0, 2.0, 5.0], InvalidPixels::Reject)?)?;
    /// let map = BilinearMap::seamless(map);
    /// assert_eq!(map.value(DVec2::new(0.0, 0.5)), 3.0); // between 5 and 1
    /// # Ok::<(), twelvefold::MapError>(())
    /// ```
    #[must_use]
    pub const fn seamless(map: ImageMap) -> Self {
        Self { map, wraps: true }
    }

    /// The pixels.
    #[must_use]
    pub const fn map(&self) -> &ImageMap {
        &self.map
    }

    /// The region and half a pixel around it: a little more, for the rounding of `value`'s own
    /// coordinates.
    fn widened(&self, region: &Disc) -> Disc {
        let reach = self.half_texel().max_element() * (1.0 + 1e-9);
        Disc { radius: region.radius + reach, ..*region }
    }

    /// Half a pixel, in units.
    fn half_texel(&self) -> DVec2 {
        let (width, height) = self.map.size();
        0.5 * self.map.domain().size() / DVec2::new(width as f64, height as f64)
    }

    fn grid(&self) -> Grid {
        let (width, height) = self.map.size();
        let min = self.map.domain().min();
        Grid { width, height, min, texel: 2.0 * self.half_texel(), wraps: self.wraps }
    }

    /// The discs whose pixels a region across the border is interpolated from, if it goes on there.
    fn images(&self, widened: &Disc) -> Option<impl Iterator<Item = Disc>> {
        if !self.wraps {
            return None;
        }
        let domain = self.map.domain();
        let (low, high, reach) = (domain.min(), domain.max(), widened.radius);
        let center = widened.center;
        if (center - reach).cmpge(low).all() && (center + reach).cmple(high).all() {
            return None;
        }
        // What lies outside is read at the nearest place inside, which is no farther from that of the center.
        Some(domain.images(&Disc { center: center.clamp(low, high), ..*widened }))
    }
}

impl Importance for BilinearMap {
    fn value(&self, at: DVec2) -> f64 {
        self.grid().value(self.map.pixels(), at)
    }

    #[inline(always)]
    fn values<S: Scalar>(&self, origin: DVec2, x: &[S], y: &[S], values: &mut [f64]) {
        let (grid, pixels) = (self.grid(), self.map.pixels());
        for ((x, y), values) in x.chunks(RUN).zip(y.chunks(RUN)).zip(values.chunks_mut(RUN)) {
            let points =
                x.iter().zip(y).map(|(x, y)| [origin.x + x.to_f64(), origin.y + y.to_f64()]);
            match grid.cells(points.clone()) {
                Some(cells) => cells.read(pixels, values),
                None => {
                    for (value, at) in values.iter_mut().zip(points) {
                        *value = grid.value(pixels, DVec2::from(at));
                    }
                }
            }
        }
    }

    /// The largest pixel whose center is less than a pixel from the region: interpolation never
    /// exceeds the pixels it lies between.
    fn upper_bound(&self, region: &Disc) -> f64 {
        let widened = self.widened(region);
        match self.images(&widened) {
            None => self.map.upper_bound(&widened),
            Some(images) => images.map(|disc| self.map.upper_bound(&disc)).fold(0.0, f64::max),
        }
    }

    /// The smallest such pixel.
    fn lower_bound(&self, region: &Disc) -> f64 {
        let widened = self.widened(region);
        match self.images(&widened) {
            None => self.map.lower_bound(&widened),
            Some(images) => {
                images.map(|disc| self.map.lower_bound(&disc)).fold(f64::INFINITY, f64::min)
            }
        }
    }

    fn is_constant(&self, region: &Disc) -> bool {
        !self.wraps && self.map.is_constant(&self.widened(region))
    }

    /// Known over the map's own domain only: there each pixel's share is one pixel's area.
    fn integral(&self, domain: &Domain) -> Option<f64> {
        (*domain == self.map.domain()).then(|| self.map.mean() * domain.area())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::{InvalidPixels, Pixels};
    use alloc::vec::Vec;
    use proptest::prelude::*;

    fn random(width: usize, height: usize, seed: u64) -> BilinearMap {
        let mut random = SplitMix64::new(seed);
        let pixels: Vec<f32> =
            (0..width * height)
                .map(|_| {
                    if random.next_u64().is_multiple_of(3) {
                        0.0
                    } else {
                        9.0 * random.unit() as f32
                    }
                })
                .collect();
        BilinearMap::new(
            Pixels::new(width, height, pixels, InvalidPixels::Reject)
                .and_then(ImageMap::new)
                .unwrap(),
        )
    }

    proptest! {
        #[test]
        fn the_bound_holds_over_every_disc(
            seed: u64,
            (width, height) in (1usize..12, 1usize..12),
            (x, y, radius) in (-0.2..1.2f64, -0.2..1.2f64, 0.0..0.6f64),
            wraps: bool,
        ) {
            let domain =
                Domain::new(DVec2::new(-3.0, 1e4), DVec2::new(5.0, 0.7)).unwrap();
            let map = random(width, height, seed).map.over(domain);
            let map = if wraps { BilinearMap::seamless(map) } else { BilinearMap::new(map) };
            let region = Disc { center: domain.min() + domain.size() * DVec2::new(x, y), radius };
            let bounds = map.lower_bound(&region)..=map.upper_bound(&region);
            let mut random = SplitMix64::new(seed);
            for _ in 0..200 {
                let at = region.center + radius * DVec2::from_array(random.in_disc(0));
                prop_assert!(bounds.contains(&map.value(at)));
            }
        }
    }

    #[test]
    fn pixels_hold_at_their_centers_and_means_between() {
        let map = random(4, 3, 2);
        let pixel = |x: usize, y: usize| f64::from(map.map.pixels()[y * 4 + x]);
        assert_eq!(map.value(DVec2::new(2.5, 1.5)), pixel(2, 1));
        assert_eq!(map.value(DVec2::new(-9.0, 0.2)), pixel(0, 0));
        assert_eq!(map.value(DVec2::new(4.0, 3.0)), pixel(3, 2));
        let middle = map.value(DVec2::new(2.0, 2.5));
        assert!((middle - 0.5 * (pixel(1, 2) + pixel(2, 2))).abs() < 1e-12);
    }

    #[test]
    fn a_map_without_border_is_one_that_is_shifted() {
        // The same pixels begun elsewhere: the same importance, elsewhere.
        for (width, height) in [(5, 4), (1, 3), (2, 1)] {
            let bordered = random(width, height, 7);
            let [begin_x, begin_y] = [width / 2, height / 2];
            let pixels = bordered.map.pixels();
            let shifted: Vec<f32> = (0..width * height)
                .map(|i| {
                    let (x, y) = (i % width + begin_x, i / width + begin_y);
                    pixels[y % height * width + x % width]
                })
                .collect();
            let shifted = Pixels::new(width, height, shifted, InvalidPixels::Reject)
                .and_then(ImageMap::new)
                .unwrap();
            let [map, shifted] = [bordered.map.clone(), shifted].map(BilinearMap::seamless);
            let size = DVec2::new(width as f64, height as f64);
            for i in 0..400 {
                let at = DVec2::new(f64::from(i % 20), f64::from(i / 20)) / 20.0 * size;
                let there = (at + DVec2::new(begin_x as f64, begin_y as f64)).rem_euclid(size);
                let (found, expected) = (shifted.value(at), map.value(there));
                assert!((found - expected).abs() < 1e-12, "{width} {height} {at}");
            }
            // Away from the border, as with one.
            let inside = 0.5 * size;
            assert_eq!(map.value(inside), bordered.value(inside));
        }
    }

    #[test]
    fn the_integral_is_that_of_the_values() {
        for map in [random(5, 4, 3), BilinearMap::seamless(random(5, 4, 3).map)] {
            check_integral(&map);
        }
    }

    fn check_integral(map: &BilinearMap) {
        // The midpoint rule is exact on each quarter pixel: the function is bilinear there.
        let (mut sum, n) = (0.0, 2usize);
        for j in 0..4 * n {
            for i in 0..5 * n {
                sum += map.value((DVec2::new(i as f64, j as f64) + 0.5) / n as f64);
            }
        }
        let integral = map.integral(&map.map.domain()).unwrap();
        assert!((sum / (n * n) as f64 - integral).abs() < 1e-12 * integral);
    }
}
