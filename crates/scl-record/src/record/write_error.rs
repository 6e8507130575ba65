//! Why a recording cannot continue, and the error for the user.

use mcap::McapError;
use rustix::io::Errno;
use scl_terminal::Problem;
use std::io;
use std::path::Path;

/// Why a recording cannot continue.
#[derive(Debug)]
pub(crate) enum WriteError {
    /// No room for the message; it was not written, and the file can be finished.
    Full(io::Error),
    /// The file no longer has its name; it can be finished.
    Moved(&'static str),
    /// The file is damaged after its last flush, and has no index.
    Failed(McapError),
}

impl WriteError {
    /// Returns the error for the user, which begins with `what`: `recording stopped`.
    pub(crate) fn problem(&self, what: &str, path: &Path) -> Problem {
        let path = path.display();
        match self {
            Self::Full(error) => {
                let reason = match Errno::from_io_error(error) {
                    Some(Errno::DQUOT) => "the disk quota is used up".to_owned(),
                    Some(Errno::FBIG) => "the file has reached the largest allowed size (`ulimit -f`)".to_owned(),
                    Some(Errno::NOSPC) => "the disk is full".to_owned(),
                    _ => error.to_string(),
                };
                Problem::new(format!("{what}: {reason}")).at(path.to_string())
            }
            Self::Moved(fault) => {
                Problem::new(format!("{what}: {fault} while it was being written")).at(path.to_string())
            }
            Self::Failed(error) => Problem::new(format!("{what}: cannot write: {}", text_of(error)))
                .at(path.to_string())
                .help(format!("`scl recover {path}` rebuilds the index of what was written")),
        }
    }
}

impl From<McapError> for WriteError {
    fn from(error: McapError) -> Self {
        Self::Failed(error)
    }
}

/// Returns the text of an error; for an I/O error, only the operating system's text.
pub(crate) fn text_of(error: &McapError) -> String {
    match error {
        McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}
