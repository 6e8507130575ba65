//! Closes TCP connections on which nothing gets through.
//!
//! When its lease ends, the network library closes a link, and first writes what is left. With a full send buffer, this
//! waits for the kernel, which retransmits at ever longer intervals: after half a minute without a network, a new link
//! was added to the old session, and ended with it 25 s later. With `TCP_USER_TIMEOUT` the kernel gives up when the
//! lease ends.
//!
//! The library has no option for this and does not expose its sockets, so they are found among the descriptors of the
//! process. Only sockets are examined further: that takes a duplicate of the descriptor, and closing a duplicate of a
//! file's descriptor would release the locks that this process holds on the file, among them those of the components
//! that the gateway mirrors.

use rustix::net::{AddressFamily, SocketType, sockopt};
use rustix::process::{self, PidfdFlags, PidfdGetfdFlags};
use std::fs;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;

use super::config::LEASE_MS;

/// Sets the timeout of all TCP sockets of this process. Without it everything works, but may resume late after an
/// outage.
pub(super) fn set() {
    if let Err(error) = try_set() {
        tracing::debug!("cannot limit how long TCP retransmits unacknowledged data: {error}");
    }
}

fn try_set() -> io::Result<()> {
    let process = process::pidfd_open(process::getpid(), PidfdFlags::empty())?;
    for entry in fs::read_dir("/proc/self/fd")? {
        let entry = entry?;
        let Some(number) = entry.file_name().to_str().and_then(|name| name.parse().ok()) else { continue };
        // The descriptor may have been closed in the meantime; then it needs no timeout.
        let Ok(target) = fs::read_link(entry.path()) else { continue };
        if !target.as_os_str().as_bytes().starts_with(b"socket:") {
            continue;
        }
        let Ok(socket) = process::pidfd_getfd(&process, number, PidfdGetfdFlags::empty()) else { continue };
        match sockopt::socket_type(&socket) {
            Ok(SocketType::STREAM) if is_internet(&socket) => sockopt::set_tcp_user_timeout(&socket, LEASE_MS)?,
            Ok(_) => {}
            // Another thread has closed the socket and opened a file in its place. Closing the duplicate would release
            // this process's locks on that file, so leak it.
            Err(_) => std::mem::forget(socket),
        }
    }
    Ok(())
}

fn is_internet(socket: &OwnedFd) -> bool {
    sockopt::socket_domain(socket).is_ok_and(|family| family == AddressFamily::INET || family == AddressFamily::INET6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rustix::fs::FlockOperation;
    use std::net::{TcpListener, TcpStream};
    use std::os::unix::fs::MetadataExt;

    #[test]
    fn both_ends_of_a_connection_get_the_limit() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let dialled = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (accepted, _) = listener.accept().unwrap();
        try_set().unwrap();
        for socket in [&dialled, &accepted] {
            assert_eq!(sockopt::tcp_user_timeout(socket).unwrap(), LEASE_MS);
        }
    }

    #[test]
    fn locks_of_this_process_stay() {
        let file = tempfile::tempfile().unwrap();
        rustix::fs::fcntl_lock(&file, FlockOperation::LockExclusive).unwrap();
        try_set().unwrap();
        let inode = file.metadata().unwrap().ino();
        let locks = fs::read_to_string("/proc/locks").unwrap();
        assert!(locks.contains(&format!(":{inode} ")), "{locks}");
    }
}
