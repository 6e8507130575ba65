//! Reading a log, also while it is written and rotated.

use super::{LogEntry, LogFolder};
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;

/// Reads the entries of a component's log in order, the oldest first.
#[derive(Debug)]
pub struct LogReader {
    folder: LogFolder,
    component: String,
    /// The file that is being read, and its inode number.
    current: Option<(BufReader<File>, u64)>,
    /// Whether `current` was seen to have a successor, so nothing more is written to it.
    is_complete: bool,
    /// A line that has no end yet.
    line: Vec<u8>,
}

impl LogReader {
    /// Creates a reader that starts at the oldest entry. The log need not exist yet.
    pub fn new(folder: &LogFolder, component: &str) -> Self {
        let (folder, component) = (folder.clone(), component.to_owned());
        Self { folder, component, current: None, is_complete: false, line: Vec::new() }
    }

    /// Returns the next entry, or `None` at the current end of the log. A later call returns entries that were written
    /// since. Lines that are not entries are skipped.
    ///
    /// # Errors
    /// A file cannot be opened or read.
    pub fn next_entry(&mut self) -> io::Result<Option<LogEntry>> {
        loop {
            if self.current.is_none() && !self.open_next(None)? {
                return Ok(None);
            }
            let Some((file, id)) = &mut self.current else { return Ok(None) };
            let id = *id;
            file.read_until(b'\n', &mut self.line)?;
            if self.line.ends_with(b"\n") {
                let entry = serde_json::from_slice(&self.line);
                self.line.clear();
                match entry {
                    Ok(entry) => return Ok(Some(entry)),
                    // Skip a line that is not an entry, for example one that a full disk has truncated.
                    Err(_) => continue,
                }
            }
            // End of file. Once a successor exists, read this file to its end once more: lines may have been added just
            // before it was rotated.
            if std::mem::take(&mut self.is_complete) {
                self.line.clear();
                if !self.open_next(Some(id))? {
                    return Ok(None);
                }
            } else if self.has_successor(id) {
                self.is_complete = true;
            } else {
                return Ok(None);
            }
        }
    }

    fn has_successor(&self, id: u64) -> bool {
        let files = self.folder.files_of(&self.component);
        // A file that no longer exists was rotated out, so it has a successor, too.
        files.iter().rev().position(|file| file_id(file) == Some(id)) != Some(0) && !files.is_empty()
    }

    /// Opens the file after the one with this id, or the oldest. Returns false if there is none yet.
    fn open_next(&mut self, after: Option<u64>) -> io::Result<bool> {
        let files = self.folder.files_of(&self.component);
        let position = after.and_then(|id| files.iter().position(|file| file_id(file) == Some(id)));
        let Some(path) = files.get(position.map_or(0, |position| position + 1)) else { return Ok(false) };
        let file = match File::open(path) {
            Ok(file) => file,
            // The file is being rotated.
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
            Err(error) => return Err(error),
        };
        let id = file.metadata()?.ino();
        self.current = Some((BufReader::new(file), id));
        Ok(true)
    }
}

fn file_id(path: &PathBuf) -> Option<u64> {
    fs::metadata(path).ok().map(|found| found.ino())
}

/// The number of the last run in a component's log; 0 if there is none.
pub(super) fn last_run(folder: &LogFolder, component: &str) -> u64 {
    let mut reader = LogReader::new(folder, component);
    let mut last = 0;
    while let Ok(Some(entry)) = reader.next_entry() {
        last = last.max(entry.run);
    }
    last
}
