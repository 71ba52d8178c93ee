//! OpenEXR: the first layer with red, green and blue, or else with luminance, block by block.

use std::fs::File;
use std::io::BufReader;

use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader as _;
use exr::block::{self, UncompressedBlock};
use exr::error::{Error as ExrError, UnitResult};
use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Text, f16};
use image::metadata::Orientation;

use super::plane::Plane;
use super::tone::{Alpha, Colors, Tone, Toner};
use super::{Format, Picture, PictureError, Radiance, limits};

/// Red, green, blue and alpha, or luminance and alpha, as far as a layer has them.
type Pixel = [f32; 4];

/// What the pixels of a file go into.
trait Canvas {
    /// Told once, before the first pixel: the size of the display window.
    fn begin(
        &mut self,
        size: (usize, usize),
        colors: Colors,
        alpha: Alpha,
    ) -> Result<(), PictureError>;
    /// A pixel inside the display window.
    fn put(&mut self, x: usize, y: usize, pixel: &Pixel);
}

/// A photograph's importance being filled.
struct Photograph {
    tone: Tone,
    filling: Option<(Toner, Plane)>,
}

impl Canvas for Photograph {
    fn begin(
        &mut self,
        size: (usize, usize),
        colors: Colors,
        alpha: Alpha,
    ) -> Result<(), PictureError> {
        let toner = Toner::new::<f32>(self.tone, colors, alpha);
        let background = toner.importance(&Pixel::default()).unwrap_or(0.0);
        let plane = Plane::new(size, Orientation::NoTransforms, background)?;
        self.filling = Some((toner, plane));
        Ok(())
    }

    fn put(&mut self, x: usize, y: usize, pixel: &Pixel) {
        if let Some((toner, plane)) = &mut self.filling {
            plane.set(x, y, toner.importance(pixel));
        }
    }
}

/// Radiance being filled, as stored.
#[derive(Default)]
struct Light {
    colors: Option<Colors>,
    radiance: Radiance,
}

impl Canvas for Light {
    fn begin(
        &mut self,
        (width, height): (usize, usize),
        colors: Colors,
        _: Alpha,
    ) -> Result<(), PictureError> {
        self.colors = Some(colors);
        self.radiance = Radiance::black(width, height)?;
        Ok(())
    }

    fn put(&mut self, x: usize, y: usize, [red, green, blue, _]: &Pixel) {
        let color = match self.colors {
            Some(Colors::Gray) => [*red; 3],
            _ => [*red, *green, *blue],
        };
        self.radiance.pixels[y * self.radiance.width + x] = color;
    }
}

/// Reads an OpenEXR file. The picture is the display window; where the layer does not reach it is
/// transparent if the layer has alpha, and black if not.
pub(super) fn read(file: BufReader<File>, tone: Tone) -> Result<Picture, PictureError> {
    let mut photograph = Photograph { tone, filling: None };
    read_into(file, &mut photograph)?;
    match photograph.filling {
        Some((_, plane)) => plane.finish(),
        None => Err(PictureError::Empty),
    }
}

/// Reads the radiance in an OpenEXR file over its display window, alpha aside; black where the layer
/// does not reach.
pub(super) fn read_radiance(file: BufReader<File>) -> Result<Radiance, PictureError> {
    let mut light = Light::default();
    read_into(file, &mut light)?;
    Ok(light.radiance)
}

fn read_into(file: BufReader<File>, canvas: &mut impl Canvas) -> Result<(), PictureError> {
    let file = block::read(file, false).map_err(failure)?;
    let (index, header, colors) = layer(file.headers())?;
    let alpha = if has(header, "A") { Alpha::Associated } else { Alpha::None };

    let window = header.shared_attributes.display_window;
    // A block may be as large as the layer, which may be larger than the picture.
    limits::check(header.layer_size.0, header.layer_size.1, header.channels.bytes_per_pixel)?;
    let size = (window.size.0, window.size.1);
    canvas.begin(size, colors, alpha)?;

    // Blocks are placed from the layer's corner. Both corners are 32-bit, so their difference fits.
    let corner = header.own_attributes.layer_position;
    let shift_x = i64::from(corner.0) - i64::from(window.position.0);
    let shift_y = i64::from(corner.1) - i64::from(window.position.1);
    let inside = |position: usize, shift: i64, length: usize| {
        let place = usize::try_from(i64::try_from(position).ok()? + shift).ok()?;
        (place < length).then_some(place)
    };

    let mut row: Vec<Pixel> = Vec::new();
    let chunks = file
        .filter_chunks(false, |_, tile, block| {
            block.layer == index && tile.is_largest_resolution_level()
        })
        .map_err(failure)?;
    chunks
        .decompress_sequential(false, |meta, block: UncompressedBlock| -> UnitResult {
            let Some(header) = meta.headers.get(index) else { return Ok(()) };
            row.clear();
            row.resize(block.index.pixel_size.0, Pixel::default());
            // Each row of pixels comes as one line a channel, in the order of the channels.
            for line in block.lines(&header.channels) {
                let channels = &header.channels.list;
                let Some(channel) = channels.get(line.location.channel) else { continue };
                if let Some(slot) = slot(channel, colors) {
                    take(&mut row, slot, channel, &line)?;
                }
                if line.location.channel + 1 < channels.len() {
                    continue;
                }
                let Some(y) = inside(line.location.position.1, shift_y, size.1) else { continue };
                for (offset, pixel) in row.iter().enumerate() {
                    if let Some(x) = inside(line.location.position.0 + offset, shift_x, size.0) {
                        canvas.put(x, y, pixel);
                    }
                }
            }
            Ok(())
        })
        .map_err(failure)?;
    Ok(())
}

/// Copies one channel of one row of pixels into place.
fn take(
    row: &mut [Pixel],
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

/// Where in a [`Pixel`] the samples of `channel` belong, if anywhere.
fn slot(channel: &ChannelDescription, colors: Colors) -> Option<usize> {
    let names: &[&str] = if colors == Colors::Gray { &["Y", "A"] } else { &["R", "G", "B", "A"] };
    names.iter().position(|&name| channel.name == *name)
}

/// The layer to show, with its number and what its colours are.
fn layer(headers: &[Header]) -> Result<(usize, &Header, Colors), PictureError> {
    let find = |names: &[&str]| {
        let shown = |header: &Header| !header.deep && names.iter().all(|name| has(header, name));
        headers.iter().enumerate().find(|(_, header)| shown(header))
    };
    let found = find(&["R", "G", "B"])
        .map(|found| (found, Colors::Rgb))
        .or_else(|| find(&["Y"]).map(|found| (found, Colors::Gray)));
    let Some(((index, header), colors)) = found else {
        let channels = headers.iter().flat_map(|header| &header.channels.list);
        let names: Vec<String> = channels.map(|channel| channel.name.to_string()).collect();
        return Err(unsupported(&format!(
            "no flat layer has channels R, G and B, or Y; there are {}",
            names.join(", ")
        )));
    };
    let subsampled =
        |channel: &ChannelDescription| (channel.sampling.0, channel.sampling.1) != (1, 1);
    if header.channels.list.iter().any(subsampled) {
        return Err(unsupported("channels with fewer samples than pixels are not supported"));
    }
    Ok((index, header, colors))
}

fn has(header: &Header, channel: &str) -> bool {
    header.channels.find_index_of_channel(&Text::from(channel)).is_some()
}

fn unsupported(reason: &str) -> PictureError {
    PictureError::Decode(Format::OpenExr, reason.into())
}

fn failure(error: ExrError) -> PictureError {
    match error {
        ExrError::Io(error) => PictureError::Io(error),
        // What the library says of a file that ends early.
        ExrError::Invalid(reason) if reason == "reference to missing bytes" => {
            PictureError::Truncated(Format::OpenExr)
        }
        error => PictureError::Decode(Format::OpenExr, Box::new(error)),
    }
}
