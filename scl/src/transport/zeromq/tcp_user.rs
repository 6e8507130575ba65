//! Which user is at the other end of a loopback TCP connection.
//!
//! Every user of a machine can connect to 127.0.0.1, and any of them may listen at a port that a killed component left
//! behind. The kernel knows which user owns a socket.

mod sock_diag;
mod table;

use sock_diag::SockDiag;
use std::io;
use std::net::{Ipv6Addr, SocketAddr};
use std::time::Instant;
use table::Tables;

/// The kernel's number for the state of a socket that listens.
const LISTENING: u8 = 10;

/// A socket, identified by what other programs can see of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Socket {
    local: SocketAddr,
    remote: SocketAddr,
    listens: bool,
}

impl Socket {
    fn connected(local: SocketAddr, remote: SocketAddr) -> Self {
        Self { local: canonical(local), remote: canonical(remote), listens: false }
    }

    fn listening(address: SocketAddr) -> Self {
        // The kernel expects an all-zero remote address for listening sockets of both families.
        Self { local: canonical(address), remote: (Ipv6Addr::UNSPECIFIED, 0).into(), listens: true }
    }

    /// Whether this socket, which was found, is the one that was asked for.
    fn is(self, asked: Self) -> bool {
        self == asked || self.listens && asked.listens && self.local == asked.local
    }
}

/// Removes the scope of an address, and turns an IPv4 address mapped into IPv6 back into IPv4: sockets of both families
/// can connect to each other.
fn canonical(address: SocketAddr) -> SocketAddr {
    SocketAddr::new(address.ip().to_canonical(), address.port())
}

/// The user who owns a socket, and the socket's inode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Owner {
    user: u32,
    /// 0 if no process has the socket any more; the kernel then names root as its user.
    inode: u32,
}

/// Checks the users of several sockets with one connection to the kernel, or one read of its tables.
#[derive(Default)]
pub(super) struct UserChecks {
    /// Opened for the first check.
    kernel: Option<SockDiag>,
    /// Read for the first check, if the kernel cannot be asked.
    tables: Option<Tables>,
}

impl UserChecks {
    /// Returns when checks are possible again, or `None` if they are possible now. Without the kernel's help they are
    /// so expensive that their rate is limited.
    pub(super) fn next() -> Option<Instant> {
        table::next_read()
    }

    /// Checks the user of an accepted connection. It must have been accepted before the first check.
    ///
    /// # Errors
    /// The connection belongs to another user ([`io::ErrorKind::PermissionDenied`]) or to an unknown one
    /// ([`io::ErrorKind::ConnectionRefused`]), or the user cannot be determined now ([`io::ErrorKind::WouldBlock`]).
    pub(super) fn check_peer(&mut self, peer: SocketAddr, own: SocketAddr) -> io::Result<()> {
        self.check(Socket::connected(peer, own)).map(drop)
    }

    /// Checks the user who listens at an address, before connecting.
    ///
    /// # Errors
    /// Those of [`check_peer`](Self::check_peer).
    pub(super) fn check_listener(&mut self, address: SocketAddr) -> io::Result<Owner> {
        self.check(Socket::listening(address))
    }

    /// Returns true if the socket at an address is still the one that was checked. Without the kernel's help this takes
    /// it for granted, because reading the tables again would take too long.
    ///
    /// # Errors
    /// Those of [`check_peer`](Self::check_peer).
    pub(super) fn is_same_listener(&mut self, address: SocketAddr, checked: Owner) -> io::Result<bool> {
        Ok(self.tables.is_some() || self.check_listener(address)? == checked)
    }

    fn check(&mut self, socket: Socket) -> io::Result<Owner> {
        let owner = if sock_diag::is_available()? {
            let kernel = match &self.kernel {
                Some(kernel) => kernel,
                None => self.kernel.insert(SockDiag::open()?),
            };
            kernel.find(socket)?
        } else {
            let tables = match &self.tables {
                Some(tables) => tables,
                None => self.tables.insert(Tables::read()?),
            };
            tables.find(socket)
        };
        let own = rustix::process::geteuid().as_raw();
        match owner.filter(|owner| owner.inode != 0) {
            Some(owner) if owner.user == own => Ok(owner),
            Some(Owner { user, .. }) => {
                let reason = format!("the peer belongs to user {user}, this program to user {own}");
                Err(io::Error::new(io::ErrorKind::PermissionDenied, reason))
            }
            // The peer has just closed its socket, or never had one.
            None => Err(io::ErrorKind::ConnectionRefused.into()),
        }
    }
}

#[cfg(test)]
mod tests;
