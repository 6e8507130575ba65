//! Listening sockets of both transports.

use super::TransportKind;
use super::stream::{Socket, Stream};
use super::tcp_user::UserChecks;
use crate::runtime_dir::{self, OwnedPath, SystemDir};
use crate::transport::TransportError;
use rustix::net::{SocketFlags, accept_with};
use std::io;
use std::net::SocketAddr;
use std::task::{Context, Poll, ready};
use std::time::Instant;
use tokio::net::{TcpListener, UnixListener};

pub(super) enum Listener {
    Unix(UnixListener),
    Tcp(TcpListener),
}

impl Listener {
    /// Binds an endpoint. Called inside a runtime.
    pub(super) fn bind(
        dir: &SystemDir,
        kind: TransportKind,
        endpoint: &str,
    ) -> Result<(Self, OwnedPath), TransportError> {
        let refused = |error| TransportError::refused(endpoint, &error);
        if kind == TransportKind::Tcp {
            let bound = runtime_dir::bind_tcp(dir, endpoint)?;
            Ok((Self::Tcp(TcpListener::from_std(bound.listener).map_err(refused)?), bound.guard))
        } else {
            let bound = runtime_dir::bind_ipc(dir, endpoint)?;
            Ok((Self::Unix(UnixListener::from_std(bound.listener).map_err(refused)?), bound.guard))
        }
    }

    /// Accepts a connection. Called inside the runtime.
    pub(super) fn poll_accept(&self, cx: &mut Context<'_>) -> Poll<io::Result<Accepted>> {
        Poll::Ready(match self {
            Self::Unix(listener) => {
                ready!(listener.poll_accept(cx)).map(|(stream, _)| Accepted::unix(Socket::Unix(stream)))
            }
            Self::Tcp(listener) => ready!(listener.poll_accept(cx)).and_then(|(stream, peer)| {
                let own = stream.local_addr()?;
                Ok(Accepted { stream: Stream::new(Socket::Tcp(stream)), addresses: Some((peer, own)) })
            }),
        })
    }

    /// The same without a runtime; fails with `WouldBlock` if no connection is pending.
    pub(super) fn accept_raw(&self) -> io::Result<Accepted> {
        let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
        match self {
            Self::Unix(listener) => Ok(Accepted::unix(Socket::Plain(accept_with(listener, flags)?))),
            Self::Tcp(listener) => {
                let stream = std::net::TcpStream::from(accept_with(listener, flags)?);
                let addresses = Some((stream.peer_addr()?, stream.local_addr()?));
                Ok(Accepted { stream: Stream::new(Socket::Plain(stream.into())), addresses })
            }
        }
    }

    /// Returns when the users of accepted connections can be checked, or `None` if they can be checked now.
    pub(super) fn next_check(&self) -> Option<Instant> {
        match self {
            Self::Unix(_) => None,
            Self::Tcp(_) => UserChecks::next(),
        }
    }
}

/// An accepted connection, whose user is not known yet.
pub(super) struct Accepted {
    stream: Stream,
    /// The addresses of the peer and of this end. `None` for a Unix socket, whose folder keeps other users out.
    addresses: Option<(SocketAddr, SocketAddr)>,
}

impl Accepted {
    fn unix(socket: Socket) -> Self {
        Self { stream: Stream::new(socket), addresses: None }
    }

    /// Returns the connection if this program's user has made it.
    ///
    /// # Errors
    /// Those of [`UserChecks::check_peer`].
    pub(super) fn check_user(self, checks: &mut UserChecks) -> io::Result<Stream> {
        if let Some((peer, own)) = self.addresses {
            checks.check_peer(peer, own)?;
            rustix::net::sockopt::set_tcp_nodelay(self.stream.as_fd(), true)?;
        }
        Ok(self.stream)
    }
}
