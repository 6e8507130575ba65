//! A service manager: the socket that programs notify.

use crate::HANG_LIMIT;
use std::os::unix::net::UnixDatagram;
use std::path::PathBuf;
use std::time::Duration;
use tempfile::TempDir;

/// Receives what programs report as `sd_notify(3)` describes.
pub struct ServiceManager {
    socket: UnixDatagram,
    path: PathBuf,
    _folder: TempDir,
}

impl ServiceManager {
    /// Listens at a socket of its own.
    pub fn new() -> Self {
        let folder = TempDir::with_prefix("scl").expect("a folder for the socket");
        let path = folder.path().join("notify");
        Self { socket: UnixDatagram::bind(&path).expect("a socket"), path, _folder: folder }
    }

    /// The value of `NOTIFY_SOCKET`.
    pub fn address(&self) -> &str {
        self.path.to_str().expect("a path in UTF-8")
    }

    /// The next datagram.
    #[track_caller]
    pub fn next(&self) -> String {
        self.next_within(HANG_LIMIT).expect("a notification")
    }

    /// The next datagram, if it arrives in time.
    pub fn next_within(&self, time: Duration) -> Option<String> {
        let mut buffer = [0; 4096];
        self.socket.set_read_timeout(Some(time)).expect("a time limit");
        let length = self.socket.recv(&mut buffer).ok()?;
        Some(String::from_utf8(buffer[..length].to_vec()).expect("a notification in UTF-8"))
    }

    /// Waits for a datagram with a line.
    #[track_caller]
    pub fn expect(&self, line: &str) {
        while !self.next().lines().any(|found| found == line) {}
    }
}

impl Default for ServiceManager {
    fn default() -> Self {
        Self::new()
    }
}
