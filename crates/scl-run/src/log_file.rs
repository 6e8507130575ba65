//! The log of each component: what it printed, as JSON lines in files that are rotated by size.
//!
//! ```text
//! $XDG_STATE_HOME/scl/<system>/        default: ~/.local/state/scl/<system>/, mode 0700
//!     <component>.log                  the newest lines
//!     <component>.log.1 ... .log.3     older ones, each of at most 4 MiB
//! ```

mod entry;
mod folder;
mod reader;

pub use entry::{LogEntry, LogStream};
pub use folder::LogFolder;
pub use reader::LogReader;

use super::lock::lock;
use reader::last_run;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// Maximum length of a file in bytes. A file that would become longer is rotated.
const LONGEST_FILE: u64 = 4 << 20;

/// How many full files are kept beside the newest.
const OLDER_FILES: u32 = 3;

/// Maximum length of a line's text in bytes; the rest is counted only.
const LONGEST_TEXT: usize = 64 << 10;

/// The log of one component, shared by the threads that read its two streams.
#[derive(Debug)]
pub(crate) struct LogFile {
    component: String,
    path: PathBuf,
    /// The number of the last process that began each stream: standard output and standard error.
    runs: [AtomicU64; 2],
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    file: Option<File>,
    length: u64,
    /// Whether the last line may be incomplete, so that a line break must come before the next one.
    is_torn: bool,
    has_failed: bool,
}

impl LogFile {
    /// Opens the log of a component, and creates its folder.
    ///
    /// # Errors
    /// If the log cannot be opened. The text names the file.
    pub(crate) fn open(folder: &LogFolder, component: &str) -> Result<Self, String> {
        let path = folder.file_of(component).ok_or_else(|| format!("`{component}` cannot be the name of a file"))?;
        let open = || {
            DirBuilder::new().mode(0o700).recursive(true).create(&folder.path)?;
            let file = open_for_append(&path)?;
            let length = file.metadata()?.len();
            io::Result::Ok((file, length))
        };
        let (file, length) = open().map_err(|error| format!("cannot write `{}`: {error}", path.display()))?;
        let runs = [last_run(folder, component); 2].map(AtomicU64::new);
        // Begin with a new line: a killed process may have left an incomplete one.
        let state = State { file: Some(file), length, is_torn: length > 0, has_failed: false };
        Ok(Self { component: component.to_owned(), path, runs, state: Mutex::new(state) })
    }

    /// Begins a stream of the next process, and returns the number of that process.
    pub(crate) fn begin(&self, stream: LogStream) -> u64 {
        self.runs[stream as usize].fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Adds a line without its line break; `run` is from [`begin`](Self::begin).
    ///
    /// # Errors
    /// The first failure, as a text for the user. Later failures are not reported. Each line is tried: a full disk may
    /// have room later.
    pub(crate) fn write(&self, stream: LogStream, run: u64, text: &[u8]) -> Result<(), String> {
        // Strings and numbers can always be serialized.
        let line = serde_json::to_string(&LogEntry::new(&self.component, stream, run, text)).unwrap_or_default() + "\n";
        let mut state = lock(&self.state);
        let written = state.write(&self.path, line.as_bytes());
        match written {
            Err(error) if !std::mem::replace(&mut state.has_failed, true) => Err(format!(
                "cannot write the log of `{}`: {error}; lines are missing in `{}`",
                self.component,
                self.path.display()
            )),
            _ => Ok(()),
        }
    }
}

impl State {
    fn write(&mut self, path: &Path, line: &[u8]) -> io::Result<()> {
        if self.length > 0 && self.length + line.len() as u64 > LONGEST_FILE {
            // Close the file first: if the rotation fails, the next line that fits reopens and continues it.
            self.file = None;
            rotate(path)?;
        }
        let file = match &mut self.file {
            Some(file) => file,
            None => {
                let file = open_for_append(path)?;
                self.length = file.metadata()?.len();
                self.is_torn = self.length > 0;
                self.file.insert(file)
            }
        };
        if self.is_torn {
            file.write_all(b"\n")?;
            self.length += 1;
        }
        self.is_torn = true;
        file.write_all(line)?;
        self.is_torn = false;
        self.length += line.len() as u64;
        Ok(())
    }
}

fn open_for_append(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).create(true).mode(0o600).open(path)
}

/// `x.log.2` becomes `x.log.3`, and so on; the oldest is replaced.
fn rotate(path: &Path) -> io::Result<()> {
    for number in (0..OLDER_FILES).rev() {
        let from = numbered(path, number);
        match fs::rename(&from, numbered(path, number + 1)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Ok(())
}

/// The file that was rotated this many times.
fn numbered(path: &Path, number: u32) -> PathBuf {
    match number {
        0 => path.to_owned(),
        _ => path.with_added_extension(number.to_string()),
    }
}

#[cfg(test)]
mod tests;
