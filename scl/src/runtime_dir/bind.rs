//! Listening at an endpoint: Unix sockets, or TCP ports of this machine.

use super::SystemDir;
use super::error::RuntimeDirError;
use super::owned_path::OwnedPath;
use super::small_file::write_temp;
use super::temp_entry::TempEntry;
use rustix::fs::OFlags;
use rustix::net::{AddressFamily, SocketAddrUnix, SocketFlags, SocketType};
use std::fs::{self, Permissions};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::os::fd::OwnedFd;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};

/// Connections that the kernel queues until they are accepted; it lowers this to its own limit.
const BACKLOG: i32 = 1024;

/// A Unix socket that listens at an endpoint.
#[derive(Debug)]
pub struct BoundIpc {
    /// Listening and non-blocking, ready for an async runtime. Its `local_addr` is the temporary name under which it
    /// was bound; peers connect to the endpoint's path.
    pub listener: UnixListener,
    /// Removes the socket's file when dropped. Drop it before the component's lock.
    pub guard: OwnedPath,
}

/// Binds the Unix socket of an endpoint, with mode 0600, and listens.
///
/// Replaces what is at the path. The caller must hold the component's lock, so that this cannot be the socket of a
/// running program.
///
/// # Errors
///
/// [`RuntimeDirError`] if the path is too long or the operating system refuses; nothing is left behind.
pub fn bind_ipc(dir: &SystemDir, endpoint: &str) -> Result<BoundIpc, RuntimeDirError> {
    let path = dir.path(endpoint)?;
    let failed = |error| RuntimeDirError::io("bind the socket", &path, error);
    let (entry, socket) = TempEntry::create(dir.folder(), bind_socket).map_err(failed)?;
    // Nobody can connect before `listen`, so nobody connects before the mode is set.
    fs::set_permissions(entry.path(), Permissions::from_mode(0o600)).map_err(failed)?;
    rustix::net::listen(&socket, BACKLOG).map_err(|error| failed(error.into()))?;
    let guard = entry.rename(&path, OFlags::PATH)?;
    Ok(BoundIpc { listener: socket.into(), guard })
}

/// A TCP socket that listens on 127.0.0.1, and the file with its address.
#[derive(Debug)]
pub struct BoundTcp {
    /// Listening and non-blocking, ready for an async runtime.
    pub listener: TcpListener,
    /// Its address: `127.0.0.1` and a port that the system chose.
    pub address: SocketAddr,
    /// Removes the file `<endpoint>.tcp` when dropped. Drop it before the component's lock.
    pub guard: OwnedPath,
}

/// Binds an unused port of `127.0.0.1` and writes its address to `<endpoint>.tcp`, with mode 0600.
///
/// Unlike a socket in the runtime folder, the port can be reached by every user of the machine.
///
/// # Errors
///
/// [`RuntimeDirError`] if the operating system refuses; nothing is left behind.
pub fn bind_tcp(dir: &SystemDir, endpoint: &str) -> Result<BoundTcp, RuntimeDirError> {
    let path = tcp_file(&dir.path(endpoint)?);
    let bind = || {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        listener.set_nonblocking(true)?;
        listener.local_addr().map(|address| (listener, address))
    };
    let (listener, address) =
        bind().map_err(|error| RuntimeDirError::io("bind a port of 127.0.0.1 for", &path, error))?;
    let guard = write_temp(dir.folder(), &path, format!("{address}\n").as_bytes())?.rename(&path, OFlags::PATH)?;
    Ok(BoundTcp { listener, address, guard })
}

/// Returns the file with the TCP address of an endpoint, given the path of its Unix socket.
pub(super) fn tcp_file(path: &Path) -> PathBuf {
    let mut file = path.as_os_str().to_owned();
    file.push(".tcp");
    file.into()
}

fn bind_socket(path: &Path) -> io::Result<OwnedFd> {
    let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
    let socket = rustix::net::socket_with(AddressFamily::UNIX, SocketType::STREAM, flags, None)?;
    rustix::net::bind(&socket, &SocketAddrUnix::new(path)?)?;
    Ok(socket)
}
