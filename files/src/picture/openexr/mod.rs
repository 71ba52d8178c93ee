//! OpenEXR: the first layer with red, green and blue, or else with luminance, block by block.

mod layer;
mod planes;

use std::io::Seek as _;

use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader as _;
use exr::block::{self, UncompressedBlock};
use exr::error::{Error as ExrError, UnitResult};
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelDescription, EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::f16;
use image::metadata::Orientation;

use super::color::{Primaries, Space};
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, color, limits};
use layer::Layer;

/// Red, green, blue and alpha, or luminance and alpha, as far as a layer has them.
type Samples = [f32; 4];

/// What [`Layer::slots`] says of an alpha channel, which follows the colors there are.
const ALPHA: usize = 3;

/// Reads an OpenEXR file. The picture is the display window; where the layer does not reach it is
/// transparent if the layer has alpha, and black if not.
pub(super) fn read<P: Pixel>(
    mut source: Source,
    wanted: Wanted<'_>,
) -> Result<Decoded<P>, PictureError> {
    source.rewind()?;
    let meta = MetaData::read_from_buffered(&mut source, true).map_err(failure)?;
    let layer = Layer::choose(&meta.headers, wanted.layer)?;
    if wanted.radiance && layer.header.own_attributes.environment_map == Some(EnvironmentMap::Cube)
    {
        return Err(PictureError::NotLatitudeLongitude("the six faces of a cube"));
    }
    let mut channels = meta.headers.iter().flat_map(|header| &header.channels.list);
    let whole = channels.all(|channel| (channel.sampling.0, channel.sampling.1) == (1, 1));
    // What goes by luminance alone has no use for the rest.
    if !whole || P::COLORED && layer.chroma.is_some() {
        return planes::read(&mut source, &meta, &layer, wanted);
    }
    source.rewind()?;
    let file = block::read(source, false).map_err(failure)?;
    let layer = Layer::choose(file.headers(), wanted.layer)?;
    let (index, colors) = (layer.index, layer.colors);
    // A block may be as large as the layer, which may be larger than the picture.
    let bytes = layer.header.channels.bytes_per_pixel + size_of::<P>() - size_of::<f32>();
    let mut canvas = Canvas::new(&layer, colors, bytes, wanted)?;
    let slots = layer.slots;

    let mut row: Vec<Samples> = Vec::new();
    let chunks = file
        .filter_chunks(false, |_, tile, block| {
            block.layer == index && tile.is_largest_resolution_level()
        })
        .map_err(failure)?;
    chunks
        .decompress_sequential(false, |meta, block: UncompressedBlock| -> UnitResult {
            let Some(header) = meta.headers.get(index) else { return Ok(()) };
            row.clear();
            row.resize(block.index.pixel_size.0, Samples::default());
            // Each row of pixels comes as one line a channel, in the order of the channels.
            for line in block.lines(&header.channels) {
                let channels = &header.channels.list;
                let Some(channel) = channels.get(line.location.channel) else { continue };
                if let Some(&Some(slot)) = slots.get(line.location.channel) {
                    // Behind the luminance alone, or behind the three colors.
                    let slot = if slot == ALPHA { colors.count() } else { slot };
                    take(&mut row, slot, channel, &line)?;
                }
                if line.location.channel + 1 < channels.len() {
                    continue;
                }
                for (offset, pixel) in row.iter().enumerate() {
                    canvas.set(line.location.position.0 + offset, line.location.position.1, pixel);
                }
            }
            Ok(())
        })
        .map_err(failure)?;
    canvas.finish()
}

/// The picture, in which a layer's pixels have their place.
struct Canvas<P> {
    plane: Plane<P>,
    toner: Toner,
    size: (usize, usize),
    /// Where the layer's corner lies in the picture.
    shift: (i64, i64),
}

impl<P: Pixel> Canvas<P> {
    /// An empty picture for a layer, read as these colors, which takes so many bytes a pixel.
    fn new(
        layer: &Layer<'_>,
        colors: Colors,
        bytes: usize,
        wanted: Wanted<'_>,
    ) -> Result<Self, PictureError> {
        let header = layer.header;
        limits::check(header.layer_size.0, header.layer_size.1, bytes)?;
        let window = header.shared_attributes.display_window;
        let size = (window.size.0, window.size.1);
        let space = match primaries(header) {
            Some(primaries) if colors == Colors::Rgb => Space::default().with_primaries(&primaries),
            _ => Space::default(),
        };
        let transparent = layer.slots.contains(&Some(ALPHA));
        let alpha = if transparent { Alpha::Associated } else { Alpha::None };
        let toner = Toner::new::<f32>(wanted.tone, colors, alpha, space);
        let background = P::of(&toner, &Samples::default()).unwrap_or(P::NOTHING);
        // One that has seen nothing yet.
        let toner = Toner::new::<f32>(wanted.tone, colors, alpha, toner.into_space());
        let mut plane = Plane::new(size, Orientation::NoTransforms, background)?;
        plane.set_aspect(f64::from(header.shared_attributes.pixel_aspect));
        // Both corners are 32-bit, so their difference fits.
        let corner = header.own_attributes.layer_position;
        let shift = (
            i64::from(corner.0) - i64::from(window.position.0),
            i64::from(corner.1) - i64::from(window.position.1),
        );
        Ok(Self { plane, toner, size, shift })
    }

    /// Sets a pixel of the layer, if it lies in the picture.
    fn set(&mut self, x: usize, y: usize, samples: &Samples) {
        let inside = |position: usize, shift: i64, length: usize| {
            let place = usize::try_from(i64::try_from(position).ok()? + shift).ok()?;
            (place < length).then_some(place)
        };
        if let Some(y) = inside(y, self.shift.1, self.size.1)
            && let Some(x) = inside(x, self.shift.0, self.size.0)
        {
            self.plane.set(x, y, P::of(&self.toner, samples));
        }
    }

    fn finish(self) -> Result<Decoded<P>, PictureError> {
        self.plane.finish(Some(&self.toner))
    }
}

/// The chromaticities that a layer says.
fn primaries(header: &Header) -> Option<Primaries> {
    let of = header.shared_attributes.chromaticities.as_ref()?;
    let points = [of.white, of.red, of.green, of.blue];
    Some(points.map(|point| [f64::from(point.0), f64::from(point.1)]))
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
