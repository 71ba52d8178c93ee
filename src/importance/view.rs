//! Views of a caller's pixels, from which maps are updated in place.

use super::MapError;

/// Pixels in rows. Values count as they are: an 8-bit 255 is importance 255.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum PixelData<'a> {
    /// Single-precision numbers.
    F32(&'a [f32]),
    /// 8 bits.
    U8(&'a [u8]),
    /// 16 bits.
    U16(&'a [u16]),
}

impl PixelData<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F32(data) => data.len(),
            Self::U8(data) => data.len(),
            Self::U16(data) => data.len(),
        }
    }
}

/// A rectangle of pixels: row `y` is `width` pixels from index `y · stride` on.
#[derive(Clone, Copy, Debug)]
pub struct PixelView<'a> {
    data: PixelData<'a>,
    pub(super) width: usize,
    pub(super) height: usize,
    stride: usize,
}

impl<'a> PixelView<'a> {
    /// Rows without gaps.
    ///
    /// # Errors
    /// [`MapError::Length`] if the number of pixels is not `width` × `height`.
    pub fn new(data: PixelData<'a>, width: usize, height: usize) -> Result<Self, MapError> {
        match width.saturating_mul(height) {
            expected if expected == data.len() => Self::strided(data, width, height, width),
            expected => Err(MapError::Length { expected, found: data.len() }),
        }
    }

    /// Rows that begin `stride` pixels apart.
    ///
    /// # Errors
    /// [`MapError::Stride`] if `stride` is less than `width`, [`MapError::Length`] if the last row ends
    /// after the data.
    pub fn strided(
        data: PixelData<'a>,
        width: usize,
        height: usize,
        stride: usize,
    ) -> Result<Self, MapError> {
        if stride < width {
            return Err(MapError::Stride { stride, width });
        }
        let end = match height {
            0 => 0,
            _ => (height - 1).saturating_mul(stride).saturating_add(width),
        };
        if end > data.len() {
            return Err(MapError::Length { expected: end, found: data.len() });
        }
        Ok(Self { data, width, height, stride })
    }

    /// Copies row `y` < height to `to`, `width` pixels.
    #[inline(always)]
    pub(super) fn copy_row(&self, y: usize, to: &mut [f32]) {
        let row = y * self.stride..y * self.stride + self.width;
        match self.data {
            PixelData::F32(data) => to.copy_from_slice(&data[row]),
            PixelData::U8(data) => {
                to.iter_mut().zip(&data[row]).for_each(|(to, from)| *to = f32::from(*from));
            }
            PixelData::U16(data) => {
                to.iter_mut().zip(&data[row]).for_each(|(to, from)| *to = f32::from(*from));
            }
        }
    }

    /// Row `y` if it is of single-precision numbers: integers need no check.
    pub(super) fn unchecked_row(&self, y: usize) -> Option<&'a [f32]> {
        match self.data {
            PixelData::F32(data) => Some(&data[y * self.stride..][..self.width]),
            _ => None,
        }
    }
}
