//! Files and sockets under temporary names, so that they appear under their own names complete and in one step.

use super::error::RuntimeDirError;
use super::owned_path::OwnedPath;
use rustix::fs::OFlags;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime};

/// Length of a temporary name: a full stop and six digits.
pub(super) const NAME_BYTES: usize = 7;

/// Temporary entries exist for microseconds; older ones belong to killed processes. Judging by age instead of by
/// process id also works where containers with their own process ids share the folder.
const STALE_AFTER: Duration = Duration::from_secs(60);

/// Maximum number of names to try. Each one that is taken was left behind by a killed process, or is in use right now.
const ATTEMPTS: usize = 64;

static NEXT: AtomicU32 = AtomicU32::new(0);

/// A file or socket under a temporary name, removed when dropped unless it has been renamed.
#[derive(Debug)]
pub(super) struct TempEntry {
    path: PathBuf,
    renamed: bool,
}

impl TempEntry {
    /// Calls `create` with unused temporary names in `folder`. It must fail if the name is taken.
    pub(super) fn create<T>(folder: &Path, mut create: impl FnMut(&Path) -> io::Result<T>) -> io::Result<(Self, T)> {
        let mut attempts = 0;
        loop {
            let path = folder.join(temporary_name());
            attempts += 1;
            match create(&path) {
                Ok(created) => return Ok((Self { path, renamed: false }, created)),
                Err(error) if is_taken(&error) && attempts < ATTEMPTS => {}
                Err(error) => return Err(error),
            }
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Renames it to `path`, replacing what is there. The returned value has the file open, with this access; dropping
    /// it removes the file.
    pub(super) fn rename(self, path: &Path, access: OFlags) -> Result<OwnedPath, RuntimeDirError> {
        let owned = OwnedPath::open(&self.path, path, access);
        let owned = owned.map_err(|error| RuntimeDirError::io("open", &self.path, error))?;
        self.rename_and_keep(path)?;
        Ok(owned)
    }

    /// Renames it to `path`, replacing what is there. It stays after this process has ended.
    pub(super) fn rename_and_keep(mut self, path: &Path) -> Result<(), RuntimeDirError> {
        fs::rename(&self.path, path).map_err(|error| RuntimeDirError::io("replace", path, error))?;
        self.renamed = true;
        Ok(())
    }
}

impl Drop for TempEntry {
    fn drop(&mut self) {
        // After a rename, another process may be using the temporary name.
        if !self.renamed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Removes the temporary entries of killed processes. Entries that cannot be removed do no damage.
pub(super) fn remove_stale_entries(folder: &Path, now: SystemTime) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_stale = || {
            let modified = entry.metadata().and_then(|metadata| metadata.modified()).ok()?;
            Some(now.duration_since(modified).ok()? > STALE_AFTER)
        };
        if entry.file_name().as_encoded_bytes().starts_with(b".") && is_stale() == Some(true) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns a short name, because the path of a socket must not exceed the limit under its temporary name either.
/// Starting from the process id makes it rare that two processes try the same name.
fn temporary_name() -> String {
    let start = std::process::id().wrapping_mul(0x9e37_79b1) >> 8;
    let number = start.wrapping_add(NEXT.fetch_add(1, Ordering::Relaxed));
    format!(".{:06x}", number & 0xff_ffff)
}

fn is_taken(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::AlreadyExists | io::ErrorKind::AddrInUse)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path) -> io::Result<fs::File> {
        fs::File::create_new(path)
    }

    fn count(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn an_entry_is_removed_unless_it_was_renamed() {
        let folder = tempfile::tempdir().unwrap();
        let create = || TempEntry::create(folder.path(), write).unwrap().0;
        let entry = create();
        assert_eq!(entry.path().file_name().unwrap().len(), NAME_BYTES);
        drop(entry);
        assert_eq!(count(folder.path()), 0);
        create().rename_and_keep(&folder.path().join("kept")).unwrap();
        let owned = create().rename(&folder.path().join("owned"), OFlags::PATH).unwrap();
        assert_eq!(count(folder.path()), 2);
        drop(owned);
        assert_eq!(count(folder.path()), 1);
    }

    #[test]
    fn a_limited_number_of_taken_names_is_skipped() {
        let folder = tempfile::tempdir().unwrap();
        let mut calls = 0;
        let mut succeeds_at = |attempt| {
            calls = 0;
            TempEntry::create(folder.path(), |path| {
                calls += 1;
                if calls < attempt { Err(io::ErrorKind::AddrInUse.into()) } else { write(path) }
            })
            .is_ok()
        };
        assert!(succeeds_at(ATTEMPTS));
        assert!(!succeeds_at(ATTEMPTS + 1));
    }

    #[test]
    fn only_stale_temporary_entries_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".00000a", "sensor.lock"] {
            write(&folder.path().join(name)).unwrap();
        }
        let created = SystemTime::now();
        remove_stale_entries(folder.path(), created + STALE_AFTER / 2);
        assert_eq!(count(folder.path()), 2);
        remove_stale_entries(folder.path(), created + STALE_AFTER * 2);
        assert_eq!(count(folder.path()), 1);
        assert!(folder.path().join("sensor.lock").exists());
    }
}
