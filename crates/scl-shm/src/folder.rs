//! The files of a node: their folder, their names, the lock, and the removal of unused ones.

use crate::error::ShmError;
use crate::limits::FOLDER;
use iceoryx2::config::Config;
use iceoryx2::node::{Node, NodeState};
use iceoryx2::prelude::{CallbackProgression, FileName, Path as EnginePath, SemanticString};
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use rustix::fs::{FlockOperation, flock};
use std::fs::{self, DirBuilder, File, OpenOptions, Permissions};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};

/// The name of the folder inside the system's folder. Endpoints have full stops in their names, so none clashes with
/// it.
const NAME: &str = "shm";
/// The longest path of that folder: the engine appends up to 90 bytes, and allows 255.
const LONGEST: usize = 160;

/// The folder of the engine's files in a system's folder.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// Prefix of the names of all files in [`FOLDER`], which belongs to no system. The prefix identifies the user and
    /// the folder.
    prefix: String,
}

impl Folder {
    pub(crate) fn create(system: &Path) -> Result<Self, ShmError> {
        let path = system.join(NAME);
        if path.as_os_str().len() > LONGEST {
            return Err(ShmError::Path { path });
        }
        match DirBuilder::new().mode(0o700).create(&path) {
            Err(source) if source.kind() != io::ErrorKind::AlreadyExists => {
                return Err(ShmError::Io { action: "create", path, source });
            }
            _ => {}
        }
        let user = rustix::process::geteuid().as_raw();
        let prefix = format!("scl_{user}_{:016x}_", hash(path.as_os_str().as_bytes()));
        Ok(Self { path, prefix })
    }

    /// Returns true if this is the folder of this system.
    pub(crate) fn is_of(&self, system: &Path) -> bool {
        self.path.parent() == Some(system)
    }

    /// Returns true if it was removed.
    pub(crate) fn is_gone(&self) -> bool {
        matches!(fs::symlink_metadata(&self.path), Err(error) if error.kind() == io::ErrorKind::NotFound)
    }

    #[cfg(test)]
    pub(crate) fn prefix(&self) -> &str {
        &self.prefix
    }

    /// Waits until no other program creates, cleans up or removes files here, and locks the folder until the returned
    /// value is dropped.
    pub(crate) fn lock(&self) -> Result<File, ShmError> {
        let path = self.path.join("lock");
        let failed = |action, source| ShmError::Io { action, path: path.clone(), source };
        let file = OpenOptions::new().write(true).create(true).truncate(false).mode(0o600).open(&path);
        let file = file.map_err(|source| failed("create", source))?;
        flock(&file, FlockOperation::LockExclusive).map_err(|error| failed("lock", error.into()))?;
        Ok(file)
    }

    pub(crate) fn config(&self) -> Result<Config, ShmError> {
        let path = || ShmError::Path { path: self.path.clone() };
        let mut config = Config::default();
        config.global.set_root_path(&EnginePath::new(self.path.as_os_str().as_bytes()).map_err(|_| path())?);
        config.global.prefix = FileName::new(self.prefix.as_bytes()).map_err(|_| path())?;
        config.global.service.cleanup_dead_nodes_on_open = false;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        // The engine warns if this is less than the number of views that may be kept.
        config.defaults.publish_subscribe.subscriber_expired_connection_buffer = 1024;
        Ok(config)
    }

    /// Refuses files of other users, who could have guessed the prefix.
    pub(crate) fn check_owners(&self) -> Result<(), ShmError> {
        let user = rustix::process::geteuid().as_raw();
        for path in self.files() {
            // Another process may have removed the file in the meantime.
            let Ok(found) = fs::symlink_metadata(&path) else { continue };
            if found.uid() != user {
                return Err(ShmError::Foreign { path, owner: found.uid() });
            }
        }
        Ok(())
    }

    /// Removes the access rights of other users. The engine leaves one file accessible to everyone, its counter of
    /// nodes: a user who can write to it can truncate it, and so crash the next program that reads it.
    pub(crate) fn close_to_others(&self) {
        for path in self.files() {
            // Another process may have removed the file in the meantime.
            let Ok(found) = fs::symlink_metadata(&path) else { continue };
            if found.mode() & 0o077 != 0 {
                let _has_gone = fs::set_permissions(&path, Permissions::from_mode(0o600));
            }
        }
    }

    /// Removes all files, including those of killed programs, if no running program has a node here any more. The
    /// caller must hold the lock.
    pub(crate) fn remove_if_unused(&self) {
        let Ok(config) = self.config() else { return };
        let mut used = false;
        let listed = Node::<Engine>::list(&config, |state| {
            // While the lock is held, no program creates or removes a node. So a node whose state the engine cannot
            // determine belongs to a program that was killed.
            used |= matches!(state, NodeState::Alive(_));
            CallbackProgression::Continue
        });
        if used || listed.is_err() {
            return;
        }
        // The next program tries again to remove what cannot be removed now.
        for path in self.files() {
            let _stays = fs::remove_file(path);
        }
        for path in [&config.global.node.directory, &config.global.service.directory] {
            let _stays = fs::remove_dir_all(self.path.join(path.to_string()));
        }
    }

    /// The files outside the folder, in [`FOLDER`].
    pub(crate) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let entries = fs::read_dir(FOLDER).into_iter().flatten().flatten();
        let is_ours = |name: &std::ffi::OsStr| name.as_bytes().starts_with(self.prefix.as_bytes());
        entries.filter(move |entry| is_ours(&entry.file_name())).map(|entry| entry.path())
    }
}

/// FNV-1a: the same in every program of the system, whatever it was built with.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
