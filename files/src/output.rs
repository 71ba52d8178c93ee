//! Where a subcommand's result goes: a file that appears whole or not at all, a device, or standard
//! output.

use std::error::Error;
use std::fmt;
use std::fs::{self, File, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempPath};

use crate::interrupt::Unfinished;

/// An open result. Write to it, then [`commit`](Output::commit) it; dropped without a commit, it
/// leaves the folder as it was.
#[derive(Debug)]
pub struct Output {
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    /// A temporary file beside `target`, renamed onto it when complete.
    Whole {
        file: File,
        temporary: TempPath,
        target: PathBuf,
        unfinished: Unfinished,
    },
    /// An existing device or pipe, which is written in place: renaming would put a file where it was.
    InPlace(File),
    Standard(io::Stdout),
}

/// Why a result cannot be written.
#[derive(Debug)]
#[non_exhaustive]
pub enum OutputError {
    /// The target is a folder.
    Folder,
    /// The target is a symbolic link to nothing.
    DanglingLink,
    /// The folder that would hold the target does not exist.
    NoSuchFolder(PathBuf),
    /// The target exists and its permissions forbid writing.
    ReadOnly,
    /// The target is the very file that is being read.
    IsInput,
    /// The system refused.
    Io(io::Error),
}

impl fmt::Display for OutputError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder => out.write_str("is a folder, not a file"),
            Self::DanglingLink => out.write_str("is a link to a file that does not exist"),
            Self::NoSuchFolder(folder) => {
                write!(out, "cannot be written: there is no folder {}", folder.display())
            }
            Self::ReadOnly => out.write_str("exists and is read-only"),
            Self::IsInput => out.write_str("would be replaced, but it is the file to read"),
            Self::Io(error) => write!(out, "cannot be written: {error}"),
        }
    }
}

impl Error for OutputError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for OutputError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl Output {
    /// Opens the file at `path` for writing; nothing at `path` changes before
    /// [`commit`](Self::commit), unless it is a device or a pipe.
    ///
    /// An existing file keeps its permissions, and a link stays a link: the file it leads to is
    /// replaced.
    ///
    /// # Errors
    /// [`OutputError`], one variant for each way that `path` cannot become a file.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let existing = match fs::metadata(path) {
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(error.into()),
        };
        let Some(metadata) = existing else {
            if path.is_symlink() {
                return Err(OutputError::DanglingLink);
            }
            let folder = folder_of(path);
            if !folder.is_dir() {
                return Err(OutputError::NoSuchFolder(folder.to_owned()));
            }
            return Self::beside(path.to_owned(), None);
        };
        if metadata.is_dir() {
            return Err(OutputError::Folder);
        }
        if !metadata.is_file() {
            let file = fs::OpenOptions::new().write(true).open(path)?;
            return Ok(Self { sink: Sink::InPlace(file) });
        }
        if metadata.permissions().readonly() {
            return Err(OutputError::ReadOnly);
        }
        Self::beside(fs::canonicalize(path)?, Some(metadata.permissions()))
    }

    /// Like [`create`](Self::create), for a result made from the file at `input`, which must not be
    /// the target.
    ///
    /// # Errors
    /// [`OutputError::IsInput`] when both are one file, and those of `create`.
    pub fn create_from(path: &Path, input: &Path) -> Result<Self, OutputError> {
        match (fs::canonicalize(path), fs::canonicalize(input)) {
            (Ok(output), Ok(input)) if output == input => Err(OutputError::IsInput),
            _ => Self::create(path),
        }
    }

    /// Standard output.
    pub fn standard() -> Self {
        Self { sink: Sink::Standard(io::stdout()) }
    }

    fn beside(target: PathBuf, permissions: Option<Permissions>) -> Result<Self, OutputError> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".twelvefold-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            // The mode that any new file is asked for with; the system then applies the umask.
            builder.permissions(Permissions::from_mode(0o666));
        }
        let temporary: NamedTempFile = builder.tempfile_in(folder_of(&target))?;
        if let Some(permissions) = permissions {
            temporary.as_file().set_permissions(permissions)?;
        }
        let (file, temporary) = temporary.into_parts();
        let unfinished = Unfinished::new(&temporary);
        Ok(Self { sink: Sink::Whole { file, temporary, target, unfinished } })
    }

    /// Makes everything written so far the content of the target.
    ///
    /// # Errors
    /// The system's, when what was written cannot be stored or renamed; the target is then as before.
    pub fn commit(self) -> Result<(), OutputError> {
        match self.sink {
            Sink::Whole { file, temporary, target, unfinished } => {
                // Some file systems report a full disk only here, and a rename that overtakes the
                // data would leave an empty file after a power cut.
                file.sync_all()?;
                drop(file);
                temporary.persist(target).map_err(|failure| failure.error)?;
                drop(unfinished);
            }
            Sink::InPlace(mut file) => file.flush()?,
            Sink::Standard(mut stdout) => stdout.flush()?,
        }
        Ok(())
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Whole { file, .. } | Sink::InPlace(file) => file.write(bytes),
            Sink::Standard(stdout) => stdout.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Whole { file, .. } | Sink::InPlace(file) => file.flush(),
            Sink::Standard(stdout) => stdout.flush(),
        }
    }
}

/// The folder that holds `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_only_when_committed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        let mut output = Output::create(&path).unwrap();
        output.write_all(b"whole").unwrap();
        assert!(!path.exists());
        output.commit().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn dropped_before_the_commit_it_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        fs::write(&path, "old").unwrap();
        let mut output = Output::create(&path).unwrap();
        output.write_all(b"half").unwrap();
        drop(output);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn folders_and_missing_folders_are_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(Output::create(folder.path()), Err(OutputError::Folder)));
        let missing = folder.path().join("no/out.csv");
        match Output::create(&missing) {
            Err(OutputError::NoSuchFolder(named)) => assert_eq!(named, folder.path().join("no")),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_input_is_never_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let photo = folder.path().join("photo.png");
        fs::write(&photo, "pixels").unwrap();
        let same = folder.path().join(".").join("photo.png");
        assert!(matches!(Output::create_from(&same, &photo), Err(OutputError::IsInput)));
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_a_normal_file_or_of_the_file_replaced() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o7777;

        let normal = folder.path().join("normal");
        File::create(&normal).unwrap();
        let fresh = folder.path().join("fresh.csv");
        Output::create(&fresh).unwrap().commit().unwrap();
        assert_eq!(mode(&fresh), mode(&normal));

        fs::set_permissions(&fresh, Permissions::from_mode(0o640)).unwrap();
        Output::create(&fresh).unwrap().commit().unwrap();
        assert_eq!(mode(&fresh), 0o640);

        fs::set_permissions(&fresh, Permissions::from_mode(0o444)).unwrap();
        assert!(matches!(Output::create(&fresh), Err(OutputError::ReadOnly)));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_leads_to_the_new_content() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file.csv");
        let link = folder.path().join("link.csv");
        std::os::unix::fs::symlink("file.csv", &link).unwrap();
        assert!(matches!(Output::create(&link), Err(OutputError::DanglingLink)));
        fs::write(&file, "old").unwrap();
        let mut output = Output::create(&link).unwrap();
        output.write_all(b"new").unwrap();
        output.commit().unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_written_in_place_and_says_so() {
        let mut output = Output::create(Path::new("/dev/full")).unwrap();
        let error = output.write_all(b"x").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
        assert!(!Path::new("/dev/full").is_file());
    }
}
