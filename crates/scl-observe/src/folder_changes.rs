//! Detects whether files in a folder were added, replaced or removed, with one `stat` now and then.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

/// Longer than two ticks of the clock for file timestamps: after a more recent change, another one may follow with the
/// same timestamp.
const SAME_TIME: Duration = Duration::from_millis(50);

/// Watches a folder, which may be missing, removed and created again.
#[derive(Debug)]
pub(crate) struct FolderChanges {
    folder: PathBuf,
    /// Inode of the folder and time of its last change; `None` if that is too recent to distinguish the next change
    /// from it.
    seen: Option<(u64, SystemTime)>,
    is_first: bool,
}

impl FolderChanges {
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self { folder, seen: None, is_first: true }
    }

    /// Returns true if the folder may have changed since the last call; at the first call, always.
    pub(crate) fn look(&mut self) -> bool {
        let found = fs::metadata(&self.folder).ok();
        let now = found.as_ref().and_then(|found| Some((found.ino(), found.modified().ok()?)));
        // A time in the future says nothing: the clock was set back, or is that of a simulation.
        let is_young = now.is_some_and(|(_, changed)| changed.elapsed().map_or(true, |age| age < SAME_TIME));
        let changed = std::mem::take(&mut self.is_first) || now != self.seen;
        self.seen = now.filter(|_| !is_young);
        changed
    }
}
