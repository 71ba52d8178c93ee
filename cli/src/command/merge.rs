//! `twelvefold merge`: one file from its parts.
//!
//! Every part is looked at before the first byte is written: what kind it is, and whether it can stand where it does.

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};
use twelvefold_stipple::drawing::npy;

use crate::args::MergeOptions;
use crate::report;

/// The length of an array's header, as this program writes it.
const NPY_HEADER: u64 = 128;

const SVG_END: &[u8] = b"</svg>\n";

/// What a part is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Lines of a table, after its header, if it is there.
    Table {
        header: Option<Columns>,
    },
    /// Of a drawing, with or without what goes before and after the dots.
    Drawing {
        head: bool,
        end: bool,
    },
    Array {
        dots: u64,
        columns: usize,
    },
}

/// The columns of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Columns {
    Places,
    PlacesAndPens,
}

/// Why a file is not the part that should be there.
#[derive(Debug)]
enum PartError {
    Io(io::Error),
    Unknown,
    /// It ends in the middle of a line or of a number.
    Incomplete,
    /// The first part has no beginning.
    NoBeginning,
    /// A later part has one.
    Beginning,
    /// The last part of a drawing has no end.
    NoEnd,
    /// An earlier part has one.
    End,
    /// It is of another kind than the first.
    OtherKind,
}

impl fmt::Display for PartError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(out, "cannot be read: {error}"),
            Self::Unknown => out.write_str("is no part of a CSV, SVG or NPY file of this program"),
            Self::Incomplete => out.write_str("ends early"),
            Self::NoBeginning => out.write_str("is not the first part; name the parts in order"),
            Self::Beginning => out.write_str("is a first part, but not named first"),
            Self::NoEnd => out.write_str("is not the last part; name all parts in order"),
            Self::End => out.write_str("is a last part, but not named last"),
            Self::OtherKind => out.write_str("is of another kind than the first part"),
        }
    }
}

impl std::error::Error for PartError {}

impl From<io::Error> for PartError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Runs the subcommand.
pub(crate) fn run(options: &MergeOptions) -> Result<(), Failure> {
    let MergeOptions { parts, output: path } = options;
    let mut kinds = Vec::new();
    for part in parts {
        kinds.push(kind(part).map_err(|error| Failure::at(part, error))?);
    }
    fit(&kinds).map_err(|(index, error)| Failure::at(&parts[index], error))?;
    let output = open(path, parts).map_err(|error| report::of_output(path, error))?;
    copy(parts, &kinds, output, path)
}

/// The output, which is none of the parts.
fn open(path: &Path, parts: &[PathBuf]) -> Result<Output, OutputError> {
    if path.as_os_str() == "-" {
        return Ok(Output::standard());
    }
    for part in &parts[1..] {
        drop(Output::create_from(path, part)?);
    }
    Output::create_from(path, &parts[0])
}

/// What a file is, by its first and last bytes.
fn kind(path: &Path) -> Result<Kind, PartError> {
    let mut file = BufReader::new(File::open(path)?);
    let length = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    let mut head = Vec::new();
    file.by_ref().take(NPY_HEADER).read_to_end(&mut head)?;
    let mut tail = vec![0; SVG_END.len().min(length as usize)];
    file.seek(SeekFrom::End(-(tail.len() as i64)))?;
    file.read_exact(&mut tail)?;
    let ends_line = tail.last().is_none_or(|&byte| byte == b'\n');
    match head.as_slice() {
        _ if head.starts_with(b"\x93NUMPY") => array(&head, length),
        _ if !ends_line => Err(PartError::Incomplete),
        // Part of anything.
        [] => Ok(Kind::Table { header: None }),
        _ if head.starts_with(b"x,y\n") => Ok(Kind::Table { header: Some(Columns::Places) }),
        _ if head.starts_with(b"x,y,pen\n") => {
            Ok(Kind::Table { header: Some(Columns::PlacesAndPens) })
        }
        [b'0'..=b'9' | b'-', ..] => Ok(Kind::Table { header: None }),
        [b'<', ..] => {
            Ok(Kind::Drawing { head: head.starts_with(b"<svg"), end: tail.ends_with(SVG_END) })
        }
        _ => Err(PartError::Unknown),
    }
}

/// The array of which this is the beginning, if the file holds it.
fn array(head: &[u8], length: u64) -> Result<Kind, PartError> {
    if head.len() < NPY_HEADER as usize {
        return Err(PartError::Incomplete);
    }
    for columns in [2, 3] {
        let row = columns as u64 * 4;
        let dots = (length - NPY_HEADER) / row;
        if npy::header(dots as usize, columns) == head {
            return match (length - NPY_HEADER) % row {
                0 => Ok(Kind::Array { dots, columns }),
                _ => Err(PartError::Incomplete),
            };
        }
    }
    // Of this program's arrays, those with another number of dots than their file has room for.
    let array = npy::header(0, 2);
    let common = array.iter().zip(head).take_while(|(a, b)| a == b).count();
    Err(if common > 60 { PartError::Incomplete } else { PartError::Unknown })
}

/// Whether parts of these kinds, in this order, are one file; else the first that does not fit.
fn fit(kinds: &[Kind]) -> Result<(), (usize, PartError)> {
    let last = kinds.len() - 1;
    for (i, kind) in kinds.iter().enumerate() {
        let error = match (kinds[0], *kind) {
            (Kind::Table { header: None }, _) => Some(PartError::NoBeginning),
            (Kind::Table { .. }, Kind::Table { header }) => {
                (i > 0 && header.is_some()).then_some(PartError::Beginning)
            }
            (Kind::Drawing { head: false, .. }, _) => Some(PartError::NoBeginning),
            (Kind::Drawing { .. }, Kind::Drawing { head, end }) => match (i, end) {
                (1.., _) if head => Some(PartError::Beginning),
                (_, true) if i < last => Some(PartError::End),
                (_, false) if i == last => Some(PartError::NoEnd),
                _ => None,
            },
            // A part without dots.
            (Kind::Drawing { .. }, Kind::Table { header: None }) => {
                (i == last).then_some(PartError::NoEnd)
            }
            (Kind::Array { columns, .. }, Kind::Array { columns: others, .. }) => {
                (columns != others).then_some(PartError::OtherKind)
            }
            _ => Some(PartError::OtherKind),
        };
        if let Some(error) = error {
            return Err((i, error));
        }
    }
    Ok(())
}

/// Writes the parts, one after the other.
fn copy(parts: &[PathBuf], kinds: &[Kind], mut output: Output, path: &Path) -> Result<(), Failure> {
    let of_output = |error: io::Error| report::finish(path, Err(error.into()));
    let mut skipped = 0;
    if let Kind::Array { columns, .. } = kinds[0] {
        let dots: u64 = kinds
            .iter()
            .map(|kind| if let Kind::Array { dots, .. } = kind { *dots } else { 0 })
            .sum();
        if let Err(error) = output.write_all(&npy::header(dots as usize, columns)) {
            return of_output(error);
        }
        skipped = NPY_HEADER;
    }
    for part in parts {
        let of_part = |error: io::Error| Failure::at(part, PartError::Io(error));
        let mut file = BufReader::with_capacity(1 << 16, File::open(part).map_err(of_part)?);
        file.seek(SeekFrom::Start(skipped)).map_err(of_part)?;
        loop {
            let bytes = file.fill_buf().map_err(of_part)?;
            if bytes.is_empty() {
                break;
            }
            if let Err(error) = output.write_all(bytes) {
                return of_output(error);
            }
            let read = bytes.len();
            file.consume(read);
        }
    }
    report::finish(path, output.commit())
}
