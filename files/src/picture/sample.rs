//! The samples of a file: what they mean, and their values.

/// What a pixel's samples mean, in file order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Colors {
    Gray,
    Rgb,
    /// Ink amounts, turned into red, green and blue without a color profile.
    Cmyk,
    /// Rec. 601 full-range luma and color differences, as in JPEG.
    YCbCr,
}

impl Colors {
    pub(super) fn count(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::Rgb | Self::YCbCr => 3,
            Self::Cmyk => 4,
        }
    }
}

/// Whether a sample after the colors says how much of the pixel is covered, and how it was applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alpha {
    None,
    /// Colors are those of the covered part.
    Straight,
    /// Colors are already multiplied by the coverage.
    Associated,
}

/// One sample of a file.
pub(super) trait Sample: Copy {
    /// Whether values are linear light and may lie outside 0 to 1; if not, they are sRGB-encoded.
    const FLOAT: bool;
    /// The value with full scale at 1; for floats, the value.
    fn fraction(self) -> f64;
    /// Index in a table with an entry for each possible value, where such a table is small.
    fn index(self) -> Option<usize>;
}

macro_rules! sample {
    ($type:ty, float: $float:literal, fraction: $fraction:expr, index: $index:expr) => {
        impl Sample for $type {
            const FLOAT: bool = $float;
            fn fraction(self) -> f64 {
                let fraction: fn($type) -> f64 = $fraction;
                fraction(self)
            }
            fn index(self) -> Option<usize> {
                let index: fn($type) -> Option<usize> = $index;
                index(self)
            }
        }
    };
}
sample!(u8, float: false, fraction: |s| f64::from(s) / 255.0, index: |s| Some(usize::from(s)));
sample!(u16, float: false, fraction: |s| f64::from(s) / 65535.0, index: |s| Some(usize::from(s)));
sample!(u32, float: false, fraction: |s| f64::from(s) / f64::from(u32::MAX), index: |_| None);
sample!(u64, float: false, fraction: |s| s as f64 / u64::MAX as f64, index: |_| None);
#[cfg(feature = "every-format")]
sample!(exr::prelude::f16, float: true, fraction: |s| s.to_f64(), index: |_| None);
sample!(f32, float: true, fraction: f64::from, index: |_| None);
sample!(f64, float: true, fraction: |s| s, index: |_| None);
