//! `twelvefold tiling`: every tile of one level as CSV, depth first and in constant memory.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use twelvefold::Tables;
use twelvefold::tiling::{FCode, MAX_LEVEL, Rules, Tile, TileCounts, TileType};
use twelvefold_lab::paper::{LAMBDA, normalized_threshold};

use crate::args::TilingOptions;
use twelvefold_files::failure::Failure;
use twelvefold_files::output::{Output, OutputError};

const HEADER: &str = "fcode,tile,rotation,z0,z1,z2,z3,rank,threshold,x,y";

/// Runs the subcommand.
pub(crate) fn run(options: &TilingOptions) -> Result<(), Failure> {
    let TilingOptions { root, levels, output } = options;
    // Before the output is opened, so that a level past the last leaves nothing behind.
    TileCounts::of(*root).at(*levels).map_err(|error| Failure::about("--levels", error))?;
    let file = output.as_deref().filter(|path| *path != Path::new("-"));
    let open = || match file {
        Some(path) => Output::create(path),
        None => Ok(Output::standard()),
    };
    match open().and_then(|output| write_whole(*root, *levels, output)) {
        // A reader that has seen enough and closed the pipe is no error.
        Err(OutputError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|error| match file {
            Some(path) => Failure::at(path, error),
            None => Failure::about("standard output", error),
        }),
    }
}

fn write_whole(root: TileType, levels: usize, output: Output) -> Result<(), OutputError> {
    let mut writer = BufWriter::with_capacity(1 << 16, output);
    write_level(&Tables::built_in().rules(), root, levels, &mut writer)?;
    writer.into_inner().map_err(io::IntoInnerError::into_error)?.commit()
}

/// Writes the header and the tiles `levels` below `root`.
fn write_level(
    rules: &Rules,
    root: TileType,
    levels: usize,
    output: &mut impl Write,
) -> io::Result<()> {
    writeln!(output, "{HEADER}")?;
    let mut rows = Rows {
        rules,
        root,
        // The newest of `levels` digits comes first, so the oldest is written last.
        newest_first: [0; MAX_LEVEL],
        levels,
        edge: (0..levels).fold(1.0, |edge, _| edge / LAMBDA),
        output,
    };
    rows.descend(&Tile::root(root), 0)
}

/// One depth-first pass; the recursion is [`MAX_LEVEL`] deep at most.
struct Rows<'a, W> {
    rules: &'a Rules,
    root: TileType,
    newest_first: [u8; MAX_LEVEL],
    levels: usize,
    /// The edge of the level that is listed, in edges of the root.
    edge: f64,
    output: &'a mut W,
}

impl<W: Write> Rows<'_, W> {
    fn descend(&mut self, tile: &Tile, level: usize) -> io::Result<()> {
        if level == self.levels {
            return self.write(tile);
        }
        for digit in 0..tile.kind.child_count() as u8 {
            self.newest_first[self.levels - 1 - level] = digit;
            let child = self.rules.child_of(tile, digit).map_err(io::Error::other)?;
            if let Some(child) = child {
                self.descend(&child, level + 1)?;
            }
        }
        Ok(())
    }

    fn write(&mut self, tile: &Tile) -> io::Result<()> {
        let code = FCode::from_newest_first(self.root, &self.newest_first[..self.levels])
            .map_err(io::Error::other)?;
        let [z0, z1, z2, z3] = tile.center.0;
        let [x, y] = tile.center.to_f64().map(|v| v * self.edge);
        writeln!(
            self.output,
            "{code},{},{},{z0},{z1},{z2},{z3},{},{},{x},{y}",
            tile.kind.letter(),
            tile.rotation,
            code.rank(),
            normalized_threshold(&code),
        )
    }
}
