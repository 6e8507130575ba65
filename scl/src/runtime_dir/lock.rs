//! The lock of a component: it is run by one process at a time.

use super::SystemDir;
use super::error::{ComponentProcess, RuntimeDirError};
use super::held_locks::{Attempt, FileId, lock_holder, try_lock, unlock};
use scl_fork::ProcessMark;
use scl_text::gate_name::in_file_name;
use std::fs;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};

/// The right to run a component, held by one process at a time.
///
/// The operating system releases it when the process ends, however it ends. Drop it last, after everything that was
/// bound. In a forked child, dropping does nothing.
#[derive(Debug)]
pub struct ComponentLock {
    component: String,
    path: PathBuf,
    // The file is never removed: a process that has opened it just before the removal would lock the removed file,
    // another would create and lock a new one, and both would run the component.
    file: FileId,
    process: ProcessMark,
}

impl ComponentLock {
    /// Takes the lock of a component, without waiting.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError::AlreadyRunning`] if another process, or another part of this one, holds it; other
    /// [`RuntimeDirError`]s if the file cannot be created.
    pub fn take(dir: &SystemDir, component: &str) -> Result<Self, RuntimeDirError> {
        let path = dir.file_of(component, ".lock")?;
        match try_lock(&path) {
            Ok(Attempt::Locked(file)) => {
                Ok(Self { component: component.to_owned(), path, file, process: ProcessMark::new() })
            }
            Ok(Attempt::Held(holder)) => {
                Err(RuntimeDirError::AlreadyRunning { component: component.to_owned(), holder, lock: path })
            }
            Err(error) => Err(RuntimeDirError::io("lock", &path, error)),
        }
    }

    /// Returns the process that runs a component, if there is one.
    pub fn holder(dir: &SystemDir, component: &str) -> Option<ComponentProcess> {
        lock_holder(&dir.file_of(component, ".lock").ok()?)
    }

    /// Returns true unless the lock's file was removed or replaced, so that it no longer excludes other processes.
    pub fn is_in_place(&self) -> bool {
        FileId::at(&self.path).is_ok_and(|now| now == self.file)
    }

    /// Removes what a killed process of this component left behind: sockets and files whose names start with the
    /// component's.
    ///
    /// Without this, sockets with the contract of an older build would remain. Must be called before the first socket
    /// is bound.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError::Io`] if the folder cannot be read, or an entry cannot be removed.
    pub fn clear_leftovers(&self) -> Result<(), RuntimeDirError> {
        let Some(folder) = self.path.parent() else { return Ok(()) };
        let unreadable = |error| RuntimeDirError::io("read the folder", folder, error);
        for entry in fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            if self.is_leftover(&path) {
                fs::remove_file(&path).map_err(|error| RuntimeDirError::io("remove the old", &path, error))?;
            }
        }
        Ok(())
    }

    fn is_leftover(&self, path: &Path) -> bool {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let own = name.strip_prefix(&in_file_name(&self.component)).is_some_and(|rest| rest.starts_with('.'));
        let is_socket = || fs::symlink_metadata(path).is_ok_and(|found| found.file_type().is_socket());
        own && ([".tcp", ".json", ".stats", ".values"].iter().any(|ending| name.ends_with(ending)) || is_socket())
    }
}

impl Drop for ComponentLock {
    fn drop(&mut self) {
        if self.process.is_own() {
            unlock(self.file);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime_dir::RuntimeDir;

    #[test]
    fn a_forked_child_releases_nothing() {
        let root = tempfile::tempdir().unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.path().into());
        let dir = RuntimeDir::locate(&variable).unwrap().system("rover").unwrap();
        let mut inherited = ComponentLock::take(&dir, "sensor").unwrap();
        inherited.process = ProcessMark::inherited();
        drop(inherited);
        assert_eq!(ComponentLock::holder(&dir, "sensor"), Some(ComponentProcess::ThisProcess));
    }
}
