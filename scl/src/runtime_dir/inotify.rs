//! Events of the file system, read without blocking.

use rustix::fs::inotify::{self, CreateFlags, Event, Reader, WatchFlags};
use std::io;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::path::Path;
use std::task::{Context, Poll, ready};
use tokio::io::unix::AsyncFd;

/// An instance of inotify. A user can have only a limited number of them, see
/// `/proc/sys/fs/inotify/max_user_instances`.
#[derive(Debug)]
pub(crate) struct Inotify(AsyncFd<OwnedFd>);

impl Inotify {
    /// Creates an instance. Must be called inside a tokio runtime.
    ///
    /// # Errors
    /// The limit of the user is reached.
    pub(crate) fn new() -> io::Result<Self> {
        let inotify = inotify::init(CreateFlags::CLOEXEC | CreateFlags::NONBLOCK)?;
        #[expect(deprecated, reason = "unsound only for types that change their descriptor; an `OwnedFd` keeps it")]
        AsyncFd::new(inotify).map(Self)
    }

    /// Watches a file or folder, but not what a link points to, and returns the number of the watch.
    pub(crate) fn watch(&self, path: &Path, events: WatchFlags) -> io::Result<i32> {
        Ok(inotify::add_watch(self.0.get_ref(), path, events | WatchFlags::DONT_FOLLOW)?)
    }

    /// Waits for events and passes all pending ones to `handle`, up to the length of a buffer.
    ///
    /// # Cancel safety
    ///
    /// Cancel safe: no event is lost.
    pub(crate) async fn read(&self, mut handle: impl FnMut(&Event<'_>)) -> io::Result<()> {
        loop {
            let mut ready = self.0.readable().await?;
            if let Ok(read) = ready.try_io(|inotify| read_now(inotify.get_ref(), &mut handle)) {
                return read;
            }
        }
    }

    /// [`read`](Self::read) as a poll function.
    pub(crate) fn poll_read(&self, cx: &mut Context<'_>, mut handle: impl FnMut(&Event<'_>)) -> Poll<io::Result<()>> {
        loop {
            let mut ready = ready!(self.0.poll_read_ready(cx))?;
            if let Ok(read) = ready.try_io(|inotify| read_now(inotify.get_ref(), &mut handle)) {
                return Poll::Ready(read);
            }
        }
    }

    /// Passes the pending events to `handle`.
    ///
    /// # Errors
    /// No event is pending ([`io::ErrorKind::WouldBlock`]).
    #[cfg(test)]
    pub(crate) fn read_now(&self, mut handle: impl FnMut(&Event<'_>)) -> io::Result<()> {
        read_now(self.0.get_ref(), &mut handle)
    }
}

fn read_now(inotify: &OwnedFd, handle: &mut impl FnMut(&Event<'_>)) -> io::Result<()> {
    let mut buffer = [MaybeUninit::uninit(); 4096];
    let mut events = Reader::new(inotify, &mut buffer);
    loop {
        handle(&events.next()?);
        if events.is_buffer_empty() {
            return Ok(());
        }
    }
}
