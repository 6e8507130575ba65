//! What a listening socket does when the program has no descriptors left.
//!
//! Whoever accepts, the library or the publishing end, asks the operating system again at once, for ever: the program
//! would spin, and whoever connects would wait in vain. So a descriptor is kept in reserve, with which those who cannot be
//! taken are accepted and closed at once; they see that, and come again. Even with nobody left to take, the operating
//! system asks for a descriptor before it says so; therefore whoever accepts has the reserve for a moment, and is quiet
//! until somebody comes.

use super::listen::Events;
use crate::sync::AbortOnDrop;
use rustix::io::Errno;
use std::fs::File;
use std::future::poll_fn;
use std::io;
use std::net::TcpListener;
use std::os::unix::net::UnixListener;
use std::task::{Context, Poll};
use zeromq::{Listener, SocketEvent, ZmqError};

/// A second hand on a listener that the library owns.
#[derive(Debug)]
pub(super) struct Door {
    listener: Listening,
    reserve: Option<File>,
    /// Whether the library has met a want of descriptors since.
    wanting: bool,
}

#[derive(Debug)]
enum Listening {
    Unix(UnixListener),
    Tcp(TcpListener),
}

impl Door {
    pub(super) fn of(listener: &Listener) -> io::Result<Self> {
        let listener = match listener {
            Listener::Ipc(listener) => Listening::Unix(listener.try_clone()?),
            Listener::Tcp(listener) => Listening::Tcp(listener.try_clone()?),
            _ => return Err(io::ErrorKind::Unsupported.into()),
        };
        Ok(Self { listener, reserve: Some(reserve()?), wanting: false })
    }

    /// To be told each event of the socket's monitor.
    pub(super) fn heard(&mut self, event: &SocketEvent) {
        if let SocketEvent::AcceptFailed(ZmqError::Network(error)) = event {
            self.refused(error);
        }
    }

    /// To be told why nobody could be accepted; whether that is for want of descriptors.
    pub(super) fn refused(&mut self, error: &io::Error) -> bool {
        let wanting = matches!(Errno::from_io_error(error), Some(Errno::MFILE | Errno::NFILE));
        self.wanting |= wanting;
        wanting
    }

    /// To be called after all that was told; wakes the task when it is to be called again.
    pub(super) fn keep(&mut self, cx: &Context<'_>) {
        if std::mem::take(&mut self.wanting) {
            let turned_away = self.turn_away();
            if turned_away > 0 {
                tracing::warn!(turned_away, "no descriptors are left for those who connect; see `ulimit -n`");
            }
            cx.waker().wake_by_ref();
        } else if self.reserve.is_none() {
            self.reserve = reserve().ok();
        }
    }

    /// Accepts and closes everybody who waits, and leaves the reserve free; how many they were.
    fn turn_away(&mut self) -> u32 {
        self.reserve = None;
        // The library has made the listener one that does not block.
        let accept = || match &self.listener {
            Listening::Unix(listener) => listener.accept().is_ok(),
            Listening::Tcp(listener) => listener.accept().is_ok(),
        };
        std::iter::repeat_with(accept).take_while(|accepted| *accepted).map(u32::from).sum()
    }

    /// Does so in a task, for a socket whose events nobody else needs.
    pub(super) fn watch(mut self, mut events: Events) -> AbortOnDrop {
        let task = tokio::spawn(poll_fn(move |cx| self.poll_events(&mut events, cx)));
        AbortOnDrop(task.abort_handle())
    }

    /// Ready when the socket is gone.
    fn poll_events(&mut self, events: &mut Events, cx: &mut Context<'_>) -> Poll<()> {
        while let Poll::Ready(event) = events.as_mut().poll_next(cx) {
            match event {
                Some(event) => self.heard(&event),
                None => return Poll::Ready(()),
            }
        }
        self.keep(cx);
        Poll::Pending
    }
}

fn reserve() -> io::Result<File> {
    File::open("/dev/null")
}
