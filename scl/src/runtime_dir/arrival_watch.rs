//! Tells when components announce themselves in the folder of a system.

use super::{Inotify, SystemDir};
use rustix::fs::inotify::{Event, WatchFlags};
use std::ffi::CStr;
use std::io;
use std::task::{Context, Poll};

/// Watches the folder of a system for components that have started.
///
/// It sees nothing any more once the folder was removed.
#[derive(Debug)]
pub struct ArrivalWatch(Inotify);

impl ArrivalWatch {
    /// Starts watching. Must be called inside a tokio runtime.
    ///
    /// # Errors
    ///
    /// The folder does not exist, or the limit of the user for inotify is reached.
    pub fn start(dir: &SystemDir) -> io::Result<Self> {
        let inotify = Inotify::new()?;
        // Announcements are renamed into the folder.
        inotify.watch(dir.folder(), WatchFlags::MOVED_TO)?;
        Ok(Self(inotify))
    }

    /// Returns when a component has announced itself since the last call.
    pub fn poll_arrived(&self, cx: &mut Context<'_>) -> Poll<()> {
        let mut announced = false;
        let mut handle = |event: &Event<'_>| {
            announced |= event.file_name().map(CStr::to_bytes).is_some_and(|name| name.ends_with(b".json"));
        };
        // After an error, nothing arrives any more.
        while let Poll::Ready(Ok(())) = self.0.poll_read(cx, &mut handle) {}
        if announced { Poll::Ready(()) } else { Poll::Pending }
    }
}
