//! The runtime folder of a test, and what programs keep outside of it.

use crate::shared_memory::FOLDER;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A runtime folder, which ends with all that its systems keep in shared memory: killed programs leave files.
pub(crate) struct RuntimeFolder(TempDir);

impl RuntimeFolder {
    pub(crate) fn new() -> Self {
        Self(TempDir::with_prefix("scl").expect("a folder for the test"))
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    /// The files in shared memory of one of the folder's systems.
    pub(crate) fn shared_files(&self, system: &str) -> Vec<PathBuf> {
        let prefix = self.shared_prefix(system);
        let entries = fs::read_dir(FOLDER).expect("shared memory");
        let paths = entries.flatten().map(|entry| entry.path());
        let is_ours = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&prefix));
        paths.filter(is_ours).collect()
    }

    /// What their names begin with: the user, and a hash (FNV-1a) of the folder.
    pub(crate) fn shared_prefix(&self, system: &str) -> String {
        let folder = self.path().join(system).join("shm");
        let bytes = folder.as_os_str().as_encoded_bytes();
        let mix = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix);
        format!("scl_{}_{hash:016x}_", rustix::process::geteuid().as_raw())
    }
}

impl Drop for RuntimeFolder {
    fn drop(&mut self) {
        let systems = fs::read_dir(self.path()).into_iter().flatten().flatten();
        for file in systems.flat_map(|system| self.shared_files(&system.file_name().to_string_lossy())) {
            // One that a program has removed meanwhile is gone, too.
            let _removed = fs::remove_file(file);
        }
    }
}
