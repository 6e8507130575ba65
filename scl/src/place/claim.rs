use std::{
    fs, io,
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
};

use rustix::fs::{Mode, OFlags};

/// Removes a file or socket when it is dropped, if it is still the one that this program put there.
///
/// A successor may have taken the name meanwhile; what it put there stays.
#[derive(Debug)]
pub struct Claim {
    path: PathBuf,
    // Open for as long as the claim lasts: a file that is open keeps its inode number, also when it has been replaced,
    // so the number below can never become that of a successor's file.
    kept: fs::File,
}

impl Claim {
    /// A claim on what is at `now`, for when it has been renamed to `path`.
    pub(super) fn on(now: &Path, path: &Path) -> io::Result<Self> {
        let flags = OFlags::PATH | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let kept = rustix::fs::open(now, flags, Mode::empty())?.into();
        Ok(Self { path: path.to_owned(), kept })
    }

    /// Whether the name still leads to what this program put there.
    pub fn is_ours(&self) -> bool {
        match (self.kept.metadata(), fs::symlink_metadata(&self.path)) {
            (Ok(ours), Ok(there)) => (ours.dev(), ours.ino()) == (there.dev(), there.ino()),
            _ => false,
        }
    }

    /// The name that is claimed.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // Between the look and the removal nobody can take the name: whoever binds it holds the component's lock, which
        // this program still does. What cannot be removed is replaced at the next start.
        if self.is_ours() {
            let _ = fs::remove_file(&self.path);
        }
    }
}
