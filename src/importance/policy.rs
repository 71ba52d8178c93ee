//! What to do with components that are no radiance.

use super::InvalidPixels;

/// What a negative component counts as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum NegativeRadiance {
    /// An error.
    #[default]
    Reject,
    /// 0. The ringing of a resampled picture leaves negative components.
    Zero,
}

/// What an infinite component counts as.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum InfiniteRadiance {
    /// An error.
    #[default]
    Reject,
    /// 0: the pixel gives no light in this component.
    Zero,
    /// This number, where it is finite and not negative; if not, an error. A sun that overflowed a half
    /// float was above 65,504. Finite components stay as they are, larger ones included.
    Clamp(f32),
}

/// What a component that is not a number counts as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum NanRadiance {
    /// An error.
    #[default]
    Reject,
    /// 0.
    Zero,
}

/// A policy for each kind of component that is no radiance. By default all are errors.
///
/// ```
/// use twelvefold::EnvironmentMap;
/// use twelvefold::light::{InfiniteRadiance, RadiancePolicy};
/// let policy = RadiancePolicy { infinite: InfiniteRadiance::Clamp(65504.0), ..Default::default() };
/// let sky = EnvironmentMap::new(2, 1, vec![[1.0; 3], [1.0, f32::INFINITY, 1.0]], policy)?;
/// assert_eq!(sky.radiance(glam::DVec3::NEG_Y), [1.0, 65504.0, 1.0]);
/// # Ok::<(), twelvefold::EnvironmentError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RadiancePolicy {
    /// Components below 0; −∞ is infinite as well, and counts as 0 if neither is rejected.
    pub negative: NegativeRadiance,
    /// ∞ and −∞.
    pub infinite: InfiniteRadiance,
    /// Not a number.
    pub nan: NanRadiance,
}

impl RadiancePolicy {
    /// The component as it counts, or `None` if this policy does not admit it.
    pub(crate) fn admit(self, value: f32) -> Option<f32> {
        if (0.0..f32::INFINITY).contains(&value) {
            return Some(value);
        }
        if value.is_nan() {
            return (self.nan == NanRadiance::Zero).then_some(0.0);
        }
        if value < 0.0 && self.negative == NegativeRadiance::Reject {
            return None;
        }
        match self.infinite {
            _ if value.is_finite() => Some(0.0),
            InfiniteRadiance::Reject => None,
            InfiniteRadiance::Zero => Some(0.0),
            InfiniteRadiance::Clamp(most) if value > 0.0 => {
                (0.0..f32::INFINITY).contains(&most).then_some(most)
            }
            InfiniteRadiance::Clamp(_) => Some(0.0),
        }
    }
}

impl From<InvalidPixels> for RadiancePolicy {
    fn from(invalid: InvalidPixels) -> Self {
        match invalid {
            InvalidPixels::Reject => Self::default(),
            InvalidPixels::ZeroNegative => {
                Self { negative: NegativeRadiance::Zero, ..Self::default() }
            }
            InvalidPixels::ZeroAll => Self {
                negative: NegativeRadiance::Zero,
                infinite: InfiniteRadiance::Zero,
                nan: NanRadiance::Zero,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::importance::ImageMap;

    #[test]
    fn every_kind_follows_its_own_policy() {
        let strict = RadiancePolicy::default();
        for bad in [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(strict.admit(bad), None);
        }
        assert_eq!((strict.admit(0.0), strict.admit(f32::MAX)), (Some(0.0), Some(f32::MAX)));
        let negative = RadiancePolicy { negative: NegativeRadiance::Zero, ..strict };
        assert_eq!(negative.admit(-1e30), Some(0.0));
        assert_eq!((negative.admit(f32::NAN), negative.admit(f32::NEG_INFINITY)), (None, None));
        let clamped = RadiancePolicy { infinite: InfiniteRadiance::Clamp(7.0), ..negative };
        assert_eq!(clamped.admit(f32::INFINITY), Some(7.0));
        assert_eq!(clamped.admit(f32::NEG_INFINITY), Some(0.0));
        assert_eq!((clamped.admit(9.0), clamped.admit(f32::NAN)), (Some(9.0), None));
        for bad in [f32::INFINITY, -1.0, f32::NAN] {
            let clamped = RadiancePolicy { infinite: InfiniteRadiance::Clamp(bad), ..strict };
            assert_eq!(clamped.admit(f32::INFINITY), None);
        }
        let dark = RadiancePolicy { nan: NanRadiance::Zero, ..strict };
        assert_eq!((dark.admit(f32::NAN), dark.admit(f32::INFINITY)), (Some(0.0), None));
    }

    #[test]
    fn policies_for_importance_mean_the_same_here() {
        for invalid in [InvalidPixels::Reject, InvalidPixels::ZeroNegative, InvalidPixels::ZeroAll]
        {
            let policy = RadiancePolicy::from(invalid);
            for value in [0.0, 2.0, -3.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let map = ImageMap::new(1, 1, alloc::vec![value], invalid);
                let admitted = map.ok().map(|map| map.pixels()[0]);
                assert_eq!(policy.admit(value), admitted, "{invalid:?} {value}");
            }
        }
    }
}
