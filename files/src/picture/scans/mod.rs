//! Windows are cut out of the whole.

mod made;
mod openexr;
mod tiff;

use std::fs;
use std::ops::Range;

use proptest::prelude::*;

use super::cases::sample;
use super::source::watched::Watched;
use super::*;

const TONES: [Tone; 2] = [
    Tone { linear: false, invert: false, levels: None, exposure: None },
    Tone {
        linear: true,
        invert: true,
        levels: Some(Levels { black: 20.0, white: 240.0, gamma: 1.2 }),
        exposure: None,
    },
];

fn scan(bytes: &[u8], tone: Tone) -> Result<Scan, PictureError> {
    let source = Source::of_bytes(bytes.to_vec())?;
    Scan::of_source(source, Path::new("a"), Wanted { tone, layer: None, radiance: false })
}

fn whole(bytes: &[u8], tone: Tone) -> Result<Picture, PictureError> {
    read_bytes(bytes.to_vec(), Path::new("a"), tone)
}

fn cut(picture: &Picture, columns: Range<usize>, rows: Range<usize>) -> Vec<f32> {
    let pixel = |x: usize, y: usize| picture.importance[y * picture.width + x];
    rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
}

/// The window with these fractions of the sides as its corners.
fn window(size: (usize, usize), [a, b, c, d]: [f64; 4]) -> (Range<usize>, Range<usize>) {
    let range = |length: usize, from: f64, to: f64| {
        let start = (length as f64 * from.min(to)) as usize;
        start..((length as f64 * from.max(to)) as usize + 1).clamp(start + 1, length)
    };
    (range(size.0, a, b), range(size.1, c, d))
}

fn windows() -> impl Strategy<Value = Vec<[f64; 4]>> {
    proptest::collection::vec(proptest::array::uniform4(0.0..1.0), 4)
}

/// Every window of these has the pixels that the whole has.
fn assert_cut(bytes: &[u8], tone: Tone, windows: &[[f64; 4]]) -> Picture {
    let expected = whole(bytes, tone).unwrap();
    let mut scan = scan(bytes, tone).unwrap();
    let size = scan.size();
    assert_eq!(size, (expected.width, expected.height));
    assert_eq!(scan.warnings(), expected.warnings);
    let all = [[0.0, 0.9999, 0.0, 0.9999], [0.0; 4], [0.9999; 4]];
    for &corners in windows.iter().chain(&all) {
        let (columns, rows) = window(size, corners);
        let found = scan.window(columns.clone(), rows.clone()).unwrap();
        assert!(found == cut(&expected, columns.clone(), rows.clone()), "{columns:?} {rows:?}");
    }
    assert_eq!(scan.range(), expected.range);
    assert!(scan.window(0..0, 0..size.1).unwrap().is_empty());
    for (columns, rows) in
        [(0..size.0 + 1, 0..1), (0..1, size.1..size.1 + 1), (0..1, 0..usize::MAX)]
    {
        assert!(matches!(scan.window(columns, rows), Err(PictureError::Outside { .. })));
    }
    expected
}

/// How many bytes of the file were read to open it, and then for a window.
fn counted(bytes: &[u8], columns: Range<usize>, rows: Range<usize>) -> (usize, usize) {
    let watched = Watched::new(bytes.to_vec());
    let seen = watched.seen.clone();
    let count = || seen.lock().unwrap().iter().filter(|&&seen| seen).count();
    let wanted = Wanted { tone: TONES[0], layer: None, radiance: false };
    let mut scan = Scan::of_source(Source::Watched(watched), Path::new("a"), wanted).unwrap();
    let before = count();
    scan.window(columns, rows).unwrap();
    (before, count() - before)
}

#[test]
fn other_formats_are_kept_whole_and_cut() {
    for name in
        ["gama1_16.png", "progressive.jpg", "exp2.hdr", "phys21.png", "f_webp.webp", "yc_zip.exr"]
    {
        let bytes = fs::read(sample(name)).unwrap();
        let corners = [[0.1, 0.5, 0.3, 0.4], [0.9, 0.2, 0.1, 0.7]];
        assert_cut(&bytes, TONES[0], &corners);
        assert!(!scan(&bytes, TONES[0]).unwrap().reads_windows(), "{name}");
    }
    let bytes = fs::read(sample("thumb_first.tif")).unwrap();
    assert_cut(&bytes, TONES[1], &[[0.1, 0.5, 0.3, 0.4]]);
    let exposed = Tone { exposure: Some(1.0), ..TONES[0] };
    assert!(matches!(scan(&bytes, exposed), Err(PictureError::NoExposure(Format::Tiff))));
    let text = scan(b"dear diary", TONES[0]);
    assert!(matches!(text, Err(PictureError::UnknownFormat)));
    assert!(matches!(Scan::open(Path::new("/"), TONES[0], None), Err(PictureError::NotAFile)));
}
