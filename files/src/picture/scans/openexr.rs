//! Windows of OpenEXR files.

use std::io::Cursor;

use exr::math::RoundingMode;
use exr::prelude::*;

use super::{
    Path, PictureError, Source, TONES, Wanted, assert_cut, counted, cut, scan, whole, window,
    windows,
};
use crate::picture::scan::Scan;
use proptest::prelude::{ProptestConfig, any, prop, prop_assert, prop_compose, proptest};

/// An OpenEXR file to be made.
#[derive(Debug, Clone)]
struct Made {
    size: (usize, usize),
    encoding: Encoding,
    /// Where the layer's corner lies, and the display window.
    corner: (i32, i32),
    shown: (i32, i32, usize, usize),
    aspect: f32,
    names: &'static [&'static str],
    kind: usize,
    /// Smaller versions beside the layer.
    levels: usize,
}

impl Made {
    fn value(&self, x: usize, y: usize, channel: usize) -> f32 {
        ((x * 37 + y * 61 + channel * 29) % 101) as f32 / 80.0 - 0.1
    }

    /// Samples of a level of this size.
    fn samples(&self, (width, height): (usize, usize), channel: usize) -> FlatSamples {
        let values = (0..width * height).map(|i| self.value(i % width, i / width, channel));
        match self.kind {
            0 => FlatSamples::F16(values.map(f16::from_f32).collect()),
            1 => FlatSamples::F32(values.collect()),
            _ => FlatSamples::U32(values.map(|value| (value * 3.0).max(0.0) as u32).collect()),
        }
    }

    fn channel(&self, index: usize, name: &str) -> AnyChannel<Levels<FlatSamples>> {
        let rounding_mode = RoundingMode::Down;
        let smaller = |length: usize, level: usize| (length >> level).max(1);
        let count = |length: usize| 1 + length.ilog2() as usize;
        let (across, down) = (count(self.size.0), count(self.size.1));
        let level = |x: usize, y: usize| {
            self.samples((smaller(self.size.0, x), smaller(self.size.1, y)), index)
        };
        let samples = match self.levels {
            0 => Levels::Singular(self.samples(self.size, index)),
            1 => {
                let level_data = (0..across.max(down)).map(|at| level(at, at)).collect();
                Levels::Mip { rounding_mode, level_data }
            }
            _ => {
                let all = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
                let map_data = all.map(|(x, y)| level(x, y)).collect();
                let level_data = RipMaps { map_data, level_count: Vec2(across, down) };
                Levels::Rip { rounding_mode, level_data }
            }
        };
        AnyChannel::new(name, samples)
    }

    fn file(&self) -> Vec<u8> {
        let list: Vec<_> =
            self.names.iter().enumerate().map(|(i, name)| self.channel(i, name)).collect();
        let attributes = LayerAttributes {
            layer_position: Vec2(self.corner.0, self.corner.1),
            ..LayerAttributes::default()
        };
        let channels = AnyChannels::sort(list.into());
        let layer = Layer::new(self.size, attributes, self.encoding, channels);
        let (x, y, width, height) = self.shown;
        let mut attributes = ImageAttributes::new(IntegerBounds::new((x, y), (width, height)));
        attributes.pixel_aspect = self.aspect;
        let image = Image::new(attributes, layer);
        let mut file = Cursor::new(Vec::new());
        image.write().non_parallel().to_buffered(&mut file).unwrap();
        file.into_inner()
    }
}

prop_compose! {
    fn made()(
        size in (1usize..50, 1usize..50),
        compression in prop::sample::select(vec![
            Compression::Uncompressed, Compression::RLE, Compression::ZIP1, Compression::ZIP16,
            Compression::PIZ, Compression::PXR24, Compression::B44,
        ]),
        tile in (any::<bool>(), 1usize..24, 1usize..24),
        line_order in prop::sample::select(vec![LineOrder::Increasing, LineOrder::Decreasing]),
        corner in (-9i32..9, -9i32..9),
        shown in (-9i32..9, -9i32..9, 1usize..50, 1usize..50),
        (turned, stretched) in (any::<bool>(), any::<bool>()),
        names in prop::sample::select(vec![
            &["Y"][..], &["A", "Y"], &["B", "G", "R"], &["A", "B", "G", "R"], &["B", "G", "R", "Z"],
        ]),
        kind in 0usize..3,
        levels in 0usize..3,
    ) -> Made {
        let (tiled, across, down) = tile;
        let blocks = if tiled { Blocks::Tiles(Vec2(across, down)) } else { Blocks::ScanLines };
        let line_order = if turned { line_order } else { LineOrder::Increasing };
        Made {
            size, corner, shown, names, kind,
            encoding: Encoding { compression, blocks, line_order },
            aspect: if stretched { 1.5 } else { 1.0 },
            levels: if tiled { levels } else { 0 },
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn windows_of_any_openexr_are_cut_out_of_the_whole(made in made(), windows in windows()) {
        let bytes = made.file();
        let found = assert_cut(&bytes, TONES[0], &windows);
        prop_assert!(scan(&bytes, TONES[0]).unwrap().reads_windows());
        // However pixels are laid out, they are the same, but of lossy compressions.
        if !matches!(made.encoding.compression, Compression::PXR24 | Compression::B44) {
            let encoding = Encoding::UNCOMPRESSED;
            let plain = whole(&Made { encoding, levels: 0, ..made }.file(), TONES[0]).unwrap();
            prop_assert!(plain.importance == found.importance);
        }
    }

    #[test]
    fn what_is_cut_off_or_flipped_is_an_error_or_nowhere(
        made in made(), windows in windows(), end in 0.0f64..1.0, value: u8, flipped: bool,
    ) {
        let mut bytes = made.file();
        let expected = whole(&bytes, TONES[0]).unwrap();
        let end = (bytes.len() as f64 * end) as usize;
        if flipped {
            bytes[end] = value;
        } else {
            bytes.truncate(end);
        }
        let Ok(mut scan) = scan(&bytes, TONES[0]) else { return Ok(()) };
        let (width, height) = scan.size();
        for corners in windows {
            let (columns, rows) = window((width.min(500), height.min(500)), corners);
            let found = scan.window(columns.clone(), rows.clone());
            if let (Ok(found), false) = (found, flipped) {
                prop_assert!(found == cut(&expected, columns, rows));
            }
        }
    }
}

fn large(blocks: Blocks, compression: Compression) -> Made {
    Made {
        size: (256, 256),
        encoding: Encoding { compression, blocks, line_order: LineOrder::Increasing },
        corner: (0, 0),
        shown: (0, 0, 256, 256),
        aspect: 1.0,
        names: &["Y"],
        kind: 1,
        levels: 0,
    }
}

#[test]
fn only_the_blocks_of_a_window_are_read() {
    let tiles = large(Blocks::Tiles(Vec2(16, 16)), Compression::Uncompressed).file();
    // To tell the format, the first page of bytes is looked at, which holds the first tiles.
    for (columns, rows, blocks) in
        [(3..4, 165..166, 1), (10..20, 170..180, 4), (0..256, 255..256, 16)]
    {
        // A block has a head of 20 bytes.
        let (before, read) = counted(&tiles, columns, rows);
        assert_eq!(read, blocks * (20 + 16 * 16 * 4), "{blocks}");
        assert!(before < 8192);
    }
    let lines = large(Blocks::ScanLines, Compression::Uncompressed).file();
    let (_, read) = counted(&lines, 100..101, 70..75);
    assert_eq!(read, 5 * (8 + 256 * 4));
    let pressed = large(Blocks::ScanLines, Compression::ZIP16).file();
    let (_, all) = counted(&pressed, 0..256, 0..256);
    let (_, read) = counted(&pressed, 100..101, 70..75);
    assert!(read * 10 < all, "{read} {all}");
}

#[test]
fn a_nan_is_named_where_a_window_holds_it() {
    let made = large(Blocks::Tiles(Vec2(16, 16)), Compression::Uncompressed);
    let mut bytes = made.file();
    let value = made.value(200, 100, 0).to_le_bytes();
    // One in 101 pixels has this value: take the one of the tile that holds (200, 100).
    let start = bytes.len() - 256 * (20 + 1024) + (100 / 16 * 16 + 200 / 16) * (20 + 1024) + 20;
    let place = start + 4 * (100 % 16 * 16 + 200 % 16);
    assert_eq!(bytes[place..place + 4], value);
    bytes[place..place + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut scan = scan(&bytes, TONES[0]).unwrap();
    for (columns, rows) in [(0..200, 0..256), (201..256, 0..256), (0..256, 101..256)] {
        assert!(scan.window(columns, rows).is_ok());
    }
    let error = scan.window(190..210, 90..110).unwrap_err();
    assert!(matches!(error, PictureError::NotFinite { x: 200, y: 100 }), "{error}");
}

#[test]
fn a_layer_is_chosen_by_its_name() {
    let bytes = std::fs::read(super::sample("blender_ml.exr")).unwrap();
    let of = |name| {
        let source = Source::of_bytes(bytes.clone()).unwrap();
        let wanted = Wanted { tone: TONES[0], layer: Some(name), radiance: false };
        Scan::of_source(source, Path::new("a"), wanted)
    };
    let path = super::sample("blender_ml.exr");
    let name = "ViewLayer.Combined";
    let expected = crate::picture::read_layer(&path, TONES[0], Some(name)).unwrap();
    let mut scan = of(name).unwrap();
    assert!(scan.window(7..40, 9..30).unwrap() == cut(&expected, 7..40, 9..30));
    assert!(of("ViewLayer.Depth").is_err());
}
