//! Domains: the rectangle of the caller's plane that receives points; and regions, the discs over
//! which the walk asks for bounds.

use core::fmt;

use glam::DVec2;

/// A half-open rectangle [min, min + size) in the caller's units, x and y finite, both sizes positive.
///
/// With the feature `serde` it is stored as its `min` and `size`, and checked when it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored"))]
pub struct Domain {
    min: DVec2,
    size: DVec2,
}

/// What is read where a domain should be.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Stored {
    min: DVec2,
    size: DVec2,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for Domain {
    type Error = DomainError;

    fn try_from(Stored { min, size }: Stored) -> Result<Self, DomainError> {
        Self::new(min, size)
    }
}

/// Why a rectangle is not a [`Domain`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum DomainError {
    /// A corner is NaN or infinite.
    NotFinite,
    /// A size is zero, negative, NaN, or outside 10⁻¹⁰⁰ … 10¹⁰⁰, where squares leave `f64`.
    Size {
        /// The size asked for.
        size: DVec2,
    },
    /// The rectangle is so far from the origin that `min + size` rounds to `min`.
    TooFar,
}

impl fmt::Display for DomainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("a corner of the domain is not finite"),
            Self::Size { size } => {
                write!(f, "a domain cannot be {} by {} units", size.x, size.y)
            }
            Self::TooFar => {
                f.write_str("the domain is too small to be told apart at its distance from 0")
            }
        }
    }
}

impl core::error::Error for DomainError {}

impl Domain {
    /// The rectangle with this corner and size.
    ///
    /// # Errors
    /// [`DomainError`] unless the corners are finite and distinct and the sizes positive.
    pub fn new(min: DVec2, size: DVec2) -> Result<Self, DomainError> {
        let sensible = |s: f64| (1e-100..=1e100).contains(&s);
        if !min.is_finite() {
            return Err(DomainError::NotFinite);
        }
        if !(sensible(size.x) && sensible(size.y)) {
            return Err(DomainError::Size { size });
        }
        let max = min + size;
        if !max.is_finite() || max.x <= min.x || max.y <= min.y {
            return Err(DomainError::TooFar);
        }
        Ok(Self { min, size })
    }

    /// [0, 1) × [0, 1).
    pub const UNIT: Self = Self { min: DVec2::ZERO, size: DVec2::ONE };

    /// The corner with the least coordinates; it belongs to the domain.
    #[must_use]
    pub const fn min(&self) -> DVec2 {
        self.min
    }

    /// The opposite corner; it does not belong to the domain.
    #[must_use]
    pub fn max(&self) -> DVec2 {
        self.min + self.size
    }

    /// Width and height.
    #[must_use]
    pub const fn size(&self) -> DVec2 {
        self.size
    }

    /// The area in squared units.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.size.x * self.size.y
    }

    /// The length of the diagonal.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        libm::sqrt(self.size.x * self.size.x + self.size.y * self.size.y)
    }

    /// Whether the point lies in the half-open rectangle.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let max = self.max();
        self.min.x <= point.x && point.x < max.x && self.min.y <= point.y && point.y < max.y
    }

    /// The smallest region that holds the whole domain.
    #[must_use]
    pub fn disc(&self) -> Disc {
        // A few ulp more than half the diagonal, for the rounding of the center.
        Disc {
            center: self.min + 0.5 * self.size,
            radius: self.diagonal() * (0.5 + 1e-9) + 1e-15 * self.min.abs().max_element(),
        }
    }

    /// The images of a disc, shifted by the domain's sides, that touch the domain: at least one of a disc whose
    /// center is less than a side outside.
    pub(crate) fn images(&self, region: &Disc) -> impl Iterator<Item = Disc> + use<> {
        let (low, high, size) = (self.min, self.max(), self.size);
        // A little more, so that rounding loses none.
        let radius = region.radius + 1e-9 * size.max_element();
        let Disc { center, radius: own } = *region;
        let shifts = (-1..=1).flat_map(|y| (-1..=1).map(move |x| DVec2::new(x.into(), y.into())));
        shifts.map(move |shift| center + shift * size).filter_map(move |center| {
            let touches = center.clamp(low, high).distance_squared(center) <= radius * radius;
            touches.then_some(Disc { center, radius: own })
        })
    }
}

/// A closed disc in the caller's units: where the points of a subtree can lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The center.
    pub center: DVec2,
    /// The radius, not negative.
    pub radius: f64,
}
