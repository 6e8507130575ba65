use std::{
    fs,
    io::Write,
    os::unix::fs::{FileTypeExt, OpenOptionsExt},
    path::{Path, PathBuf},
};

use rustix::{
    fs::{FlockOperation, OFlags},
    io::Errno,
};

use super::{SystemDir, error::PlaceError, holder::find_holder};

/// The right to play a component, held by one process at a time.
///
/// The operating system gives it back when the process ends, however it ends. Drop it last, after all that was bound.
#[derive(Debug)]
pub struct ComponentLock {
    component: String,
    path: PathBuf,
    // The lock lasts as long as the file is open. The file itself is never removed: a process that has opened it just
    // before the removal would lock the removed one, another would make and lock a new one, and both would believe that
    // they are alone.
    file: fs::File,
}

impl ComponentLock {
    /// Takes the lock of a component, without waiting, and writes this process's number into it.
    ///
    /// # Errors
    ///
    /// [`PlaceError::AlreadyRunning`] when another program has it; other [`PlaceError`]s when the file cannot be made.
    pub fn take(dir: &SystemDir, component: &str) -> Result<Self, PlaceError> {
        let path = dir.file_of(component, ".lock")?;
        let refused = |error| PlaceError::io("take the lock", &path, error);
        let mut file = open(&path).map_err(refused)?;
        match rustix::fs::flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) => {}
            Err(Errno::WOULDBLOCK) => {
                return Err(PlaceError::AlreadyRunning {
                    component: component.to_owned(),
                    holder: find_holder(&mut file),
                    lock: path,
                });
            }
            Err(error) => return Err(refused(error.into())),
        }
        file.set_len(0).and_then(|()| writeln!(file, "{}", std::process::id())).map_err(refused)?;
        Ok(Self { component: component.to_owned(), path, file })
    }

    /// Removes what an earlier program that played this component could not remove because it was killed: the sockets
    /// and files whose names start with the component's.
    ///
    /// Without this, a component that was rebuilt for another contract would leave the old one's sockets about, and
    /// its peers would believe that it still offers them. To be called before the first socket is bound.
    ///
    /// # Errors
    ///
    /// [`PlaceError::Io`] when the folder cannot be read or something in it cannot be removed.
    pub fn clear_leftovers(&self) -> Result<(), PlaceError> {
        let Some(folder) = self.path.parent() else { return Ok(()) };
        let unreadable = |error| PlaceError::io("look into", folder, error);
        for entry in fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if self.is_leftover(&path) {
                fs::remove_file(&path).map_err(|error| PlaceError::io("remove the old", &path, error))?;
            }
        }
        Ok(())
    }

    fn is_leftover(&self, path: &Path) -> bool {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let own = name.strip_prefix(&self.component).is_some_and(|rest| rest.starts_with('.'));
        let is_socket = || fs::symlink_metadata(path).is_ok_and(|seen| seen.file_type().is_socket());
        own && (name.ends_with(".tcp") || name.ends_with(".json") || is_socket())
    }
}

impl Drop for ComponentLock {
    fn drop(&mut self) {
        // Closing the file is not enough: a program that another thread is just starting has a copy of it for a moment.
        let _ = rustix::fs::flock(&self.file, FlockOperation::Unlock);
    }
}

fn open(path: &Path) -> std::io::Result<fs::File> {
    let flags = OFlags::NOFOLLOW.bits().cast_signed();
    // Not truncated here: until the lock is ours, the number in it is the holder's.
    fs::OpenOptions::new()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .mode(0o600)
        .custom_flags(flags)
        .open(path)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::place::RuntimeDir;

    #[test]
    fn a_copy_of_the_open_file_does_not_outlive_the_lock() {
        let folder = tempfile::tempdir().unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
        let dir = RuntimeDir::locate(&variable).unwrap().system("rover").unwrap();
        let lock = ComponentLock::take(&dir, "sensor").unwrap();
        let copy = lock.file.try_clone().unwrap();
        drop(lock);
        assert!(ComponentLock::take(&dir, "sensor").is_ok());
        drop(copy);
    }
}
