//! Whatever points, windows and images the measures are given: a figure or an error, never a panic.
//! Where a measure has a figure, the figure is a number.

use glam::DVec2;
use proptest::collection::vec;
use proptest::prelude::*;
use twelvefold_lab::measure::fidelity::{self, Raster};
use twelvefold_lab::measure::nearest::{Summary, distances};
use twelvefold_lab::measure::periodogram::Periodogram;
use twelvefold_lab::measure::stippling::{Gray, stippling};
use twelvefold_lab::measure::{
    MeasureError, Window, discrepancy, evenness, hexagonal_distance, spectrum,
};

/// What breaks arithmetic: no numbers, the ends of the range, and places where floats are few.
const HOSTILE: [f64; 16] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e154,
    -1e200,
    1e-160,
    9_007_199_254_740_993.0,
];

fn hostile() -> impl Strategy<Value = f64> {
    prop_oneof![proptest::sample::select(&HOSTILE[..]), 0.0..1.0, -10.0..10.0]
}

/// Finite, but not kind.
fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..1.0, 1 => proptest::sample::select(&HOSTILE[3..])]
}

fn pair(coordinate: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = DVec2> {
    (coordinate.clone(), coordinate).prop_map(|(x, y)| DVec2::new(x, y))
}

/// Points that may be anything, that are finite, or that a measure can take.
fn points() -> impl Strategy<Value = Vec<DVec2>> {
    prop_oneof![
        vec(pair(hostile().boxed()), 0..8),
        vec(pair(finite().boxed()), 0..200),
        vec(pair((0.0..1.0).boxed()), 64..300),
        (pair(finite().boxed()), 0..300usize).prop_map(|(point, n)| vec![point; n]),
    ]
}

fn window() -> impl Strategy<Value = Option<Window>> {
    let any = (pair(hostile().boxed()), pair(hostile().boxed()));
    // Of area 1, up to 10¹⁰⁰ times as long as wide.
    let narrow = (0..200i32).prop_map(|exponent| {
        let side = 10.0f64.powf(0.25 * f64::from(exponent));
        (DVec2::ZERO, DVec2::new(side, side.recip()))
    });
    let turned = narrow.clone().prop_map(|(min, size)| (min, DVec2::new(size.y, size.x)));
    prop_oneof![any, narrow, turned].prop_map(|(min, size)| Window::new(min, size).ok())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn windows_are_not_empty(min in pair(hostile().boxed()), size in pair(hostile().boxed()), margin in hostile()) {
        for window in [Window::new(min, size), Window::UNIT.shrunk(margin)].into_iter().flatten() {
            prop_assert!(window.area() > 0.0 && window.area().is_finite());
            prop_assert!(window.contains(window.min()));
            prop_assert!(!window.contains(window.min() + 2.0 * window.size()));
            prop_assert!(window.min().is_finite() && window.size().is_finite());
        }
    }

    #[test]
    fn distances_and_discrepancies(points in points(), queries in points(), fraction in hostile()) {
        let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all();
        let fit = !points.is_empty() && points.iter().all(inside);
        let star = discrepancy::star(&points);
        prop_assert_eq!(star.is_ok(), fit);
        let l2 = discrepancy::l2_star(&points);
        prop_assert_eq!(l2.is_ok(), fit);
        if let (Ok(star), Ok(l2)) = (star, l2) {
            // The mean square is at most the greatest.
            prop_assert!(star.lower <= star.upper && star.upper <= 1.0 && l2 <= star.upper + 1e-6);
        }
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            prop_assert_eq!(distances(&points, &queries), Err(MeasureError::NotFinite { point }));
        }
        if let Ok(found) = distances(&points, &queries) {
            prop_assert!(found.len() == queries.len() && found.iter().all(|d| *d >= 0.0));
        }
        let values: Vec<f64> = points.iter().map(|p| p.x).collect();
        match Summary::new(values.clone()) {
            Ok(summary) => {
                let ranked = summary.percentile(fraction);
                prop_assert!(summary.least() <= ranked && ranked <= summary.greatest());
                let _ = summary.mean();
            }
            Err(MeasureError::NotANumber { value }) => prop_assert!(values[value].is_nan()),
            Err(_) => prop_assert!(values.is_empty()),
        }
        let _ = hexagonal_distance(fraction);
    }

    #[test]
    fn spectra(points in points(), window in window()) {
        let window = window.unwrap_or(Window::UNIT);
        // The points where they are, and spread over the window.
        let spread = points.iter().map(|p| window.min() + *p * window.size()).collect();
        for points in [points, spread] {
            if let Ok(power) = spectrum::low_frequency_power(&points, window) {
                prop_assert!(power.is_finite() && power >= 0.0);
            }
            if let Ok(found) = Periodogram::new(&points, window) {
                prop_assert_eq!(found.power().len(), (2 * found.limit() + 1).pow(2));
                prop_assert_eq!(found.rings().len(), found.limit() - 2);
                prop_assert!(found.power().iter().all(|power| *power >= 0.0));
            }
            if let Ok(found) = evenness(&points, window) {
                prop_assert!(found.least_distance <= found.mean_distance * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn images(
        points in points(),
        width in 0..5usize,
        values in vec(prop_oneof![hostile(), 0.0..1.0], 0..20),
        kind in any::<bool>(),
        number in hostile(),
    ) {
        let unit: Vec<f64> =
            values.iter().map(|v| if kind { v.abs().clamp(0.0, 1.0) } else { *v }).collect();
        let single: Vec<f32> = unit.iter().map(|v| *v as f32).collect();
        let rows = width > 0 && !unit.is_empty() && unit.len().is_multiple_of(width);
        let raster = Raster::new(width, &single);
        let fit = single.iter().all(|v| *v >= 0.0 && v.is_finite());
        prop_assert_eq!(raster.is_ok(), rows && fit);
        // Over the image as well as where they are.
        let scale = DVec2::new(width as f64, (values.len() / width.max(1)) as f64);
        let spread: Vec<DVec2> = points.iter().map(|p| *p * scale).collect();
        for points in [points, spread] {
            if let Ok(raster) = raster {
                prop_assert!(raster.at(DVec2::new(number, -number)) >= 0.0);
                prop_assert!((0.0..=1.0).contains(&fidelity::share_on_zero(&points, &raster)));
                let _ = fidelity::local_distances(&points, &raster, number);
                let enough = fidelity::block_variance(&points, &raster, number).is_ok();
                prop_assert!(!enough || number >= 1.0);
                if let Ok(variance) = fidelity::block_variance(&points, &raster, 1.0) {
                    prop_assert!(variance >= 0.0);
                }
                if let Ok(found) = fidelity::fidelity(&points, &raster) {
                    prop_assert!(found.block_variance >= 0.0 && found.mean_distance >= 0.0);
                }
            }
            if let Ok(gray) = Gray::new(width, unit.clone())
                && let Ok(found) = stippling(&gray, &points)
            {
                prop_assert_eq!(found.dots, points.len());
                prop_assert!(found.tone.iter().all(|tone| tone.is_finite()), "{:?}", found);
                prop_assert!((0.0..=1.0).contains(&found.on_white) && found.ink_error.is_finite());
            }
        }
    }
}
