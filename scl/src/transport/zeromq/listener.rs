//! Listening sockets of both media.

use super::Medium;
use super::stream::{Socket, Stream};
use super::tcp_user;
use crate::runtime_dir::{self, OwnedPath, RuntimeDirError, SystemDir};
use rustix::net::{SocketFlags, accept_with};
use std::io;
use std::net::SocketAddr;
use std::task::{Context, Poll, ready};
use tokio::net::{TcpListener, UnixListener};

pub(super) enum Listener {
    Unix(UnixListener),
    Tcp(TcpListener),
}

impl Listener {
    /// Binds an endpoint. Called inside a runtime.
    pub(super) fn bind(dir: &SystemDir, medium: Medium, endpoint: &str) -> Result<(Self, OwnedPath), BindError> {
        match medium {
            Medium::Ipc | Medium::Shm => {
                let bound = runtime_dir::bind_ipc(dir, endpoint)?;
                Ok((Self::Unix(UnixListener::from_std(bound.listener)?), bound.guard))
            }
            Medium::Tcp => {
                let bound = runtime_dir::bind_tcp(dir, endpoint)?;
                Ok((Self::Tcp(TcpListener::from_std(bound.listener)?), bound.guard))
            }
        }
    }

    /// Accepts a connection. Called inside the runtime.
    pub(super) fn poll_accept(&self, cx: &mut Context<'_>) -> Poll<io::Result<Stream>> {
        Poll::Ready(match self {
            Self::Unix(listener) => {
                ready!(listener.poll_accept(cx)).map(|(stream, _)| Stream::new(Socket::Unix(stream)))
            }
            Self::Tcp(listener) => ready!(listener.poll_accept(cx)).and_then(|(stream, peer)| {
                check_user(peer, stream.local_addr()?)?;
                stream.set_nodelay(true)?;
                Ok(Stream::new(Socket::Tcp(stream)))
            }),
        })
    }

    /// The same without a runtime; fails with `WouldBlock` if nobody connects.
    pub(super) fn accept_raw(&self) -> io::Result<Stream> {
        let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
        let descriptor = match self {
            Self::Unix(listener) => accept_with(listener, flags)?,
            Self::Tcp(listener) => {
                let stream = std::net::TcpStream::from(accept_with(listener, flags)?);
                check_user(stream.peer_addr()?, stream.local_addr()?)?;
                stream.set_nodelay(true)?;
                stream.into()
            }
        };
        Ok(Stream::new(Socket::Plain(descriptor)))
    }
}

fn check_user(peer: SocketAddr, own: SocketAddr) -> io::Result<()> {
    tcp_user::check_peer(peer, own).inspect_err(|error| {
        if error.kind() == io::ErrorKind::PermissionDenied {
            tracing::warn!(%peer, %error, "refusing a connection");
        }
    })
}

/// An endpoint could not be bound.
#[derive(Debug, thiserror::Error)]
pub(super) enum BindError {
    #[error(transparent)]
    RuntimeDir(#[from] RuntimeDirError),
    #[error(transparent)]
    Io(#[from] io::Error),
}
