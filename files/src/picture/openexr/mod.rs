//! OpenEXR: the first layer with red, green and blue, or else with luminance, block by block.

mod blocks;
mod layer;
mod planes;

use std::io::{Read as _, Seek as _, SeekFrom};
use std::ops::Range;

use exr::error::Error as ExrError;
use exr::meta::MetaData;
use exr::meta::attribute::EnvironmentMap;
use exr::meta::header::Header;
use image::metadata::Orientation;

use super::area::Area;
use super::color::{Primaries, Space};
use super::plane::{self, Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Tone, Toner, Wanted, color, limits};
pub(super) use blocks::Blocks;
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
    if !complete::<P>(&meta, &layer) {
        return planes::read(&mut source, &meta, &layer, wanted);
    }
    // A block may be as large as the layer, which may be larger than the picture.
    let bytes = layer.header.channels.bytes_per_pixel + size_of::<P>() - size_of::<f32>();
    limits::check(layer.header.layer_size.0, layer.header.layer_size.1, bytes)?;
    let mut blocks = Blocks::open(source, wanted)?;
    let whole = Area::whole(blocks.size());
    blocks.window(&whole)
}

/// Whether the layer can be read by windows, as [`Blocks`] does, for importance.
pub(super) fn in_blocks(source: &mut Source, wanted: Wanted<'_>) -> Result<bool, PictureError> {
    source.rewind()?;
    let meta = MetaData::read_from_buffered(&mut *source, true).map_err(failure)?;
    let layer = Layer::choose(&meta.headers, wanted.layer)?;
    Ok(complete::<f32>(&meta, &layer))
}

/// Whether each pixel has all samples that count.
fn complete<P: Pixel>(meta: &MetaData, layer: &Layer<'_>) -> bool {
    let mut channels = meta.headers.iter().flat_map(|header| &header.channels.list);
    let whole = channels.all(|channel| (channel.sampling.0, channel.sampling.1) == (1, 1));
    // What goes by luminance alone has no use for the rest.
    whole && !(P::COLORED && layer.chroma.is_some())
}

/// Where the blocks of a part of the file lie, in the order of its table, which is that of the rows. `source` is
/// where the header ended.
fn offsets(source: &mut Source, meta: &MetaData, index: usize) -> Result<Vec<u64>, PictureError> {
    let tables = source.stream_position()?;
    let before: usize = meta.headers[..index].iter().map(|header| header.chunk_count).sum();
    let start = tables.saturating_add((before as u64).saturating_mul(8));
    let count = meta.headers[index].chunk_count;
    // A table that is not there takes no memory.
    if (count as u64).saturating_mul(8) > source.length()?.saturating_sub(start) {
        return Err(PictureError::Truncated(Format::OpenExr));
    }
    source.seek(SeekFrom::Start(start))?;
    let mut offsets = Vec::new();
    offsets.try_reserve_exact(count).map_err(|_| limits::too_large(count, 1, 8))?;
    for _ in 0..count {
        offsets.push(u64::from_le_bytes(bytes(source)?));
    }
    Ok(offsets)
}

/// How the pixels of a layer become those of the picture.
struct View<P> {
    toner: Toner,
    /// A pixel that the layer does not reach.
    background: P,
    /// Of the picture.
    size: (usize, usize),
    /// Where the layer's corner lies in it.
    shift: (i64, i64),
    /// Width of a pixel over its height.
    aspect: f64,
}

impl<P: Pixel> View<P> {
    /// That of a layer which is read as these colors.
    fn of(layer: &Layer<'_>, colors: Colors, tone: Tone) -> Self {
        let header = layer.header;
        let window = header.shared_attributes.display_window;
        let space = match primaries(header) {
            Some(primaries) if colors == Colors::Rgb => Space::default().with_primaries(&primaries),
            _ => Space::default(),
        };
        let transparent = layer.slots.contains(&Some(ALPHA));
        let alpha = if transparent { Alpha::Associated } else { Alpha::None };
        let toner = Toner::new::<f32>(tone, colors, alpha, space);
        let background = P::of(&toner, &Samples::default()).unwrap_or(P::NOTHING);
        // One that has seen nothing yet.
        let toner = Toner::new::<f32>(tone, colors, alpha, toner.into_space());
        // Both corners are 32-bit, so their difference fits.
        let corner = header.own_attributes.layer_position;
        let shift = (
            i64::from(corner.0) - i64::from(window.position.0),
            i64::from(corner.1) - i64::from(window.position.1),
        );
        let aspect = f64::from(header.shared_attributes.pixel_aspect);
        let aspect = plane::upright_aspect(aspect, Orientation::NoTransforms);
        Self { toner, background, size: (window.size.0, window.size.1), shift, aspect }
    }

    /// Nothing yet of a window of the picture.
    fn plane(&self, window: &Area) -> Result<Plane<P>, PictureError> {
        let mut plane =
            Plane::of_window(self.size, Orientation::NoTransforms, self.background, window)?;
        plane.set_aspect(self.aspect);
        Ok(plane)
    }

    /// A window of the picture in the layer's own numbers, which begin at its corner.
    fn of_layer(&self, window: &Area) -> Area {
        let shifted = |range: &Range<usize>, shift: i64| {
            let own = |place: usize| usize::try_from(place as i64 - shift).unwrap_or(0);
            own(range.start)..own(range.end)
        };
        let (columns, rows) = (&window.columns, &window.rows);
        Area { columns: shifted(columns, self.shift.0), rows: shifted(rows, self.shift.1) }
    }

    /// The columns and rows of the picture that hold those of the layer, and those of a window.
    fn of_picture(&self, layer: &Area, window: &Area) -> Area {
        let shifted = |range: &Range<usize>, shift: i64, length: usize, least: &Range<usize>| {
            let own = |place: usize| usize::try_from(place as i64 + shift).unwrap_or(0).min(length);
            own(range.start).min(least.start)..own(range.end).max(least.end)
        };
        let (columns, rows) = (&layer.columns, &layer.rows);
        Area {
            columns: shifted(columns, self.shift.0, self.size.0, &window.columns),
            rows: shifted(rows, self.shift.1, self.size.1, &window.rows),
        }
    }

    /// Sets a pixel of the layer, if it is one of the plane.
    fn set(&self, plane: &mut Plane<P>, x: usize, y: usize, samples: &Samples) {
        let shifted = |position: usize, shift: i64| {
            usize::try_from(i64::try_from(position).ok()? + shift).ok()
        };
        if let Some(y) = shifted(y, self.shift.1)
            && let Some(x) = shifted(x, self.shift.0)
            && plane.stored().holds(x, y)
        {
            plane.set(x, y, P::of(&self.toner, samples));
        }
    }
}

/// The chromaticities that a layer says.
fn primaries(header: &Header) -> Option<Primaries> {
    let of = header.shared_attributes.chromaticities.as_ref()?;
    let points = [of.white, of.red, of.green, of.blue];
    Some(points.map(|point| [f64::from(point.0), f64::from(point.1)]))
}

fn bytes<const N: usize>(source: &mut Source) -> Result<[u8; N], PictureError> {
    let mut bytes = [0; N];
    source.read_exact(&mut bytes).map_err(|error| super::ended(error, Format::OpenExr))?;
    Ok(bytes)
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
