//! Which of an OpenEXR file's layers is shown.

use exr::meta::attribute::ChannelDescription;
use exr::meta::header::Header;
use exr::prelude::Text;

use super::{ALPHA, Colors, PictureError, unsupported};

/// The channels to show, all of one part of the file.
pub(super) struct Layer<'a> {
    pub(super) index: usize,
    pub(super) header: &'a Header,
    pub(super) colors: Colors,
    /// For each channel of the part, its place in [`Samples`], if any.
    pub(super) slots: Vec<Option<usize>>,
    /// The channels of color differences beside luminance, of red and of blue, if they are there.
    pub(super) chroma: Option<[usize; 2]>,
}

impl<'a> Layer<'a> {
    /// The layer called `name`; or the first without a name that has colors or luminance, or else the
    /// only one that has.
    pub(super) fn choose(headers: &'a [Header], name: Option<&str>) -> Result<Self, PictureError> {
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
                    let chroma = (colors == Colors::Gray).then(|| chroma(header, prefix)).flatten();
                    found.push((name, Self { index, header, colors, slots, chroma }));
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
        let name = named(channel, prefix)?;
        // Some programs write small letters.
        let is = |wanted: &&str| name.eq_ignore_ascii_case(wanted);
        names.iter().position(is).or(is(&"A").then_some(ALPHA))
    };
    let slots: Vec<_> = header.channels.list.iter().map(of).collect();
    (0..names.len()).all(|slot| slots.contains(&Some(slot))).then_some(slots)
}

/// The channels of color differences.
fn chroma(header: &Header, prefix: &str) -> Option<[usize; 2]> {
    let of = |wanted| {
        let mut channels = header.channels.list.iter();
        channels.position(|channel| named(channel, prefix).as_deref() == Some(wanted))
    };
    Some([of("RY")?, of("BY")?])
}

/// The name of a channel in the layer called `prefix`, if it is one of it.
fn named(channel: &ChannelDescription, prefix: &str) -> Option<String> {
    let full = channel.name.to_string();
    let (before, name) = full.rsplit_once('.').unwrap_or(("", &full));
    (before == prefix).then(|| name.to_owned())
}
