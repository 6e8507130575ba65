//! Events in the folder of a system: which components' files were published, closed or removed.

use crate::runtime_dir::{RuntimeDirError, SystemDir};
use rustix::fs::inotify::{self, CreateFlags, ReadFlags, Reader, WatchFlags};
use rustix::io::Errno;
use std::collections::BTreeMap;
use std::io;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use tokio::io::unix::AsyncFd;

/// Watches a system's folder with inotify.
#[derive(Debug)]
pub(super) struct FolderEvents {
    inotify: AsyncFd<OwnedFd>,
}

/// What has happened in the folder.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Happened {
    /// Something about these components; of some, a file was removed.
    To(BTreeMap<String, bool>),
    /// The folder is gone, or events were lost: look at everything, and watch anew.
    Unknown,
}

impl FolderEvents {
    /// Starts watching. Must be called inside a tokio runtime.
    pub(super) fn start(dir: &SystemDir) -> Result<Self, RuntimeDirError> {
        let failed = |error: io::Error| RuntimeDirError::io("watch", dir.folder(), error);
        let start = || {
            let inotify = inotify::init(CreateFlags::CLOEXEC | CreateFlags::NONBLOCK)?;
            // A process that ends, however it does, closes its component's lock, which was opened for writing.
            let events = WatchFlags::MOVED_TO | WatchFlags::DELETE | WatchFlags::CLOSE_WRITE;
            let gone = WatchFlags::DELETE_SELF | WatchFlags::MOVE_SELF;
            inotify::add_watch(&inotify, dir.folder(), events | gone | WatchFlags::DONT_FOLLOW)?;
            Ok(inotify)
        };
        let inotify = start().map_err(|errno: Errno| failed(errno.into()))?;
        #[expect(deprecated, reason = "unsound only for types that change their descriptor; an `OwnedFd` keeps it")]
        let inotify = AsyncFd::new(inotify).map_err(failed)?;
        Ok(Self { inotify })
    }

    /// Waits for events about components.
    pub(super) async fn next(&self) -> Happened {
        loop {
            let Ok(mut ready) = self.inotify.readable().await else { return Happened::Unknown };
            match ready.try_io(|inotify| read(inotify.get_ref())) {
                Ok(Ok(Happened::To(components))) if components.is_empty() => {}
                Ok(happened) => return happened.unwrap_or(Happened::Unknown),
                Err(_would_block) => {}
            }
        }
    }
}

fn read(inotify: &OwnedFd) -> io::Result<Happened> {
    let mut buffer = [MaybeUninit::uninit(); 16384];
    let mut events = Reader::new(inotify, &mut buffer);
    let mut components = BTreeMap::new();
    loop {
        let event = events.next()?;
        let gone = ReadFlags::DELETE_SELF | ReadFlags::MOVE_SELF | ReadFlags::IGNORED | ReadFlags::QUEUE_OVERFLOW;
        if event.events().intersects(gone) {
            return Ok(Happened::Unknown);
        }
        let name = event.file_name().and_then(|name| name.to_str().ok()).unwrap_or_default();
        let component = name.strip_suffix(".lock").or_else(|| name.strip_suffix(".json"));
        if let Some(component) = component {
            *components.entry(component.to_owned()).or_default() |= event.events().contains(ReadFlags::DELETE);
        }
        if events.is_buffer_empty() {
            return Ok(Happened::To(components));
        }
    }
}
