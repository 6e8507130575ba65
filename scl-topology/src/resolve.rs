//! Where the gates of a checked topology meet: contracts and the names of sockets.
//!
//! A contract is a short mark of what two ends must agree on: pattern, types, codec. It stands in the name of the
//! socket, so programs that were built from different contracts never meet. Names of gates, options and other parts of
//! the file do not change it.

use crate::topology::{Codec, ConnectionId, Gate, GateId, GateKind, Payload, Topology};

/// The longest path of a socket, in bytes, without the final zero (`sun_path` of Linux).
pub const LONGEST_PATH: usize = 107;

/// The characters of a contract.
pub const CONTRACT_LENGTH: usize = 8;

/// The folder of all systems where it is longest: the largest user id there is.
const LONGEST_ROOT: &str = "/run/user/4294967295/scl";

/// The contract of a connection: eight characters of `a-z2-7`.
pub fn contract(topology: &Topology, connection: ConnectionId) -> String {
    // The receiving end has one contract for all its peers, so it is the one that counts.
    gate_contract(topology, topology.connection(connection).sink())
}

/// The contract of a gate with any of its peers: eight characters of `a-z2-7`.
pub fn gate_contract(topology: &Topology, gate: GateId) -> String {
    let gate = topology.gate(gate);
    let pattern = match gate.kind() {
        GateKind::Pub | GateKind::Sub => "pub/sub",
        GateKind::Req | GateKind::Rep => "req/rep",
        GateKind::Push | GateKind::Pull => "push/pull",
    };
    let [first, second] = type_texts(gate);
    fingerprint([pattern, first, second, codec_text(gate.codec())])
}

/// The name of a connection's socket in the folder of its system.
///
/// For `pub` and `sub` it is `<pub>.<gate>--<sub>.<gate>.<contract>`. Where the longest usual folder leaves no room for
/// that, the end of the gates' names is replaced by `~` and a fingerprint of them; the contract always stays the part
/// after the last dot. For `req` and `push` it is the socket of the gate at the other end, see [`gate_endpoint`].
pub fn endpoint(topology: &Topology, connection: ConnectionId) -> String {
    let link = topology.connection(connection);
    if let Some(own) = shared_endpoint(topology, link.sink()) {
        return own;
    }
    let pair = format!("{}--{}", topology.gate_path(link.source()), topology.gate_path(link.sink()));
    let room = LONGEST_PATH.saturating_sub(folder_length(topology.system()) + 1 + CONTRACT_LENGTH);
    format!("{}.{}", shortened(&pair, room), contract(topology, connection))
}

/// The name of the socket that belongs to a gate as a whole.
///
/// `rep` and `pull` gates listen at `<component>.<gate>.<contract>`, a `pub` gate lets tools listen at its tap
/// `<component>.<gate>`; the other gates have none.
pub fn gate_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    match topology.gate(gate).kind() {
        GateKind::Pub => Some(topology.gate_path(gate)),
        _ => shared_endpoint(topology, gate),
    }
}

fn shared_endpoint(topology: &Topology, gate: GateId) -> Option<String> {
    matches!(topology.gate(gate).kind(), GateKind::Rep | GateKind::Pull)
        .then(|| format!("{}.{}", topology.gate_path(gate), gate_contract(topology, gate)))
}

/// The longest usual folder of a system, with a slash at its end.
pub(crate) fn longest_folder(system: &str) -> String {
    format!("{LONGEST_ROOT}/{system}/")
}

pub(crate) fn folder_length(system: &str) -> usize {
    LONGEST_ROOT.len() + system.len() + 2
}

/// Names are ASCII once they are checked, so that any byte is the end of a character.
fn shortened(pair: &str, room: usize) -> String {
    if pair.len() <= room {
        return pair.to_owned();
    }
    let kept = room.saturating_sub(1 + CONTRACT_LENGTH);
    format!("{}~{}", pair.get(..kept).unwrap_or(""), fingerprint([pair]))
}

fn type_texts(gate: &Gate) -> [&str; 2] {
    match gate.payload() {
        Payload::Bytes => ["", ""],
        Payload::Message(name) => [name.dotted(), ""],
        Payload::Exchange { request, reply } => [request.dotted(), reply.dotted()],
    }
}

fn codec_text(codec: &Codec) -> &str {
    match codec {
        Codec::Protobuf => "protobuf",
        Codec::Json => "json",
        Codec::Cbor => "cbor",
        Codec::Msgpack => "msgpack",
        Codec::Postcard => "postcard",
        Codec::Raw => "raw",
        Codec::Path(path) => path,
    }
}

/// Forty bits of FNV-1a (64 bits) over the parts, as eight characters. Written out here because programs of different
/// versions and languages must agree on it for ever.
pub(crate) fn fingerprint<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    const ALPHABET: &[u8; 32] = b"abcdefghijklmnopqrstuvwxyz234567";
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for part in parts {
        // The zero after each part keeps `ab`, `c` and `a`, `bc` apart.
        for byte in part.bytes().chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    // The upper half of the product has met every byte; the lower one folds in what it lacks.
    let folded = hash ^ (hash >> 40);
    let letter = |at: usize| char::from(ALPHABET[(folded >> (5 * at)) as usize % 32]);
    (0..CONTRACT_LENGTH).map(letter).collect()
}
