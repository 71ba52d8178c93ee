//! The one kind of error a subcommand hands back: which file (or option) and why, on one line.

use std::error::Error;
use std::fmt;
use std::path::Path;

/// An error as the user sees it: `SUBJECT: reason`, always a single line.
#[derive(Debug)]
pub struct Failure {
    /// The file, folder or option that the reason is about.
    subject: String,
    reason: Box<dyn Error>,
}

impl Failure {
    /// A failure about the file or folder at `path`.
    pub fn at(path: &Path, reason: impl Into<Box<dyn Error>>) -> Self {
        Self { subject: path.to_string_lossy().into_owned(), reason: reason.into() }
    }

    /// A failure about something with a name of its own, such as an option or standard output.
    pub fn about(subject: &str, reason: impl Into<Box<dyn Error>>) -> Self {
        Self { subject: subject.to_owned(), reason: reason.into() }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        // File names may hold line breaks and terminal escapes, and so may a library's message.
        for part in [&self.subject, ": ", &self.reason.to_string()] {
            for character in part.chars() {
                match character {
                    '\n' | '\r' | '\t' => out.write_str(" ")?,
                    c if c.is_control() => write!(out, "{}", c.escape_default())?,
                    c => write!(out, "{c}")?,
                }
            }
        }
        Ok(())
    }
}

impl Error for Failure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(self.reason.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stays_on_one_line_whatever_the_file_is_called() {
        let failure = Failure::at(Path::new("a\nb\u{1b}[31m.png"), "bad\r\nheader");
        assert_eq!(failure.to_string(), "a b\\u{1b}[31m.png: bad  header");
    }
}
