//! Clips: the half-open rectangle from which points are taken, in exact agreement for both precisions.

use glam::DVec2;

use crate::domain::{Disc, Domain};
use crate::error::SamplingError;
use crate::position::{Position, Scalar};

/// The part of the plane from which points are taken: a domain, or its part in a rectangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clip {
    min: DVec2,
    max: DVec2,
    /// Points computed in here lie in the clip however they are rounded.
    inner_min: DVec2,
    inner_max: DVec2,
    rectangle: Option<Domain>,
}

impl Clip {
    /// All of a domain.
    pub(crate) fn domain(domain: &Domain) -> Self {
        let (min, max) = (domain.min(), domain.max());
        Self { min, max, inner_min: min, inner_max: max, rectangle: None }
    }

    /// The part of a domain that lies in a half-open rectangle; points belong to it by their final
    /// coordinates.
    pub(crate) fn rectangle_of(domain: &Domain, rectangle: Domain) -> Self {
        // Final coordinates are rounded to the position type's precision: up to 2⁻²⁴ of the largest.
        let largest = domain.min().abs().max(domain.max().abs()).max_element();
        let slack = DVec2::splat(largest * (0.5 / 4_194_304.0));
        Self {
            min: domain.min().max(rectangle.min() - slack),
            max: domain.max().min(rectangle.max() + slack),
            inner_min: domain.min().max(rectangle.min() + slack),
            inner_max: domain.max().min(rectangle.max() - slack),
            rectangle: Some(rectangle),
        }
    }

    /// The area of the part.
    pub(crate) fn area(&self) -> f64 {
        let size = (self.max - self.min).max(DVec2::ZERO);
        size.x * size.y
    }

    /// The rectangle to which points are clipped, if they are.
    pub(crate) fn rectangle(&self) -> Option<&Domain> {
        self.rectangle.as_ref()
    }

    /// Whether the disc may hold a point of the clip.
    #[inline(always)]
    pub(crate) fn touches(&self, region: &Disc) -> bool {
        // Corner by corner, for a clip outside the domain, whose corners are the wrong way round.
        let nearest = region.center.min(self.max).max(self.min);
        nearest.distance_squared(region.center) <= region.radius * region.radius
    }

    /// The least and the greatest corner of the clip with a margin around it.
    #[inline(always)]
    pub(crate) fn widened(&self, margin: f64) -> (DVec2, DVec2) {
        (self.min - margin, self.max + margin)
    }

    /// Whether all points in the disc lie in the clip.
    #[inline(always)]
    pub(crate) fn holds(&self, region: &Disc) -> bool {
        let (low, high) = (region.center - region.radius, region.center + region.radius);
        low.cmpge(self.inner_min).all() && high.cmplt(self.inner_max).all()
    }
}

/// From positions relative to the domain's least corner to the caller's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToWorld<S> {
    min: [S; 2],
    /// The least and the greatest number of this precision in the domain.
    x_range: (S, S),
    y_range: (S, S),
    /// The corner is 0: nothing to add, and nothing rounds.
    at_origin: bool,
}

impl<S: Scalar> ToWorld<S> {
    pub(crate) fn new(domain: &Domain) -> Result<Self, SamplingError> {
        let (min, max) = (domain.min(), domain.max());
        if !resolves::<S>(domain) {
            return Err(SamplingError::Precision);
        }
        Ok(Self {
            min: min.to_array().map(S::from_f64),
            x_range: representable(min.x, max.x).ok_or(SamplingError::Precision)?,
            y_range: representable(min.y, max.y).ok_or(SamplingError::Precision)?,
            at_origin: min == DVec2::ZERO,
        })
    }

    /// The position in the caller's coordinates, inside the half-open domain: rounding of the sum may
    /// carry a coordinate to the border, and is undone there.
    #[inline(always)]
    pub(crate) fn place<P: Position<Scalar = S>>(&self, x: S, y: S) -> P {
        if self.at_origin {
            return P::from_xy(x, y);
        }
        let within = |sum: S, (low, high): (S, S)| {
            if sum < low {
                low
            } else if sum > high {
                high
            } else {
                sum
            }
        };
        P::from_xy(within(self.min[0] + x, self.x_range), within(self.min[1] + y, self.y_range))
    }

    /// What is added, and the least and the greatest number of the domain.
    pub(crate) fn numbers(&self) -> [[S; 2]; 3] {
        let (x, y) = (self.x_range, self.y_range);
        [self.min, [x.0, y.0], [x.1, y.1]]
    }

    /// Whether [`place`](Self::place) changes nothing.
    pub(crate) fn is_identity(&self) -> bool {
        self.at_origin
    }
}

/// How many of the largest rounding errors of a position the short side must have. A point that close to
/// one of the two long sides may fall on the wrong side of it: 2 in 64, at most, of all points, and 1 in
/// 100 with the errors that are met. For `f32`, sides may be as 1 to 43,690.
const ROUNDINGS: f64 = 64.0;

/// Whether the short side is well above the rounding errors of positions, and the edges of the deepest
/// level, 10⁻⁷ diagonals, are normal numbers of this precision, as are positions and both sizes:
/// otherwise rounding errors are not a matter of the last place.
fn resolves<S: Scalar>(domain: &Domain) -> bool {
    let diagonal = domain.diagonal();
    let epsilon = S::from_f64(1.0).next_up().to_f64() - 1.0;
    // Positions are within 3 units in the last place of the diagonal: see `Sample::position`.
    if domain.size().min_element() < ROUNDINGS * 3.0 * epsilon * diagonal {
        return false;
    }
    [1e-8 * diagonal, 16.0 * diagonal, domain.size().min_element()].into_iter().all(|length| {
        let rounded = S::from_f64(length).to_f64();
        (rounded - length).abs() <= 1e-6 * length
    })
}

/// The closed range of numbers of a precision inside a half-open interval, if there are any.
fn representable<S: Scalar>(min: f64, max: f64) -> Option<(S, S)> {
    let mut low = S::from_f64(min);
    if low.to_f64() < min {
        low = low.next_up();
    }
    let mut high = S::from_f64(max);
    if high.to_f64() >= max {
        high = high.next_down();
    }
    (low <= high && low.to_f64() < max).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_at_the_ends_of_a_precision_are_refused() {
        let single = |width, height| {
            resolves::<f32>(&Domain::new(DVec2::ZERO, DVec2::new(width, height)).unwrap())
        };
        for (width, height) in [(1.0, 1.0), (1e-29, 1e-29), (1e36, 1e36), (1.0, 43_000.0)] {
            assert!(single(width, height), "{width} {height}");
        }
        for (width, height) in [
            (1e-32, 1e-32),
            (1e-50, 1.0),
            (1e38, 1.0),
            (1e50, 1e50),
            (44_000.0, 1.0),
            (1.0, 1.7e7),
            (1e30, 1e37),
        ] {
            assert!(!single(width, height), "{width} {height}");
        }
        for size in [1e-100, 1.0, 1e100] {
            let domain = Domain::new(DVec2::ZERO, DVec2::splat(size)).unwrap();
            assert!(resolves::<f64>(&domain));
        }
    }

    #[test]
    fn ranges_hold_exactly_the_numbers_inside() {
        for (min, max) in [(0.1, 0.3), (0.7, 0.9), (-3.0, 1e9), (1e9, 1e9 + 200.0), (0.0, 1e-30)] {
            let (low, high) = representable::<f32>(min, max).unwrap();
            assert!(f64::from(low) >= min && f64::from(low.next_down()) < min);
            assert!(f64::from(high) < max && f64::from(high.next_up()) >= max);
        }
        assert_eq!(representable::<f32>(1e9 + 1.0, 1e9 + 2.0), None);
        assert_eq!(representable::<f32>(0.1, 0.1 + 1e-12), None);
        assert!(representable::<f64>(1e9 + 1.0, 1e9 + 2.0).is_some());
    }
}
