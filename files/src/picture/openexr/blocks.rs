//! OpenEXR files of which each pixel has all samples: read by windows, the blocks that hold any of it.

use std::io::{Seek as _, SeekFrom};

use exr::block::UncompressedBlock;
use exr::block::chunk::Chunk;
use exr::block::lines::LineRef;
use exr::error::UnitResult;
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelDescription, ChannelList, SampleType};
use exr::prelude::f16;

use super::super::area::Area;
use super::super::plane::Decoded;
use super::super::source::Source;
use super::{
    ALPHA, Layer, PictureError, Pixel, Samples, Toner, View, Wanted, failure, limits, offsets,
    unsupported,
};

/// A layer, opened to be read by windows.
pub(in super::super) struct Blocks<P> {
    source: Source,
    meta: MetaData,
    /// The number of the layer's part of the file, and for each of its channels the place in [`Samples`], if any.
    index: usize,
    slots: Vec<Option<usize>>,
    view: View<P>,
    blocks: Vec<Block>,
}

/// A block of the largest level.
struct Block {
    /// Where it lies in the file.
    offset: u64,
    /// Its pixels, counted from the layer's corner.
    area: Area,
}

impl<P: Pixel> Blocks<P> {
    /// Reads what there is beside the pixels.
    pub(in super::super) fn open(
        mut source: Source,
        wanted: Wanted<'_>,
    ) -> Result<Self, PictureError> {
        source.rewind()?;
        let meta = MetaData::read_from_buffered(&mut source, true).map_err(failure)?;
        let layer = Layer::choose(&meta.headers, wanted.layer)?;
        let offsets = offsets(&mut source, &meta, layer.index)?;
        let mut blocks = Vec::new();
        for (tile, offset) in layer.header.blocks_increasing_y_order().zip(offsets) {
            if !tile.location.is_largest_resolution_level() {
                continue;
            }
            let area = layer.header.get_absolute_block_pixel_coordinates(tile.location);
            let area = area.map_err(failure)?;
            let start = area.position.to_usize("block start").map_err(failure)?;
            let area = Area {
                columns: start.0..start.0 + area.size.0,
                rows: start.1..start.1 + area.size.1,
            };
            blocks.push(Block { offset, area });
        }
        // Mostly their order in the file.
        blocks.sort_by_key(|block| block.offset);
        let view = View::of(&layer, layer.colors, wanted.tone);
        // Alpha lies behind the luminance alone, or behind the three colors.
        let behind = layer.colors.count();
        let place = |slot: usize| if slot == ALPHA { behind } else { slot };
        let slots = layer.slots.iter().map(|slot| slot.map(place)).collect();
        let index = layer.index;
        Ok(Self { source, meta, index, slots, view, blocks })
    }

    /// Pixels across and down.
    pub(in super::super) fn size(&self) -> (usize, usize) {
        self.view.size
    }

    /// Width of a pixel over its height.
    pub(in super::super) fn aspect(&self) -> f64 {
        self.view.aspect
    }

    /// All of the picture that is decoded for a window.
    pub(in super::super) fn reach(&self, window: &Area) -> Area {
        let header = &self.meta.headers[self.index];
        let (block, layer) = (header.max_block_pixel_size(), header.layer_size);
        let wanted = self.view.of_layer(window).widened((block.0, block.1), (layer.0, layer.1));
        self.view.of_picture(&wanted, window)
    }

    /// The least and greatest brightness of the pixels that were read.
    pub(in super::super) fn range(&self) -> Option<(f64, f64)> {
        Toner::range(&self.view.toner)
    }

    /// The pixels of a window, which must lie in the picture. Blocks that hold none of them are not read.
    ///
    /// # Errors
    /// [`PictureError::TooLarge`] and [`PictureError::LargeParts`] before anything is read.
    pub(in super::super) fn window(&mut self, window: &Area) -> Result<Decoded<P>, PictureError> {
        let Self { source, meta, index, slots, view, blocks } = self;
        let header = &meta.headers[*index];
        let block = header.max_block_pixel_size();
        let part = (block.0.min(header.layer_size.0), block.1.min(header.layer_size.1));
        limits::check_beside(window.size(), part, header.channels.bytes_per_pixel)?;
        let mut plane = view.plane(window)?;
        let wanted = view.of_layer(window);
        for block in blocks.iter().filter(|block| !block.area.meet(&wanted).is_empty()) {
            // A seek to where it is would read anew what is buffered.
            if source.stream_position()? != block.offset {
                source.seek(SeekFrom::Start(block.offset))?;
            }
            let chunk = Chunk::read(source, meta).map_err(failure)?;
            let found = UncompressedBlock::decompress_chunk(chunk, meta, false).map_err(failure)?;
            let start = (block.area.columns.start, block.area.rows.start);
            let place = found.index.pixel_position;
            if found.index.layer != *index || (place.0, place.1) != start {
                return Err(unsupported("it has blocks out of place"));
            }
            paint(&found, &header.channels, slots, &wanted, |x, y, pixel| {
                view.set(&mut plane, x, y, pixel);
            })
            .map_err(failure)?;
        }
        plane.finish(Some(&view.toner))
    }
}

/// Hands out the pixels of a block that are wanted, with their places counted from the layer's corner.
fn paint(
    block: &UncompressedBlock,
    channels: &ChannelList,
    slots: &[Option<usize>],
    wanted: &Area,
    mut set: impl FnMut(usize, usize, &Samples),
) -> UnitResult {
    let mut row = vec![Samples::default(); block.index.pixel_size.0];
    // Each row of pixels comes as one line a channel, in the order of the channels.
    for line in block.lines(channels) {
        let (left, y) = (line.location.position.0, line.location.position.1);
        let Some(channel) = channels.list.get(line.location.channel) else { continue };
        if !wanted.rows.contains(&y) {
            continue;
        }
        if let Some(&Some(slot)) = slots.get(line.location.channel) {
            take(&mut row, slot, channel, &line)?;
        }
        if line.location.channel + 1 < channels.list.len() {
            continue;
        }
        for (x, pixel) in (left..).zip(&row).filter(|(x, _)| wanted.columns.contains(x)) {
            set(x, y, pixel);
        }
    }
    Ok(())
}

/// Copies one channel of one row of pixels into place.
fn take(
    row: &mut [Samples],
    slot: usize,
    channel: &ChannelDescription,
    line: &LineRef<'_>,
) -> UnitResult {
    match channel.sample_type {
        SampleType::F16 => {
            for (pixel, sample) in row.iter_mut().zip(line.read_samples::<f16>()) {
                pixel[slot] = sample?.to_f32();
            }
        }
        SampleType::F32 => {
            for (pixel, sample) in row.iter_mut().zip(line.read_samples::<f32>()) {
                pixel[slot] = sample?;
            }
        }
        SampleType::U32 => {
            for (pixel, sample) in row.iter_mut().zip(line.read_samples::<u32>()) {
                pixel[slot] = sample? as f32;
            }
        }
    }
    Ok(())
}
