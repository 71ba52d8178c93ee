//! The two precisions of positions.

use core::ops::{Add, Mul};

use glam::{DVec2, Vec2};

/// `f32` or `f64`. Only + and × of IEEE 754 are used on it, so that all platforms agree to the bit.
pub trait Scalar:
    Copy + PartialOrd + Add<Output = Self> + Mul<Output = Self> + Default + sealed::Sealed
{
    /// √3, rounded.
    const SQRT_3: Self;
    /// Rounded to nearest.
    fn from_f64(value: f64) -> Self;
    /// Rounded to nearest.
    fn from_i32(value: i32) -> Self;
    /// Exact.
    fn to_f64(self) -> f64;
    /// The same slice, if this is `f32`.
    fn as_singles(values: &[Self]) -> Option<&[f32]>;
    /// The next number up.
    fn next_up(self) -> Self;
    /// The next number down.
    fn next_down(self) -> Self;
}

macro_rules! scalar {
    ($float:ident, $singles:expr) => {
        impl Scalar for $float {
            const SQRT_3: Self = crate::tiling::numbers::SQRT_3 as $float;
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            #[allow(clippy::cast_lossless, reason = "exact for f64, rounded for f32")]
            fn from_i32(value: i32) -> Self {
                value as $float
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn as_singles(values: &[Self]) -> Option<&[f32]> {
                $singles(values)
            }
            fn next_up(self) -> Self {
                self.next_up()
            }
            fn next_down(self) -> Self {
                self.next_down()
            }
        }
    };
}

scalar!(f32, Some);
scalar!(f64, |_| None);

/// A position type: glam's [`Vec2`] or `[f32; 2]`, glam's [`DVec2`] or `[f64; 2]`.
pub trait Position: Copy + Default + sealed::Sealed {
    /// The type of its coordinates.
    type Scalar: Scalar;
    /// The position with these coordinates.
    fn from_xy(x: Self::Scalar, y: Self::Scalar) -> Self;
    /// x and y.
    fn xy(self) -> [Self::Scalar; 2];
}

impl Position for Vec2 {
    type Scalar = f32;
    #[inline(always)]
    fn from_xy(x: f32, y: f32) -> Self {
        Self::new(x, y)
    }
    #[inline(always)]
    fn xy(self) -> [f32; 2] {
        [self.x, self.y]
    }
}

impl Position for DVec2 {
    type Scalar = f64;
    #[inline(always)]
    fn from_xy(x: f64, y: f64) -> Self {
        Self::new(x, y)
    }
    #[inline(always)]
    fn xy(self) -> [f64; 2] {
        [self.x, self.y]
    }
}

macro_rules! pair {
    ($float:ident) => {
        impl Position for [$float; 2] {
            type Scalar = $float;
            #[inline(always)]
            fn from_xy(x: $float, y: $float) -> Self {
                [x, y]
            }
            #[inline(always)]
            fn xy(self) -> Self {
                self
            }
        }
    };
}

pair!(f32);
pair!(f64);

/// A coordinate type with the position type it makes: `f32` with [`Vec2`], `f64` with [`DVec2`].
pub trait Coordinate: Scalar {
    /// The position type.
    type Position: Position<Scalar = Self>;
}

impl Coordinate for f32 {
    type Position = Vec2;
}

impl Coordinate for f64 {
    type Position = DVec2;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
    impl Sealed for [f32; 2] {}
    impl Sealed for [f64; 2] {}
    impl Sealed for glam::Vec2 {}
    impl Sealed for glam::DVec2 {}
}
