//! Ports of this machine for programs that are told where to listen.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::atomic::{AtomicU32, Ordering};

/// Below those that the operating system gives to outgoing connections, which could take one before the program does.
const FIRST: u32 = 10_000;
const COUNT: u32 = 20_000;

/// An address of this machine where nobody listens. Each call returns another one.
///
/// # Panics
/// If no port is free.
pub fn free_address() -> SocketAddr {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    // Processes begin at different numbers.
    let begin = std::process::id().wrapping_mul(199);
    let port = || FIRST + begin.wrapping_add(NEXT.fetch_add(1, Ordering::Relaxed)) % COUNT;
    let address = |_| SocketAddr::from((Ipv4Addr::LOCALHOST, u16::try_from(port()).expect("a port")));
    (0..COUNT).map(address).find(|address| TcpListener::bind(address).is_ok()).expect("a free port")
}
