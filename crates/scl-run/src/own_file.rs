//! The sockets of a `scl run`, named after its process id: `run.<pid>.control`, `run.<pid>.notify`. The next process
//! that finds the sockets of a killed one removes them.

use rustix::net::{AddressFamily, SocketAddrUnix, SocketFlags, SocketType, socket_with};
use std::fs;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::{UnixDatagram, UnixStream};
use std::path::{Path, PathBuf};

const PREFIX: &str = "run.";

/// A socket's file. Dropping this value removes it.
#[derive(Debug)]
pub(crate) struct OwnFile {
    pub(crate) path: PathBuf,
}

impl OwnFile {
    /// Binds a socket in a folder that only this user can write to. Its name ends with `ending`. The file appears only
    /// when clients can connect, so that it is not mistaken for one that was left behind.
    ///
    /// # Errors
    ///
    /// If it cannot be bound, for example because the path is too long for a socket.
    pub(crate) fn bind<S>(
        folder: &Path,
        ending: &str,
        bind: impl FnOnce(&Path) -> io::Result<S>,
    ) -> io::Result<(Self, S)> {
        let file = Self { path: folder.join(format!("{PREFIX}{}.{ending}", std::process::id())) };
        let socket = file.bind_again(bind)?;
        Ok((file, socket))
    }

    /// Binds another socket in the place of the one that was removed.
    ///
    /// # Errors
    ///
    /// As for [`bind`](Self::bind).
    pub(crate) fn bind_again<S>(&self, bind: impl FnOnce(&Path) -> io::Result<S>) -> io::Result<S> {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let new = self.path.with_file_name(format!(".{name}"));
        // Remove what an earlier process with the same id may have left.
        let _ = fs::remove_file(&new);
        let socket = bind(&new)?;
        let ready = fs::set_permissions(&new, fs::Permissions::from_mode(0o600));
        let ready = ready.and_then(|()| fs::rename(&new, &self.path));
        if ready.is_err() {
            let _ = fs::remove_file(&new);
        }
        ready.map(|()| socket)
    }

    /// Whether the file was removed, so that clients cannot find the socket.
    pub(crate) fn is_gone(&self) -> bool {
        self.path.symlink_metadata().is_err()
    }
}

impl Drop for OwnFile {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// The sockets with this ending in a folder, by process id.
pub(crate) fn sockets_in(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<_> =
        entries.filter_map(|entry| Some((process_of(&entry.path(), ending)?, entry.path()))).collect();
    found.sort();
    found.into_iter().map(|(_, path)| path).collect()
}

/// Returns the process id in the name of a socket with this ending, or `None` for other files.
pub(crate) fn process_of(path: &Path, ending: &str) -> Option<u32> {
    path.file_name()?.to_str()?.strip_prefix(PREFIX)?.strip_suffix(ending)?.strip_suffix('.')?.parse().ok()
}

/// Connects to the `scl run` of a control socket. Removes the socket if its process has ended.
///
/// # Errors
///
/// [`io::ErrorKind::WouldBlock`] if the process accepts no connections at the moment.
pub(crate) fn connect(path: &Path) -> io::Result<UnixStream> {
    connect_at_once(path).inspect_err(|error| remove_if_dead(path, error))
}

/// Connects without blocking: a stopped process accepts no connections, so a blocking call could hang.
fn connect_at_once(path: &Path) -> io::Result<UnixStream> {
    let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
    let socket = socket_with(AddressFamily::UNIX, SocketType::STREAM, flags, None)?;
    rustix::net::connect(&socket, &SocketAddrUnix::new(path)?)?;
    let stream = UnixStream::from(socket);
    stream.set_nonblocking(false)?;
    Ok(stream)
}

/// Removes the sockets of processes that have ended.
pub(crate) fn remove_stale(folder: &Path) {
    for path in sockets_in(folder, "notify") {
        let connected = UnixDatagram::unbound().and_then(|socket| socket.connect(&path));
        let _ = connected.inspect_err(|error| remove_if_dead(&path, error));
    }
    for path in sockets_in(folder, "control") {
        let _ = connect(&path);
    }
}

fn remove_if_dead(path: &Path, error: &io::Error) {
    if error.kind() == io::ErrorKind::ConnectionRefused {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::net::UnixListener;

    #[test]
    fn dead_sockets_are_removed_and_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        drop(UnixListener::bind(path("run.1.control")).unwrap());
        drop(UnixDatagram::bind(path("run.1.notify")).unwrap());
        fs::write(path("run.x.control"), "").unwrap();
        let (own, _listener) = OwnFile::bind(folder.path(), "control", |path| UnixListener::bind(path)).unwrap();
        let (_notify, _socket) = OwnFile::bind(folder.path(), "notify", |path| UnixDatagram::bind(path)).unwrap();
        assert_eq!(fs::metadata(&own.path).unwrap().permissions().mode() & 0o777, 0o600);
        remove_stale(folder.path());
        assert_eq!(sockets_in(folder.path(), "control"), [own.path.as_path()]);
        assert_eq!(sockets_in(folder.path(), "notify").len(), 1);
        assert!(path("run.x.control").exists());
        drop(own);
        assert!(sockets_in(folder.path(), "control").is_empty());
    }

    #[test]
    fn a_process_that_accepts_nothing_is_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.1.control");
        let socket = socket_with(AddressFamily::UNIX, SocketType::STREAM, SocketFlags::CLOEXEC, None).unwrap();
        rustix::net::bind(&socket, &SocketAddrUnix::new(&path).unwrap()).unwrap();
        rustix::net::listen(&socket, 1).unwrap();
        let mut waiting = Vec::new();
        let error = loop {
            match connect(&path) {
                Ok(connection) => waiting.push(connection),
                Err(error) => break error,
            }
        };
        assert_eq!(error.kind(), io::ErrorKind::WouldBlock);
        assert!(path.exists() && !waiting.is_empty());
    }
}
