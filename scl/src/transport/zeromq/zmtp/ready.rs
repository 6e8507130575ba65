//! READY: what both sides say about themselves after the greeting.

use super::super::memory_format::memory_format;
use super::frame::{COMMAND, Header};
use super::{ProtocolError, SocketType, greeting};
use crate::runtime_dir::SystemDir;
use crate::transport::{PeerKind, Window};
use bytes::Buf;
use std::os::unix::ffi::OsStrExt;

/// The property that tells SCL's ends from other ZeroMQ programs.
const SCL_PROPERTY: &[u8] = b"X-SCL";
/// The version of SCL's additions. A peer with another version is treated as a plain ZeroMQ program.
const SCL_VERSION: &str = "1";

/// Maximum number of unanswered requests of one requester for which a replier keeps room. A requester that announces
/// more is treated as if it had announced one.
const MOST_IN_FLIGHT: usize = 4096;

/// What a peer has said about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::transport::zeromq) struct PeerReady {
    /// Present if the peer is an SCL end whose version is known.
    pub(in crate::transport::zeromq) scl: Option<SclReady>,
    /// The service in which both ends share memory, if one end offers it and both can. READY contains it only if the
    /// peer is the end that offers it.
    pub(in crate::transport::zeromq) service: Option<u128>,
}

impl PeerReady {
    pub(in crate::transport::zeromq) fn kind(&self) -> PeerKind {
        if self.scl.is_some() { PeerKind::Component } else { PeerKind::Foreign }
    }

    /// Fails if the peer is an end of another connection.
    pub(in crate::transport::zeromq) fn check(self, own: ConnectionId) -> Result<Self, ProtocolError> {
        match self.scl.and_then(|scl| scl.connection) {
            Some(other) if other != own => Err(ProtocolError::OtherConnection),
            _ => Ok(self),
        }
    }
}

/// The value of the property `X-SCL`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(in crate::transport::zeromq) struct SclReady {
    /// How much may be sent to this end without acknowledgement.
    pub(in crate::transport::zeromq) window: Option<Window>,
    /// Whether only the newest message matters to this end.
    pub(in crate::transport::zeromq) newest_only: bool,
    /// Whether this sending end waits instead of dropping messages.
    pub(in crate::transport::zeromq) lossless: bool,
    /// How many requests this requesting end may have sent without a reply, if more than one.
    pub(in crate::transport::zeromq) in_flight: Option<usize>,
    /// Whether this publishing end keeps its last message for subscribers that join.
    pub(in crate::transport::zeromq) latched: bool,
    /// Present if this end can share memory with one that has the same engine and user.
    pub(in crate::transport::zeromq) shm: Option<ShmReady>,
    /// The connection that this end belongs to. An older release does not tell.
    pub(in crate::transport::zeromq) connection: Option<ConnectionId>,
}

/// Tells the connections of all systems of a machine apart.
///
/// The address that a killed program leaves behind may by now be that of any other end, which speaks the same protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::transport::zeromq) struct ConnectionId(u64);

impl ConnectionId {
    /// The 64-bit FNV-1a of `system/endpoint`.
    pub(in crate::transport::zeromq) fn of(dir: &SystemDir, endpoint: &str) -> Self {
        let system = dir.folder().file_name().unwrap_or_default().as_bytes();
        let bytes = system.iter().chain(b"/").chain(endpoint.as_bytes());
        Self(bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)))
    }

    /// Returns `None` if the text is malformed, as for an end that does not tell.
    fn parse(text: &str) -> Option<Self> {
        let are_digits = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        u64::from_str_radix(text, 16).ok().filter(|_| are_digits).map(Self)
    }

    fn encode(self) -> String {
        format!(" connection={:016x}", self.0)
    }
}

/// What an end that can share memory announces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(in crate::transport::zeromq) struct ShmReady {
    /// The service that a listening end offers.
    pub(in crate::transport::zeromq) service: Option<u128>,
}

impl SclReady {
    fn encode(self) -> String {
        let window =
            self.window.map_or_else(String::new, |Window { messages, bytes }| format!(" window={messages},{bytes}"));
        let newest = if self.newest_only { " newest" } else { "" };
        let lossless = if self.lossless { " lossless" } else { "" };
        let latched = if self.latched { " latched" } else { "" };
        let in_flight = self.in_flight.map_or_else(String::new, |requests| format!(" in-flight={requests}"));
        let shm = self.shm.map_or_else(String::new, ShmReady::encode);
        let connection = self.connection.map_or_else(String::new, ConnectionId::encode);
        format!("{SCL_VERSION}{window}{newest}{lossless}{latched}{in_flight}{shm}{connection}")
    }

    /// Returns `None` for another version. Unknown words are ignored, so that the value can grow.
    fn parse(value: &[u8]) -> Result<Option<Self>, ProtocolError> {
        let mut words = std::str::from_utf8(value).unwrap_or_default().split(' ');
        if words.next() != Some(SCL_VERSION) {
            return Ok(None);
        }
        let mut ready = Self::default();
        for word in words {
            match (word, word.split_once('=')) {
                ("newest", _) => ready.newest_only = true,
                ("lossless", _) => ready.lossless = true,
                ("latched", _) => ready.latched = true,
                (_, Some(("window", window))) => ready.window = parse_window(window),
                (_, Some(("in-flight", requests))) => {
                    ready.in_flight = requests.parse().ok().filter(|&requests| requests <= MOST_IN_FLIGHT);
                }
                (_, Some(("shm", shm))) => ready.shm = ShmReady::parse(shm)?,
                (_, Some(("connection", connection))) => ready.connection = ConnectionId::parse(connection),
                _ => {}
            }
        }
        Ok(Some(ready))
    }
}

impl ShmReady {
    /// Returns what a connecting end announces: that it can share memory, if its messages go one way. The listening end
    /// decides.
    pub(in crate::transport::zeromq) fn of_dialling(socket: SocketType) -> Option<Self> {
        let goes_one_way = matches!(socket, SocketType::Sub | SocketType::Push);
        memory_format().filter(|_| goes_one_way).map(|_| Self::default())
    }

    fn encode(self) -> String {
        let Some(format) = memory_format() else { return String::new() };
        let service = self.service.map_or_else(String::new, |service| format!(",{service:032x}"));
        format!(" shm={format}{service}")
    }

    /// Returns `None` if the engine, its version, the width of pointers or the user differs from this end's.
    fn parse(text: &str) -> Result<Option<Self>, ProtocolError> {
        let Some(rest) = memory_format().and_then(|format| text.strip_prefix(&*format)) else {
            return Ok(None);
        };
        match rest.strip_prefix(',') {
            Some(service) => {
                let service = parse_service(service).ok_or(ProtocolError::MalformedReady)?;
                Ok(Some(Self { service: Some(service) }))
            }
            None => Ok(rest.is_empty().then_some(Self { service: None })),
        }
    }
}

/// Reads the 32 hexadecimal digits that name a service.
fn parse_service(text: &str) -> Option<u128> {
    let are_digits = text.len() == 32 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
    u128::from_str_radix(text, 16).ok().filter(|_| are_digits)
}

/// A window of zero messages or bytes would never let a message pass, so it counts as no window.
fn parse_window(text: &str) -> Option<Window> {
    let (messages, bytes) = text.split_once(',')?;
    let number = |text: &str| text.parse().ok().filter(|&number: &u64| number > 0);
    Some(Window { messages: number(messages)?, bytes: number(bytes)? })
}

/// What an end sends as soon as it is connected: greeting and READY.
pub(in crate::transport::zeromq) fn hello(socket: SocketType, scl: SclReady) -> Vec<u8> {
    let mut body = b"\x05READY".to_vec();
    put_property(&mut body, b"Socket-Type", socket.word().as_bytes());
    put_property(&mut body, SCL_PROPERTY, scl.encode().as_bytes());
    [&greeting::greeting()[..], Header::new(COMMAND, body.len()).as_bytes(), &body].concat()
}

fn put_property(body: &mut Vec<u8>, name: &[u8], value: &[u8]) {
    body.push(name.len() as u8);
    body.extend_from_slice(name);
    body.extend_from_slice(&(value.len() as u32).to_be_bytes());
    body.extend_from_slice(value);
}

/// Reads the properties of a peer's READY.
pub(super) fn parse(socket: SocketType, mut properties: &[u8]) -> Result<PeerReady, ProtocolError> {
    let (mut peer, mut scl) = (None, None);
    while !properties.is_empty() {
        let (name, value, rest) = split_property(properties).ok_or(ProtocolError::MalformedReady)?;
        if name.eq_ignore_ascii_case(b"Socket-Type") {
            peer = Some(value);
        } else if name.eq_ignore_ascii_case(SCL_PROPERTY) {
            scl = SclReady::parse(value)?;
        }
        properties = rest;
    }
    let peer = peer.ok_or(ProtocolError::MalformedReady)?;
    if !socket.peers().contains(&peer) {
        let shown = &peer[..peer.len().min(16)];
        return Err(ProtocolError::SocketType { own: socket, peer: shown.escape_ascii().to_string() });
    }
    Ok(PeerReady { scl, service: scl.and_then(|scl| scl.shm).and_then(|shm| shm.service) })
}

fn split_property(properties: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (&length, rest) = properties.split_first()?;
    let (name, mut rest) = rest.split_at_checked(length.into())?;
    let length = rest.try_get_u32().ok()?;
    let (value, rest) = rest.split_at_checked(length as usize)?;
    Some((name, value, rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime_dir::RuntimeDir;

    #[test]
    fn ends_of_another_connection_are_refused() {
        let peer = |connection| PeerReady { scl: Some(SclReady { connection, ..SclReady::default() }), service: None };
        let own = ConnectionId(1);
        // The last two are an end of an older release, and a plain ZeroMQ program.
        for accepted in [peer(Some(own)), peer(None), PeerReady { scl: None, service: None }] {
            assert_eq!(accepted.clone().check(own), Ok(accepted));
        }
        assert_eq!(peer(Some(ConnectionId(2))).check(own), Err(ProtocolError::OtherConnection));
    }

    #[test]
    fn the_connection_is_told_in_sixteen_digits() {
        let folder = tempfile::tempdir().unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
        let dir = RuntimeDir::locate(&variable).unwrap().system("rover").unwrap();
        // FNV-1a of `rover/sensor.out--controller.in.1a2b3c4d`.
        let id = ConnectionId::of(&dir, "sensor.out--controller.in.1a2b3c4d");
        assert_eq!(id.encode(), " connection=ffa1c03bf2446447");
        assert_eq!(ConnectionId::parse("ffa1c03bf2446447"), Some(id));
        for malformed in ["", "1", "+23456789abcdef0", "0123456789abcdefg", "00000000000000000"] {
            assert_eq!(ConnectionId::parse(malformed), None, "{malformed}");
        }
    }

    #[test]
    fn names_of_services_are_parsed_or_refused() {
        assert_eq!(parse_service("00112233445566778899aabbccddeeff"), Some(0x0011_2233_4455_6677_8899_aabb_ccdd_eeff));
        for wrong in ["", "abc", &"g".repeat(32), &"A".repeat(32), &"a".repeat(33), "../../../../../../../../etc/pass"]
        {
            assert_eq!(parse_service(wrong), None, "{wrong}");
        }
    }
}
