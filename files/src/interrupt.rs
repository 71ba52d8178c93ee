//! A run that is interrupted takes its unfinished file with it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, Once, PoisonError};

/// What shells report of a command that the user interrupted: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

/// The file to remove when the run is interrupted.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// While it lives, an interrupt (or a request to end, or a closed terminal) removes a file before the
/// program ends. There is at most one such file at a time.
#[derive(Debug)]
pub(crate) struct Unfinished(());

impl Unfinished {
    /// Begins to watch over the file at `path`.
    pub(crate) fn new(path: &Path) -> Self {
        static HANDLER: Once = Once::new();
        HANDLER.call_once(|| {
            // Without a handler an interrupt still ends the program; it only leaves the file.
            let _ = ctrlc::set_handler(|| {
                if let Some(path) = replace(None) {
                    let _ = fs::remove_file(path);
                }
                process::exit(INTERRUPTED);
            });
        });
        replace(Some(path.to_owned()));
        Self(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        replace(None);
    }
}

fn replace(path: Option<PathBuf>) -> Option<PathBuf> {
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    std::mem::replace(&mut *unfinished, path)
}
