use std::{
    fs,
    net::SocketAddr,
    os::unix::fs::FileTypeExt,
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    SystemDir,
    announcement::{AnnouncedEndpoint, Announcement},
    bind::tcp_file,
    small_file::read_file,
};

/// Where an endpoint can be reached.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Address {
    /// The file of a Unix socket.
    Ipc(PathBuf),
    /// A TCP address.
    Tcp(SocketAddr),
}

/// Finds where an endpoint can be reached now, if its component has bound it.
///
/// Of a socket and a TCP address the newer one counts; the other was left behind by a killed program. Whether anybody still
/// listens there shows when one connects.
pub fn find(dir: &SystemDir, endpoint: &str) -> Option<Address> {
    let path = dir.path(endpoint).ok()?;
    match (find_ipc(&path), find_tcp(&tcp_file(&path))) {
        (Some((older, _)), Some((newer, tcp))) if newer > older => Some(tcp),
        (Some((_, ipc)), _) => Some(ipc),
        (None, tcp) => tcp.map(|(_, tcp)| tcp),
    }
}

/// An endpoint of the wanted name that was built for another contract.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Announced {
    /// The whole name of the endpoint.
    pub endpoint: String,
    /// The contract, its last part.
    pub contract: String,
    /// What its component says about it, if it does: the gate, the type, the codec.
    pub details: Option<AnnouncedEndpoint>,
}

/// Finds the endpoints that are called like the wanted one but were built for another contract, sorted by name.
///
/// `endpoint` is the name without its contract. This is for error texts, so what cannot be read counts as absent.
pub fn other_contracts(dir: &SystemDir, endpoint: &str, own_contract: &str) -> Vec<Announced> {
    let entries = fs::read_dir(dir.folder()).into_iter().flatten().flatten();
    let mut contracts: Vec<String> = entries
        .filter_map(|entry| contract_of(entry.file_name().to_str()?, endpoint))
        .filter(|contract| contract != own_contract)
        .filter(|contract| find(dir, &format!("{endpoint}.{contract}")).is_some())
        .collect();
    contracts.sort();
    contracts.dedup();
    contracts.into_iter().map(|contract| announced(dir, endpoint, contract)).collect()
}

fn announced(dir: &SystemDir, endpoint: &str, contract: String) -> Announced {
    let whole = format!("{endpoint}.{contract}");
    let component = endpoint.split('.').next().unwrap_or_default();
    let announcement = Announcement::read(dir, component);
    let details =
        announcement.and_then(|found| found.endpoints.into_iter().find(|announced| announced.endpoint == whole));
    Announced { endpoint: whole, contract, details }
}

fn contract_of(file: &str, endpoint: &str) -> Option<String> {
    let rest = file.strip_prefix(endpoint)?.strip_prefix('.')?;
    let contract = rest.strip_suffix(".tcp").unwrap_or(rest);
    (!contract.is_empty() && !contract.contains('.')).then(|| contract.to_owned())
}

fn find_ipc(path: &Path) -> Option<(SystemTime, Address)> {
    let seen = fs::symlink_metadata(path).ok().filter(|seen| seen.file_type().is_socket())?;
    Some((seen.modified().ok()?, Address::Ipc(path.to_owned())))
}

fn find_tcp(file: &Path) -> Option<(SystemTime, Address)> {
    let written = fs::symlink_metadata(file).ok()?.modified().ok()?;
    let address: SocketAddr = read_file(file).ok()?.trim().parse().ok()?;
    (address.port() != 0).then_some((written, Address::Tcp(address)))
}
