//! Tells when components announce themselves in the folder of a system.

use super::{Inotify, SystemDir};
use rustix::fs::inotify::{Event, ReadFlags, WatchFlags};
use std::ffi::CStr;
use std::io;
use std::task::{Context, Poll};

/// Watches the folder of a system for components that have started.
///
/// It sees nothing any more once the folder was removed, even if there is a new one: then it [is over](Self::is_over).
#[derive(Debug)]
pub struct ArrivalWatch {
    inotify: Inotify,
    is_over: bool,
}

impl ArrivalWatch {
    /// Starts watching. Must be called inside a tokio runtime.
    ///
    /// # Errors
    ///
    /// The folder does not exist, or the limit of the user for inotify is reached.
    pub fn start(dir: &SystemDir) -> io::Result<Self> {
        let inotify = Inotify::new()?;
        // Announcements are renamed into the folder.
        inotify.watch(dir.folder(), WatchFlags::MOVED_TO | WatchFlags::MOVE_SELF)?;
        Ok(Self { inotify, is_over: false })
    }

    /// Whether the folder was removed or moved before the last call of [`poll_arrived`](Self::poll_arrived).
    pub fn is_over(&self) -> bool {
        self.is_over
    }

    /// Returns when a component has announced itself since the last call.
    pub fn poll_arrived(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let (mut announced, mut is_over) = (false, self.is_over);
        let mut handle = |event: &Event<'_>| {
            // The watch of a folder that is gone is removed.
            is_over |= event.events().intersects(ReadFlags::IGNORED | ReadFlags::MOVE_SELF);
            announced |= event.file_name().map(CStr::to_bytes).is_some_and(|name| name.ends_with(b".json"));
        };
        // After an error, nothing arrives any more.
        while let Poll::Ready(Ok(())) = self.inotify.poll_read(cx, &mut handle) {}
        self.is_over = is_over;
        if announced { Poll::Ready(()) } else { Poll::Pending }
    }
}
