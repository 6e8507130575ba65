//! Finding the address of an endpoint.

use super::SystemDir;
use super::bind::tcp_file;
use super::small_file::read_file;
use std::fs;
use std::net::SocketAddr;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Maximum size of an address file that is read, in bytes: more than any address takes.
const ADDRESS_LIMIT: u64 = 256;

/// The address of an endpoint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Address {
    /// The file of a Unix socket.
    Ipc(PathBuf),
    /// A TCP address.
    Tcp(SocketAddr),
}

/// Finds the address of an endpoint, if it has been bound.
///
/// If there is both a socket and a TCP address, the older one was left behind by a killed process, and the newer one is
/// returned. Whether a peer is listening there shows only when connecting.
pub fn find(dir: &SystemDir, endpoint: &str) -> Option<Address> {
    let path = dir.path(endpoint).ok()?;
    match (find_ipc(&path), find_tcp(&tcp_file(&path))) {
        (Some((older, _)), Some((newer, tcp))) if newer > older => Some(tcp),
        (Some((_, ipc)), _) => Some(ipc),
        (None, tcp) => tcp.map(|(_, tcp)| tcp),
    }
}

fn find_ipc(path: &Path) -> Option<(SystemTime, Address)> {
    let found = fs::symlink_metadata(path).ok().filter(|found| found.file_type().is_socket())?;
    Some((found.modified().ok()?, Address::Ipc(path.to_owned())))
}

fn find_tcp(file: &Path) -> Option<(SystemTime, Address)> {
    let written = fs::symlink_metadata(file).ok()?.modified().ok()?;
    let text = String::from_utf8(read_file(file, ADDRESS_LIMIT).ok()?).ok()?;
    let address: SocketAddr = text.trim().parse().ok()?;
    (address.port() != 0).then_some((written, Address::Tcp(address)))
}
