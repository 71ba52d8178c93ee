//! OpenEXR files of which some channels have fewer samples than pixels, such as color differences beside
//! luminance: each channel is read as a plane of its own.

use std::io::{Read as _, Seek as _, SeekFrom};

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData};
use exr::prelude::f16;

use super::super::source::Source;
use super::{
    ALPHA, Area, Colors, Decoded, Layer, PictureError, Pixel, Samples, View, Wanted, bytes, color,
    failure, limits, offsets, primaries, unsupported,
};

/// Reads a layer of a file whose header has just been read.
pub(super) fn read<P: Pixel>(
    source: &mut Source,
    meta: &MetaData,
    layer: &Layer<'_>,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    let header = layer.header;
    if header.deep || header.blocks != BlockDescription::ScanLines {
        return Err(unsupported(
            "channels with fewer samples than pixels are not supported in tiles",
        ));
    }
    let chroma = layer.chroma.filter(|_| P::COLORED);
    let colors = if chroma.is_some() { Colors::Rgb } else { layer.colors };
    limits::check(header.layer_size.0, header.layer_size.1, 4 * 4 + size_of::<P>())?;
    let view = View::<P>::of(layer, colors, wanted.tone);
    let mut picture = view.plane(&Area::whole(view.size))?;
    let mut planes = planes(layer, chroma)?;
    let several = meta.requirements.is_multilayer();
    if header.chunk_count > header.layer_size.1 {
        return Err(unsupported("it has more blocks than rows"));
    }
    let offsets = offsets(source, meta, layer.index)?;
    for offset in offsets {
        // In a file of several parts, the part's number comes first.
        source.seek(SeekFrom::Start(offset.saturating_add(if several { 4 } else { 0 })))?;
        let y = i32::from_le_bytes(bytes(source)?);
        let length = u32::from_le_bytes(bytes(source)?);
        let corner = header.own_attributes.layer_position.1;
        let top = usize::try_from(i64::from(y) - i64::from(corner)).unwrap_or(usize::MAX);
        let rows = header.compression.scan_lines_per_block();
        if u64::from(length) > limits::MEMORY_LIMIT || top >= header.layer_size.1 {
            return Err(unsupported("it has blocks outside of the picture"));
        }
        let rows = rows.min(header.layer_size.1 - top);
        let mut pressed = Vec::new();
        source.by_ref().take(u64::from(length)).read_to_end(&mut pressed)?;
        if pressed.len() < length as usize {
            return Err(PictureError::Truncated(super::Format::OpenExr));
        }
        let block = decompressed(header, pressed, top, rows)?;
        let mut rest = &block[..];
        for y in top..top + rows {
            for (index, channel) in header.channels.list.iter().enumerate() {
                let Some(length) = line_bytes(channel, header.layer_size.0, y) else { continue };
                let (line, after) = rest.split_at_checked(length).unwrap_or((rest, &[]));
                rest = after;
                if let Some(plane) = planes.iter_mut().find(|plane| plane.channel == index) {
                    plane.set(y / channel.sampling.1, line, channel.sample_type);
                }
            }
        }
    }
    let weights = primaries(header).and_then(|of| color::luminance(&of));
    let weights = weights.unwrap_or(color::LUMINANCE).map(|weight| weight as f32);
    for y in 0..header.layer_size.1 {
        for x in 0..header.layer_size.0 {
            let mut samples = Samples::default();
            for plane in &planes {
                samples[plane.slot] = plane.at(x, y);
            }
            if chroma.is_some() {
                let [luminance, red, blue, alpha] = samples;
                let (red, blue) = ((red + 1.0) * luminance, (blue + 1.0) * luminance);
                let green = (luminance - weights[0] * red - weights[2] * blue) / weights[1];
                samples = [red, green, blue, alpha];
            }
            view.set(&mut picture, x, y, &samples);
        }
    }
    picture.finish(Some(&view.toner))
}

/// The samples of one channel.
struct Plane {
    channel: usize,
    /// Where they belong in [`Samples`].
    slot: usize,
    sampling: (usize, usize),
    width: usize,
    values: Vec<f32>,
}

/// A plane for each channel that counts.
fn planes(layer: &Layer<'_>, chroma: Option<[usize; 2]>) -> Result<Vec<Plane>, PictureError> {
    let mut used: Vec<(usize, usize)> = Vec::new();
    let behind = if chroma.is_some() { 3 } else { layer.colors.count() };
    for (channel, slot) in layer.slots.iter().enumerate() {
        match *slot {
            Some(ALPHA) => used.push((channel, behind)),
            Some(slot) => used.push((channel, slot)),
            None => {}
        }
    }
    used.extend(chroma.iter().flatten().copied().zip(1..));
    let (width, height) = (layer.header.layer_size.0, layer.header.layer_size.1);
    let plane = |(channel, slot): (usize, usize)| {
        let sampling = layer.header.channels.list[channel].sampling;
        if sampling.0 == 0 || sampling.1 == 0 {
            return Err(unsupported("it has a channel without samples"));
        }
        let (width, height) = (width.div_ceil(sampling.0), height.div_ceil(sampling.1));
        let mut values = Vec::new();
        let count = width.saturating_mul(height);
        values.try_reserve_exact(count).map_err(|_| limits::too_large(width, height, 4))?;
        values.resize(count, 0.0);
        Ok(Plane { channel, slot, sampling: (sampling.0, sampling.1), width, values })
    };
    used.into_iter().map(plane).collect()
}

impl Plane {
    fn set(&mut self, row: usize, line: &[u8], kind: SampleType) {
        let row = self.values.chunks_mut(self.width).nth(row).unwrap_or_default();
        match kind {
            SampleType::F16 => {
                for (value, &bytes) in row.iter_mut().zip(line.as_chunks().0) {
                    *value = f16::from_ne_bytes(bytes).to_f32();
                }
            }
            SampleType::F32 => {
                for (value, &bytes) in row.iter_mut().zip(line.as_chunks().0) {
                    *value = f32::from_ne_bytes(bytes);
                }
            }
            SampleType::U32 => {
                for (value, &bytes) in row.iter_mut().zip(line.as_chunks().0) {
                    *value = u32::from_ne_bytes(bytes) as f32;
                }
            }
        }
    }

    /// The value at a pixel: of the first pixel of each group as it is, and between them as a straight line.
    fn at(&self, x: usize, y: usize) -> f32 {
        let (left, top) = (x / self.sampling.0, y / self.sampling.1);
        let (across, down) = (x % self.sampling.0, y % self.sampling.1);
        let value = |x: usize, y: usize| {
            let x = x.min(self.width - 1);
            let y = y.min(self.values.len() / self.width - 1);
            self.values[y * self.width + x]
        };
        if (across, down) == (0, 0) {
            return value(left, top);
        }
        let (u, v) = (across as f32 / self.sampling.0 as f32, down as f32 / self.sampling.1 as f32);
        let of = |y| value(left, y) * (1.0 - u) + value(left + 1, y) * u;
        of(top) * (1.0 - v) + of(top + 1) * v
    }
}

/// The bytes of a channel's line at row `y` of the layer; `None` if it has none there.
fn line_bytes(channel: &ChannelDescription, width: usize, y: usize) -> Option<usize> {
    let (across, down) = (channel.sampling.0.max(1), channel.sampling.1.max(1));
    let size = channel.sample_type.bytes_per_sample();
    y.is_multiple_of(down).then(|| width.div_ceil(across) * size)
}

/// The bytes of a block: row by row a line of each channel that has one there.
fn decompressed(
    header: &Header,
    pressed: Vec<u8>,
    top: usize,
    rows: usize,
) -> Result<Vec<u8>, PictureError> {
    let width = header.layer_size.0;
    let lines = |channel| (top..top + rows).filter_map(move |y| line_bytes(channel, width, y));
    let bytes: usize = header.channels.list.iter().flat_map(lines).sum();
    let mut header = header.clone();
    let size = match header.compression {
        // To these, bytes are bytes: one line of halves holds them.
        Compression::Uncompressed | Compression::RLE | Compression::ZIP1 | Compression::ZIP16 => {
            let half = ChannelDescription::named("Y", SampleType::F16);
            header.channels = ChannelList::new([half].into_iter().collect());
            header.layer_size = Vec2(bytes / 2, 1);
            header.layer_size
        }
        // The library counts the bytes of all pixels alike, and takes whole blocks of B44 only.
        compression
            if !matches!(compression, Compression::B44 | Compression::B44A)
                && bytes.is_multiple_of(width * rows) =>
        {
            header.channels.bytes_per_pixel = bytes / (width * rows);
            Vec2(width, rows)
        }
        other => {
            let reason = format!(
                "{other} is not supported for channels with fewer samples than pixels; save it with ZIP"
            );
            return Err(unsupported(&reason));
        }
    };
    let section = IntegerBounds::new((0, 0), size);
    let compression = header.compression;
    let block = compression
        .decompress_image_section_from_le(&header, pressed, section, false)
        .map_err(failure)?;
    if block.len() < bytes { Err(unsupported("it has blocks of another size")) } else { Ok(block) }
}
