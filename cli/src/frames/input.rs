//! Frames, from numbered files or a stream.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use twelvefold_files::failure::Failure;
use twelvefold_files::picture::{self, Picture, Tone};
use twelvefold_files::y4m::{Rate, Reader};

use super::options::FramesOptions;
use super::pattern::Pattern;
use crate::report;
use crate::stipple::tones::Importance;

/// A frame.
#[derive(Debug)]
pub(crate) struct Frame {
    /// That of its file, or counted from 1.
    pub(crate) number: u64,
    /// The file that it alone was read from.
    pub(crate) file: Option<PathBuf>,
    /// Its importance, as dots should have it.
    pub(crate) picture: Picture,
}

/// Frames on their way.
pub(crate) struct Input {
    source: Source,
    importance: Importance,
    /// Of the next frame.
    next: u64,
    /// The first frame that is not blank, until it is its turn.
    held: Option<(u64, Picture)>,
    size: Option<(usize, usize)>,
    quiet: bool,
    /// What was said already.
    told: Vec<String>,
}

enum Source {
    Files {
        pattern: Pattern,
        all: Range<u64>,
        /// Of the part that is drawn.
        own: Range<u64>,
        tone: Tone,
        layer: Option<String>,
    },
    Stream {
        path: PathBuf,
        reader: Box<Reader<Box<dyn Read>>>,
    },
}

impl Input {
    /// Opens what the options name; for photographs, looks which there are.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn open(options: &FramesOptions, importance: Importance) -> Result<Self, Failure> {
        let (path, tone) = (&options.input, options.tone.tone()?);
        let pattern = Pattern::of(path).map_err(|reason| report::of_input(path, reason))?;
        let (source, next) = match pattern {
            Some(pattern) => {
                let (all, beyond) = pattern.sequence(options.first, options.last)?;
                if beyond > 0 && !options.quiet {
                    let files = if beyond == 1 { "file" } else { "files" };
                    let warning =
                        format!("is missing; the {beyond} {files} after it are not drawn");
                    report::warn(&pattern.path(all.end), &[warning]);
                }
                let own = match options.part {
                    None => all.clone(),
                    Some(part) => {
                        let count = u128::from(all.end - all.start);
                        let start = |index: usize| {
                            all.start + (count * index as u128 / part.of as u128) as u64
                        };
                        start(part.index)..start(part.index + 1)
                    }
                };
                let (next, layer) = (own.start, options.layer.clone());
                (Source::Files { pattern, all, own, tone, layer }, next)
            }
            None => {
                let file: Box<dyn Read> = if path.as_os_str() == "-" {
                    Box::new(io::stdin())
                } else if is_stream(path) {
                    let file = File::open(path)
                        .map_err(|error| Failure::at(path, format!("cannot be read: {error}")))?;
                    Box::new(file)
                } else {
                    let reason = "is neither numbered files, such as in/%04d.png, nor a .y4m file";
                    return Err(Failure::at(path, reason));
                };
                let reader =
                    Reader::new(file, tone).map_err(|error| report::of_input(path, error))?;
                (Source::Stream { path: path.clone(), reader: Box::new(reader) }, 1)
            }
        };
        let (held, size, quiet, told) = (None, None, options.quiet, Vec::new());
        Ok(Self { source, importance, next, held, size, quiet, told })
    }

    /// Frames a second, of a stream.
    pub(crate) fn rate(&self) -> Option<Rate> {
        match &self.source {
            Source::Files { .. } => None,
            Source::Stream { reader, .. } => Some(reader.rate()),
        }
    }

    /// How many frames there will be, if that is known.
    pub(crate) fn count(&self) -> Option<u64> {
        match &self.source {
            Source::Files { own, .. } => Some(own.end - own.start),
            Source::Stream { .. } => None,
        }
    }

    /// The number of the next frame.
    pub(crate) fn next_number(&self) -> u64 {
        self.next
    }

    /// The file of the next frame, if it has one of its own.
    pub(crate) fn next_file(&self) -> Option<PathBuf> {
        match &self.source {
            Source::Files { pattern, .. } => Some(pattern.path(self.next)),
            Source::Stream { .. } => None,
        }
    }

    /// The first frame of all parts that is not blank, to be asked for before the first frame; `None` if all are.
    ///
    /// # Errors
    /// [`Failure`], also if there is no frame.
    pub(crate) fn first(&mut self) -> Result<Option<&Picture>, Failure> {
        let mut number = match &self.source {
            Source::Files { all, .. } => all.start,
            Source::Stream { .. } => 1,
        };
        loop {
            match self.read(number)? {
                None if number == 1 && self.size.is_none() => {
                    return Err(report::of_input(self.name(), "has no frames"));
                }
                None => return Ok(None),
                Some(picture) if picture.importance.iter().any(|&pixel| pixel > 0.0) => {
                    return Ok(Some(&self.held.insert((number, picture)).1));
                }
                Some(_) => number += 1,
            }
        }
    }

    /// The next frame; `None` if there are no more.
    ///
    /// # Errors
    /// [`Failure`].
    pub(crate) fn frame(&mut self) -> Result<Option<Frame>, Failure> {
        let number = self.next;
        if let Source::Files { own, .. } = &self.source
            && number >= own.end
        {
            return Ok(None);
        }
        let file = self.next_file();
        let picture = match (self.held.take(), &self.source) {
            (Some((at, picture)), _) if at == number => Some(picture),
            (held @ Some(_), Source::Stream { .. }) => {
                self.held = held;
                Some(self.blank())
            }
            (held, Source::Files { .. }) => {
                self.held = held;
                self.read(number)?
            }
            (None, Source::Stream { .. }) => self.read(number)?,
        };
        self.next += 1;
        Ok(picture.map(|picture| Frame { number, file, picture }))
    }

    /// Reads a frame, of a stream the next one.
    fn read(&mut self, number: u64) -> Result<Option<Picture>, Failure> {
        let (path, mut picture) = match &mut self.source {
            Source::Files { all, .. } if !all.contains(&number) => return Ok(None),
            Source::Files { pattern, tone, layer, .. } => {
                let path = pattern.path(number);
                let picture = picture::read_layer(&path, *tone, layer.as_deref())
                    .map_err(|error| Failure::at(&path, error))?;
                (path, picture)
            }
            Source::Stream { path, reader } => {
                let picture = reader.frame().map_err(|error| report::of_input(path, error))?;
                let Some(picture) = picture else { return Ok(None) };
                (path.clone(), picture)
            }
        };
        let size = (picture.width, picture.height);
        let (width, height) = *self.size.get_or_insert(size);
        if size != (width, height) {
            let (w, h) = size;
            let reason =
                format!("has {w} x {h} pixels, but the first frame has {width} x {height}");
            return Err(report::of_input(&path, reason));
        }
        if !self.quiet {
            picture.warnings.retain(|warning| !self.told.contains(warning));
            report::warn(&path, &picture.warnings);
            self.told.append(&mut picture.warnings);
        }
        self.importance.of_darkness(&mut picture.importance);
        Ok(Some(picture))
    }

    fn blank(&self) -> Picture {
        let (width, height) = self.size.unwrap_or((1, 1));
        let importance = vec![0.0; width * height];
        Picture { width, height, importance, range: None, warnings: Vec::new() }
    }

    /// What all frames are in.
    fn name(&self) -> &Path {
        match &self.source {
            Source::Files { .. } => Path::new("FRAMES"),
            Source::Stream { path, .. } => path,
        }
    }
}

/// Whether this is the name of a stream.
pub(crate) fn is_stream(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("y4m"))
}
