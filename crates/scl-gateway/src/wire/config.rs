//! The configuration of the network library.
//!
//! Every key is written out, even where the default would do, because defaults and even keys change between versions of
//! the library; unknown keys are errors, and a test reads all of them back.

use std::net::{IpAddr, TcpListener};

use serde_json::{Value, json};

use super::access;
use super::error::WireError;
use super::options::{Peer, WireOptions};

/// A link on which nothing arrives for this long is closed. A loaded machine must not reach this limit, and a dead link
/// should be detected soon.
pub(super) const LEASE_MS: u32 = 2000;
/// Keep-alive messages per lease.
const KEEP_ALIVE: u64 = 5;
/// Longest pause between two attempts to connect: everything resumes within 1 s after the link is back.
const RETRY_MS: u64 = 250;
/// Timeout of an attempt. A lost SYN is retransmitted after 1 s and then after 3 s, so a new attempt after 2 s is
/// sooner.
const OPEN_TIMEOUT_MS: u64 = 2000;

/// Timeout of the TLS handshake of a host that connects, which takes one network round trip. A stranger can keep a
/// handshake open for this long.
const HANDSHAKE_MS: u64 = 1000;

/// Checks the options, and returns the configuration as JSON.
pub(super) fn config(options: &WireOptions) -> Result<Value, WireError> {
    for address in options.listen.iter().chain(options.peers.iter().filter_map(|peer| peer.address.as_ref())) {
        check_address(address, options.tls.is_some() || options.insecure)?;
    }
    if let Some(address) = &options.listen {
        check_free(address)?;
    }
    let protocol = protocol(options);
    let listen: Vec<_> = options.listen.iter().map(|address| listen_endpoint(options, address)).collect();
    let connect: Vec<_> = options.peers.iter().filter_map(|peer| endpoint(options, peer)).collect();
    Ok(json!({
        "mode": "peer",
        "listen": { "endpoints": listen, "timeout_ms": 0, "exit_on_failure": true },
        "connect": {
            "endpoints": connect,
            "timeout_ms": -1,
            "exit_on_failure": false,
            "retry": { "period_init_ms": 100, "period_max_ms": RETRY_MS, "period_increase_factor": 1.5 },
        },
        "open": { "return_conditions": { "connect_scouted": false, "declares": false } },
        "scouting": {
            "delay": 0,
            "multicast": { "enabled": false },
            "gossip": { "enabled": false },
        },
        "timestamping": { "enabled": false },
        "transport": {
            "unicast": {
                "open_timeout": OPEN_TIMEOUT_MS,
                "accept_timeout": OPEN_TIMEOUT_MS,
                "accept_pending": 100,
                "max_links": 1,
                // This mode loses messages over 64 KiB.
                "lowlatency": false,
                "qos": { "enabled": true },
            },
            "link": {
                "protocols": [protocol],
                "tx": {
                    "lease": LEASE_MS,
                    "keep_alive": KEEP_ALIVE,
                    "queue": {
                        // Room for the windows of `lane`, and for the acknowledgements of all routes.
                        "size": {
                            "control": 4, "real_time": 1, "interactive_high": 16, "interactive_low": 1,
                            "data_high": 1, "data": 16, "data_low": 1, "background": 1,
                        },
                        "congestion_control": {
                            "drop": { "wait_before_drop": 1000, "max_wait_before_drop_fragments": 50000 },
                            // Affects declarations only: our own messages never block.
                            "block": { "wait_before_close": 5000000 },
                        },
                        "allocation": { "mode": "lazy" },
                    },
                },
                "tls": tls(options)?,
            },
            "shared_memory": { "enabled": false },
        },
        "adminspace": { "enabled": false, "permissions": { "read": false, "write": false } },
        "access_control": access::access_control(options),
    }))
}

/// Returns the endpoint at which this host connects to a peer; `None` if the peer connects: exactly one of two hosts
/// does.
pub(super) fn endpoint(options: &WireOptions, peer: &Peer) -> Option<String> {
    let address = peer.address.as_ref().filter(|_| options.listen.is_none() || options.host < peer.host)?;
    Some(format!("{}/{address}", protocol(options)))
}

/// Returns the endpoint on which this host listens, with the settings that only an endpoint can have.
fn listen_endpoint(options: &WireOptions, address: &str) -> String {
    let protocol = protocol(options);
    match options.tls.is_some() {
        true => format!("{protocol}/{address}#tls_handshake_timeout_ms={HANDSHAKE_MS}"),
        false => format!("{protocol}/{address}"),
    }
}

fn protocol(options: &WireOptions) -> &'static str {
    if options.tls.is_some() { "tls" } else { "tcp" }
}

fn check_address(address: &str, any: bool) -> Result<(), WireError> {
    let malformed = || WireError::Address { address: address.to_owned() };
    let (host, port) = address.rsplit_once(':').ok_or_else(malformed)?;
    port.parse::<u16>().map_err(|_| malformed())?;
    let literal = host.strip_prefix('[').and_then(|host| host.strip_suffix(']')).unwrap_or(host);
    let ip: Option<IpAddr> = literal.parse().ok();
    let is_unbracketed = literal.contains(':') && literal.len() == host.len();
    let is_foreign = |character: char| !character.is_ascii_alphanumeric() && !".-_:%".contains(character);
    if literal.is_empty() || is_unbracketed || literal.contains(is_foreign) {
        return Err(malformed());
    }
    match any || literal == "localhost" || ip.is_some_and(|ip| ip.is_loopback()) {
        true => Ok(()),
        false => Err(WireError::NoTls { address: address.to_owned() }),
    }
}

/// Checks that this host can listen on an address, because the network library's own error is hard to read.
fn check_free(address: &str) -> Result<(), WireError> {
    let failed = |error: std::io::Error| WireError::Listen { address: address.to_owned(), reason: error.to_string() };
    TcpListener::bind(address).map(drop).map_err(failed)
}

fn tls(options: &WireOptions) -> Result<Value, WireError> {
    let Some(files) = &options.tls else { return Ok(json!({})) };
    let refuse = |reason: String| WireError::Certificates { host: options.host.clone(), reason };
    let mut paths = Vec::new();
    for (path, kind) in
        [(&files.authority, "CERTIFICATE"), (&files.certificate, "CERTIFICATE"), (&files.key, "PRIVATE KEY")]
    {
        let text = std::fs::read_to_string(path).map_err(|error| refuse(format!("`{}`: {error}", path.display())))?;
        if !text.contains(&format!("{kind}-----")) {
            return Err(refuse(format!("`{}` is not a {} in PEM", path.display(), kind.to_lowercase())));
        }
        let path = path.to_str().ok_or_else(|| refuse(format!("the path `{}` is not UTF-8", path.display())))?;
        paths.push(path.to_owned());
    }
    Ok(json!({
        "root_ca_certificate": paths[0],
        "listen_certificate": paths[1],
        "connect_certificate": paths[1],
        "listen_private_key": paths[2],
        "connect_private_key": paths[2],
        "enable_mtls": true,
        "verify_name_on_connect": true,
        "close_link_on_expiration": true,
    }))
}

#[cfg(test)]
mod tests;
