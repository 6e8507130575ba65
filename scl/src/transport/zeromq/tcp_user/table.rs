//! The tables of all TCP sockets, used where the kernel does not answer queries about a single one.
//!
//! The kernel writes a row for every socket of the machine, which takes milliseconds. So reading may use at most a
//! twentieth of a processor, and connections that arrive together share one read.

use super::{LISTENING, Owner, Socket};
use crate::sync::lock;
use std::fs;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The pause after a read, as a multiple of the processor time that the read took.
const PAUSE: u32 = 19;

/// When the tables may be read again.
static NEXT_READ: Mutex<Option<Instant>> = Mutex::new(None);

/// Returns when the tables may be read again, or `None` if they may be read now.
pub(super) fn next_read() -> Option<Instant> {
    (*lock(&NEXT_READ)).filter(|next| *next > Instant::now())
}

/// The tables of IPv4 and IPv6 at some moment.
pub(super) struct Tables([String; 2]);

impl Tables {
    /// Reads both tables.
    ///
    /// # Errors
    /// They were read a moment ago ([`io::ErrorKind::WouldBlock`]), or cannot be read.
    pub(super) fn read() -> io::Result<Self> {
        let mut next_read = lock(&NEXT_READ);
        if next_read.is_some_and(|next| next > Instant::now()) {
            return Err(io::ErrorKind::WouldBlock.into());
        }
        let begun = processor_time();
        // A machine without IPv6 has no such table.
        let tables =
            [fs::read_to_string("/proc/self/net/tcp"), fs::read_to_string("/proc/self/net/tcp6").or(Ok(String::new()))];
        *next_read = Some(Instant::now() + processor_time().saturating_sub(begun) * PAUSE);
        let [tcp, tcp6] = tables;
        Ok(Self([tcp?, tcp6?]))
    }

    /// Returns the owner of a socket with exactly these addresses, if there is one.
    pub(super) fn find(&self, socket: Socket) -> Option<Owner> {
        // The first line names the columns.
        let mut rows = self.0.iter().flat_map(|table| table.lines().skip(1).filter_map(row));
        rows.find(|(found, _)| found.is(socket)).map(|(_, owner)| owner)
    }
}

/// Returns the processor time that this thread has used. On a busy machine a read lasts much longer than its processor
/// time, and a pause of 19 times that duration would keep peers apart for seconds.
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Reads `sl local rem st tx:rx tr:when retrnsmt uid timeout inode ...`.
fn row(line: &str) -> Option<(Socket, Owner)> {
    let mut columns = line.split_ascii_whitespace().skip(1);
    let (local, remote) = (address(columns.next()?)?, address(columns.next()?)?);
    let listens = u8::from_str_radix(columns.next()?, 16).ok()? == LISTENING;
    let user = columns.nth(3)?.parse().ok()?;
    let inode = columns.nth(1)?.parse().ok()?;
    Some((Socket { local, remote, listens }, Owner { user, inode }))
}

/// Reads `0100007F:1F90`: the address in words as this machine's memory holds them, then the port.
fn address(text: &str) -> Option<SocketAddr> {
    let (ip, port) = text.split_once(':')?;
    let word = |at: usize| Some(u32::from_str_radix(ip.get(at..at + 8)?, 16).ok()?.to_ne_bytes());
    let ip = match ip.len() {
        8 => IpAddr::V4(Ipv4Addr::from(word(0)?)),
        32 => {
            let words = [word(0)?, word(8)?, word(16)?, word(24)?];
            IpAddr::V6(Ipv6Addr::from(<[u8; 16]>::try_from(words.as_flattened()).ok()?)).to_canonical()
        }
        _ => return None,
    };
    Some(SocketAddr::new(ip, u16::from_str_radix(port, 16).ok()?))
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
    const TABLE_6: &str = "\
  sl  local_address                         remote_address                        st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode
   0: 00000000000000000000000001000000:1F93 00000000000000000000000000000000:0000 0A 00000000:00000000 00:00000000 00000000  1003        0 105 1 0000000000000000 100
   1: 0000000000000000FFFF00000100007F:C352 0000000000000000FFFF00000100007F:1F90 01 00000000:00000000 00:00000000 00000000  1004        0 106 1 0000000000000000 20
";

    fn local(port: u16) -> SocketAddr {
        (Ipv4Addr::LOCALHOST, port).into()
    }

    #[test]
    fn the_user_of_a_socket_is_found_in_the_tables() {
        let tables = Tables([TABLE.to_owned(), TABLE_6.to_owned()]);
        let user = |socket| tables.find(socket).map(|owner| owner.user);
        let connections = [
            ((50000, 8080), Some(1001)),
            ((8080, 50000), Some(1000)),
            ((50000, 8081), None),
            ((50002, 8080), Some(1004)),
        ];
        for ((peer, own), expected) in connections {
            assert_eq!(user(Socket::connected(local(peer), local(own))), expected, "{peer} {own}");
        }
        for (port, expected) in [(8080, Some(1000)), (8081, Some(0)), (50000, None), (8082, None), (8083, None)] {
            assert_eq!(user(Socket::listening(local(port))), expected, "{port}");
        }
        assert_eq!(user(Socket::listening("[::1]:8083".parse().unwrap())), Some(1003));
        assert_eq!(user(Socket::listening("[::1]:8080".parse().unwrap())), None);
    }
}
