//! What is known of a photograph before the first dot: how much of it there is to draw.

use std::fmt;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use twelvefold::Pixels;
use twelvefold_files::picture::{Picture, PictureError, Scan, Tone};
use twelvefold_stipple::gain;

/// Raised when what is written changes.
const VERSION: u32 = 1;

/// Pixels that are read at a time.
const BAND: usize = 1 << 24;

/// Rows are read by multiples of this many where memory allows: tiles are rarely higher.
const TILE: usize = 256;

/// How much there is to draw, of pixels' importance from 0 on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Darkness {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// As of [`Pixels::mean`].
    pub(crate) mean: f64,
    /// The area, in pixels, of black that would hold as many dots.
    pub(crate) total: f64,
    pub(crate) darkest: f32,
}

impl Darkness {
    /// Of a picture as it is.
    pub(crate) fn of(picture: &Picture) -> Self {
        let mut tally = Tally::default();
        picture.importance.chunks(picture.width.max(1)).for_each(|row| tally.add(row));
        tally.darkness(picture.width)
    }
}

/// What has been counted so far, row by row: the same sums whether an image comes at once or in parts.
#[derive(Debug, Default)]
struct Tally {
    row_sums: Vec<f64>,
    total: f64,
    darkest: f32,
}

impl Tally {
    fn add(&mut self, row: &[f32]) {
        self.row_sums.push(Pixels::sum_of_row(row));
        // As of `Picture::total`.
        self.total += row.iter().map(|&pixel| f64::from(pixel)).sum::<f64>();
        self.darkest = row.iter().fold(self.darkest, |most, &pixel| most.max(pixel));
    }

    fn darkness(&self, width: usize) -> Darkness {
        let (height, mean) = (self.row_sums.len(), Pixels::mean_of_rows(width, &self.row_sums));
        Darkness { width, height, mean, total: self.total, darkest: self.darkest }
    }
}

/// What the parts of a photograph must know of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Survey {
    version: u32,
    /// Of the file, in bytes.
    length: u64,
    tone: Read,
    /// Its darkness as it is.
    pub(crate) plain: Darkness,
    /// The share of area that dots should have.
    pub(crate) corrected: Darkness,
    /// The least and greatest brightness of a float file.
    pub(crate) range: Option<(f64, f64)>,
}

/// How the photograph was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Read {
    layer: Option<String>,
    linear: bool,
    invert: bool,
    /// Black, white and gamma.
    levels: Option<[f64; 3]>,
    exposure: Option<f64>,
}

impl Read {
    fn new(tone: Tone, layer: Option<&str>) -> Self {
        Self {
            layer: layer.map(str::to_owned),
            linear: tone.linear,
            invert: tone.invert,
            levels: tone.levels.map(|levels| [levels.black, levels.white, levels.gamma]),
            exposure: tone.exposure,
        }
    }
}

/// Why there is no survey.
#[derive(Debug)]
pub(crate) enum SurveyError {
    /// The file cannot be read.
    Io(std::io::Error),
    /// It is no survey.
    Malformed(serde_json::Error),
    /// It was made by another version of this program.
    Version(u32),
    /// It is of another photograph.
    Photograph,
    /// The photograph was read in another way.
    Tone,
}

impl fmt::Display for SurveyError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(out, "cannot be read: {error}"),
            Self::Malformed(error) => write!(out, "is no survey: {error}"),
            Self::Version(version) => {
                write!(
                    out,
                    "is a survey of version {version}; this program makes version {VERSION}"
                )
            }
            Self::Photograph => out.write_str("is the survey of another photograph"),
            Self::Tone => out.write_str(
                "was made with other options for the photograph's tone; make it with the same ones",
            ),
        }
    }
}

impl std::error::Error for SurveyError {}

impl Survey {
    /// Reads all of a photograph, in bands.
    ///
    /// # Errors
    /// [`PictureError`].
    pub(crate) fn of(
        scan: &mut Scan,
        photo: &Path,
        tone: Tone,
        layer: Option<&str>,
    ) -> Result<Self, PictureError> {
        let (width, height) = scan.size();
        let rows = (BAND / width).max(1);
        let rows = if rows > TILE { rows / TILE * TILE } else { rows };
        let (mut plain, mut corrected) = (Tally::default(), Tally::default());
        for first in (0..height).step_by(rows) {
            let mut band = scan.window(0..width, first..(first + rows).min(height))?;
            band.chunks(width).for_each(|row| plain.add(row));
            gain::correct(&mut band);
            band.chunks(width).for_each(|row| corrected.add(row));
        }
        Ok(Self {
            version: VERSION,
            length: length(photo),
            tone: Read::new(tone, layer),
            plain: plain.darkness(width),
            corrected: corrected.darkness(width),
            range: scan.range(),
        })
    }

    /// Reads the survey of a photograph of this size that is read in this way.
    ///
    /// # Errors
    /// [`SurveyError`].
    pub(crate) fn read(
        path: &Path,
        size: (usize, usize),
        photo: &Path,
        tone: Tone,
        layer: Option<&str>,
    ) -> Result<Self, SurveyError> {
        #[derive(Deserialize)]
        struct Version {
            version: u32,
        }
        let text = fs::read_to_string(path).map_err(SurveyError::Io)?;
        let Version { version } = serde_json::from_str(&text).map_err(SurveyError::Malformed)?;
        if version != VERSION {
            return Err(SurveyError::Version(version));
        }
        let survey: Self = serde_json::from_str(&text).map_err(SurveyError::Malformed)?;
        let of_size = |darkness: &Darkness| (darkness.width, darkness.height) == size;
        if survey.length != length(photo) || !of_size(&survey.plain) || !of_size(&survey.corrected)
        {
            return Err(SurveyError::Photograph);
        }
        if survey.tone != Read::new(tone, layer) {
            return Err(SurveyError::Tone);
        }
        Ok(survey)
    }

    /// As it is written.
    pub(crate) fn text(&self) -> String {
        // Numbers and names only: nothing that could fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// The length of a file in bytes; 0 of what is none.
fn length(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |metadata| metadata.len())
}
