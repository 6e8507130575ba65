//! Who is still connected to a listening socket, read from the operating system.
//!
//! The library's XPUB forgets a subscriber that went away without telling anyone, and then sends to nobody with
//! success. So the publisher looks up the operating system's sockets that were accepted at its address, and, whenever
//! it wakes, whether they are still open in this process: the library closes them as it forgets them.
//!
//! Which of the sockets is a subscriber's is not to be seen: another may have connected and stay silent. So as soon as
//! one closes while there are more sockets than peers that introduced themselves, nobody is believed to be left; a
//! subscriber that is there after all is disconnected, dials again at once, and finds what was queued meanwhile.

use std::fs;
use std::net::{SocketAddr, TcpListener};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};

/// The address that a listener, and each socket it accepts, is bound to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum LocalAddress {
    Unix(PathBuf),
    Tcp(u16),
    /// Not known; then nobody is ever seen to leave.
    Unknown,
}

impl LocalAddress {
    pub(super) fn of_unix(listener: &UnixListener) -> Self {
        let path = listener.local_addr().ok().and_then(|address| address.as_pathname().map(Path::to_owned));
        path.map_or(Self::Unknown, Self::Unix)
    }

    pub(super) fn of_tcp(listener: &TcpListener) -> Self {
        listener.local_addr().map_or(Self::Unknown, |address: SocketAddr| Self::Tcp(address.port()))
    }
}

/// The accepted sockets of one listener that stand for subscribers.
#[derive(Debug)]
pub(super) struct Accepted {
    address: LocalAddress,
    open: Vec<OpenSocket>,
    /// How many of those that were found have closed since all were forgotten.
    closed: usize,
    /// Set when a subscriber is there whose socket could not be found: then it is taken to stay.
    untraceable: bool,
}

/// A descriptor of this process and the socket that it was seen to hold.
#[derive(Debug, PartialEq, Eq)]
struct OpenSocket {
    descriptor: PathBuf,
    socket: PathBuf,
}

impl Accepted {
    pub(super) fn at(address: LocalAddress) -> Self {
        Self { address, open: Vec::new(), closed: 0, untraceable: false }
    }

    /// Somebody subscribed: finds the sockets accepted so far.
    pub(super) fn subscribed(&mut self) {
        let before = std::mem::replace(&mut self.open, open_sockets(&self.address));
        self.closed += before.iter().filter(|socket| !self.open.contains(socket)).count();
        self.untraceable = self.open.is_empty();
    }

    /// Whether anybody was found.
    pub(super) fn is_anybody(&self) -> bool {
        self.untraceable || !self.open.is_empty()
    }

    /// Whether anybody is left for sure, given how many peers have introduced themselves since all were forgotten.
    pub(super) fn any_left(&mut self, introduced: usize) -> bool {
        if self.untraceable {
            return true;
        }
        let before = self.open.len();
        self.open.retain(OpenSocket::is_open);
        let closed = before - self.open.len();
        self.closed += closed;
        let doubtful = closed > 0 && self.closed + self.open.len() > introduced;
        !self.open.is_empty() && !doubtful
    }

    /// Starts afresh, after all connections were closed.
    pub(super) fn forget(&mut self) {
        self.open.clear();
        self.closed = 0;
    }
}

impl OpenSocket {
    fn is_open(&self) -> bool {
        fs::read_link(&self.descriptor).is_ok_and(|target| target == self.socket)
    }
}

fn open_sockets(address: &LocalAddress) -> Vec<OpenSocket> {
    let inodes = match address {
        LocalAddress::Unix(path) => unix_inodes(&read("/proc/self/net/unix"), path),
        LocalAddress::Tcp(port) => tcp_inodes(&read("/proc/self/net/tcp"), *port),
        LocalAddress::Unknown => return Vec::new(),
    };
    let wanted: Vec<PathBuf> = inodes.into_iter().map(|inode| format!("socket:[{inode}]").into()).collect();
    let Ok(descriptors) = fs::read_dir("/proc/self/fd") else { return Vec::new() };
    descriptors
        .flatten()
        .filter_map(|entry| {
            let socket = fs::read_link(entry.path()).ok()?;
            wanted.contains(&socket).then(|| OpenSocket { descriptor: entry.path(), socket })
        })
        .collect()
}

fn read(path: &str) -> String {
    fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default()
}

/// The connected sockets bound to a path: `Num RefCount Protocol Flags Type St Inode Path`, state 03.
fn unix_inodes(table: &str, path: &Path) -> Vec<String> {
    let path = path.to_string_lossy();
    let inode = |line: &str| {
        let mut columns = line.split_ascii_whitespace();
        let state = columns.by_ref().nth(5)?;
        let inode = columns.next()?;
        (state == "03" && line.ends_with(&*path)).then(|| inode.to_owned())
    };
    table.lines().filter_map(inode).collect()
}

/// The connected sockets on a local port: `sl local rem st tx:rx tr:tm retrnsmt uid timeout inode`, state 01, or 08 when
/// the other side has closed and this one has not.
fn tcp_inodes(table: &str, port: u16) -> Vec<String> {
    let suffix = format!(":{port:04X}");
    let inode = |line: &str| {
        let columns: Vec<&str> = line.split_ascii_whitespace().collect();
        let ours = columns.get(1)?.ends_with(&suffix) && matches!(*columns.get(3)?, "01" | "08");
        columns.get(9).filter(|_| ours).map(|inode| (*inode).to_owned())
    };
    table.lines().filter_map(inode).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::net::UnixStream;

    #[test]
    fn a_closed_connection_is_seen_to_be_gone() {
        let folder = tempfile::tempdir().expect("a folder");
        let listener = UnixListener::bind(folder.path().join("a b.sock")).expect("bound");
        let mut accepted = Accepted::at(LocalAddress::of_unix(&listener));
        let _client = UnixStream::connect(folder.path().join("a b.sock")).expect("connected");
        let (server, _) = listener.accept().expect("accepted");
        accepted.subscribed();
        assert!(accepted.any_left(1) && !accepted.untraceable);
        drop(server);
        assert!(!accepted.any_left(1));
    }

    #[test]
    fn tcp_connections_are_found_by_their_port() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("bound");
        let mut accepted = Accepted::at(LocalAddress::of_tcp(&listener));
        let _client = std::net::TcpStream::connect(listener.local_addr().expect("address")).expect("connected");
        let (server, _) = listener.accept().expect("accepted");
        accepted.subscribed();
        assert!(accepted.any_left(1) && !accepted.untraceable);
        drop(server);
        assert!(!accepted.any_left(1));
    }

    #[test]
    fn a_subscriber_that_has_closed_already_is_found_until_the_library_closes_its_side() {
        let folder = tempfile::tempdir().expect("a folder");
        let tcp = TcpListener::bind("127.0.0.1:0").expect("bound");
        let unix = UnixListener::bind(folder.path().join("s")).expect("bound");
        drop(std::net::TcpStream::connect(tcp.local_addr().expect("address")).expect("connected"));
        drop(UnixStream::connect(folder.path().join("s")).expect("connected"));
        let mut over_tcp = Accepted::at(LocalAddress::of_tcp(&tcp));
        let mut over_unix = Accepted::at(LocalAddress::of_unix(&unix));
        let servers = (tcp.accept().expect("accepted"), unix.accept().expect("accepted"));
        for accepted in [&mut over_tcp, &mut over_unix] {
            accepted.subscribed();
            assert!(accepted.any_left(1) && !accepted.untraceable, "{accepted:?}");
        }
        drop(servers);
        assert!(!over_tcp.any_left(1) && !over_unix.any_left(1));
    }

    #[test]
    fn as_long_as_a_silent_connection_is_there_nobody_is_believed_to_be_left() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("bound");
        let address = listener.local_addr().expect("address");
        let connect = || (std::net::TcpStream::connect(address).expect("connected"), listener.accept());
        let (pairs, introduced) = ([connect(), connect(), connect()], [2, 3]);
        let [first, second, _third] = pairs;
        let mut in_doubt = Accepted::at(LocalAddress::Tcp(address.port()));
        let mut sure = Accepted::at(LocalAddress::Tcp(address.port()));
        in_doubt.subscribed();
        sure.subscribed();
        assert!(in_doubt.any_left(introduced[0]) && sure.any_left(introduced[1]));
        drop(first);
        assert!(!in_doubt.any_left(introduced[0]) && sure.any_left(introduced[1]));
        drop(second);
        assert!(sure.any_left(introduced[1]));
    }
}
