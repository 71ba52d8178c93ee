//! The fuzz targets on stable Rust: every file of the corpus is replayed, and mutated from a fixed seed.
//!
//! `TWELVEFOLD_FUZZ_SECONDS=3600 cargo test --release --test fuzz_corpus` goes on for an hour a target,
//! from another seed each time. A crash prints the bytes; add them to `fuzz/corpus`.

use std::path::Path;
use std::time::{Duration, Instant};

use twelvefold::Tables;
use twelvefold::bake::bake;
use twelvefold::bake::displacement::{DELTA, Displacements, Layer, Slot, born_classes};
use twelvefold::tiling::Digits;

#[path = "../../fuzz/bodies.rs"]
mod bodies;

#[path = "../../fuzz/readers.rs"]
mod readers;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// One to eight changes: bits, bytes, interesting numbers, cuts, repetitions, parts of another file.
fn mutated(bytes: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    const NUMBERS: [u64; 8] = [
        0,
        u64::MAX,
        0x7ff0_0000_0000_0000,
        0x7ff8_0000_0000_0000,
        1,
        0x8000_0000_8000_0000,
        0x7f80_0000_7f80_0000,
        0x3ff0_0000_3f80_0000,
    ];
    let mut bytes = bytes.to_vec();
    for _ in 0..1 + random.below(8) {
        let at = random.below(bytes.len());
        match random.below(7) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 if !bytes.is_empty() => bytes[at] = random.next() as u8,
            2 => {
                let number = NUMBERS[random.below(NUMBERS.len())].to_le_bytes();
                let width = [1, 2, 4, 8][random.below(4)];
                for (slot, byte) in bytes[at..].iter_mut().zip(&number[8 - width..]) {
                    *slot = *byte;
                }
            }
            3 => bytes.truncate(at),
            4 => {
                let end = (at + random.below(32)).min(bytes.len());
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            5 if !other.is_empty() => {
                let from = random.below(other.len());
                let part = &other[from..(from + random.below(64)).min(other.len())];
                let end = (at + part.len()).min(bytes.len());
                bytes.splice(at..end, part.iter().copied());
            }
            _ => {
                let end = (at + random.below(16)).min(bytes.len());
                bytes.drain(at..end);
            }
        }
    }
    bytes
}

/// Replays and mutates; `rounds` mutations, or as long as the environment says.
fn fuzz(target: &str, seeds: Vec<Vec<u8>>, rounds: usize, body: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let mut corpus = seeds;
    if let Ok(files) = std::fs::read_dir(folder) {
        let mut paths: Vec<_> = files.map(|file| file.unwrap().path()).collect();
        paths.sort();
        corpus.extend(paths.iter().map(|path| std::fs::read(path).unwrap()));
    }
    let run = |bytes: &[u8]| {
        if std::panic::catch_unwind(|| body(bytes)).is_err() {
            panic!("{target} fails on {bytes:?}");
        }
    };
    corpus.iter().for_each(|bytes| run(bytes));
    let seconds = std::env::var("TWELVEFOLD_FUZZ_SECONDS").ok().and_then(|s| s.parse().ok());
    let start = Instant::now();
    let seed = if seconds.is_some() { std::process::id() } else { 1 };
    let mut random = Random(u64::from(seed));
    let mut round = 0;
    loop {
        let enough = match seconds {
            Some(seconds) => start.elapsed() >= Duration::from_secs(seconds),
            None => round >= rounds,
        };
        if enough {
            break;
        }
        let bytes = &corpus[random.below(corpus.len())];
        let other = &corpus[random.below(corpus.len())];
        run(&mutated(bytes, other, &mut random));
        round += 1;
    }
    println!("{target}: {} files, {round} mutations", corpus.len());
}

/// Small valid files: a fuzzer that starts from them gets past the first checks.
fn valid_tables() -> [(&'static str, Vec<u8>); 4] {
    let rules = Tables::built_in().rules();
    let slot = |tau, generations: u8, vectors| Slot { tau, generations, scale: 0.044, vectors };
    // As few vectors as two slots between the ends may have, some nearly as long as they may be.
    let vectors = |next: f64| {
        let vector = |i: u32| [(i * 37) as i8, (i * 59 + 128) as i8];
        (0..born_classes(2, next)).map(vector).collect()
    };
    let layer = |number| {
        let slots = vec![
            slot(1.0, 2, vec![]),
            slot(1.25, 2, vectors(2.0)),
            slot(2.0, 2, vectors(f64::from(DELTA))),
            slot(DELTA, 2, vec![]),
        ];
        Layer::new(number, slots).unwrap()
    };
    let displacements = Displacements {
        digits: rules.digits().derivation_order(),
        provenance: "for fuzzing".to_owned(),
        smooth: layer(0),
        rough: Some(layer(1)),
    };
    let file = displacements.to_bytes().unwrap();
    [
        ("depth-1", bake(&rules, 1, None).unwrap()),
        ("depth-1-relaxed", bake(&rules, 1, Some(&displacements)).unwrap()),
        ("relaxation", file),
        ("digits", include_bytes!("../../tables/digits.txt").to_vec()),
    ]
}

/// cargo-fuzz has no other way to them than files. `TWELVEFOLD_BLESS=1` writes them anew.
fn committed(target: &str, files: &[(&str, Vec<u8>)]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    for (name, bytes) in files {
        let path = folder.join(name);
        if std::env::var_os("TWELVEFOLD_BLESS").is_some() {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&path, bytes).unwrap();
        }
        assert!(std::fs::read(&path).unwrap() == *bytes, "{} is out of date", path.display());
    }
}

#[test]
fn the_corpus_holds_valid_files_of_each_kind() {
    let files = valid_tables();
    committed("tables", &files);
    for (name, bytes) in &files {
        let known = match *name {
            "relaxation" => Displacements::from_bytes(bytes).is_ok(),
            "digits" => std::str::from_utf8(bytes).is_ok_and(|text| Digits::parse(text).is_ok()),
            _ => Tables::from_bytes(bytes).is_ok(),
        };
        assert!(known, "{name}");
    }
}

#[test]
fn tables() {
    fuzz("tables", vec![Vec::new()], 20_000, bodies::tables);
}

#[test]
fn fcodes() {
    let seeds =
        [&b"\x00CAB0123"[..], b"\x01D3D9", b"\x020", b"\x03\xff\xff\xff\xff\xff\xff\xff\x0f"];
    fuzz("fcodes", seeds.map(<[u8]>::to_vec).into(), 20_000, bodies::fcodes);
}

#[test]
fn maps() {
    let seed = |width: u8, height: u8, min: f64, size: f64, pixel: fn(usize) -> f32| {
        let mut bytes = vec![width, height, 1];
        bytes.extend(77u64.to_le_bytes());
        for number in [min, -min, size, 0.5 * size] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([2, 40]);
        for i in 0..usize::from(width) * usize::from(height) {
            bytes.extend(pixel(i).to_le_bytes());
        }
        bytes
    };
    let seeds = [
        ("ramp", seed(8, 6, 0.0, 1.0, |i| i as f32)),
        ("thin", seed(1, 39, 1e6, 1e-3, |i| (i % 3) as f32)),
        ("hot", seed(17, 3, -7.0, 1e9, |i| if i == 20 { 1e30 } else { 1e-30 })),
        ("edges", seed(32, 24, 0.0, 32.0, |i| ((i / 7) % 2) as f32)),
        // The crash that NaN as a position in an environment was.
        ("nan-position", seed(5, 5, f64::NAN, 1.0, |_| 1.0)),
        // So far from the origin that several pixels lie between two numbers.
        ("far", seed(1, 39, 5.5e11, 0.001, |i| (i % 2) as f32)),
        // Too small for `f32`: positions left the domain.
        ("tiny", seed(4, 4, 0.0, 1e-44, |_| 1.0)),
        ("huge", seed(4, 4, 0.0, 1e44, |_| 1.0)),
        ("nan-size", seed(5, 5, 0.0, f64::NAN, |_| 1.0)),
    ];
    committed("maps", &seeds);
    let seeds = vec![Vec::new()];
    fuzz("maps", seeds, 600, bodies::maps);
}

#[test]
fn readers() {
    let picture = image::RgbImage::from_fn(9, 7, |x, y| image::Rgb([x as u8, y as u8, 7]));
    let mut seeds = vec![b"x,y\n0.5,0.25\n# end\n1 2\n".to_vec()];
    for format in [image::ImageFormat::Png, image::ImageFormat::Jpeg] {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        seeds.push(bytes.into_inner());
    }
    let colors = vec![image::Rgb([0.5f32, 2.0, 1e-3]); 63];
    let mut bytes = Vec::new();
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&colors, 9, 7).unwrap();
    seeds.push(bytes);
    let mut bytes = std::io::Cursor::new(Vec::new());
    tiff::encoder::TiffEncoder::new(&mut bytes)
        .unwrap()
        .write_image::<tiff::encoder::colortype::RGB8>(9, 7, picture.as_raw())
        .unwrap();
    seeds.push(bytes.into_inner());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("seed.exr");
    exr::prelude::write_rgb_file(&path, 9, 7, |x, y| (x as f32, y as f32, -1.0f32)).unwrap();
    seeds.push(std::fs::read(&path).unwrap());
    fuzz("readers", seeds, 1500, readers::readers);
}
