//! How the pixels of a TIFF file lie in its strips or tiles.

use std::ops::Range;

use tiff::ColorType;
use tiff::decoder::{ChunkType, Decoder};
use tiff::tags::Tag;

use super::super::area::Area;
use super::super::plane::Plane;
use super::super::source::Source;
use super::relabel::Bits;
use super::{Alpha, Colors, PictureError, Pixel, Sample, failure, limits, unsupported};

/// Values of the tags `ExtraSamples` and `PlanarConfiguration`.
const ASSOCIATED_ALPHA: u16 = 1;
const UNASSOCIATED_ALPHA: u16 = 2;
const PLANAR: u16 = 2;

/// What the header says about the pixels.
pub(super) struct Layout {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) bits: u8,
    /// Of a pixel, those that nobody asked for among them.
    pub(super) samples: usize,
    /// Bits of a pixel as the decoder hands them over, where they are unpacked to 16 bits a sample; 0 if not.
    packed: usize,
    pub(super) colors: Colors,
    pub(super) alpha: Alpha,
    /// Width and height of a strip or tile.
    pub(super) chunk: (usize, usize),
    /// Whether each sample has strips or tiles of its own.
    pub(super) planar: bool,
}

/// The part of a picture that one strip or tile covers, with the chunk numbers that hold it.
pub(super) struct Region {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    /// One number, or one for each sample of a planar file.
    pub(super) chunks: Vec<u32>,
}

impl Layout {
    pub(super) fn of(decoder: &mut Decoder<Source>) -> Result<Self, PictureError> {
        let (width, height) = decoder.dimensions().map_err(failure)?;
        let (width, height) = (width as usize, height as usize);
        let color = decoder.colortype().map_err(failure)?;
        let extra = decoder
            .find_tag_unsigned_vec::<u16>(Tag::ExtraSamples)
            .map_err(failure)?
            .and_then(|kinds| kinds.first().copied());
        let tagged = match extra {
            Some(ASSOCIATED_ALPHA) => Alpha::Associated,
            Some(UNASSOCIATED_ALPHA) => Alpha::Straight,
            _ => Alpha::None,
        };
        // A fourth color sample that no tag explains is alpha to most writers.
        let assumed = if tagged == Alpha::None { Alpha::Straight } else { tagged };
        let (colors, alpha) = match color {
            // Extra samples of a gray file make it "multiband".
            ColorType::Gray(_) => (Colors::Gray, Alpha::None),
            ColorType::Multiband { .. } => (Colors::Gray, tagged),
            ColorType::GrayA(_) => (Colors::Gray, assumed),
            ColorType::RGB(_) => (Colors::Rgb, Alpha::None),
            ColorType::RGBA(_) => (Colors::Rgb, assumed),
            ColorType::CMYK(_) => (Colors::Cmyk, Alpha::None),
            ColorType::CMYKA(_) => (Colors::Cmyk, assumed),
            ColorType::YCbCr(8) => (Colors::YCbCr, Alpha::None),
            other => return Err(unsupported(&format!("{other:?} pixels"))),
        };
        let bits = color.bit_depth();
        if !matches!(bits, 8 | 16 | 32 | 64) && !matches!(color, ColorType::Gray(1 | 2 | 4)) {
            return Err(unsupported(&format!("{color:?} pixels")));
        }
        let planar = decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(failure)?
            == Some(PLANAR)
            && color.num_samples() > 1;
        let samples = usize::from(color.num_samples());
        let chunk = match decoder.get_chunk_type() {
            ChunkType::Strip => {
                let rows = decoder
                    .find_tag_unsigned::<u32>(Tag::RowsPerStrip)
                    .map_err(failure)?
                    .unwrap_or(u32::MAX);
                (width, (rows as usize).min(height))
            }
            ChunkType::Tile => {
                let (width, height) = decoder.chunk_dimensions();
                (width as usize, height as usize)
            }
        };
        if chunk.0 == 0 || chunk.1 == 0 {
            return Err(unsupported("strips or tiles without pixels"));
        }
        let packed = if bits < 8 { usize::from(bits) } else { 0 };
        Ok(Self { width, height, bits, samples, packed, colors, alpha, chunk, planar })
    }

    /// The same of rows of bits that the decoder takes for bytes.
    pub(super) fn of_bits(self, kind: &Bits) -> Self {
        let Bits { samples, colors, alpha, width, .. } = *kind;
        let (chunk, packed) = ((kind.chunk, self.chunk.1), kind.bits * samples);
        Self { width, chunk, colors, alpha, samples, bits: 16, packed, ..self }
    }

    /// Checks that all of the picture, of pixels that take four bytes and `more`, is within the memory limit; its
    /// chunks are never larger.
    ///
    /// # Errors
    /// [`PictureError::Empty`], [`PictureError::TooLarge`].
    pub(super) fn check(&self, more: usize) -> Result<(), PictureError> {
        let bytes = self.samples * usize::from(self.bits).div_ceil(8);
        limits::check(self.width, self.height, bytes + more).map(|_| ())
    }

    /// Checks that a window and what is decoded for it at a time are.
    ///
    /// # Errors
    /// [`PictureError::Empty`], [`PictureError::TooLarge`], [`PictureError::LargeParts`].
    pub(super) fn check_window(&self, window: (usize, usize)) -> Result<(), PictureError> {
        let bytes = match self.packed {
            0 => self.samples * usize::from(self.bits) / 8,
            bits => 2 * self.samples + bits.div_ceil(8),
        };
        let chunk = (self.chunk.0.min(self.width), self.chunk.1.min(self.height));
        limits::check_beside(window, chunk, bytes)
    }

    /// The regions that hold any of these pixels, in file order.
    pub(super) fn regions(&self, wanted: &Area) -> impl Iterator<Item = Region> {
        let across = self.width.div_ceil(self.chunk.0);
        let down = self.height.div_ceil(self.chunk.1);
        let touched =
            |range: &Range<usize>, length: usize| range.start / length..range.end.div_ceil(length);
        let columns = touched(&wanted.columns, self.chunk.0);
        let rows = touched(&wanted.rows, self.chunk.1);
        let planes = if self.planar {
            self.colors.count() + usize::from(self.alpha != Alpha::None)
        } else {
            1
        };
        let places = rows.flat_map(move |row| columns.clone().map(move |column| (column, row)));
        places.map(move |(column, row)| {
            let (left, top) = (column * self.chunk.0, row * self.chunk.1);
            let number = |plane: usize| {
                let before = plane.checked_mul(down)?.checked_add(row)?.checked_mul(across)?;
                u32::try_from(before.checked_add(column)?).ok()
            };
            Region {
                left,
                top,
                width: self.chunk.0.min(self.width - left),
                height: self.chunk.1.min(self.height - top),
                // No file has chunks of higher numbers.
                chunks: (0..planes).map(|plane| number(plane).unwrap_or(u32::MAX)).collect(),
            }
        })
    }
}

impl Region {
    /// Sets those pixels of this region that are wanted, each from its `used` samples. `parts` holds them: all
    /// interleaved in one part, or each in a part of its own.
    pub(super) fn fill<P: Pixel, S: Sample>(
        &self,
        plane: &mut Plane<P>,
        parts: &[&[S]],
        used: usize,
        pixel: impl Fn(&[S]) -> Option<P>,
    ) -> Result<(), PictureError> {
        let count = self.width * self.height;
        // Samples that nobody asked for may follow those that count.
        let stride = parts[0].len() / count;
        let complete = match parts {
            [interleaved] => interleaved.len() == count * stride && stride >= used,
            // The decoder hands over the padding rows of the lowest tiles of all planes but the first.
            separate => separate.len() >= used && separate.iter().all(|part| part.len() >= count),
        };
        if !complete {
            return Err(unsupported("strips or tiles of an unexpected size"));
        }
        let all = Area {
            columns: self.left..self.left + self.width,
            rows: self.top..self.top + self.height,
        };
        let wanted = all.meet(plane.stored());
        let mut samples = Vec::with_capacity(used);
        for y in wanted.rows.clone() {
            let row = (y - self.top) * self.width;
            for x in wanted.columns.clone() {
                let index = row + x - self.left;
                let value = match parts {
                    [interleaved] => pixel(&interleaved[index * stride..][..used]),
                    separate => {
                        samples.clear();
                        samples.extend(separate[..used].iter().map(|part| part[index]));
                        pixel(&samples)
                    }
                };
                plane.set(x, y, value);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_cover_every_pixel_once_and_planes_have_chunks_of_their_own() {
        let layout = Layout {
            width: 10,
            height: 7,
            bits: 8,
            samples: 3,
            packed: 0,
            colors: Colors::Rgb,
            alpha: Alpha::None,
            chunk: (4, 3),
            planar: true,
        };
        let mut covered = [[0; 10]; 7];
        let mut chunks = Vec::new();
        for region in layout.regions(&Area::whole((10, 7))) {
            for row in &mut covered[region.top..][..region.height] {
                for pixel in &mut row[region.left..][..region.width] {
                    *pixel += 1;
                }
            }
            chunks.extend(region.chunks);
        }
        assert_eq!(covered, [[1; 10]; 7]);
        chunks.sort_unstable();
        assert_eq!(chunks, (0..27).collect::<Vec<_>>());
        // A window touches the regions that hold any of it.
        for (columns, rows, expected) in
            [(3..4, 0..1, 1), (3..5, 2..4, 4), (9..10, 6..7, 1), (0..10, 3..6, 3), (4..4, 0..1, 0)]
        {
            let area = Area { columns, rows };
            assert_eq!(layout.regions(&area).count(), expected, "{area:?}");
        }
    }
}
