//! Events in the folder of a system: which components' files were published, closed or removed.

use crate::runtime_dir::{Inotify, RuntimeDirError, SystemDir};
use rustix::fs::inotify::{Event, ReadFlags, WatchFlags};
use scl_text::gate_name::from_file_name;
use std::collections::BTreeMap;
use std::ffi::CStr;

/// Watches a system's folder with inotify.
#[derive(Debug)]
pub(super) struct FolderEvents {
    inotify: Inotify,
}

/// What has happened in the folder.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum FolderChange {
    /// Files of these components have changed. The value is true if one was removed.
    Components(BTreeMap<String, bool>),
    /// The folder is gone, or events were lost: check every component, and start a new watch.
    Unknown,
}

impl FolderEvents {
    /// Starts watching. Must be called inside a tokio runtime.
    pub(super) fn start(dir: &SystemDir) -> Result<Self, RuntimeDirError> {
        // `CLOSE_WRITE` reports the end of a process: the kernel closes its component's lock file, which it opened for
        // writing.
        let events = WatchFlags::MOVED_TO | WatchFlags::DELETE | WatchFlags::CLOSE_WRITE;
        let gone = WatchFlags::DELETE_SELF | WatchFlags::MOVE_SELF;
        let started = Inotify::new().and_then(|inotify| {
            inotify.watch(dir.folder(), events | gone)?;
            Ok(Self { inotify })
        });
        started.map_err(|error| RuntimeDirError::io("watch", dir.folder(), error))
    }

    /// Waits for events about components.
    pub(super) async fn next(&self) -> FolderChange {
        loop {
            let mut happened = FolderChange::Components(BTreeMap::new());
            if self.inotify.read(|event| happened.add(event)).await.is_err() {
                return FolderChange::Unknown;
            }
            if !matches!(&happened, FolderChange::Components(components) if components.is_empty()) {
                return happened;
            }
        }
    }
}

impl FolderChange {
    fn add(&mut self, event: &Event<'_>) {
        let Self::Components(components) = self else { return };
        let gone = ReadFlags::DELETE_SELF | ReadFlags::MOVE_SELF | ReadFlags::IGNORED | ReadFlags::QUEUE_OVERFLOW;
        if event.events().intersects(gone) {
            *self = Self::Unknown;
            return;
        }
        let name = event.file_name().map_or("", |name| CStr::to_str(name).unwrap_or_default());
        if let Some(component) = name.strip_suffix(".lock").or_else(|| name.strip_suffix(".json")) {
            *components.entry(from_file_name(component)).or_default() |= event.events().contains(ReadFlags::DELETE);
        }
    }
}
