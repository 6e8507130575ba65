//! Asking the kernel for one TCP socket, over netlink (`sock_diag(7)`).
//!
//! A lookup by both addresses costs some microseconds, however many sockets the machine has.

use super::{LISTENING, Owner, Socket};
use bytes::{Buf, BufMut};
use rustix::io::Errno;
use rustix::net::netlink::{SOCK_DIAG, SocketAddrNetlink};
use rustix::net::{AddressFamily, RecvFlags, SendFlags, SocketFlags, SocketType, recv, sendto, socket_with};
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::os::fd::OwnedFd;
use std::sync::OnceLock;

/// `SOCK_DIAG_BY_FAMILY`, the type of the request and of its answer.
const BY_FAMILY: u16 = 20;
const NLM_F_REQUEST: u16 = 1;
const NLMSG_ERROR: u16 = 2;
const IPPROTO_TCP: u8 = 6;
/// Lengths of `struct nlmsghdr`, alone and followed by `struct inet_diag_req_v2` or `struct inet_diag_msg`.
const HEADER: usize = 16;
const REQUEST: usize = HEADER + 56;
const ANSWER: usize = HEADER + 72;

/// Whether the kernel answers such queries. Containers and sandboxes may refuse them.
///
/// # Errors
/// This cannot be determined now, for example without free file descriptors.
pub(super) fn is_available() -> io::Result<bool> {
    static AVAILABLE: OnceLock<bool> = OnceLock::new();
    if let Some(available) = AVAILABLE.get() {
        return Ok(*available);
    }
    // A missing kernel module gives the same answer as a missing socket, so this asks for one that exists.
    let probe = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    let address = probe.local_addr()?;
    let available = match SockDiag::open().and_then(|kernel| kernel.find(Socket::listening(address))) {
        Ok(found) => found.is_some(),
        Err(error) if is_passing(&error) => return Err(error),
        Err(error) => {
            tracing::debug!(%error, "cannot use sock_diag");
            false
        }
    };
    if !available {
        tracing::info!(
            "the kernel does not answer `sock_diag`; reading /proc/self/net/tcp for each connection instead"
        );
    }
    Ok(*AVAILABLE.get_or_init(|| available))
}

/// Whether an error is temporary, rather than about what the program is allowed to do.
fn is_passing(error: &io::Error) -> bool {
    let errors = [Errno::MFILE, Errno::NFILE, Errno::NOMEM, Errno::NOBUFS, Errno::AGAIN, Errno::INTR];
    Errno::from_io_error(error).is_some_and(|error| errors.contains(&error))
}

/// A connection to the kernel.
pub(super) struct SockDiag(OwnedFd);

impl SockDiag {
    pub(super) fn open() -> io::Result<Self> {
        let socket = socket_with(AddressFamily::NETLINK, SocketType::DGRAM, SocketFlags::CLOEXEC, Some(SOCK_DIAG));
        Ok(Self(socket?))
    }

    /// Returns the owner of a socket with exactly these addresses, if there is one.
    pub(super) fn find(&self, socket: Socket) -> io::Result<Option<Owner>> {
        sendto(&self.0, &request(socket), SendFlags::empty(), &SocketAddrNetlink::new(0, 0))?;
        // The kernel has answered before `sendto` returns. Only the kernel may send to a socket of this protocol.
        let mut buffer = [0; 1024];
        let (received, _) = recv(&self.0, &mut buffer, RecvFlags::DONTWAIT)?;
        answer(&buffer[..received], socket)
    }
}

fn request(socket: Socket) -> [u8; REQUEST] {
    let mut request = [0; REQUEST];
    let mut rest = &mut request[..];
    rest.put_u32_ne(REQUEST as u32);
    rest.put_u16_ne(BY_FAMILY);
    rest.put_u16_ne(NLM_F_REQUEST);
    // `nlmsg_seq` and `nlmsg_pid`, which are not needed.
    rest.put_bytes(0, 8);
    let family = if socket.local.is_ipv4() { AddressFamily::INET } else { AddressFamily::INET6 };
    rest.put_slice(&[family.as_raw() as u8, IPPROTO_TCP, 0, 0]);
    // Match sockets in all states.
    rest.put_u32_ne(u32::MAX);
    rest.put_u16(socket.local.port());
    rest.put_u16(socket.remote.port());
    rest.put_slice(&octets(socket.local.ip()));
    rest.put_slice(&octets(socket.remote.ip()));
    // Match any interface.
    rest.put_u32_ne(0);
    // `INET_DIAG_NOCOOKIE`: match any cookie.
    rest.put_bytes(0xff, 8);
    request
}

fn octets(ip: IpAddr) -> [u8; 16] {
    let mut octets = [0; 16];
    match ip {
        IpAddr::V4(ip) => octets[..4].copy_from_slice(&ip.octets()),
        IpAddr::V6(ip) => octets = ip.octets(),
    }
    octets
}

fn answer(bytes: &[u8], asked: Socket) -> io::Result<Option<Owner>> {
    let malformed = || io::Error::from(io::ErrorKind::InvalidData);
    let kind = bytes.get(4..6).map(|mut kind| kind.get_u16_ne());
    if kind == Some(NLMSG_ERROR) {
        let number = bytes.get(HEADER..HEADER + 4).map(|mut number| number.get_i32_ne());
        return match number.map(|number| Errno::from_raw_os_error(number.wrapping_neg())) {
            Some(Errno::NOENT) => Ok(None),
            Some(error) => Err(error.into()),
            None => Err(malformed()),
        };
    }
    let (Some(BY_FAMILY), Some(mut message)) = (kind, bytes.get(HEADER..ANSWER)) else { return Err(malformed()) };
    let (is_ipv4, state) = (u16::from(message.get_u8()) == AddressFamily::INET.as_raw(), message.get_u8());
    // Skip `idiag_timer` and `idiag_retrans`.
    message.advance(2);
    let [local_port, remote_port] = [message.get_u16(), message.get_u16()];
    let [local, remote] = [message.get_u128(), message.get_u128()].map(|ip| match is_ipv4 {
        true => IpAddr::from(((ip >> 96) as u32).to_be_bytes()),
        false => IpAddr::from(ip.to_be_bytes()).to_canonical(),
    });
    let found = Socket {
        local: SocketAddr::new(local, local_port),
        remote: SocketAddr::new(remote, remote_port),
        listens: state == LISTENING,
    };
    // Skip interface, cookie, expiry and queues.
    message.advance(24);
    let owner = Owner { user: message.get_u32_ne(), inode: message.get_u32_ne() };
    // If no socket matches exactly, the kernel returns the one that listens on the port, at whatever address.
    Ok(found.is(asked).then_some(owner))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_laid_out_as_the_kernel_reads_it() {
        let socket = Socket::connected("127.0.0.1:8080".parse().unwrap(), "127.0.0.1:50000".parse().unwrap());
        let mut expected = vec![];
        expected.extend(72_u32.to_ne_bytes());
        expected.extend(20_u16.to_ne_bytes());
        expected.extend(1_u16.to_ne_bytes());
        expected.extend([0; 8]);
        expected.extend([2, 6, 0, 0, 255, 255, 255, 255]);
        expected.extend([0x1f, 0x90, 0xc3, 0x50, 127, 0, 0, 1]);
        expected.extend([0; 12]);
        expected.extend([127, 0, 0, 1]);
        expected.extend([0; 16]);
        expected.extend([255; 8]);
        assert_eq!(request(socket)[..], expected);
    }

    #[test]
    fn answers_that_are_cut_off_are_errors() {
        let asked = Socket::listening("127.0.0.1:8080".parse().unwrap());
        let mut message = [0; ANSWER];
        message[4..6].copy_from_slice(&BY_FAMILY.to_ne_bytes());
        for length in 0..ANSWER {
            assert!(answer(&message[..length], asked).is_err(), "{length}");
        }
    }
}
