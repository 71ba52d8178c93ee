//! Clips: the half-open rectangle from which points are taken, in exact agreement for both precisions.

use glam::DVec2;

use crate::domain::{Domain, Region};
use crate::sampling::SamplingError;
use crate::walk::scalar::{Position, Scalar};

/// The part of the plane from which points are taken.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clip {
    min: DVec2,
    max: DVec2,
}

impl Clip {
    pub(crate) fn domain(domain: &Domain) -> Self {
        Self { min: domain.min(), max: domain.max() }
    }

    /// Whether the disc may hold a point of the rectangle.
    pub(crate) fn touches(&self, region: &Region) -> bool {
        let nearest = region.centre.clamp(self.min, self.max);
        nearest.distance_squared(region.centre) <= region.radius * region.radius
    }

    /// Whether the disc lies in the rectangle.
    pub(crate) fn holds(&self, region: &Region) -> bool {
        let (low, high) = (region.centre - region.radius, region.centre + region.radius);
        low.cmpge(self.min).all() && high.cmplt(self.max).all()
    }
}

/// From positions relative to the domain's least corner to the caller's coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToCaller<S> {
    min: [S; 2],
    /// The least and the greatest number of this precision in the domain.
    x_range: (S, S),
    y_range: (S, S),
    /// The corner is 0: nothing to add, and nothing rounds.
    at_origin: bool,
}

impl<S: Scalar> ToCaller<S> {
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

    /// [`place`](Self::place) for positions that were written relative to the corner.
    pub(crate) fn place_all<P: Position<Scalar = S>>(&self, positions: &mut [P]) {
        if !self.at_origin {
            for position in positions {
                let [x, y] = position.xy();
                *position = self.place(x, y);
            }
        }
    }
}

/// Whether the edges of the deepest level, 10⁻⁷ diagonals, are normal numbers of this precision, as are
/// positions and both sizes: otherwise rounding errors are not a matter of the last place.
fn resolves<S: Scalar>(domain: &Domain) -> bool {
    let diagonal = domain.diagonal();
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
        for (width, height) in [(1.0, 1.0), (1e-29, 1e-29), (1e36, 1e36), (1e-8, 1.0), (1e9, 1e-6)]
        {
            assert!(single(width, height), "{width} {height}");
        }
        for (width, height) in [(1e-32, 1e-32), (1e-50, 1.0), (1e38, 1.0), (1e50, 1e50)] {
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
