use std::{
    fs, io,
    net::{Ipv4Addr, SocketAddr, TcpListener},
    os::{
        fd::OwnedFd,
        unix::{fs::PermissionsExt, net::UnixListener},
    },
    path::Path,
};

use rustix::net::{AddressFamily, SocketAddrUnix, SocketFlags, SocketType};

use super::{SystemDir, claim::Claim, draft::Draft, error::PlaceError, small_file::write_file};

/// How many peers may wait for `accept`; the system lowers it to its own limit.
const BACKLOG: i32 = 1024;

/// A Unix socket that listens under an endpoint's name.
#[derive(Debug)]
pub struct BoundIpc {
    /// Listens already, and does not block, so that an async runtime can take it over. Its own `local_addr` is the
    /// temporary name under which it was bound; peers find it by the endpoint's.
    pub listener: UnixListener,
    /// Removes the socket's file when it is dropped. To be dropped before the component's lock.
    pub guard: Claim,
}

/// Binds and listens at an endpoint's Unix socket, of mode 0600.
///
/// A socket or file that has the name already, left behind by a killed program, is replaced in one step. That it is no
/// living one, the caller knows by holding the component's [`ComponentLock`](super::ComponentLock).
///
/// # Errors
///
/// [`PlaceError`] when the path is too long or the operating system refuses; nothing is left behind then.
pub fn bind_ipc(dir: &SystemDir, endpoint: &str) -> Result<BoundIpc, PlaceError> {
    let path = dir.path(endpoint)?;
    let refused = |error| PlaceError::io("bind the socket", &path, error);
    let (draft, socket) = Draft::create(dir.folder(), bind_socket).map_err(refused)?;
    // Nobody can connect before `listen`, so nobody meets the socket with the rights it had before `chmod`.
    fs::set_permissions(draft.path(), fs::Permissions::from_mode(0o600)).map_err(refused)?;
    rustix::net::listen(&socket, BACKLOG).map_err(|error| refused(error.into()))?;
    let guard = draft.place(&path)?;
    Ok(BoundIpc { listener: socket.into(), guard })
}

/// A TCP socket of this machine, with a file that tells its address.
#[derive(Debug)]
pub struct BoundTcp {
    /// Listens already, and does not block, so that an async runtime can take it over.
    pub listener: TcpListener,
    /// Where it listens: `127.0.0.1` and a port that the system chose.
    pub address: SocketAddr,
    /// Removes the file `<endpoint>.tcp` when it is dropped. To be dropped before the component's lock.
    pub guard: Claim,
}

/// Binds a free port of `127.0.0.1` and writes its address to `<endpoint>.tcp`, of mode 0600.
///
/// Unlike a socket in the runtime folder, the port can be reached by every user of the machine.
///
/// # Errors
///
/// [`PlaceError`] when the operating system refuses; nothing is left behind then.
pub fn bind_tcp(dir: &SystemDir, endpoint: &str) -> Result<BoundTcp, PlaceError> {
    let path = tcp_file(&dir.path(endpoint)?);
    let bound = || {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
        listener.set_nonblocking(true)?;
        listener.local_addr().map(|address| (listener, address))
    };
    let (listener, address) = bound().map_err(|error| PlaceError::io("bind a port of 127.0.0.1 for", &path, error))?;
    let guard = write_file(dir.folder(), &path, &format!("{address}\n"))?;
    Ok(BoundTcp { listener, address, guard })
}

/// The file that tells the TCP address of the endpoint whose socket would be at `path`.
pub(super) fn tcp_file(path: &Path) -> std::path::PathBuf {
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
