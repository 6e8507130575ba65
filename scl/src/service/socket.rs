//! The datagram socket to the service manager.

use rustix::net::{AddressFamily, SendFlags, SocketAddrUnix, SocketFlags, SocketType, send, socket_with};
use std::ffi::OsStr;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;

pub(super) struct Socket(OwnedFd);

impl Socket {
    /// Connects to an absolute path, or to an abstract name that starts with `@`.
    pub(super) fn connect(address: &OsStr) -> io::Result<Self> {
        let address = match address.as_bytes() {
            [b'@', name @ ..] => SocketAddrUnix::new_abstract_name(name)?,
            path @ [b'/', ..] => SocketAddrUnix::new(path)?,
            _ => return Err(io::Error::new(io::ErrorKind::Unsupported, "it is neither a path nor an abstract name")),
        };
        let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
        let socket = socket_with(AddressFamily::UNIX, SocketType::DGRAM, flags, None)?;
        rustix::net::connect(&socket, &address)?;
        Ok(Self(socket))
    }

    /// Sends a datagram. Returns false if the manager does not take it now.
    pub(super) fn send(&self, text: &str) -> bool {
        let sent = send(&self.0, text.as_bytes(), SendFlags::NOSIGNAL | SendFlags::DONTWAIT);
        sent.inspect_err(|error| tracing::debug!(%error, text, "cannot notify the service manager")).is_ok()
    }
}
