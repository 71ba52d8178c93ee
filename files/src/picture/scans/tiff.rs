//! Windows of TIFF files.

use std::io::{Seek as _, SeekFrom, Write as _};

use super::super::kinds::FORMS;
use super::made::{Kind, Made, gray, made};
use super::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn windows_of_any_tiff_are_cut_out_of_the_whole(
        made in made(), windows in windows(), tone in 0usize..2,
    ) {
        let (_, _, bytes) = made.file();
        let expected = assert_cut(&bytes, TONES[tone], &windows);
        prop_assert!(scan(&bytes, TONES[tone]).unwrap().reads_windows());
        // However pixels are laid out, they are the same.
        if !matches!(made.kind, Kind::Jpeg(_)) {
            let plain = Made {
                chunk: (0, made.size.1), planar: false, runs: false, form: FORMS[0], ..made
            };
            let plain = whole(&plain.file().2, TONES[tone]).unwrap();
            prop_assert_eq!(&plain.importance, &expected.importance);
        }
    }

    #[test]
    fn windows_of_pressed_strips_are_cut_out_of_the_whole(
        size in (1u32..60, 1u32..60), rows in 1u32..12, method in 0usize..3, predicted: bool,
        windows in windows(),
    ) {
        use ::tiff::encoder::{Compression, TiffEncoder, colortype::RGB16};
        use ::tiff::tags::Predictor;
        let method = [Compression::Lzw, Compression::Deflate(Default::default()), Compression::Packbits]
            [method];
        let mut file = std::io::Cursor::new(Vec::new());
        let predictor = if predicted { Predictor::Horizontal } else { Predictor::None };
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        encoder = encoder.with_compression(method).with_predictor(predictor);
        let mut page = encoder.new_image::<RGB16>(size.0, size.1).unwrap();
        page.rows_per_strip(rows.min(size.1)).unwrap();
        let samples: Vec<u16> = (0..size.0 * size.1 * 3).map(|i| (i * i % 40_000) as u16).collect();
        page.write_data(&samples).unwrap();
        assert_cut(&file.into_inner(), TONES[0], &windows);
    }

    #[test]
    fn what_is_cut_off_is_missing_where_it_is_wanted_and_nowhere_else(
        made in made(), windows in windows(), end in 0.0f64..1.0,
    ) {
        let (head, lengths, bytes) = made.file();
        let expected = whole(&bytes, TONES[0]).unwrap();
        let end = (bytes.len() as f64 * end) as usize;
        let found = scan(&bytes[..end], TONES[0]);
        // Of a kind that is kept as it is, all that is there is kept.
        let Ok(mut scan) = found else {
            prop_assert!(end < head);
            return Ok(());
        };
        for corners in windows {
            let (columns, rows) = window(scan.size(), corners);
            let found = scan.window(columns.clone(), rows.clone());
            if let Ok(found) = &found {
                prop_assert!(*found == cut(&expected, columns.clone(), rows.clone()));
            }
            let upright = made.orientation == 1 && made.resolution == (72, 72) && !made.planar;
            if upright && end > head {
                let last = made.chunk_of(columns.end - 1, rows.end - 1);
                let there = head + lengths[..=last].iter().sum::<usize>() <= end;
                prop_assert!(found.is_ok() || !there, "{}", found.unwrap_err());
            }
        }
    }

    #[test]
    fn no_flipped_file_crashes(
        made in made(), windows in windows(), flips in proptest::collection::vec((0.0f64..1.0, any::<u8>()), 1..4),
    ) {
        let (head, _, mut bytes) = made.file();
        for (place, value) in flips {
            let place = (head as f64 * place) as usize;
            bytes[place] = value;
        }
        if let Ok(mut scan) = scan(&bytes, TONES[0]) {
            let (width, height) = scan.size();
            for corners in windows {
                let (columns, rows) = window((width.min(500), height.min(500)), corners);
                let _ = scan.window(columns, rows);
            }
            let _ = scan.window(width - 1..width, height - 1..height);
        }
    }
}

#[test]
fn only_the_chunks_of_a_window_are_read() {
    for (chunk, window, expected) in [
        ((64, 64), (70..80, 3..4), 64 * 64),
        ((64, 64), (60..70, 60..70), 4 * 64 * 64),
        ((64, 64), (0..1024, 0..1), 16 * 64 * 64),
        ((64, 64), (0..1024, 0..1024), 1024 * 1024),
        ((0, 2), (500..501, 500..501), 2 * 1024),
        ((0, 2), (0..3, 1..5), 6 * 1024),
    ] {
        let (head, _, bytes) = gray((1024, 1024), chunk).file();
        let (before, read) = counted(&bytes, window.0, window.1);
        // To tell the format, the first page of bytes is looked at.
        assert!(before <= head.max(4096), "{before} {head}");
        assert!(read <= expected && read + 4096 >= expected, "{chunk:?} {read} {expected}");
    }
}

#[test]
fn strips_are_read_once_for_windows_side_by_side() {
    let (_, _, bytes) = gray((1024, 1024), (0, 16)).file();
    let watched = Watched::new(bytes.clone());
    let seen = watched.seen.clone();
    let wanted = Wanted { tone: TONES[0], layer: None, radiance: false };
    let mut scan = Scan::of_source(Source::Watched(watched), Path::new("a"), wanted).unwrap();
    let expected = whole(&bytes, TONES[0]).unwrap();
    for rows in [500..590, 580..670] {
        for (i, left) in (0..1024).step_by(128).enumerate() {
            seen.lock().unwrap().fill(false);
            let found = scan.window(left..left + 128, rows.clone()).unwrap();
            assert!(found == cut(&expected, left..left + 128, rows.clone()));
            let read = seen.lock().unwrap().iter().filter(|&&seen| seen).count();
            let strips = rows.end.div_ceil(16) - rows.start / 16;
            assert_eq!(read, if i == 0 { strips * 16 * 1024 } else { 0 });
        }
    }
}

#[test]
fn pictures_and_files_may_be_larger_than_the_limit() {
    // All tiles but one are the same, so that ten thousand million pixels are a short file.
    let mut made = gray((100_000, 100_000), (256, 256));
    let chunks = made.chunk_of(99_999, 99_999) + 1;
    let lengths = vec![256 * 256; chunks];
    made.size.1 = 1;
    let tile = made.chunks().swap_remove(0);
    made.size.1 = 100_000;
    let mut entries = made.entries();
    let head = made.form.head(&entries, true, &lengths).len();
    let mut offsets = vec![head; chunks];
    offsets[chunks - 1] = head + tile.len();
    entries.extend([(324, 8, offsets), (325, 4, lengths)]);
    let (mut bytes, first) = made.form.start();
    let place = made.form.directory(&mut bytes, &entries);
    made.form.begin(&mut bytes, first, place);
    assert_eq!(bytes.len(), head);
    bytes.extend(&tile);
    bytes.extend(vec![255; tile.len()]);

    assert!(matches!(whole(&bytes, TONES[0]), Err(PictureError::TooLarge { .. })));
    let mut scan = scan(&bytes, TONES[0]).unwrap();
    assert_eq!(scan.size(), (100_000, 100_000));
    let corner = scan.window(99_990..100_000, 99_990..100_000).unwrap();
    assert_eq!(corner, [0.0; 100]);
    let found = scan.window(5_000..5_010, 77_000..77_010).unwrap();
    let expected = |i: usize| {
        let (x, y) = ((5_000 + i % 10) % 256, (77_000 + i / 10) % 256);
        1.0 - f32::from(tile[y * 256 + x]) / 255.0
    };
    assert!(found.iter().enumerate().all(|(i, &value)| (value - expected(i)).abs() < 1e-6));
    // A window may not be.
    let large = scan.window(0..20_000, 0..20_000);
    assert!(matches!(large, Err(PictureError::TooLarge { width: 20_000, .. })));

    // A file of which most is not there: it takes no place on a disk.
    let made = gray((40_000, 40_000), (0, 1));
    let head = made.form.head(&made.entries(), false, &vec![40_000; 40_000]);
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&head).unwrap();
    file.seek(SeekFrom::Start((head.len() + 30_000 * 40_000 + 7) as u64)).unwrap();
    file.write_all(&[255]).unwrap();
    file.as_file().set_len((head.len() + 40_000 * 40_000) as u64).unwrap();
    let long = read_layer(file.path(), TONES[0], None);
    assert!(matches!(long, Err(PictureError::TooLong { .. })));
    let mut scan = Scan::open(file.path(), TONES[0], None).unwrap();
    assert_eq!(scan.window(5..9, 30_000..30_001).unwrap(), [1.0, 1.0, 0.0, 1.0]);

    // One strip cannot be read in part.
    let made = gray((40_000, 40_000), (0, 40_000));
    let head = made.form.head(&made.entries(), false, &[40_000 * 40_000]);
    let mut scan = self::scan(&head, TONES[0]).unwrap();
    let large = scan.window(0..1, 0..1).unwrap_err();
    assert!(large.to_string().contains("in parts of 40000 x 40000"), "{large}");
}

#[test]
fn a_nan_is_named_where_a_window_holds_it_by_its_place_in_the_file() {
    let mut made = gray((40, 30), (16, 16));
    made.kind = Kind::Floats(32, 1);
    made.orientation = 6;
    let (head, _, mut bytes) = made.file();
    // Pixel (20, 18) of the file lies in the second tile of the second row.
    let place = head + 4 * ((3 + 1) * 256 + 2 * 16 + 4);
    bytes[place..place + 4].copy_from_slice(&[0x7f, 0xc0, 0, 0]);
    let mut scan = scan(&bytes, TONES[0]).unwrap();
    assert_eq!(scan.size(), (30, 40));
    // Turned to the right, row 18 is column 29 - 18.
    let error = scan.window(11..12, 20..21).unwrap_err();
    assert!(matches!(error, PictureError::NotFinite { x: 20, y: 18 }), "{error}");
    for (columns, rows) in [(10..11, 0..40), (12..30, 0..40), (0..30, 0..20), (0..30, 21..40)] {
        assert!(scan.window(columns, rows).is_ok());
    }
    let error = scan.window(0..30, 0..40).unwrap_err();
    assert!(matches!(error, PictureError::NotFinite { x: 20, y: 18 }), "{error}");
}
