//! Connections of the two media, of which the publishing end accepts its own.

use bytes::BytesMut;
use std::io::{self, IoSlice};
use std::task::{Context, Poll, ready};
use tokio::net::{TcpListener, TcpStream, UnixListener, UnixStream};
use zeromq::Listener;

pub(super) enum Acceptor {
    Unix(UnixListener),
    Tcp(TcpListener),
}

pub(super) enum Stream {
    Unix(UnixStream),
    Tcp(TcpStream),
}

impl Acceptor {
    pub(super) fn of(listener: Listener) -> io::Result<Self> {
        match listener {
            Listener::Ipc(listener) => UnixListener::from_std(listener).map(Self::Unix),
            Listener::Tcp(listener) => TcpListener::from_std(listener).map(Self::Tcp),
            _ => Err(io::ErrorKind::Unsupported.into()),
        }
    }

    pub(super) fn poll_accept(&self, cx: &mut Context<'_>) -> Poll<io::Result<Stream>> {
        Poll::Ready(match self {
            Self::Unix(listener) => ready!(listener.poll_accept(cx)).map(|(stream, _)| Stream::Unix(stream)),
            Self::Tcp(listener) => ready!(listener.poll_accept(cx)).and_then(|(stream, _)| {
                stream.set_nodelay(true)?;
                Ok(Stream::Tcp(stream))
            }),
        })
    }
}

impl Stream {
    /// Appends what has arrived; nothing more will when it is 0 bytes.
    pub(super) fn poll_read(&self, cx: &mut Context<'_>, into: &mut BytesMut) -> Poll<io::Result<usize>> {
        loop {
            let read = match self {
                Self::Unix(stream) => ready!(stream.poll_read_ready(cx)).and_then(|()| stream.try_read_buf(into)),
                Self::Tcp(stream) => ready!(stream.poll_read_ready(cx)).and_then(|()| stream.try_read_buf(into)),
            };
            if !would_block(&read) {
                return Poll::Ready(read);
            }
        }
    }

    /// Writes what the operating system takes at once; if that is nothing, the task is woken when it takes more.
    pub(super) fn poll_write(&self, cx: &mut Context<'_>, parts: &[IoSlice<'_>]) -> Poll<io::Result<usize>> {
        loop {
            let written = match self {
                Self::Unix(stream) => stream.try_write_vectored(parts),
                Self::Tcp(stream) => stream.try_write_vectored(parts),
            };
            if !would_block(&written) {
                return Poll::Ready(written);
            }
            let writable = match self {
                Self::Unix(stream) => ready!(stream.poll_write_ready(cx)),
                Self::Tcp(stream) => ready!(stream.poll_write_ready(cx)),
            };
            writable?;
        }
    }
}

fn would_block(result: &io::Result<usize>) -> bool {
    matches!(result, Err(error) if error.kind() == io::ErrorKind::WouldBlock)
}
