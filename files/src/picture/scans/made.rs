//! TIFF files of any layout, made byte by byte.

use image::codecs::jpeg::JpegEncoder;
use proptest::prelude::*;

use super::super::kinds::{Entry, FORMS, Form, packed};

/// What the samples of a file are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Photometric interpretation, bits, and samples, of which the last may be alpha.
    Integers(usize, usize, usize, bool),
    Floats(usize, usize),
    Jpeg(usize),
}

/// A TIFF file to be made.
#[derive(Debug, Clone)]
pub(super) struct Made {
    pub(super) size: (usize, usize),
    pub(super) kind: Kind,
    pub(super) form: Form,
    /// Pixels across and down of a tile, or with 0 across the rows of a strip.
    pub(super) chunk: (usize, usize),
    pub(super) planar: bool,
    pub(super) runs: bool,
    pub(super) orientation: usize,
    pub(super) resolution: (usize, usize),
    pub(super) seed: u64,
}

impl Made {
    /// A sample of a pixel, in the file's own bits.
    fn number(&self, x: usize, y: usize, channel: usize) -> u64 {
        let mut bits = self.seed ^ (x as u64) << 40 ^ (y as u64) << 16 ^ channel as u64;
        for _ in 0..2 {
            bits = (bits ^ bits >> 31).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
        let part = (bits >> 11) as f64 / (1u64 << 53) as f64;
        match self.kind {
            Kind::Integers(_, bits_per_sample, ..) => bits >> (64 - bits_per_sample),
            Kind::Floats(32, _) => u64::from(((part * 2.0 - 0.5) as f32).to_bits()),
            Kind::Floats(..) => (part * 2.0 - 0.5).to_bits(),
            // What a JPEG file keeps.
            Kind::Jpeg(_) => (x * 5 + y * 3 + channel * 40) as u64 % 256,
        }
    }

    fn bits(&self) -> usize {
        match self.kind {
            Kind::Integers(_, bits, ..) | Kind::Floats(bits, _) => bits,
            Kind::Jpeg(_) => 8,
        }
    }

    pub(super) fn samples(&self) -> usize {
        match self.kind {
            Kind::Integers(_, _, samples, _) | Kind::Floats(_, samples) | Kind::Jpeg(samples) => {
                samples
            }
        }
    }

    fn chunks_across(&self) -> usize {
        if self.chunk.0 == 0 { 1 } else { self.size.0.div_ceil(self.chunk.0) }
    }

    /// The chunk that holds a pixel, of the first plane.
    pub(super) fn chunk_of(&self, x: usize, y: usize) -> usize {
        let column = x.checked_div(self.chunk.0).unwrap_or(0);
        y / self.chunk.1 * self.chunks_across() + column
    }

    pub(super) fn entries(&self) -> Vec<Entry> {
        let (samples, bits) = (self.samples(), self.bits());
        let (photometric, format, alpha) = match self.kind {
            Kind::Integers(photometric, _, _, alpha) => (photometric, 1, alpha),
            Kind::Floats(_, samples) => (if samples < 3 { 1 } else { 2 }, 3, samples % 2 == 0),
            Kind::Jpeg(samples) => (if samples == 1 { 1 } else { 6 }, 1, false),
        };
        let compression = match self.kind {
            Kind::Jpeg(_) => 7,
            _ if self.runs => 32773,
            _ => 1,
        };
        let mut entries = vec![
            (256, 4, vec![self.size.0]),
            (257, 4, vec![self.size.1]),
            (258, 2, vec![bits; samples]),
            (259, 2, vec![compression]),
            (262, 2, vec![photometric]),
            (274, 2, vec![self.orientation]),
            (277, 2, vec![samples]),
            (282, 4, vec![self.resolution.0, 1]),
            (283, 4, vec![self.resolution.1, 1]),
            (284, 2, vec![if self.planar { 2 } else { 1 }]),
            (339, 2, vec![format; samples]),
        ];
        if self.chunk.0 == 0 {
            entries.push((278, 4, vec![self.chunk.1]));
        } else {
            entries.extend([(322, 4, vec![self.chunk.0]), (323, 4, vec![self.chunk.1])]);
        }
        if alpha {
            entries.push((338, 2, vec![2]));
        }
        if photometric == 3 {
            entries.push((320, 2, (0..3usize << bits).map(|i| i * 7919 % 65536).collect()));
        }
        entries
    }

    /// The strips or tiles.
    pub(super) fn chunks(&self) -> Vec<Vec<u8>> {
        let (width, height) = self.size;
        let tiled = self.chunk.0 > 0;
        let across = if tiled { self.chunk.0 } else { width };
        let planes: Vec<Vec<usize>> = if self.planar {
            (0..self.samples()).map(|channel| vec![channel]).collect()
        } else {
            vec![(0..self.samples()).collect()]
        };
        let mut chunks = Vec::new();
        for channels in planes {
            for top in (0..height).step_by(self.chunk.1) {
                for left in (0..width).step_by(across) {
                    // Strips end with the picture, tiles do not.
                    let rows = if tiled { self.chunk.1 } else { self.chunk.1.min(height - top) };
                    let numbers: Vec<u64> = (top..top + rows)
                        .flat_map(|y| (left..left + across).map(move |x| (x, y)))
                        .flat_map(|(x, y)| channels.iter().map(move |&c| self.number(x, y, c)))
                        .collect();
                    chunks.push(self.stored(&numbers, across, channels.len(), rows));
                }
            }
        }
        chunks
    }

    fn stored(&self, numbers: &[u64], across: usize, channels: usize, rows: usize) -> Vec<u8> {
        if let Kind::Jpeg(samples) = self.kind {
            let bytes: Vec<u8> = numbers.iter().map(|&number| number as u8).collect();
            let color = [image::ExtendedColorType::L8, image::ExtendedColorType::Rgb8][samples / 3];
            let mut out = Vec::new();
            let mut encoder = JpegEncoder::new_with_quality(&mut out, 95);
            encoder.encode(&bytes, across as u32, rows as u32, color).unwrap();
            return out;
        }
        let bits = self.bits();
        let mut bytes = Vec::new();
        if matches!(bits, 8 | 16 | 32 | 64) {
            numbers.iter().for_each(|&n| self.form.put(&mut bytes, n as usize, bits / 8));
        } else {
            let numbers: Vec<usize> = numbers.iter().map(|&number| number as usize).collect();
            bytes = packed(across * channels, bits, &numbers);
        }
        if !self.runs {
            return bytes;
        }
        bytes.chunks(128).flat_map(|part| [&[part.len() as u8 - 1], part].concat()).collect()
    }

    /// The lengths of the file's head and of its chunks, and its bytes.
    pub(super) fn file(&self) -> (usize, Vec<usize>, Vec<u8>) {
        let chunks = self.chunks();
        let lengths: Vec<usize> = chunks.iter().map(Vec::len).collect();
        let head = self.form.head(&self.entries(), self.chunk.0 > 0, &lengths);
        (head.len(), lengths, [head, chunks.concat()].concat())
    }
}

/// A gray file in strips or tiles.
pub(super) fn gray(size: (usize, usize), chunk: (usize, usize)) -> Made {
    Made {
        size,
        kind: Kind::Integers(1, 8, 1, false),
        form: FORMS[3],
        chunk,
        planar: false,
        runs: false,
        orientation: 1,
        resolution: (72, 72),
        seed: 1,
    }
}

fn kind() -> impl Strategy<Value = Kind> {
    prop_oneof![
        3 => (0usize..2, prop::sample::select(vec![1usize, 2, 4, 8, 12, 16, 32, 64]))
            .prop_map(|(photometric, bits)| Kind::Integers(photometric, bits, 1, false)),
        3 => prop::sample::select(vec![8usize, 16, 32]).prop_map(|bits| Kind::Integers(2, bits, 3, false)),
        2 => prop::sample::select(vec![8usize, 16]).prop_map(|bits| Kind::Integers(2, bits, 4, true)),
        1 => prop::sample::select(vec![8usize, 16]).prop_map(|bits| Kind::Integers(1, bits, 2, true)),
        1 => prop::sample::select(vec![5usize, 10]).prop_map(|bits| Kind::Integers(2, bits, 3, false)),
        1 => Just(Kind::Integers(5, 8, 4, false)),
        1 => Just(Kind::Integers(8, 8, 3, false)),
        1 => prop::sample::select(vec![4usize, 8]).prop_map(|bits| Kind::Integers(3, bits, 1, false)),
        2 => (prop::sample::select(vec![32usize, 64]), 1usize..5)
            .prop_map(|(bits, samples)| Kind::Floats(bits, samples)),
        2 => prop::sample::select(vec![1usize, 3]).prop_map(Kind::Jpeg),
    ]
}

prop_compose! {
    pub(super) fn made()(
        size in (1usize..70, 1usize..70),
        kind in kind(),
        form in prop::sample::select(FORMS.to_vec()),
        tiled in any::<bool>(),
        tile in (1usize..4, 1usize..4),
        rows in prop_oneof![1usize..8, Just(70usize)],
        (planar, runs, turned) in (any::<bool>(), any::<bool>(), any::<bool>()),
        orientation in 1usize..9,
        resolution in prop_oneof![6 => Just((72usize, 72usize)), 1 => (50usize..200, 50usize..200)],
        seed in any::<u64>(),
    ) -> Made {
        let bits = match kind {
            Kind::Integers(_, bits, ..) | Kind::Floats(bits, _) => bits,
            Kind::Jpeg(_) => 0,
        };
        let whole = matches!(bits, 8 | 16 | 32 | 64);
        let rows = rows.min(size.1);
        Made {
            size, kind, form, seed, resolution,
            chunk: if tiled { (16 * tile.0, 16 * tile.1) } else { (0, rows) },
            planar: planar && whole,
            runs: runs && bits > 0,
            orientation: if turned { orientation } else { 1 },
        }
    }
}
