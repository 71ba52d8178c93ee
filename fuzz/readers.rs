//! The body of the target `readers`: the program's own readers.

use twelvefold_files::picture::{self, Tone};
use twelvefold_files::point_list;

/// Any bytes are a picture, light, a list of points, or an error; never a panic, and pixels are
/// importance.
pub(crate) fn readers(data: &[u8]) {
    if let Ok(text) = std::str::from_utf8(data)
        && let Ok(points) = point_list::parse(text)
    {
        assert!(points.iter().all(|point| point.is_finite()));
    }
    let Ok(file) = tempfile::NamedTempFile::new() else { return };
    if std::fs::write(file.path(), data).is_err() {
        return;
    }
    let tone = Tone {
        linear: data.len().is_multiple_of(2),
        invert: data.len() % 4 < 2,
        ..Tone::default()
    };
    if let Ok(picture) = picture::read(file.path(), tone) {
        assert_eq!(picture.importance.len(), picture.width * picture.height);
        assert!(picture.importance.iter().all(|value| (0.0..=1.0).contains(value)));
    }
    if let Ok(light) = picture::read_radiance(file.path()) {
        assert_eq!(light.pixels.len(), light.width * light.height);
    }
}
