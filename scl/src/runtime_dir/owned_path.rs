//! Files and sockets that are removed together with the value that created them.

use rustix::fs::{Mode, OFlags};
use scl_fork::ProcessMark;
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Removes a file or socket when dropped, if it is still the one that this process put there.
///
/// A file that another process has put in its place stays. In a forked child, dropping does nothing.
#[derive(Debug)]
pub struct OwnedPath {
    path: PathBuf,
    // Kept open because an open file keeps its inode number after it was replaced: the number that `is_ours` compares
    // can never become that of another file.
    opened: File,
    process: ProcessMark,
    /// Whether it stays when this is dropped.
    stays: bool,
}

impl OwnedPath {
    /// Opens the file at `now`, which is about to be renamed to `path`.
    pub(super) fn open(now: &Path, path: &Path, access: OFlags) -> io::Result<Self> {
        let flags = access | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let opened = rustix::fs::open(now, flags, Mode::empty())?.into();
        Ok(Self { path: path.to_owned(), opened, process: ProcessMark::new(), stays: false })
    }

    /// Leaves the file where it is when this is dropped.
    pub(super) fn stay(mut self) -> Self {
        self.stays = true;
        self
    }

    /// Returns the file, for reading its attributes, or for writing if it was opened with that access.
    pub(super) fn file(&self) -> &File {
        &self.opened
    }

    /// Returns true if the path still leads to the file that this process put there.
    pub fn is_ours(&self) -> bool {
        match (self.opened.metadata(), fs::symlink_metadata(&self.path)) {
            (Ok(ours), Ok(found)) => (ours.dev(), ours.ino()) == (found.dev(), found.ino()),
            _ => false,
        }
    }

    /// Returns the path.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for OwnedPath {
    fn drop(&mut self) {
        // Nobody can replace the file between the check and the removal: that takes the component's lock, which this
        // process still holds. A file that cannot be removed is replaced at the next start.
        if self.process.is_own() && !self.stays && self.is_ours() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forked_child_removes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.json");
        fs::write(&path, "").unwrap();
        let mut inherited = OwnedPath::open(&path, &path, OFlags::PATH).unwrap();
        inherited.process = ProcessMark::inherited();
        drop(inherited);
        assert!(path.exists());
        drop(OwnedPath::open(&path, &path, OFlags::PATH).unwrap());
        assert!(!path.exists());
    }
}
