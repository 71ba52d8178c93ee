//! Maps updated in place are the maps made anew, and refuse what those refuse.

use glam::Vec2;
use proptest::prelude::*;
use twelvefold::{
    Amount, Disc, ImageMap, Importance, InvalidPixels, MapError, PixelData, PixelView, Placement,
    Sampling,
};

fn assert_same(updated: &ImageMap, pixels: &[f32]) {
    let (width, height) = updated.size();
    let fresh = ImageMap::new(width, height, pixels.to_vec(), InvalidPixels::ZeroAll).unwrap();
    assert_eq!(updated.pixels(), fresh.pixels());
    assert_eq!(updated.mean().to_bits(), fresh.mean().to_bits());
    // All bounds agree: over every square of a power of two that the pyramid holds.
    for radius in [0.4, 1.0, 3.0, 11.0, 100.0] {
        for y in 0..height {
            for x in 0..width {
                let center = glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let region = Disc { center, radius };
                assert_eq!(updated.upper_bound(&region), fresh.upper_bound(&region));
                assert_eq!(updated.lower_bound(&region), fresh.lower_bound(&region));
            }
        }
    }
    if fresh.mean() > 0.0 {
        let placement = Placement::new(fresh.domain(), 5);
        let points = |map: &ImageMap| -> Vec<(u64, Vec2)> {
            let sampling = Sampling::new(&placement, map, Amount::Points(500.0)).unwrap();
            let sample = |sample: Result<twelvefold::Sample<Vec2>, _>| sample.unwrap();
            sampling.points().unwrap().map(sample).map(|s| (s.rank, s.position)).collect()
        };
        assert_eq!(points(updated), points(&fresh));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn updates_in_place_equal_a_map_made_anew(
        (width, height) in (1usize..34, 1usize..34),
        updates in prop::collection::vec(
            (0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64, 0u8..3, 0usize..5, any::<u32>()), 1..6
        ),
    ) {
        let mut pixels = vec![1.0f32; width * height];
        let mut map = ImageMap::new(width, height, pixels.clone(), InvalidPixels::Reject).unwrap();
        for (left, top, right, bottom, format, gap, bits) in updates {
            let place = |from: f64, to: f64, size: usize| {
                let at = (from * size as f64) as usize;
                (at, 1 + (to * (size - at - 1) as f64) as usize)
            };
            let ((x, w), (y, h)) = (place(left, right, width), place(top, bottom, height));
            let stride = w + gap;
            let value = |i: usize| (bits.wrapping_mul(i as u32 + 1) >> 16) as u16;
            let f32s: Vec<f32> = (0..stride * h)
                .map(|i| match value(i) % 7 {
                    0 => -1.0,
                    1 => f32::NAN,
                    _ => f32::from(value(i)) / 3.0,
                })
                .collect();
            let u16s: Vec<u16> = (0..stride * h).map(value).collect();
            let u8s: Vec<u8> = (0..stride * h).map(|i| value(i) as u8).collect();
            let data = match format {
                0 => PixelData::F32(&f32s),
                1 => PixelData::U8(&u8s),
                _ => PixelData::U16(&u16s),
            };
            let view = PixelView::strided(data, w, h, stride).unwrap();
            if (w, h) == (width, height) {
                map.update(&view, InvalidPixels::ZeroAll).unwrap();
            } else {
                map.update_at(x, y, &view, InvalidPixels::ZeroAll).unwrap();
            }
            for row in 0..h {
                for column in 0..w {
                    let i = row * stride + column;
                    pixels[(y + row) * width + x + column] = match format {
                        0 => f32s[i],
                        1 => u8s[i].into(),
                        _ => u16s[i].into(),
                    };
                }
            }
            assert_same(&map, &pixels);
        }
    }
}

#[test]
fn a_refused_update_leaves_the_map_as_it_was() {
    let mut map = ImageMap::new(8, 6, vec![2.0; 48], InvalidPixels::Reject).unwrap();
    let before = map.clone();
    let mut patch = [1.0f32; 12];
    patch[7] = f32::NAN;
    let view = PixelView::new(PixelData::F32(&patch), 4, 3).unwrap();
    for policy in [InvalidPixels::Reject, InvalidPixels::ZeroNegative] {
        match map.update_at(3, 2, &view, policy).unwrap_err() {
            MapError::InvalidPixel { x: 6, y: 3, value } => assert!(value.is_nan()),
            other => panic!("{other}"),
        }
        assert_eq!(map.pixels(), before.pixels());
    }
    assert_eq!(map.update(&view, InvalidPixels::Reject), Err(MapError::OutsideMap));
    for (x, y) in [(5, 0), (0, 4), (9, 0), (usize::MAX, 0), (0, usize::MAX)] {
        let outcome = map.update_at(x, y, &view, InvalidPixels::ZeroAll);
        assert_eq!(outcome, Err(MapError::OutsideMap));
    }
    map.update_at(3, 2, &view, InvalidPixels::ZeroAll).unwrap();
    assert_eq!(map.pixels()[3 * 8 + 6], 0.0);
    let nothing = PixelView::new(PixelData::U8(&[]), 0, 5).unwrap();
    assert_eq!(map.update_at(8, 0, &nothing, InvalidPixels::Reject), Ok(()));
}

#[test]
fn views_that_do_not_fit_their_data_do_not_exist() {
    let data = PixelData::U16(&[0; 10]);
    assert!(PixelView::new(data, 5, 2).is_some());
    assert!(PixelView::new(data, 5, 3).is_none());
    assert!(PixelView::new(data, usize::MAX, usize::MAX).is_none());
    assert!(PixelView::strided(data, 4, 2, 6).is_some());
    assert!(PixelView::strided(data, 5, 2, 6).is_none());
    assert!(PixelView::strided(data, 5, 2, 4).is_none());
    assert!(PixelView::strided(data, 1, usize::MAX, usize::MAX).is_none());
}

#[test]
fn a_bound_misses_no_pixel_and_sees_none_far_away() {
    for (width, height) in [(1, 1), (1, 9), (17, 1), (7, 5), (33, 40)] {
        for hot in 0..width * height {
            let mut pixels = vec![0.0f32; width * height];
            pixels[hot] = 1.0;
            let negative = pixels.iter().map(|pixel| 1.0 - pixel).collect();
            let negative = ImageMap::new(width, height, negative, InvalidPixels::Reject).unwrap();
            let map = ImageMap::new(width, height, pixels, InvalidPixels::Reject).unwrap();
            // The nearest point of the hot pixel's square to a disc's center.
            let low = glam::DVec2::new((hot % width) as f64, (hot / width) as f64);
            for i in 0..64 {
                let place = |step: usize, size: usize| (i * step % 64) as f64 / 64.0 * size as f64;
                let center = glam::DVec2::new(place(1, width), place(27, height));
                for radius in [0.01, 0.6, 1.0, 2.3, 9.0, 70.0] {
                    let region = Disc { center, radius };
                    let bound = map.upper_bound(&region);
                    assert_eq!(negative.lower_bound(&region), 1.0 - bound);
                    let away = center.distance(center.clamp(low, low + 1.0));
                    assert!(away >= radius || bound == 1.0);
                    // A square of side 2r, widened to texels of at most 2r or one pixel each side.
                    let reach = std::f64::consts::SQRT_2 * (3.0 * radius).max(radius + 1.0);
                    assert!(
                        away <= reach + 1e-9 || bound == 0.0,
                        "{width} {hot} {center} {radius}"
                    );
                }
            }
        }
    }
}
