//! Inspects what is running, for tools: nothing here creates, changes or removes a file.

use super::error::ComponentProcess;
use super::folder::{RuntimeDir, SystemDir, is_plain};
use super::lock::ComponentLock;
use super::schema::SCHEMA_LIMIT;
use super::small_file::read_file;
use bytes::Bytes;
use scl_text::gate_name::from_file_name;
use std::collections::BTreeSet;
use std::fs::{self, FileType};
use std::io;

/// Whether a component runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComponentState {
    /// A process runs it: it holds the component's lock.
    Running(ComponentProcess),
    /// No process runs it, and the last one left its announcement behind: it was killed or has crashed.
    Dead,
    /// No process runs it; the last one, if there was one, has closed it.
    Stopped,
}

impl RuntimeDir {
    /// Returns the names of the systems whose folders are here, sorted. [`SystemDir::state`] tells whether a component
    /// of a system runs.
    ///
    /// # Errors
    ///
    /// The folder cannot be read.
    pub fn systems(&self) -> io::Result<Vec<String>> {
        // Symbolic links are not followed: their targets may belong to another user.
        names(fs::read_dir(self.path())?, |kind, name| Some(name).filter(|_| kind.is_dir()))
    }

    /// Returns the names of the systems of which at least one component runs, sorted.
    ///
    /// # Errors
    ///
    /// The folder cannot be read.
    pub fn running_systems(&self) -> io::Result<Vec<String>> {
        let mut systems = self.systems()?;
        systems.retain(|name| {
            // Skip folders that are unsafe or have disappeared: they cannot be observed.
            let Ok(Some(dir)) = self.existing_system(name) else { return false };
            let components = dir.components().unwrap_or_default();
            components.iter().any(|component| matches!(dir.state(component), ComponentState::Running(_)))
        });
        Ok(systems)
    }
}

impl SystemDir {
    /// Returns the names of the components that run or once ran in this folder, sorted.
    ///
    /// # Errors
    ///
    /// The folder cannot be read, for example because it was removed.
    pub fn components(&self) -> io::Result<Vec<String>> {
        let files = names(fs::read_dir(self.folder())?, |kind, name| {
            name.strip_suffix(".lock").or_else(|| name.strip_suffix(".json")).filter(|_| kind.is_file())
        })?;
        let mut components: Vec<String> = files.iter().map(|name| from_file_name(name)).collect();
        components.sort_unstable();
        Ok(components)
    }

    /// Returns whether a component runs. One that never ran in this folder counts as stopped.
    ///
    /// A component that hangs is running: what it has done lately is in its [`ComponentStats`](super::ComponentStats).
    pub fn state(&self, component: &str) -> ComponentState {
        let holder = || ComponentLock::holder(self, component).map(ComponentState::Running);
        holder().unwrap_or_else(|| match self.has_announcement(component) {
            // Ask again: a component that is just starting takes its lock before it announces itself.
            true => holder().unwrap_or(ComponentState::Dead),
            false => ComponentState::Stopped,
        })
    }

    /// Returns true if a component has announced itself and has not closed since: it runs, or was killed or has
    /// crashed.
    pub(crate) fn has_announcement(&self, component: &str) -> bool {
        let path = self.file_of(component, ".json");
        path.is_ok_and(|path| fs::symlink_metadata(path).is_ok_and(|found| found.is_file()))
    }

    /// Returns the protobuf messages that a program was built with, by the hash in its
    /// [`Announcement::schema`](super::Announcement::schema): a serialized `google.protobuf.FileDescriptorSet`. `None`
    /// if there is no such file or it is longer than 16 MiB. The bytes are not checked.
    pub fn schema(&self, hash: &str) -> Option<Bytes> {
        read_file(&self.schema_file(hash).ok()?, SCHEMA_LIMIT).ok().map(Bytes::from)
    }
}

/// Returns the names that `pick` finds in a folder, each once and sorted. Skips entries that are removed at the same
/// time, and names that SCL never uses.
fn names(entries: fs::ReadDir, pick: impl Fn(FileType, &str) -> Option<&str>) -> io::Result<Vec<String>> {
    let mut found = BTreeSet::new();
    for entry in entries {
        let entry = entry?;
        let (name, kind) = (entry.file_name(), entry.file_type());
        let picked =
            name.to_str().filter(|name| is_plain(&from_file_name(name))).and_then(|name| pick(kind.ok()?, name));
        found.extend(picked.map(str::to_owned));
    }
    found.remove("");
    Ok(found.into_iter().collect())
}
