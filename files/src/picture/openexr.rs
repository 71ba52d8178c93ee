//! OpenEXR: the first layer with red, green and blue, or else with luminance, block by block.

use std::io::Seek as _;

use exr::block::lines::LineRef;
use exr::block::reader::ChunksReader as _;
use exr::block::{self, UncompressedBlock};
use exr::error::{Error as ExrError, UnitResult};
use exr::meta::attribute::{ChannelDescription, EnvironmentMap, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Text, f16};
use image::metadata::Orientation;

use super::color::Space;
use super::plane::{Decoded, Plane};
use super::source::Source;
use super::{Alpha, Colors, Format, PictureError, Pixel, Toner, Wanted, limits};

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
    let file = block::read(source, false).map_err(failure)?;
    let layer = Layer::choose(file.headers(), wanted.layer)?;
    let (index, header) = (layer.index, layer.header);
    if wanted.radiance && header.own_attributes.environment_map == Some(EnvironmentMap::Cube) {
        return Err(PictureError::NotLatitudeLongitude("the six faces of a cube"));
    }
    let colors = layer.colors;
    let alpha = if layer.slots.contains(&Some(ALPHA)) { Alpha::Associated } else { Alpha::None };

    let window = header.shared_attributes.display_window;
    // A block may be as large as the layer, which may be larger than the picture.
    let bytes = header.channels.bytes_per_pixel + size_of::<P>() - size_of::<f32>();
    limits::check(header.layer_size.0, header.layer_size.1, bytes)?;
    let size = (window.size.0, window.size.1);
    let space = match &header.shared_attributes.chromaticities {
        Some(of) if colors == Colors::Rgb => {
            let points = [of.white, of.red, of.green, of.blue];
            Space::default()
                .with_primaries(&points.map(|point| [f64::from(point.0), f64::from(point.1)]))
        }
        _ => Space::default(),
    };
    let toner = Toner::new::<f32>(wanted.tone, colors, alpha, space);
    let background = P::of(&toner, &Samples::default()).unwrap_or(P::NOTHING);
    let toner = Toner::new::<f32>(wanted.tone, colors, alpha, toner.into_space());
    let mut plane = Plane::new(size, Orientation::NoTransforms, background)?;
    plane.set_aspect(f64::from(header.shared_attributes.pixel_aspect));

    // Blocks are placed from the layer's corner. Both corners are 32-bit, so their difference fits.
    let corner = header.own_attributes.layer_position;
    let shift_x = i64::from(corner.0) - i64::from(window.position.0);
    let shift_y = i64::from(corner.1) - i64::from(window.position.1);
    let inside = |position: usize, shift: i64, length: usize| {
        let place = usize::try_from(i64::try_from(position).ok()? + shift).ok()?;
        (place < length).then_some(place)
    };
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
                let Some(y) = inside(line.location.position.1, shift_y, size.1) else { continue };
                for (offset, pixel) in row.iter().enumerate() {
                    if let Some(x) = inside(line.location.position.0 + offset, shift_x, size.0) {
                        plane.set(x, y, P::of(&toner, pixel));
                    }
                }
            }
            Ok(())
        })
        .map_err(failure)?;
    plane.finish(Some(&toner))
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

/// The channels to show, all of one part of the file.
struct Layer<'a> {
    index: usize,
    header: &'a Header,
    colors: Colors,
    /// For each channel of the part, its place in [`Samples`], if any.
    slots: Vec<Option<usize>>,
}

impl<'a> Layer<'a> {
    /// The layer called `name`; or the first without a name that has colors or luminance, or else the
    /// only one that has.
    fn choose(headers: &'a [Header], name: Option<&str>) -> Result<Self, PictureError> {
        let mut found: Vec<(String, Self)> = Vec::new();
        let mut prefixes: Vec<String> = Vec::new();
        for (index, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
            prefixes.clear();
            for channel in &header.channels.list {
                let full = channel.name.to_string();
                let prefix = full.rsplit_once('.').map_or("", |(prefix, _)| prefix).to_owned();
                if !prefixes.contains(&prefix) {
                    prefixes.push(prefix);
                }
            }
            for prefix in &prefixes {
                for colors in [Colors::Rgb, Colors::Gray] {
                    let Some(slots) = slots(header, prefix, colors) else { continue };
                    let part = header.own_attributes.layer_name.as_ref().map(Text::to_string);
                    let name = match (part, prefix.is_empty()) {
                        (Some(part), true) => part,
                        (Some(part), false) if headers.len() > 1 => format!("{part}.{prefix}"),
                        _ => prefix.clone(),
                    };
                    found.push((name, Self { index, header, colors, slots }));
                    break;
                }
            }
        }
        let names = found.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>().join(", ");
        if let Some(wanted) = name {
            return match found.into_iter().find(|(name, _)| name == wanted) {
                Some((_, layer)) => Ok(layer),
                None => Err(unsupported(&format!(
                    "no layer with colors is called {wanted}; there are {names}"
                ))),
            };
        }
        // Colors that stand alone go before luminance, as before all that have a name.
        let plain = |layer: &Self, colors| {
            layer.colors == colors
                && layer.slots.iter().zip(&layer.header.channels.list).any(|(slot, channel)| {
                    slot.is_some() && !channel.name.to_string().contains('.')
                })
        };
        for colors in [Colors::Rgb, Colors::Gray] {
            if let Some(place) = found.iter().position(|(_, layer)| plain(layer, colors)) {
                return Ok(found.swap_remove(place).1);
            }
        }
        for colors in [Colors::Rgb, Colors::Gray] {
            let mut of = found.iter().enumerate().filter(|(_, (_, layer))| layer.colors == colors);
            match (of.next(), of.next()) {
                (Some((place, _)), None) => return Ok(found.swap_remove(place).1),
                (Some(_), Some(_)) => {
                    return Err(unsupported(&format!(
                        "there are several layers; choose one by --layer: {names}"
                    )));
                }
                _ => {}
            }
        }
        let channels = headers.iter().flat_map(|header| &header.channels.list);
        let names: Vec<String> = channels.map(|channel| channel.name.to_string()).collect();
        Err(unsupported(&format!(
            "no flat layer has channels R, G and B, or Y; there are {}",
            names.join(", ")
        )))
    }
}

/// Where the channels of a layer belong, if all that its colors need are there.
fn slots(header: &Header, prefix: &str, colors: Colors) -> Option<Vec<Option<usize>>> {
    let names: &[&str] = if colors == Colors::Gray { &["Y"] } else { &["R", "G", "B"] };
    let of = |channel: &ChannelDescription| {
        let full = channel.name.to_string();
        let (before, name) = full.rsplit_once('.').unwrap_or(("", &full));
        if before != prefix {
            return None;
        }
        names.iter().position(|&n| n == name).or((name == "A").then_some(ALPHA))
    };
    let slots: Vec<_> = header.channels.list.iter().map(of).collect();
    (0..names.len()).all(|slot| slots.contains(&Some(slot))).then_some(slots)
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
