//! Which user is at the other end of a loopback TCP connection.
//!
//! Every user of a machine can connect to 127.0.0.1, and any of them may listen at a port that a killed component left
//! behind. The table of the operating system tells whose a socket is.

use std::fs;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

/// The operating system's number for a socket that listens.
const LISTENING: &str = "0A";

/// Checks the user of an accepted connection.
///
/// # Errors
/// It belongs to another user ([`io::ErrorKind::PermissionDenied`]), or nobody knows to whom.
pub(super) fn check_peer(peer: SocketAddr, own: SocketAddr) -> io::Result<()> {
    check(|table| user_of_connection(table, peer, own))
}

/// Checks the user who listens at an address, before connecting.
///
/// # Errors
/// It is another user ([`io::ErrorKind::PermissionDenied`]), or nobody listens there.
pub(super) fn check_listener(address: SocketAddr) -> io::Result<()> {
    check(|table| user_of_listener(table, address))
}

fn check(find: impl Fn(&str) -> Option<u32>) -> io::Result<()> {
    let user = find(&fs::read_to_string("/proc/self/net/tcp")?);
    let own = rustix::process::geteuid().as_raw();
    match user {
        Some(user) if user == own => Ok(()),
        Some(user) => {
            let reason = format!("the peer belongs to user {user}, this program to user {own}");
            Err(io::Error::new(io::ErrorKind::PermissionDenied, reason))
        }
        // A peer that has just left, or never was there.
        None => Err(io::ErrorKind::ConnectionRefused.into()),
    }
}

/// The user of the socket at the other end of a connection.
fn user_of_connection(table: &str, peer: SocketAddr, own: SocketAddr) -> Option<u32> {
    rows(table).find(|row| SocketAddr::V4(row.local) == peer && SocketAddr::V4(row.remote) == own).map(|row| row.user)
}

/// The user of the socket that listens at an address.
fn user_of_listener(table: &str, address: SocketAddr) -> Option<u32> {
    rows(table).find(|row| row.state == LISTENING && SocketAddr::V4(row.local) == address).map(|row| row.user)
}

#[derive(Debug, PartialEq, Eq)]
struct Row<'t> {
    local: SocketAddrV4,
    remote: SocketAddrV4,
    state: &'t str,
    user: u32,
}

fn rows(table: &str) -> impl Iterator<Item = Row<'_>> {
    // The first line names the columns.
    table.lines().skip(1).filter_map(row)
}

/// Reads `sl local rem st tx:rx tr:when retrnsmt uid ...`.
fn row(line: &str) -> Option<Row<'_>> {
    let mut columns = line.split_ascii_whitespace().skip(1);
    let (local, remote) = (address(columns.next()?)?, address(columns.next()?)?);
    let state = columns.next()?;
    let user = columns.nth(3)?.parse().ok()?;
    Some(Row { local, remote, state, user })
}

/// Reads `0100007F:1F90`: the address as this machine's memory holds it, then the port.
fn address(text: &str) -> Option<SocketAddrV4> {
    let (ip, port) = text.split_once(':')?;
    let ip = u32::from_str_radix(ip, 16).ok()?.to_ne_bytes();
    Some(SocketAddrV4::new(Ipv4Addr::from(ip), u16::from_str_radix(port, 16).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "\
  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode
   0: 0100007F:1F90 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000        0 101 1 0000000000000000 100
   1: 0100007F:1F91 00000000:0000 0A 00000000:00000000 00:00000000 00000000     0        0 102 1 0000000000000000 100
   2: 0100007F:C350 0100007F:1F90 01 00000000:00000000 00:00000000 00000000  1001        0 103 1 0000000000000000 20
   3: 0100007F:1F90 0100007F:C350 01 00000000:00000000 00:00000000 00000000  1000        0 104 1 0000000000000000 20
   4: 0100007F:C351 0100007F:1F92 06 00000000:00000000 03:00001770 00000000     0        0 0 3 0000000000000000
 garbage
";

    fn local(port: u16) -> SocketAddr {
        (Ipv4Addr::LOCALHOST, port).into()
    }

    #[test]
    fn the_user_of_a_socket_is_found_in_the_table() {
        let connections = [((50000, 8080), Some(1001)), ((8080, 50000), Some(1000)), ((50000, 8081), None)];
        for ((peer, own), user) in connections {
            assert_eq!(user_of_connection(TABLE, local(peer), local(own)), user, "{peer} {own}");
        }
        for (port, user) in [(8080, Some(1000)), (8081, Some(0)), (50000, None), (8082, None)] {
            assert_eq!(user_of_listener(TABLE, local(port)), user, "{port}");
        }
        assert_eq!(user_of_listener(TABLE, "[::1]:8080".parse().unwrap()), None);
    }

    #[test]
    fn the_table_of_this_machine_is_understood() {
        let listener = std::net::TcpListener::bind(local(0)).unwrap();
        let address = listener.local_addr().unwrap();
        check_listener(address).unwrap();
        let client = std::net::TcpStream::connect(address).unwrap();
        let (_accepted, peer) = listener.accept().unwrap();
        check_peer(peer, address).unwrap();
        check_peer(address, peer).unwrap();
        drop((client, listener));
        assert_eq!(check_listener(address).unwrap_err().kind(), io::ErrorKind::ConnectionRefused);
    }
}
